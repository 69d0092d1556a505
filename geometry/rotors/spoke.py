"""A rotor inside its stator with magnets that stand like spokes between its poles."""

from __future__ import annotations

from dataclasses import dataclass
from math import asin, cos, pi, sin, sqrt

import numpy as np

from geometry.errors import GeometryError, in_mm
from geometry.parts import Length, Rim, Rotor
from geometry.plane_mesh import Drawing


@dataclass(frozen=True)
class Spoke(Rotor):
    """Bar magnets magnetised around the rotor, each shared by two poles of iron; lengths in m.

    The magnets reach from ``magnet_radius`` to the surface; inside of it there is no iron (a hub that carries no flux),
    so that nothing short-circuits them. Half of each magnet counts to either pole.

    magnet_length: along the magnetisation; magnet_radius: where the magnets begin, from the axis of the machine
    """

    poles: int
    outer_radius: Length
    magnet_length: Length
    magnet_radius: Length

    @property
    def rim_radius(self) -> float:
        return self.outer_radius

    @property
    def magnets_per_pitch(self) -> int:
        return 2

    def direction(self, position_angle: np.ndarray, axis: float, which: int) -> np.ndarray:
        """Towards the pole [rad], of any shape, that of position_angle: [rad], of any shape; axis: [rad].

        which: 0 is the clockwise half
        """
        side = -self.pitch / 2 if which == 0 else self.pitch / 2
        return 0.0 * position_angle + axis + side + (pi / 2 if which == 0 else -pi / 2)

    def check(self) -> None:
        if self.magnet_radius >= self._corner(self.outer_radius):
            raise GeometryError(
                f"the magnets begin at {in_mm(self.magnet_radius)}, beyond the surface of {in_mm(self.outer_radius)}: "
                "reduce magnet_radius"
            )
        if self.magnet_length / 2 >= self.magnet_radius * sin(self.pitch / 2):
            raise GeometryError(
                f"magnets of {in_mm(self.magnet_length)} meet {in_mm(self.magnet_radius)} from the axis, no iron is "
                "left: reduce magnet_length or enlarge magnet_radius"
            )

    def draw(self, rim: Rim) -> Drawing:
        """From the axis of pole 0 to the middle of a magnet; regions hub, iron, magnet."""
        d = Drawing()
        self._points(d, rim)
        half = asin(self.magnet_length / 2 / self.outer_radius)
        covered = min(max(1, round(rim.edges * half / (self.pitch / 2))), rim.edges - 1)
        d.arc("top", "top_edge", rim.edges - covered)
        d.arc("top_edge", "top_pole", covered)
        d.arc("hub", "hub_edge")
        d.line("hub_edge", "hub_pole")
        d.line("hub_edge", "top_edge")
        d.path("centre", "hub", "top")
        d.path("centre", "hub_pole", "top_pole")
        d.region("hub", "centre", "hub", "hub_edge", "hub_pole")
        d.region("iron", "hub", "top", "top_edge", "hub_edge")
        d.region("magnet", "hub_edge", "top_edge", "top_pole", "hub_pole")
        return d

    def _points(self, d: Drawing, rim: Rim) -> None:
        half, fine, side = self.pitch / 2, rim.edge_length, self.magnet_length / 2
        inside = min(self.magnet_length, self.magnet_radius * half) / rim.across_iron
        d.point("centre", 0, 0, self.magnet_radius)
        d.point("hub", self.magnet_radius, 0, inside)
        d.point("hub_edge", self.magnet_radius, half - asin(side / self.magnet_radius), inside)
        d.point("hub_pole", sqrt(self.magnet_radius**2 - side**2), half, inside)
        d.point("top", self.outer_radius, 0, 3 * fine)
        d.point("top_edge", self.outer_radius, half - asin(side / self.outer_radius), fine)
        d.point("top_pole", self.outer_radius, half, 2 * fine)

    def _corner(self, radius: float) -> float:
        """Distance from the axis of the machine, along the middle of a magnet, of its end on a circle [m]."""
        return radius * cos(asin(min(1.0, self.magnet_length / 2 / radius)))
