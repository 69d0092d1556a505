"""The loss map of a wound machine read at one torque and speed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import RegularGridInterpolator

from losses.map import PowerLosses


@dataclass(frozen=True)
class PointLosses:
    """Mechanical power and losses of a motor at one point; NaN where the point is out of reach."""

    power_out: float  # T omega [W]
    copper: float  # [W]
    stator_iron: float  # [W]
    rotor_iron: float  # [W]
    magnet: float  # [W]
    circulating: float  # [W], in the copper, by the current round a delta

    @property
    def total(self) -> float:
        """All electrical losses [W]."""
        return self.copper + self.circulating + self.stator_iron + self.rotor_iron + self.magnet

    @property
    def power_in(self) -> float:
        """Electrical [W]."""
        return self.power_out + self.total

    @property
    def efficiency(self) -> float:
        """Power out over power in, dimensionless."""
        return self.power_out / self.power_in


def losses_at(losses: PowerLosses, torque: float, speed: float) -> PointLosses:
    """Losses [W] at a torque [Nm] and a mechanical speed [rad/s], linear between the points of the map.

    The copper loss goes with the square of the torque: between the 161 torques of a map it is off by (1/160)^2/4 of
    its largest value. NaN beyond the map.
    """
    axes = losses.torque[:, 0], losses.speed[0]

    def at(table: np.ndarray) -> float:
        return float(RegularGridInterpolator(axes, table, bounds_error=False)([(torque, speed)])[0])

    parts = (losses.copper, losses.stator_iron, losses.rotor_iron, losses.magnet, losses.circulating)
    return PointLosses(torque * speed, *map(at, parts))
