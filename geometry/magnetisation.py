"""How a magnet on the axis of its pole is magnetised."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import pi

import numpy as np


class Magnetisation:
    """Direction of the remanence inside one magnet; the concrete patterns are below."""

    def direction_angle(self, position_angle: np.ndarray, centre_angle: float, pitch: float) -> np.ndarray:
        """Angle of the magnetisation vector of an outward magnet [rad], of the shape of the positions.

        position_angle: polar angle of the point [rad], array of any shape
        centre_angle: polar angle of the magnet's centre line [rad]
        pitch: angle between two poles [rad], negative where the gap lies inside of the magnets
        """
        raise NotImplementedError


@dataclass(frozen=True)
class ParallelMagnetisation(Magnetisation):
    """Every point of a magnet is magnetised along the magnet's centre line."""

    def direction_angle(self, position_angle: np.ndarray, centre_angle: float, pitch: float) -> np.ndarray:
        """The angle of the centre line [rad], of the shape of position_angle [rad], any shape."""
        return 0.0 * position_angle + centre_angle


@dataclass(frozen=True)
class RadialMagnetisation(Magnetisation):
    """Every point of a magnet is magnetised along its own radius."""

    def direction_angle(self, position_angle: np.ndarray, centre_angle: float, pitch: float) -> np.ndarray:
        """The polar angle of the point [rad], of the shape of position_angle [rad], any shape."""
        return position_angle + 0.0 * centre_angle


@dataclass(frozen=True)
class HalbachMagnetisation(Magnetisation):
    """Turned further and further from the centre line on, so that the flux gathers at the gap and needs no iron behind.

    delta - pi delta/pitch from the centre line: radial in the middle of a pole, along the circumference between two.
    Source: the ideal Halbach cylinder, Atallah and Howe, IEEE Trans. Magn. 34(4) (1998) 2060.
    """

    def direction_angle(self, position_angle: np.ndarray, centre_angle: float, pitch: float) -> np.ndarray:
        """Angles [rad], of the shape of position_angle [rad], any shape."""
        off = _from_centre(position_angle, centre_angle)
        return centre_angle + off - pi / pitch * off


@dataclass(frozen=True)
class TurnedToRadial(Magnetisation):
    """Magnetised as drawn, each point turned by a share of its angle from the centre line: of parallel magnets share 1
    makes radial ones, of radial ones share -1 parallel ones."""

    drawn: Magnetisation
    share: float

    def direction_angle(self, position_angle: np.ndarray, centre_angle: float, pitch: float) -> np.ndarray:
        """Angles [rad], of the shape of position_angle [rad], any shape."""
        off = _from_centre(position_angle, centre_angle)
        return self.drawn.direction_angle(position_angle, centre_angle, pitch) + self.share * off


def _from_centre(position_angle: np.ndarray, centre_angle: float) -> np.ndarray:
    """Angle from the centre line [rad], -pi to pi."""
    return np.mod(position_angle - centre_angle + pi, 2 * pi) - pi


PARALLEL = ParallelMagnetisation()
PATTERNS: Mapping[str, Magnetisation] = {
    "parallel": PARALLEL, "radial": RadialMagnetisation(), "halbach": HalbachMagnetisation(),
}  # fmt: skip
