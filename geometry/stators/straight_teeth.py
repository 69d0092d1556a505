"""A stator around its rotor with straight teeth (thesis Fig. 3.16)."""

from __future__ import annotations

from cmath import phase, rect
from dataclasses import dataclass
from math import acos, asin, sin

from geometry.errors import GeometryError, in_mm
from geometry.parts import Length, Rim, Segment, StatorRoundRotor
from geometry.plane_mesh import Drawing
from units import MILLIMETRE

_SMALLEST_GAP_BETWEEN_SHOES = 0.05 * MILLIMETRE  # below this the shoes touch within any lamination tolerance
_SMALLEST_SLOT_DEPTH = 0.2 * MILLIMETRE  # between the shoe and the slot bottom, for the slot to hold any copper


@dataclass(frozen=True)
class StraightTeeth(StatorRoundRotor):
    """The slot has a parallel-sided opening of depth ``shoe_d1``, a straight taper to the tooth flank over ``shoe_d2``
    (see ``taper_angle``), straight tooth flanks and an arc bottom. Lengths in m.
    """

    slots: int
    outer_radius: Length  # R_so
    bore_radius: Length  # R_si
    back_iron_width: Length  # w_bi
    tooth_width: Length  # w_tb
    slot_opening: Length  # w_s
    shoe_d1: Length  # depth of the parallel-sided opening [m]
    shoe_d2: Length  # depth of the taper [m]

    @property
    def slot_radii(self) -> tuple[float, float]:
        """Of the ends of the coil sides [m]."""
        return self.shoe_top_radius, self.slot_bottom_radius

    @property
    def tooth_probe(self) -> Segment:
        """At mid height [m]."""
        distance = (self.shoe_top_radius + self.slot_bottom_radius) / 2
        return (distance, -self.tooth_width / 2), (distance, self.tooth_width / 2)

    @property
    def back_iron_probe(self) -> Segment:
        """Radially [m]."""
        return (self.slot_bottom_radius, 0.0), (self.outer_radius, 0.0)

    @property
    def slot_bottom_radius(self) -> float:
        """R_sb = R_so - w_bi (eq. 3.56)."""
        return self.outer_radius - self.back_iron_width

    @property
    def opening_width(self) -> float:
        """Distance between neighbouring shoes at the bore: tau_s - w_t, w_t = max(tau_s - w_s, w_tb) (eq. 3.54)."""
        return min(self.slot_opening, self.pitch * self.bore_radius - self.tooth_width)

    @property
    def opening_top_radius(self) -> float:
        """Radius at which the parallel-sided opening ends and the taper begins, R_si + d_1 [m]."""
        return self.bore_radius + self.shoe_d1

    @property
    def opening_top_angle(self) -> float:
        """Angle of that end from the tooth axis [rad]."""
        return self.pitch / 2 - asin(self.opening_width / 2 / self.opening_top_radius)

    @property
    def taper_angle(self) -> float:
        """Angle from the tooth axis at which the straight taper leaves the shoe [rad].

        That is the end of the opening, unless the shoe spans so wide an angle (few slots) that a straight line from
        there would cut through it, or through the bore: then the shoe keeps its depth d_1 up to the line that touches
        it.
        """
        flank = asin(self.tooth_width / 2 / self.shoe_top_radius)
        touching = flank + acos(self.opening_top_radius / self.shoe_top_radius)
        return min(touching, self.opening_top_angle)

    @property
    def taper_touches_shoe(self) -> bool:
        """Whether a straight taper from the end of the opening would cut through the shoe; see ``taper_angle``."""
        return self.taper_angle < self.opening_top_angle

    @property
    def shoe_top_radius(self) -> float:
        """Radius at which the taper meets the tooth flank, R_si + d_1 + d_2."""
        return self.bore_radius + self.shoe_d1 + self.shoe_d2

    @property
    def half_slot_area(self) -> float:
        """Area that one coil side may fill, from the axis of the slot to the tooth and down to its opening [m^2].

        A = (r_sb^2 (t/2 - f_sb) - r_op^2 (t/2 - f_t) - P_sb x P_1 - P_1 x P_t)/2, Green's theorem around the half slot;
        t: slot pitch; f_sb, f_t: angles at which the flank ends and the taper begins, at P_sb and P_t; P_1: between.
        """
        flank_end, flank_start = self._flank(self.slot_bottom_radius), self._flank(self.shoe_top_radius)
        taper = rect(self.opening_top_radius, self.taper_angle)
        arcs = self.slot_bottom_radius**2 * (self.pitch / 2 - phase(flank_end))
        arcs -= self.opening_top_radius**2 * (self.pitch / 2 - self.taper_angle)
        return (arcs - _cross(flank_end, flank_start) - _cross(flank_start, taper)) / 2

    def _flank(self, radius: float) -> complex:
        """Point x + jy of the flank of tooth 0 at this radius [m]."""
        return rect(radius, asin(self.tooth_width / 2 / radius))

    @property
    def other_corners(self) -> str:
        return "the tapers of these two machines have different corners"

    def check(self) -> None:
        for rule in (_check_radii, _check_shoes, _check_teeth, _check_slot):
            rule(self)

    def draw(self, rim: Rim) -> Drawing:
        """From the axis of tooth 0 to the centre of slot 0."""
        d = Drawing()
        _points(d, self, rim)
        taper = ("tip_top", "taper") if self.taper_touches_shoe else ("tip_top",)
        _edges(d, self, rim.edges, taper)
        tooth_side = (*taper, "shoe_top", "flank_middle", "flank_end")
        d.region("iron", "bore", "tip", *tooth_side, "bottom", "outer_slot", "outer", "shoe_axis")
        d.region("opening", "tip", "bore_slot", "open_slot", "tip_top")
        d.region("copper", "open_slot", "shoe_slot", "slot_middle", "bottom", *reversed(tooth_side))
        return d

    def in_tooth(self, across_iron: float) -> float:
        """Edge length in a tooth [m], of across_iron edges (dimensionless) across it.

        A back iron thinner than half a tooth refines it, though not without end.
        """
        width = self.tooth_width
        return min(width, max(2 * self.back_iron_width, width / 2)) / across_iron

    def in_yoke(self, across_iron: float) -> float:
        """Edge length in the back iron and at the bottom of the slot [m]; a thin tooth does not refine them.

        across_iron: edges across it, dimensionless
        """
        return min(max(self.tooth_width, self.back_iron_width), 2 * self.back_iron_width) / across_iron


def _cross(p: complex, q: complex) -> float:
    return (p.conjugate() * q).imag


def _points(d: Drawing, m: StraightTeeth, rim: Rim) -> None:
    """From the bore outwards, on the axis of the tooth, on its side and on the axis of the slot."""
    fine, in_tooth, in_yoke = rim.edge_length, m.in_tooth(rim.across_iron), m.in_yoke(rim.across_iron)
    in_shoe, axis = min(4 * fine, in_tooth), m.pitch / 2
    r_si, r_shoe, r_sb, r_so = m.bore_radius, m.shoe_top_radius, m.slot_bottom_radius, m.outer_radius
    d.point("bore", r_si, 0, 2 * fine)  # the edges on the bore are set by their number
    d.point("tip", r_si, _tip_angle(m), fine)
    d.point("bore_slot", r_si, axis, 2 * fine)
    d.point("tip_top", m.opening_top_radius, m.opening_top_angle, min(3 * fine, m.shoe_d1))
    d.point("open_slot", m.opening_top_radius, axis, 3 * fine)
    d.point("shoe_top", r_shoe, asin(m.tooth_width / 2 / r_shoe), in_shoe)
    d.point("shoe_axis", r_shoe, 0, 1.5 * in_tooth)
    d.point("shoe_slot", r_shoe, axis, in_yoke)
    d.point("flank_end", r_sb, asin(m.tooth_width / 2 / r_sb), 0.5 * in_tooth)
    d.point("bottom", r_sb, axis, in_yoke)
    d.point("outer_slot", r_so, axis, in_yoke)
    d.point("outer", r_so, 0, in_yoke)
    middle = (r_shoe + r_sb) / 2
    d.point("flank_middle", middle, asin(m.tooth_width / 2 / middle), in_tooth)
    d.point("slot_middle", middle, axis, min(2 * in_yoke, (r_sb - r_shoe) / 2))
    if m.taper_touches_shoe:
        d.point("taper", m.opening_top_radius, m.taper_angle, min(3 * fine, in_shoe))


def _tip_angle(m: StraightTeeth) -> float:
    """Of the edge of the shoe at the bore, from the axis of the tooth [rad]."""
    return m.pitch / 2 - asin(m.opening_width / 2 / m.bore_radius)


def _edges(d: Drawing, m: StraightTeeth, edges: int, taper: tuple[str, ...]) -> None:
    """Lines and arcs; edges: of the mesh along the bore of half a slot pitch"""
    opening = min(max(2, round(edges * (1 - _tip_angle(m) / (m.pitch / 2)))), edges - 1)
    d.arc("bore", "tip", edges - opening)
    d.arc("tip", "bore_slot", opening)
    if len(taper) > 1:
        d.arc(taper[0], taper[1])
    d.line("tip", "tip_top")
    d.path(taper[-1], "shoe_top", "flank_middle", "flank_end")
    d.arc("tip_top", "open_slot")
    d.arc("flank_end", "bottom")
    d.path("bore_slot", "open_slot", "shoe_slot", "slot_middle", "bottom", "outer_slot")
    d.arc("outer", "outer_slot")
    d.path("bore", "shoe_axis", "outer")


# ---- can it be built? ------------------------------------------------------------------------------------------------


def _check_radii(m: StraightTeeth) -> None:
    if m.bore_radius >= m.slot_bottom_radius:
        raise GeometryError(
            f"the stator bore radius {in_mm(m.bore_radius)} must be smaller than the slot bottom radius "
            f"{in_mm(m.slot_bottom_radius)}: reduce rotor_outer_radius or back_iron_width, or enlarge "
            "stator_outer_radius"
        )


def _check_shoes(m: StraightTeeth) -> None:
    pitch = m.pitch * m.bore_radius
    if m.tooth_width >= pitch:
        raise GeometryError(
            f"the teeth ({in_mm(m.tooth_width)}) are wider than the slot pitch at the bore ({in_mm(pitch)}): "
            "reduce back_iron_width or tooth_width, or enlarge rotor_outer_radius"
        )
    if m.opening_width < _SMALLEST_GAP_BETWEEN_SHOES:
        raise GeometryError(
            f"the shoes of neighbouring teeth touch: the opening between them would be {in_mm(m.opening_width)}, "
            f"it must be at least {in_mm(_SMALLEST_GAP_BETWEEN_SHOES)}: enlarge slot_opening or reduce tooth_width"
        )
    if m.slot_opening >= pitch:
        raise GeometryError(
            f"slot_opening {in_mm(m.slot_opening)} exceeds the slot pitch at the bore ({in_mm(pitch)}): reduce "
            "slot_opening"
        )


def _check_teeth(m: StraightTeeth) -> None:
    if m.shoe_top_radius + _SMALLEST_SLOT_DEPTH >= m.slot_bottom_radius:
        raise GeometryError(
            f"the tooth shoe reaches {in_mm(m.shoe_top_radius)} while the slot ends at {in_mm(m.slot_bottom_radius)}, "
            "no room is left for copper: reduce rotor_outer_radius, back_iron_width or the shoe depth"
        )


def _slot_half_width(m: StraightTeeth, radius: float) -> float:
    """Distance from the slot axis to the tooth flank, measured at right angles to the slot axis, at this radius."""
    return radius * sin(m.pitch / 2 - asin(m.tooth_width / 2 / radius))


def _check_slot(m: StraightTeeth) -> None:
    half_width = _slot_half_width(m, m.shoe_top_radius)
    if half_width <= 0:
        raise GeometryError(
            f"the slot area is negative: neighbouring teeth of width {in_mm(m.tooth_width)} overlap at radius "
            f"{in_mm(m.shoe_top_radius)}: reduce back_iron_width or tooth_width, or enlarge rotor_outer_radius"
        )
    if 2 * half_width <= m.opening_width:
        raise GeometryError(
            f"the slot is {in_mm(2 * half_width)} wide where the shoe ends, narrower than its opening of "
            f"{in_mm(m.opening_width)}: reduce slot_opening or tooth_width, or enlarge rotor_outer_radius"
        )
