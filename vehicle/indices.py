"""What a run comes to: comfort, road holding, stroke, and the working points of the actuator."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vehicle.ride import RideHistory


def rms(values: np.ndarray) -> float:
    """Root mean square [as the values] over the whole run, its start from rest included.

    values: [any unit], any shape
    """
    return float(np.sqrt(np.mean(np.square(values))))


def at_largest(values: np.ndarray) -> int:
    """Position of the value of largest magnitude; values: [any unit], (n,)."""
    return int(np.argmax(np.abs(values)))


@dataclass(frozen=True)
class WorkingPoint:
    """Force [N] and velocity [m/s] of the actuator at one instant, positive in rebound."""

    force: float
    velocity: float

    @property
    def power(self) -> float:
        """F v [W]."""
        return self.force * self.velocity


@dataclass(frozen=True)
class RideSummary:
    """The numbers of one run that Tables 3.4-3.6 of the thesis list; peaks keep their sign.

    scenario, damping: names; seed: of a random road, None where the scenario has none
    comfort_rms, comfort_peak: weighted acceleration [m/s^2]; road_holding_rms, road_holding_peak: dimensionless;
    stroke_peak [m]; force_rms [N], velocity_rms, velocity_peak [m/s], power_rms, power_mean [W];
    energy_error: of the balance, relative.
    """

    scenario: str
    seed: int | None
    damping: str
    comfort_rms: float
    comfort_peak: float
    road_holding_rms: float
    road_holding_peak: float
    stroke_peak: float
    force_rms: float
    velocity_rms: float
    power_rms: float
    power_mean: float
    velocity_peak: float
    at_force_peak: WorkingPoint
    at_power_peak: WorkingPoint
    energy_error: float


def summary(history: RideHistory) -> RideSummary:
    """Numbers of one run."""
    force, velocity, power = history.actuator_force, history.velocity, history.actuator_power
    felt, holding = history.weighted_acceleration, history.road_holding

    def point(k: int) -> WorkingPoint:
        """Force and velocity at a sample."""
        return WorkingPoint(float(force[k]), float(velocity[k]))

    return RideSummary(
        scenario=history.run.scenario.name,
        seed=history.run.scenario.road.random_seed,
        damping=history.run.command.name,
        comfort_rms=rms(felt),
        comfort_peak=float(felt[at_largest(felt)]),
        road_holding_rms=rms(holding),
        road_holding_peak=float(holding[at_largest(holding)]),
        stroke_peak=float(history.stroke[at_largest(history.stroke)]),
        force_rms=rms(force),
        velocity_rms=rms(velocity),
        power_rms=rms(power),
        power_mean=float(np.mean(power)),
        velocity_peak=float(velocity[at_largest(velocity)]),
        at_force_peak=point(at_largest(force)),
        at_power_peak=point(at_largest(power)),
        energy_error=history.energy.error,
    )
