"""A rotor inside its stator with two buried magnets a pole in a V, and a rib of iron between the two."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from geometry.parts import Angle, Buried, Length, Rim, Segment
from geometry.plane_mesh import Drawing
from geometry.v_layer import RibbedVLayer, draw_buried


@dataclass(frozen=True)
class RibbedVShape(Buried):
    """Two bar magnets a pole, each in a hole that goes on to the bridge under the surface; lengths in m, angles in rad.

    The rib holds the iron over the magnets against the centrifugal force; it saturates and shorts some of their flux.
    The two halves of a ``VShape`` stand apart by its width, each moved sideways by half of it.

    rib: iron between the holes of a pole, on its axis
    tip_depth: of the V, from the axis of the machine to the inner ends of the outer faces of the magnets
    tilt: of the magnets' outer faces against the axis of the pole
    magnet_length: along the magnetisation; magnet_width: across it
    recess: by which a magnet is sunk into the iron under it
    hole_depth: from the axis of the machine to the inner ends of the inner sides of the two holes
    bridge: iron between hole and surface
    bridge_start, bridge_end: angles of the outer end of the hole, from the axis of the pole
    """

    poles: int
    outer_radius: Length
    shaft_radius: Length
    rib: Length
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
    def magnets_per_pitch(self) -> int:
        return 2

    def direction(self, position_angle: np.ndarray, axis: float, which: int) -> np.ndarray:
        """Across the magnet [rad], of any shape, that of position_angle: [rad], of any shape; axis: [rad].

        which: 0 is the clockwise one
        """
        return 0.0 * position_angle + axis + self._layer.across(which)

    @property
    def probes(self) -> Mapping[str, Segment]:
        return self._layer.probes

    def check(self) -> None:
        self._layer.check(self.pitch / 2, self.shaft_radius, "shaft_radius")

    def draw(self, rim: Rim) -> Drawing:
        """From the axis of pole 0 to half a pole pitch; regions iron, that of the rib too, magnet, ends of the hole."""
        return draw_buried(self, (self._layer,), self.magnet_length, rim)

    @property
    def _layer(self) -> RibbedVLayer:
        return RibbedVLayer(
            "", self.outer_radius, self.tip_depth, self.tilt, self.magnet_length, self.magnet_width, self.recess,
            self.hole_depth, self.bridge, self.bridge_start, self.bridge_end, self.rib,
        )  # fmt: skip
