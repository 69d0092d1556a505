"""A rotor inside its stator with magnets in every second pole; the poles between them are iron."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

from geometry.errors import GeometryError
from geometry.magnetisation import PARALLEL, Magnetisation
from geometry.parts import Length, MagnetsOfRoundCore, Rim, Share
from geometry.plane_mesh import Drawing


@dataclass(frozen=True)
class ConsequentPole(MagnetsOfRoundCore):
    """Magnets of constant thickness with radial sides, all of one sign, let into a round rotor; lengths in m.

    The rotor repeats itself after two poles, so that north and south are not alike: a voltage may have even harmonics,
    and sectors are those of the pole pairs.

    arc_fraction: of the pole pitch that a magnet covers, below 2; air_fraction: of the pole pitch, between a magnet and
    the iron pole on either side of it, as deep as the magnet
    """

    poles: int
    outer_radius: Length
    magnet_length: Length
    shaft_radius: Length
    arc_fraction: Share
    air_fraction: Share
    magnetisation: Magnetisation = PARALLEL

    @property
    def repeats(self) -> int:
        return self.poles // 2

    def check(self) -> None:
        if self.arc_fraction + 2 * self.air_fraction >= 2:
            raise GeometryError(
                f"magnets of {self.arc_fraction:g} and air of twice {self.air_fraction:g} pole pitches leave nothing "
                "of the iron poles between them: reduce arc_fraction or air_fraction"
            )
        self.check_core()

    def draw(self, rim: Rim) -> Drawing:
        """From the axis of magnet 0 to that of the iron pole; regions shaft, iron, magnet, between."""
        d = Drawing()
        self._points(d, rim)
        magnet = min(max(1, round(rim.edges * self.arc_fraction / 2)), rim.edges - 2)
        air = min(max(1, round(rim.edges * self.air_fraction)), rim.edges - magnet - 1)
        d.arc("top", "top_edge", magnet)
        d.arc("top_edge", "top_iron", air)
        d.arc("top_iron", "top_pole", rim.edges - magnet - air)
        d.arc("core", "core_edge")
        d.arc("core_edge", "core_iron")
        d.arc("shaft", "shaft_pole")
        d.path("centre", "shaft", "core", "top")
        d.path("centre", "shaft_pole", "top_pole")
        d.line("core_edge", "top_edge")
        d.line("core_iron", "top_iron")
        d.region("shaft", "centre", "shaft", "shaft_pole")
        d.region("iron", "shaft", "core", "core_edge", "core_iron", "top_iron", "top_pole", "shaft_pole")
        d.region("magnet", "core", "top", "top_edge", "core_edge")
        d.region("between", "core_edge", "top_edge", "top_iron", "core_iron")
        return d

    def _points(self, d: Drawing, rim: Rim) -> None:
        pole, fine = 2 * pi / self.poles, rim.edge_length
        edge, iron = self.arc_fraction * pole / 2, (self.arc_fraction / 2 + self.air_fraction) * pole
        coarse, under = self.core_radius * pole / 2 / rim.across_iron, min(3 * fine, self.magnet_length)
        d.point("centre", 0, 0, self.shaft_radius)
        for name, radius, size in (("shaft", self.shaft_radius, coarse), ("core", self.core_radius, under)):
            d.point(name, radius, 0, size)
        d.point("shaft_pole", self.shaft_radius, pole, coarse)
        for name, radius, size in (("core", self.core_radius, under), ("top", self.outer_radius, fine)):
            d.point(f"{name}_edge", radius, edge, size)
            d.point(f"{name}_iron", radius, iron, size)
        d.point("top", self.outer_radius, 0, 3 * fine)
        d.point("top_pole", self.outer_radius, pole, 3 * fine)
