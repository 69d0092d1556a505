"""A rotor inside its stator with magnets on its surface whose base is flat and whose sides are parallel."""

from __future__ import annotations

from dataclasses import dataclass
from math import asin, cos, hypot, tan

from geometry.errors import GeometryError, in_mm
from geometry.magnetisation import PARALLEL, Magnetisation
from geometry.parts import Length, MagnetOnAxis, Rim
from geometry.plane_mesh import Drawing


@dataclass(frozen=True)
class BreadLoafMagnets(MagnetOnAxis):
    """Loaves on a core with as many flats as poles, their faces round about the axis of the machine; lengths in m.

    outer_radius: over the magnets; base_distance: from the axis to the flats
    magnet_width: between the parallel sides
    """

    poles: int
    outer_radius: Length
    base_distance: Length
    magnet_width: Length
    shaft_radius: Length
    magnetisation: Magnetisation = PARALLEL

    @property
    def rim_radius(self) -> float:
        return self.outer_radius

    def check(self) -> None:
        corner, flat = self.base_distance / cos(self.pitch / 2), 2 * self.base_distance * tan(self.pitch / 2)
        if self.magnet_width >= flat:
            raise GeometryError(
                f"magnets of {in_mm(self.magnet_width)} are wider than the flats of {in_mm(flat)} they lie on: reduce "
                "magnet_width or enlarge base_distance"
            )
        if max(corner, hypot(self.base_distance, self.magnet_width / 2)) >= self.outer_radius:
            raise GeometryError(
                f"the core reaches {in_mm(corner)} at its corners, no magnet is left under {in_mm(self.outer_radius)}: "
                "reduce base_distance or enlarge outer_radius"
            )
        if self.shaft_radius >= self.base_distance:
            raise GeometryError(
                f"the shaft of radius {in_mm(self.shaft_radius)} cuts the flats at {in_mm(self.base_distance)}: reduce "
                "shaft_radius or enlarge base_distance"
            )

    def draw(self, rim: Rim) -> Drawing:
        """From the axis of magnet 0 to half a pole pitch; regions shaft, iron, magnet, between."""
        d, half = Drawing(), self.pitch / 2
        self._points(d, rim)
        share = asin(self.magnet_width / 2 / self.outer_radius) / half
        covered = min(max(1, round(rim.edges * share)), rim.edges - 1)
        d.arc("top", "top_edge", covered)
        d.arc("top_edge", "top_pole", rim.edges - covered)
        d.arc("shaft", "shaft_pole")
        d.path("centre", "shaft", "base", "top")
        d.path("centre", "shaft_pole", "base_pole", "top_pole")
        d.path("base", "base_edge", "base_pole")
        d.line("base_edge", "top_edge")
        d.region("shaft", "centre", "shaft", "shaft_pole")
        d.region("iron", "shaft", "base", "base_edge", "base_pole", "shaft_pole")
        d.region("magnet", "base", "top", "top_edge", "base_edge")
        d.region("between", "base_edge", "top_edge", "top_pole", "base_pole")
        return d

    def _points(self, d: Drawing, rim: Rim) -> None:
        half, fine, side = self.pitch / 2, rim.edge_length, self.magnet_width / 2
        coarse = self.base_distance * half / rim.across_iron
        under = min(3 * fine, self.outer_radius - self.base_distance)
        d.point("centre", 0, 0, self.shaft_radius)
        d.point("shaft", self.shaft_radius, 0, coarse)
        d.point("shaft_pole", self.shaft_radius, half, coarse)
        d.place("base", self.base_distance, 0, under)
        d.place("base_edge", self.base_distance, side, under)
        d.point("base_pole", self.base_distance / cos(half), half, under)
        d.point("top", self.outer_radius, 0, 3 * fine)
        d.point("top_edge", self.outer_radius, asin(side / self.outer_radius), fine)
        d.point("top_pole", self.outer_radius, half, 3 * fine)
