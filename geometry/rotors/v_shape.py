"""A rotor inside its stator with two buried magnets a pole in a V that opens outwards."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np

from geometry.errors import GeometryError, in_mm
from geometry.parts import Angle, Length, Rim, Rotor
from geometry.plane_mesh import Drawing

_ACROSS_BRIDGE = 3  # elements across the thinnest iron, which saturates hard


@dataclass(frozen=True)
class VShape(Rotor):
    """Two bar magnets a pole, each in a hole that goes on to the bridge under the surface; lengths in m, angles in rad.

    The holes of a pole meet on its axis, so that no iron stands between them.

    tip_depth: of the V, from the axis of the machine to where the outer faces of the two magnets meet
    tilt: of the magnets' outer faces against the axis of the pole
    magnet_length: along the magnetisation; magnet_width: across it
    recess: by which a magnet is sunk into the iron under it
    hole_depth: from the axis of the machine to where the inner sides of the two holes meet
    bridge: iron between hole and surface
    bridge_start, bridge_end: angles of the outer end of the hole, from the axis of the pole
    """

    poles: int
    outer_radius: Length
    shaft_radius: Length
    tip_depth: Length
    tilt: Angle
    magnet_length: Length
    magnet_width: Length
    recess: Length
    hole_depth: Length
    bridge: Length
    bridge_start: Angle
    bridge_end: Angle

    @property
    def rim_radius(self) -> float:
        return self.outer_radius

    @property
    def grounded_radius(self) -> float:
        return self.shaft_radius

    @property
    def bore_radius(self) -> float:
        return self.shaft_radius

    @property
    def magnets_per_pole(self) -> int:
        return 2

    def direction(self, position_angle: np.ndarray, axis: float, which: int) -> np.ndarray:
        """Across the magnet [rad], of any shape, that of position_angle: [rad], of any shape; axis: [rad].

        which: 0 is the clockwise one
        """
        across = pi / 2 - self.tilt
        return 0.0 * position_angle + axis + (across if which == 0 else -across)

    def check(self) -> None:
        if not 0 < self.bridge_start < self.bridge_end < self.pitch / 2:
            raise GeometryError(
                f"bridge_start and bridge_end must rise within half a pole of {self.pitch / 2:.4f} rad, found "
                f"{self.bridge_start:.4f} and {self.bridge_end:.4f}"
            )
        end = abs(self._corner(self.magnet_width, 0.0))
        if end >= self.outer_radius - self.bridge:
            raise GeometryError(
                f"the magnets reach {in_mm(end)} from the axis, into the bridge at "
                f"{in_mm(self.outer_radius - self.bridge)}: reduce magnet_width or tip_depth, or enlarge outer_radius"
            )
        if not self.shaft_radius < self.hole_depth < self.tip_depth:
            raise GeometryError(
                f"shaft_radius, hole_depth and tip_depth must rise from each to the next, found "
                f"{in_mm(self.shaft_radius)}, {in_mm(self.hole_depth)} and {in_mm(self.tip_depth)}"
            )

    def draw(self, rim: Rim) -> Drawing:
        """From the axis of pole 0 to half a pole pitch; regions iron, magnet, and the two ends of the hole."""
        d = Drawing()
        self._points(d, rim)
        self._curves(d, rim.edges)
        under = ("inner_shoulder", "inner_start", "inner_end", "outer_shoulder")
        d.region("iron", "shaft", "hole", *under, "bridge_end", "bridge_start", "face_end", "tip", "top", "top_pole",
                 "shaft_pole")  # fmt: skip
        d.region("magnet", "tip", "face_end", "outer_shoulder", "inner_end", "inner_start", "inner_shoulder")
        d.region("hole_inside", "hole", "tip", "inner_shoulder")
        d.region("hole_outside", "face_end", "bridge_start", "bridge_end", "outer_shoulder")
        return d

    def _points(self, d: Drawing, rim: Rim) -> None:
        fine, width, length = rim.edge_length, self.magnet_width, self.magnet_length
        iron, thin = length / rim.across_iron, self.bridge / _ACROSS_BRIDGE
        corners = {
            "tip": (0.0, 0.0), "face_end": (width, 0.0),
            "inner_start": (0.0, length), "inner_end": (width, length),
            "inner_shoulder": (0.0, length - self.recess), "outer_shoulder": (width, length - self.recess),
        }  # fmt: skip
        for name, (along, down) in corners.items():
            corner = self._corner(along, down)
            d.place(name, corner.real, corner.imag, iron)
        for name, angle in (("bridge_start", self.bridge_start), ("bridge_end", self.bridge_end)):
            d.point(name, self.outer_radius - self.bridge, angle, thin)
        d.point("hole", self.hole_depth, 0, iron)
        d.point("top", self.outer_radius, 0, 2 * fine)
        d.point("top_pole", self.outer_radius, self.pitch / 2, 2 * fine)
        d.point("shaft", self.shaft_radius, 0, 1.5 * iron)
        d.point("shaft_pole", self.shaft_radius, self.pitch / 2, 1.5 * iron)

    def _curves(self, d: Drawing, edges: int) -> None:
        """Lines and arcs; edges: of the mesh along the surface of half a pole pitch"""
        d.path("shaft", "hole", "tip", "top")
        d.arc("top", "top_pole", edges)
        d.line("top_pole", "shaft_pole")
        d.arc("shaft", "shaft_pole")
        d.path("tip", "face_end", "outer_shoulder", "inner_end", "inner_start", "inner_shoulder", "tip")
        d.line("hole", "inner_shoulder")
        d.line("face_end", "bridge_start")
        d.arc("bridge_start", "bridge_end")
        d.line("bridge_end", "outer_shoulder")

    def _corner(self, along: float, down: float) -> complex:
        """Point x + jy [m] along the outer face of the magnet beyond the axis of the pole and down from it [m]."""
        face = np.exp(1j * self.tilt)
        return complex(self.tip_depth + along * face + down * 1j * face)
