"""A rotor of one's own: magnets with a flat base and a round face, on a core with as many flats as poles."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos

import numpy as np

from geometry.errors import GeometryError
from geometry.parts import Length, Rim, Rotor
from geometry.plane_mesh import Drawing


@dataclass(frozen=True)
class BreadLoaf(Rotor):
    """Lengths in m.

    flat_distance: from the axis of the machine to the base of the magnets; shaft_radius: of the hole of the core
    """

    poles: int
    outer_radius: Length
    flat_distance: Length
    shaft_radius: Length

    rim_radius = property(lambda self: self.outer_radius)

    def direction(self, position_angle: np.ndarray, axis: float, which: int) -> np.ndarray:
        """Along the axis of the pole."""
        return 0.0 * position_angle + axis

    def check(self) -> None:
        corner = self.flat_distance / cos(self.pitch / 2)
        if not self.shaft_radius < self.flat_distance < corner < self.outer_radius:
            raise GeometryError("a bread loaf needs shaft_radius < flat_distance < its corner < outer_radius")

    def draw(self, rim: Rim) -> Drawing:
        """From the axis of a magnet to the joint of two."""
        d, half, fine = Drawing(), self.pitch / 2, rim.edge_length
        d.point("centre", 0, 0, self.shaft_radius)
        for name, angle in (("", 0.0), ("_pole", half)):
            d.point("shaft" + name, self.shaft_radius, angle, self.shaft_radius * half)
            d.point("flat" + name, self.flat_distance / cos(angle), angle, 3 * fine)
            d.point("top" + name, self.outer_radius, angle, 3 * fine)
            d.path("centre", "shaft" + name, "flat" + name, "top" + name)
        d.arc("shaft", "shaft_pole")
        d.line("flat", "flat_pole")
        d.arc("top", "top_pole", rim.edges)
        d.region("shaft", "centre", "shaft", "shaft_pole")
        d.region("iron", "shaft", "flat", "flat_pole", "shaft_pole")
        d.region("magnet", "flat", "top", "top_pole", "flat_pole")
        return d
