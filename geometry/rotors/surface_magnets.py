"""A rotor inside its stator with magnets on its surface."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from geometry.errors import GeometryError
from geometry.magnetisation import Magnetisation
from geometry.parts import Length, MagnetsOfRoundCore, Rim, Share
from geometry.plane_mesh import Drawing


@dataclass(frozen=True)
class SurfaceMagnets(MagnetsOfRoundCore):
    """Magnets of constant thickness on a round core, lengths in m."""

    poles: int
    outer_radius: Length  # R_ro, over the magnets
    magnet_length: Length  # l_m, radial
    shaft_radius: Length
    arc_fraction: Share  # of the pole pitch
    magnetisation: Magnetisation
    outer_name: ClassVar[str] = "rotor_outer_radius"

    @property
    def other_corners(self) -> str:
        return (
            "a mesh of magnets that touch (magnet_arc_fraction = 1) cannot be moved onto magnets that do not, nor "
            "back; where the arc is to change, take a magnet_arc_fraction below 1"
        )

    def check(self) -> None:
        if self.arc_fraction > 1:
            raise GeometryError(
                "magnet_arc_fraction must be at most 1 (neighbouring magnets touch), found "
                f"{self.arc_fraction}: reduce it"
            )
        self.check_core()

    def draw(self, rim: Rim) -> Drawing:
        """From the axis of magnet 0 to half a pole pitch; regions shaft, iron, magnet, (between)."""
        return _draw(self, rim.edges, rim.edge_length)


def _draw(m: SurfaceMagnets, edges: int, fine: float) -> Drawing:
    half_pole = m.pitch / 2
    coarse = m.core_radius * half_pole
    under_magnet = min(3 * fine, m.magnet_length)
    half_magnet = m.arc_fraction * half_pole
    covers_pole = m.arc_fraction >= 1
    magnet_edges = edges if covers_pole else min(max(1, round(edges * m.arc_fraction)), edges - 1)
    d = Drawing()
    d.point("centre", 0, 0, coarse)
    for name, radius, size in (("shaft", m.shaft_radius, coarse), ("core", m.core_radius, under_magnet)):
        d.point(name, radius, 0, size)
        d.point(f"{name}_pole", radius, half_pole, size)
    d.point("top", m.outer_radius, 0, 3 * fine)  # the edges around the rotor are set below
    d.point("top_edge", m.outer_radius, half_magnet, 3 * fine)
    d.line("centre", "shaft")
    d.line("centre", "shaft_pole")
    d.arc("shaft", "shaft_pole")
    d.line("shaft", "core")
    d.line("shaft_pole", "core_pole")
    d.line("core", "top", max(1, round(m.magnet_length / (6 * fine))))
    d.arc("top", "top_edge", magnet_edges)
    d.region("shaft", "centre", "shaft", "shaft_pole")
    if covers_pole:
        d.arc("core", "core_pole")
        d.line("core_pole", "top_edge")
        d.region("iron", "shaft", "core", "core_pole", "shaft_pole")
        d.region("magnet", "core", "top", "top_edge", "core_pole")
        return d
    d.point("core_edge", m.core_radius, half_magnet, under_magnet)
    d.point("top_pole", m.outer_radius, half_pole, 3 * fine)
    d.arc("core", "core_edge")
    d.arc("core_edge", "core_pole")
    d.line("core_edge", "top_edge")
    d.line("core_pole", "top_pole")
    d.arc("top_edge", "top_pole", edges - magnet_edges)
    d.region("iron", "shaft", "core", "core_edge", "core_pole", "shaft_pole")
    d.region("magnet", "core", "top", "top_edge", "core_edge")
    d.region("between", "core_edge", "top_edge", "top_pole", "core_pole")
    return d
