"""A cup around its stator with magnets inside."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from geometry.errors import GeometryError, in_mm
from geometry.magnetisation import PARALLEL, Magnetisation
from geometry.parts import Length, MagnetOnAxis, Rim, Share
from geometry.plane_mesh import Drawing


@dataclass(frozen=True)
class OuterMagnets(MagnetOnAxis):
    """Magnets of constant thickness with radial sides in a cup of finite thickness, lengths in m; beyond it there is
    air up to a circle on which the field has died away.

    inner_radius: of the magnets; back_iron_width: thickness of the cup; air_radius: where the model ends
    """

    poles: int
    inner_radius: Length
    magnet_length: Length
    back_iron_width: Length
    air_radius: Length
    arc_fraction: Share  # of the pole pitch, below 1
    magnetisation: Magnetisation = PARALLEL
    gap_outside: ClassVar[bool] = False
    of_the_model: ClassVar[frozenset[str]] = frozenset({"air_radius"})

    @property
    def cup_radius(self) -> float:
        """Inner radius of the cup [m]."""
        return self.inner_radius + self.magnet_length

    @property
    def outer_radius(self) -> float:
        """Of the cup [m]."""
        return self.cup_radius + self.back_iron_width

    @property
    def rim_radius(self) -> float:
        return self.inner_radius

    @property
    def grounded_radius(self) -> float:
        return self.air_radius

    def check(self) -> None:
        if self.arc_fraction >= 1:
            raise GeometryError(
                f"the magnets must leave air between them, found an arc_fraction of {self.arc_fraction:g}: reduce it"
            )
        if self.air_radius <= self.outer_radius:
            raise GeometryError(
                f"the model ends at {in_mm(self.air_radius)}, inside the cup of {in_mm(self.outer_radius)}: enlarge "
                "air_radius, to about twice as much"
            )

    def draw(self, rim: Rim) -> Drawing:
        """From the axis of magnet 0 to half a pole pitch; regions magnet, between, iron, outside."""
        d = Drawing()
        self._points(d, rim)
        self._curves(d, rim.edges)
        d.region("magnet", "top", "top_edge", "cup_edge", "cup")
        d.region("between", "top_edge", "top_pole", "cup_pole", "cup_edge")
        d.region("iron", "cup", "cup_edge", "cup_pole", "back_pole", "back")
        d.region("outside", "back", "back_pole", "air_pole", "air")
        return d

    def _points(self, d: Drawing, rim: Rim) -> None:
        half, edge = self.pitch / 2, self.arc_fraction * self.pitch / 2
        fine, iron = rim.edge_length, self.back_iron_width / rim.across_iron
        rings = {"top": (self.inner_radius, 2 * fine), "cup": (self.cup_radius, min(iron, 3 * fine)),
                 "back": (self.outer_radius, iron), "air": (self.air_radius, self.air_radius * half / 3)}  # fmt: skip
        for name, (radius, size) in rings.items():
            d.point(name, radius, 0, size)
            d.point(f"{name}_pole", radius, half, size)
        for name in ("top", "cup"):
            d.point(f"{name}_edge", rings[name][0], edge, fine)

    def _curves(self, d: Drawing, edges: int) -> None:
        """Lines and arcs; edges: of the mesh along the rim of half a pole pitch"""
        covered = min(max(1, round(edges * self.arc_fraction)), edges - 1)
        d.arc("top", "top_edge", covered)
        d.arc("top_edge", "top_pole", edges - covered)
        d.arc("cup", "cup_edge")
        d.arc("cup_edge", "cup_pole")
        d.arc("back", "back_pole")
        d.arc("air", "air_pole")
        d.line("top_edge", "cup_edge")
        d.path("top", "cup", "back", "air")
        d.path("top_pole", "cup_pole", "back_pole", "air_pole")
