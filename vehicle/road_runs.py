"""Actuators over the first random road of a case, each with every damping of it: what searches compare them by."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TypeVar

from actuator.model import Actuator
from control.errors import ControlError
from control.force_loop import ForceLoop
from vehicle.demands import RideCase
from vehicle.errors import VehicleError
from vehicle.ride import RideHistory, Run, simulate

_STEP = 5e-4  # s, of the history: means of powers are taken over its samples

Found = TypeVar("Found")


@dataclass(frozen=True)
class RoadTask:
    """One actuator; runs: with each damping of the case."""

    runs: tuple[Run, ...]


def road_task(case: RideCase, actuator: Actuator, loop: ForceLoop) -> RoadTask:
    """An actuator in its force loop in the vehicle of a case."""
    road = replace(case.road[0], time_step=min(case.road[0].time_step, _STEP))
    return RoadTask(tuple(Run(case.vehicle, command, road, actuator, loop) for command in case.damping))


def read_of_rides(task: RoadTask, read: Callable[[RideHistory], Found]) -> tuple[Found, ...] | str:
    """What is read of every run, or why they cannot be driven: a force loop or a ride that is not stable."""
    try:
        return tuple(read(one) for one in simulate(task.runs))
    except (ControlError, VehicleError) as error:
        return str(error)
