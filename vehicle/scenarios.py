"""What a vehicle is driven over to find out what its actuator must do: random roads, obstacles, an acceleration."""

from __future__ import annotations

from collections.abc import Sequence

from units import FACTORS, MILLIMETRE
from vehicle.damping import DamperCurve
from vehicle.errors import require_positive
from vehicle.indices import RideSummary, summary
from vehicle.models import Vehicle
from vehicle.ride import Run, Scenario, simulate_and_keep
from vehicle.road import IsoRoad, Obstacle, ObstacleShape

RANDOM_ROAD = "random road"
OBSTACLE_STEP = 2.5e-4  # s; flanks last some milliseconds and end stops act as long


def road_scenarios(roughness: float, speed: float, duration: float, seeds: Sequence[int]) -> list[Scenario]:
    """A random road at cruise speed, once a seed; roughness G_r [m cycle], speed [m/s], duration [s]."""
    return [Scenario(RANDOM_ROAD, speed, duration, IsoRoad(roughness, seed)) for seed in seeds]


def obstacle_scenarios(
    shape: ObstacleShape, speeds: Sequence[float], amplitudes: Sequence[float], duration: float
) -> list[Scenario]:
    """Each of the speeds [m/s] with each of the amplitudes [m]; positive ones are bumps, negative ones potholes."""
    return [
        Scenario(obstacle_name(speed, amplitude), speed, duration, Obstacle(shape, amplitude), time_step=OBSTACLE_STEP)
        for speed in speeds
        for amplitude in amplitudes
    ]


def obstacle_name(speed: float, amplitude: float) -> str:
    """What an obstacle's scenario is called; speed [m/s], amplitude [m]."""
    height, pace = abs(amplitude) / MILLIMETRE, speed / FACTORS["km_per_h"]
    return f"{'bump' if amplitude > 0 else 'pothole'} {height:.4g} mm at {pace:.4g} km/h"


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
