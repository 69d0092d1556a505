"""Requirements on the actuator from runs of the vehicle (thesis Table 3.7), each with the scenario that set it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Any

import numpy as np

from vehicle.damping import DamperCurve
from vehicle.errors import VehicleError, require_positive
from vehicle.indices import RideSummary, summary
from vehicle.models import Vehicle
from vehicle.ride import Run, Scenario, simulate_and_keep
from vehicle.road import IsoRoad, Obstacle, ObstacleShape


def road_scenarios(roughness: float, speed: float, duration: float, seeds: Sequence[int]) -> list[Scenario]:
    """A random road at cruise speed, once a seed; roughness G_r [m cycle], speed [m/s], duration [s]."""
    return [Scenario(f"{RANDOM_ROAD}{_SEED}{seed}", speed, duration, IsoRoad(roughness, seed)) for seed in seeds]


RANDOM_ROAD = "random road"  # begins the name of every scenario of ``road_scenarios``
_SEED = ", seed "


def obstacle_scenarios(
    shape: ObstacleShape, speeds: Sequence[float], amplitudes: Sequence[float], duration: float
) -> list[Scenario]:
    """Every speed [m/s] with every amplitude [m]; positive amplitudes are bumps, negative ones potholes."""
    return [
        Scenario(obstacle_name(speed, amplitude), speed, duration, Obstacle(shape, amplitude), time_step=OBSTACLE_STEP)
        for speed in speeds
        for amplitude in amplitudes
    ]


OBSTACLE_STEP = 2.5e-4  # s; flanks last some milliseconds and end stops act as long


def obstacle_name(speed: float, amplitude: float) -> str:
    """What an obstacle's scenario is called."""
    return f"{'bump' if amplitude > 0 else 'pothole'} {abs(amplitude) * 1e3:.4g} mm at {speed * 3.6:.4g} km/h"


def acceleration_scenario(longitudinal: float, duration: float) -> Scenario:
    """Full acceleration from rest on a smooth road; longitudinal: a_x [m/s^2] (3.25)."""
    require_positive("acceleration", longitudinal=longitudinal)
    return Scenario("acceleration", 0.0, duration, longitudinal=longitudinal)


def runs_of(vehicle: Vehicle, damping: Sequence[DamperCurve], scenarios: Sequence[Scenario]) -> list[Run]:
    """Every scenario with every damping: independent tasks, those of one scenario together."""
    return [Run(vehicle, curve, scenario) for scenario in scenarios for curve in damping]


def summaries(runs: Sequence[Run]) -> list[RideSummary]:
    """The runs simulated and summed up, in their order."""
    return simulate_and_keep(summary, runs)


@dataclass(frozen=True)
class Required:
    """A value, SI and signed, and the run that set it."""

    value: float
    scenario: str


@dataclass(frozen=True)
class Requirements:
    """Rows of Table 3.7. Velocities and forces are positive in rebound; peaks are None without an overload scenario.

    maximum_damping c_max,reg [Ns/m]; nominal: force_rms [N], velocity_rms [m/s], power_rms [W];
    overload: velocity_peak, force_peak, velocity_at_force_peak, power_peak, force_at_power_peak,
    velocity_at_power_peak.
    """

    maximum_damping: Required
    force_rms: Required
    velocity_rms: Required
    power_rms: Required
    velocity_peak: Required | None
    force_peak: Required | None
    velocity_at_force_peak: Required | None
    power_peak: Required | None
    force_at_power_peak: Required | None
    velocity_at_power_peak: Required | None


def requirements(
    maximum_damping: float, nominal: Sequence[RideSummary], overload: Sequence[RideSummary] = ()
) -> Requirements:
    """The most demanding values of the runs.

    maximum_damping: regenerative damping that the damping curves were capped at [Ns/m]
    nominal: random road; the mean over the seeds of the damping with the largest RMS force is the nominal working
        point, so that force, velocity and power belong together, as in Table 3.7
    overload: obstacles and manoeuvres, whose peaks count
    """
    require_positive("requirements", maximum_damping=maximum_damping)
    if not nominal:
        raise VehicleError("requirements: expected at least one run on a random road, found none; add a road scenario")
    return Requirements(Required(maximum_damping, "given"), **_nominal_point(nominal), **_peaks(overload))


def _nominal_point(runs: Sequence[RideSummary]) -> dict[str, Required]:
    ordered = sorted(runs, key=_name_of_all_seeds)
    groups = [list(group) for _, group in groupby(ordered, key=_name_of_all_seeds)]
    worst = max(groups, key=lambda group: np.mean([run.force_rms for run in group]))
    names = ("force_rms", "velocity_rms", "power_rms")
    note = _name_of_all_seeds(worst[0]) + (f", mean of {len(worst)}" if len(worst) > 1 else "")
    return {name: Required(float(np.mean([getattr(run, name) for run in worst])), note) for name in names}


def _peaks(runs: Sequence[RideSummary]) -> dict[str, Any]:
    if not runs:
        return dict.fromkeys(_PEAKS)
    fastest = max(runs, key=lambda run: abs(run.velocity_peak))
    strongest = max(runs, key=lambda run: abs(run.at_force_peak.force))
    mightiest = max(runs, key=lambda run: abs(run.at_power_peak.power))
    strong, mighty = strongest.at_force_peak, mightiest.at_power_peak
    values = (fastest.velocity_peak, strong.force, strong.velocity, mighty.power, mighty.force, mighty.velocity)
    owners = (fastest, strongest, strongest, mightiest, mightiest, mightiest)
    return {key: Required(value, _name(run)) for key, value, run in zip(_PEAKS, values, owners, strict=True)}


_PEAKS = (
    "velocity_peak",
    "force_peak",
    "velocity_at_force_peak",
    "power_peak",
    "force_at_power_peak",
    "velocity_at_power_peak",
)


def _name(run: RideSummary) -> str:
    return f"{run.scenario}, {run.damping} damping"


def _name_of_all_seeds(run: RideSummary) -> str:
    return f"{run.scenario.partition(_SEED)[0]}, {run.damping} damping"
