"""A rotor inside its stator with four buried magnets a pole in two Vs, one above the other."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import sin

import numpy as np

from geometry.errors import GeometryError, in_mm
from geometry.parts import Angle, Buried, Length, Rim, Segment
from geometry.plane_mesh import Drawing
from geometry.v_layer import VLayer, draw_buried


@dataclass(frozen=True)
class TwoLayerVShape(Buried):
    """The inner V lies nearer to the shaft, the outer one between it and the surface; lengths in m, angles in rad.

    Magnets are of one thickness and sunk into the iron under them alike; the inner sides of two holes that meet on the
    axis of a pole are parallel to the magnets. tip_depth ... bridge_end: see ``geometry.v_layer``, of either layer
    """

    poles: int
    outer_radius: Length
    shaft_radius: Length
    magnet_length: Length
    recess: Length
    inner_tip_depth: Length
    inner_tilt: Angle
    inner_magnet_width: Length
    inner_bridge: Length
    inner_bridge_start: Angle
    inner_bridge_end: Angle
    outer_tip_depth: Length
    outer_tilt: Angle
    outer_magnet_width: Length
    outer_bridge: Length
    outer_bridge_start: Angle
    outer_bridge_end: Angle

    @property
    def magnets_per_pitch(self) -> int:
        return 4

    @property
    def layers(self) -> tuple[VLayer, VLayer]:
        """The inner and the outer one."""
        return self._layer("inner_"), self._layer("outer_")

    def direction(self, position_angle: np.ndarray, axis: float, which: int) -> np.ndarray:
        """Across the magnet [rad], of any shape, that of position_angle: [rad], of any shape; axis: [rad].

        which: 0, 1 are the clockwise ones of the inner and the outer layer
        """
        side, layer = divmod(which, 2)
        return 0.0 * position_angle + axis + self.layers[layer].across(side)

    @property
    def probes(self) -> Mapping[str, Segment]:
        inner, outer = self.layers
        return inner.probes | outer.probes

    def check(self) -> None:
        inner, outer = self.layers
        inner.check(self.pitch / 2, self.shaft_radius, "shaft_radius")
        outer.check(self.pitch / 2, inner.tip_depth, "inner_tip_depth")
        if outer.bridge_end >= inner.bridge_start:
            raise GeometryError(
                f"the holes of both layers meet under the surface, outer_bridge_end is {outer.bridge_end:.4f} rad and "
                f"inner_bridge_start {inner.bridge_start:.4f}: reduce one or enlarge the other"
            )
        if self.iron_between <= 0:
            raise GeometryError(
                f"the magnets of the outer layer come {in_mm(-self.iron_between)} into the hole of the inner one: "
                "reduce inner_tip_depth, outer_magnet_width or magnet_length, or enlarge outer_tip_depth or inner_tilt"
            )

    @property
    def iron_between(self) -> float:
        """Least distance of the outer layer's magnet from the line of the inner one's faces [m], negative beyond it."""
        inner, outer = self.layers
        corners = (outer.corner(along, outer.magnet_length) for along in (0.0, outer.magnet_width))
        return float(min(-((corner - inner.tip_depth) * np.exp(-1j * inner.tilt)).imag for corner in corners))

    def draw(self, rim: Rim) -> Drawing:
        """From the axis of pole 0 to half a pole pitch; regions iron, magnet, magnet_1, and the ends of the holes."""
        return draw_buried(self, self.layers, self.magnet_length, rim)

    def _layer(self, name: str) -> VLayer:
        tip, tilt, width, bridge, start, end = (
            getattr(self, name + one)
            for one in ("tip_depth", "tilt", "magnet_width", "bridge", "bridge_start", "bridge_end")
        )
        hole = tip - (self.magnet_length - self.recess) / sin(tilt)
        return VLayer(
            name, self.outer_radius, tip, tilt, self.magnet_length, width, self.recess, hole, bridge, start, end
        )
