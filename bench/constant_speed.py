"""Tests at constant speed over a shunt: damping and conversion efficiency (thesis section 5.2.1).

    eta = V^2 / (R_shunt F v)                                        (5.1)
    F = c v + F_0, a straight line over the points of one shunt      (table 5.1)

Means over the record, so that neither inertia nor compliance plays a part.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import hypot, isinf, nan

import numpy as np

from bench.errors import RecordError
from bench.memory import mean_and_error
from bench.record import Record
from bench.shunt_damping import ShuntPoints
from workbench.data.table import OPEN_CIRCUIT

_LARGEST_DRIFT = 0.05  # of the speed between the first and the last third of a record


@dataclass(frozen=True)
class SteadyPoint:
    """The means of one record.

    record: its name; shunt [ohm], infinite for an open circuit; velocity [m/s], force [N]; force_error: standard error
    [N]; power: electrical, in the shunt [W]; power_error: standard error [W]; 0 where the shunt is open or shorted
    """

    record: str
    shunt: float
    velocity: float
    force: float
    force_error: float
    power: float
    power_error: float

    @property
    def efficiency(self) -> float:
        """Electrical over mechanical power, dimensionless (5.1)."""
        return self.power / (self.force * self.velocity)

    @property
    def efficiency_error(self) -> float:
        """Standard error of the efficiency from those of power and force, dimensionless."""
        of_force = self.efficiency * self.velocity * self.force_error
        return hypot(self.power_error, of_force) / abs(self.force * self.velocity)


def steady_point(record: Record) -> SteadyPoint:
    """Means of the channels velocity (or stroke), force, shunt and, over a resistance, shunt_voltage.

    Raises RecordError where the speed drifts, or a channel is missing.
    """
    velocity, shunt = record.velocity(), record.constant("shunt")
    _require_steady(record, velocity)
    force, force_error = mean_and_error(record.channel("force"))
    power, power_error = (0.0, 0.0)
    if 0 < shunt < OPEN_CIRCUIT:
        power, power_error = mean_and_error(np.square(record.channel("shunt_voltage")) / shunt)
    return SteadyPoint(record.name, shunt, float(np.mean(velocity)), force, force_error, power, power_error)


def _require_steady(record: Record, velocity: np.ndarray) -> None:
    third = len(velocity) // 3
    first, last, mean = velocity[:third].mean(), velocity[-third:].mean(), velocity.mean()
    if mean == 0 or abs(last - first) > _LARGEST_DRIFT * abs(mean):
        raise RecordError(
            f"{record.name}: expected a constant speed other than zero, found {first:.4g} m/s at the beginning and "
            f"{last:.4g} m/s at "
            "the end; cut out the part at constant speed."
        )


@dataclass(frozen=True)
class StraightLine:
    """F = c v + F_0 over the points of one shunt.

    shunt [ohm]; damping: c [Ns/m]; intercept: F_0 [N]; damping_error [Ns/m], intercept_error [N]: standard errors, NaN
    for two points; fastest: largest velocity [m/s]; best_efficiency: dimensionless; most_power: in the shunt [W]
    """

    shunt: float
    damping: float
    intercept: float
    damping_error: float
    intercept_error: float
    fastest: float
    best_efficiency: float
    most_power: float


def straight_lines(points: Sequence[SteadyPoint]) -> tuple[StraightLine, ...]:
    """One line for every shunt that was driven at two velocities or more, from the largest shunt down."""
    shunts = sorted({point.shunt for point in points}, reverse=True)
    groups = [[point for point in points if point.shunt == shunt] for shunt in shunts]
    return tuple(_line(group) for group in groups if len({point.velocity for point in group}) > 1)


def _line(points: Sequence[SteadyPoint]) -> StraightLine:
    velocity, force = np.array([(p.velocity, p.force) for p in points]).T
    (damping, intercept), errors = np.polyfit(velocity, force, 1), (nan, nan)
    if len(points) > 2:
        _, covariance = np.polyfit(velocity, force, 1, cov=True)
        errors = tuple(np.sqrt(np.diag(covariance)).tolist())
    return StraightLine(
        points[0].shunt, float(damping), float(intercept), *errors, float(np.max(np.abs(velocity))),
        max(p.efficiency for p in points), max(p.power for p in points),
    )  # fmt: skip


def shunt_points(lines: Sequence[StraightLine]) -> ShuntPoints:
    """The slopes over a closed circuit, as the static laws take them."""
    closed = [line for line in lines if not isinf(line.shunt) and line.shunt < OPEN_CIRCUIT]
    return ShuntPoints(*np.array([(line.shunt, line.damping) for line in closed]).reshape(-1, 2).T)
