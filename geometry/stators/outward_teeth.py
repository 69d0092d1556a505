"""A stator inside its rotor: straight teeth that point outwards, on a ring."""

from __future__ import annotations

from dataclasses import dataclass
from math import asin, sin, sqrt

from geometry.errors import GeometryError, in_mm
from geometry.parts import Length, Rim, Segment, Stator
from geometry.plane_mesh import Drawing


@dataclass(frozen=True)
class OutwardTeeth(Stator):
    """Straight flanks from an arc at the bottom of the slot to ``flank_radius``, a straight taper from there to the
    parallel walls of the opening at ``opening_radius``, and those on to the rim. Lengths in m; radii are distances from
    the machine's axis. The coils fill the slot up to the chord between the two ends of the tapers.
    """

    slots: int
    bore_radius: Length
    slot_bottom_radius: Length
    flank_radius: Length
    opening_radius: Length
    outer_radius: Length
    tooth_width: Length
    slot_opening: Length

    @property
    def rim_radius(self) -> float:
        return self.outer_radius

    @property
    def slot_radii(self) -> tuple[float, float]:
        """Of the ends of the coil sides [m]."""
        return self.slot_bottom_radius, self.flank_radius

    @property
    def tooth_probe(self) -> Segment:
        """At mid height of the flank [m]."""
        distance = (self.slot_bottom_radius + self.flank_radius) / 2
        return (distance, -self.tooth_width / 2), (distance, self.tooth_width / 2)

    @property
    def back_iron_probe(self) -> Segment:
        """Radially [m]."""
        return (self.bore_radius, 0.0), (self.slot_bottom_radius, 0.0)

    def check(self) -> None:
        radii = (self.bore_radius, self.slot_bottom_radius, self.flank_radius, self.opening_radius, self.outer_radius)
        if sorted(set(radii)) != list(radii):
            raise GeometryError(
                "bore_radius, slot_bottom_radius, flank_radius, opening_radius and outer_radius of the stator must "
                f"rise from each to the next, found {', '.join(map(in_mm, radii))}"
            )
        if self.tooth_width / 2 >= self.slot_bottom_radius * sin(self.pitch / 2):
            raise GeometryError(
                f"teeth of {in_mm(self.tooth_width)} leave no slot at its bottom, {in_mm(self.slot_bottom_radius)} "
                "from the axis: reduce tooth_width, or enlarge slot_bottom_radius"
            )
        if asin(self.slot_opening / 2 / self.opening_radius) >= self.pitch / 2 - self._flank_angle(self.flank_radius):
            raise GeometryError(
                f"the opening of {in_mm(self.slot_opening)} is wider than the slot behind it: reduce slot_opening or "
                "tooth_width"
            )

    def draw(self, rim: Rim) -> Drawing:
        """From the axis of tooth 0 to the centre of slot 0; the bore is air, down to the axis."""
        d = Drawing()
        self._points(d, rim)
        self._curves(d, rim.edges)
        side = ("tip_end", "flank_end", "flank_start")
        d.region("bore", "centre", "bore_tooth", "bore_slot")
        d.region("iron", "bore_tooth", "tip", "edge", *side, "bottom", "bore_slot")
        d.region("opening", "edge", "rim_slot", "chord", "tip_end")
        d.region("copper", *side, "bottom", "chord")
        return d

    def _points(self, d: Drawing, rim: Rim) -> None:
        """From the axis outwards, on the axis of the tooth, on its side and on the axis of the slot."""
        fine, iron, axis = rim.edge_length, self.tooth_width / rim.across_iron, self.pitch / 2
        d.point("centre", 0, 0, self.bore_radius)
        d.point("bore_tooth", self.bore_radius, 0, iron)
        d.point("bore_slot", self.bore_radius, axis, iron)
        d.point("bottom", self.slot_bottom_radius, axis, iron)
        d.point("flank_start", self.slot_bottom_radius, self._flank_angle(self.slot_bottom_radius), iron / 2)
        d.point("flank_end", self.flank_radius, self._flank_angle(self.flank_radius), min(2 * fine, iron))
        d.point("tip_end", self.opening_radius, self._wall_angle(self.opening_radius), min(2 * fine, iron))
        d.point("chord", self._chord, axis, min(2 * fine, iron))
        d.point("edge", self.outer_radius, self._wall_angle(self.outer_radius), fine)
        d.point("rim_slot", self.outer_radius, axis, fine)
        d.point("tip", self.outer_radius, 0, 2 * fine)

    def _curves(self, d: Drawing, edges: int) -> None:
        """Lines and arcs; edges: of the mesh along the rim of half a slot pitch"""
        opening = min(max(2, round(edges * (1 - self._wall_angle(self.outer_radius) / (self.pitch / 2)))), edges - 1)
        d.path("centre", "bore_tooth", "tip")
        d.path("centre", "bore_slot", "bottom", "chord", "rim_slot")
        d.arc("bore_tooth", "bore_slot")
        d.arc("flank_start", "bottom")
        d.path("flank_start", "flank_end", "tip_end", "edge")
        d.line("tip_end", "chord")
        d.arc("tip", "edge", edges - opening)
        d.arc("edge", "rim_slot", opening)

    def _flank_angle(self, radius: float) -> float:
        """Of the flank from the axis of the tooth [rad]."""
        return asin(self.tooth_width / 2 / radius)

    def _wall_angle(self, radius: float) -> float:
        """Of the wall of the opening from the axis of the tooth [rad]."""
        return self.pitch / 2 - asin(self.slot_opening / 2 / radius)

    @property
    def _chord(self) -> float:
        """Distance of the chord between the two tapers from the axis of the machine [m]."""
        return sqrt(self.opening_radius**2 - (self.slot_opening / 2) ** 2)
