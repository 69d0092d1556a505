"""How a magnet on the axis of its pole is magnetised."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


class Magnetisation:
    """Direction of the remanence inside one magnet; the concrete patterns are below."""

    def direction_angle(self, position_angle: np.ndarray, centre_angle: float) -> np.ndarray:
        """Angle of the magnetisation vector of an outward magnet [rad], of the shape of the positions.

        position_angle: polar angle of the point [rad], array of any shape
        centre_angle: polar angle of the magnet's centre line [rad]
        """
        raise NotImplementedError


@dataclass(frozen=True)
class ParallelMagnetisation(Magnetisation):
    """Every point of a magnet is magnetised along the magnet's centre line."""

    def direction_angle(self, position_angle: np.ndarray, centre_angle: float) -> np.ndarray:
        """The angle of the centre line [rad], of the shape of position_angle [rad], any shape."""
        return 0.0 * position_angle + centre_angle


@dataclass(frozen=True)
class RadialMagnetisation(Magnetisation):
    """Every point of a magnet is magnetised along its own radius."""

    def direction_angle(self, position_angle: np.ndarray, centre_angle: float) -> np.ndarray:
        """The polar angle of the point [rad], of the shape of position_angle [rad], any shape."""
        return position_angle + 0.0 * centre_angle


PARALLEL = ParallelMagnetisation()
