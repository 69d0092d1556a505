"""A rotor inside its stator with magnets let into its surface: iron stands between them."""

from __future__ import annotations

from dataclasses import dataclass

from geometry.errors import GeometryError
from geometry.magnetisation import PARALLEL, Magnetisation
from geometry.parts import Length, MagnetsOfRoundCore, Rim, Share
from geometry.plane_mesh import Drawing


@dataclass(frozen=True)
class InsetMagnets(MagnetsOfRoundCore):
    """Magnets of constant thickness with radial sides, flush with the round rotor. Lengths in m."""

    poles: int
    outer_radius: Length
    magnet_length: Length
    shaft_radius: Length
    arc_fraction: Share  # of the pole pitch, below 1
    magnetisation: Magnetisation = PARALLEL

    def check(self) -> None:
        if not 0 < self.arc_fraction < 1:
            raise GeometryError(
                f"iron must stand between inset magnets, found an arc_fraction of {self.arc_fraction:g}: take one "
                "between 0 and 1"
            )
        self.check_core()

    def draw(self, rim: Rim) -> Drawing:
        """From the axis of magnet 0 to half a pole pitch; regions shaft, iron, magnet."""
        d = Drawing()
        self._points(d, rim)
        covered = min(max(1, round(rim.edges * self.arc_fraction)), rim.edges - 1)
        d.arc("top", "top_edge", covered)
        d.arc("top_edge", "top_pole", rim.edges - covered)
        d.arc("core", "core_edge")
        d.arc("shaft", "shaft_pole")
        d.path("centre", "shaft", "core", "top")
        d.path("centre", "shaft_pole", "top_pole")
        d.line("core_edge", "top_edge")
        d.region("shaft", "centre", "shaft", "shaft_pole")
        d.region("iron", "shaft", "core", "core_edge", "top_edge", "top_pole", "shaft_pole")
        d.region("magnet", "core", "top", "top_edge", "core_edge")
        return d

    def _points(self, d: Drawing, rim: Rim) -> None:
        half, edge = self.pitch / 2, self.arc_fraction * self.pitch / 2
        fine, coarse = rim.edge_length, self.core_radius * half / rim.across_iron
        under = min(3 * fine, self.magnet_length)
        d.point("centre", 0, 0, self.shaft_radius)
        d.point("shaft", self.shaft_radius, 0, coarse)
        d.point("shaft_pole", self.shaft_radius, half, coarse)
        d.point("core", self.core_radius, 0, under)
        d.point("core_edge", self.core_radius, edge, under)
        d.point("top", self.outer_radius, 0, 3 * fine)
        d.point("top_edge", self.outer_radius, edge, fine)
        d.point("top_pole", self.outer_radius, half, 3 * fine)
