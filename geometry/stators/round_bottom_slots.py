"""A stator around its rotor whose slots widen outwards in straight sides and end in half a circle."""

from __future__ import annotations

from cmath import rect
from dataclasses import dataclass
from math import asin, atan2, hypot, sqrt

from geometry.chords import with_short_chords
from geometry.errors import GeometryError, in_mm
from geometry.parts import Length, Rim, Segment, StatorRoundRotor
from geometry.plane_mesh import Drawing

_ROUND = 12  # edges of a quarter circle; chords take 0.3 % of its area


@dataclass(frozen=True)
class RoundBottomSlots(StatorRoundRotor):
    """The opening has parallel walls and ends in shoulders at right angles to the axis of the slot; from these the
    sides run straight to a half circle, whose diameter they meet. Lengths in m, depths along the axis of the slot.

    slot_opening, opening_depth: of the parallel walls; top_width, bottom_width: of the slot, at both ends of its sides
    side_depth: of the straight sides
    """

    slots: int
    bore_radius: Length
    outer_radius: Length
    slot_opening: Length
    opening_depth: Length
    top_width: Length
    bottom_width: Length
    side_depth: Length

    @property
    def slot_radii(self) -> tuple[float, float]:
        """Of the ends of the coil sides [m]."""
        return self._top, self._bottom

    @property
    def tooth_probe(self) -> Segment:
        """Where the straight sides are half way out [m]."""
        corner = self._at(self._circle - self.side_depth / 2, (self.top_width + self.bottom_width) / 4)
        return (corner.real, -corner.imag), (corner.real, corner.imag)

    @property
    def back_iron_probe(self) -> Segment:
        """Radially [m]."""
        return (self._bottom, 0.0), (self.outer_radius, 0.0)

    def check(self) -> None:
        if self._bottom >= self.outer_radius:
            raise GeometryError(
                f"the slots end {in_mm(self._bottom)} from the axis, beyond the outer radius of "
                f"{in_mm(self.outer_radius)}: reduce side_depth or bottom_width, or enlarge outer_radius"
            )
        if min(self._at(self._circle, self.bottom_width / 2).imag, self._at(self._top, self.top_width / 2).imag) <= 0:
            raise GeometryError(
                f"slots of {in_mm(self.top_width)} to {in_mm(self.bottom_width)} leave nothing of the teeth: reduce "
                "top_width or bottom_width, or take fewer slots"
            )
        if self.slot_opening >= self.top_width:
            raise GeometryError(
                f"the opening of {in_mm(self.slot_opening)} has no shoulder in a slot that is {in_mm(self.top_width)} "
                "wide behind it: reduce slot_opening"
            )

    def draw(self, rim: Rim) -> Drawing:
        """From the axis of tooth 0 to the centre of slot 0."""
        d = Drawing()
        self._points(d, rim)
        self._curves(d, rim.edges)
        side = ("wall_end", "shoulder", "side_end")
        d.region("iron", "bore", "tip", *side, "bottom", "outer_slot", "outer")
        d.region("opening", "tip", "bore_slot", "open_slot", "wall_end")
        d.region("copper", *side, "bottom", "open_slot")
        return with_short_chords(d, rim.edge_length)

    def _points(self, d: Drawing, rim: Rim) -> None:
        """From the bore outwards, on the axis of the tooth, on its side and on the axis of the slot."""
        fine, axis = rim.edge_length, self.pitch / 2
        tooth = self._at(self._circle - self.side_depth / 2, (self.top_width + self.bottom_width) / 4).imag
        iron, yoke = 2 * tooth / rim.across_iron, (self.outer_radius - self._bottom) / rim.across_iron
        places = {
            "tip": (self._wall(self.bore_radius), self.slot_opening / 2, fine),
            "wall_end": (self._top, self.slot_opening / 2, min(2 * fine, iron)),
            "shoulder": (self._top, self.top_width / 2, min(3 * fine, iron)),
            "side_end": (self._circle, self.bottom_width / 2, iron),
        }
        for name, (along, beside, size) in places.items():
            corner = self._at(along, beside)
            d.place(name, corner.real, corner.imag, size)
        d.point("bore", self.bore_radius, 0, 2 * fine)
        d.point("bore_slot", self.bore_radius, axis, fine)
        d.point("open_slot", self._top, axis, 2 * fine)
        d.point("bottom", self._bottom, axis, iron)
        d.point("outer_slot", self.outer_radius, axis, yoke)
        d.point("outer", self.outer_radius, 0, yoke)

    def _curves(self, d: Drawing, edges: int) -> None:
        """Lines and arcs; edges: of the mesh along the bore of half a slot pitch"""
        half = asin(self.slot_opening / 2 / self.bore_radius)
        opening = min(max(2, round(edges * half / (self.pitch / 2))), edges - 1)
        centre = rect(self._circle, self.pitch / 2)
        d.arc("bore", "tip", edges - opening)
        d.arc("tip", "bore_slot", opening)
        d.path("tip", "wall_end", "shoulder", "side_end")
        d.line("wall_end", "open_slot")
        d.arc("side_end", "bottom", _ROUND, centre=(centre.real, centre.imag))
        d.path("bore_slot", "open_slot", "bottom", "outer_slot")
        d.arc("outer", "outer_slot")
        d.line("bore", "outer")

    def _at(self, along: float, beside: float) -> complex:
        """Point x + jy [m] at a distance along the axis of slot 0 and one from it towards tooth 0 [m]."""
        return rect(hypot(along, beside), self.pitch / 2 - atan2(beside, along))

    def _wall(self, radius: float) -> float:
        """Where the walls of the opening meet a circle, along the axis of the slot [m]."""
        return sqrt(radius**2 - (self.slot_opening / 2) ** 2)

    @property
    def _top(self) -> float:
        """Distance of the shoulders from the axis of the machine [m]."""
        return self._wall(self.bore_radius) + self.opening_depth

    @property
    def _circle(self) -> float:
        """Distance of the centre of the half circle [m]."""
        return self._top + self.side_depth

    @property
    def _bottom(self) -> float:
        """Distance of the end of the slot [m]."""
        return self._circle + self.bottom_width / 2
