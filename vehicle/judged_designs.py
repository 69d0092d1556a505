"""The designs of the search over all stages, driven over the road: comfort, road holding and recovered power of each.

Every design rides with the motor of its fits, its ratio and its equivalent mass behind the mount and in the force loop
of the actuator that was designed stage by stage, whose friction, gear efficiency and course of the ratio it takes too.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import pi

import numpy as np

from actuator.drive import LossLaw, MappedMotor, flat_limit
from actuator.model import Actuator
from actuator.parts import Ratio
from drivetrain.pareto import non_dominated
from drivetrain.whole_design import RatedDesign, RoadMachine
from drivetrain.whole_search import WholeSearch
from tasks import Workers
from vehicle.damping import DamperCurve
from vehicle.demands import RideCase
from vehicle.designed import DesignedActuator
from vehicle.energy import RideEnergy, ride_energy
from vehicle.errors import VehicleError
from vehicle.road_aims import road_costs
from vehicle.road_runs import RoadTask, read_of_rides, road_task

_MASS, _EQUIVALENT_MASS = 0, 1  # among the objectives of a design


@dataclass(frozen=True)
class DesignLoss(LossLaw):
    """Losses of the machine of a design: copper by the torque, iron and magnets by the speed (``RoadMachine``)."""

    machine: RoadMachine

    def at(self, torque: np.ndarray, speed: np.ndarray) -> np.ndarray:
        """[W], of that shape; torque: [Nm], any shape; speed: [rad/s], any shape."""
        frequency = self.machine.pole_pairs * np.asarray(speed) / (2 * pi)
        return self.machine.copper * np.square(torque) + np.asarray(self.machine.idle.at(frequency))


@dataclass(frozen=True)
class JudgedDesign:
    """What a design is worth on the road; each index with the command that serves it best.

    number: of the design in optimise.csv, None for one that was not solved by the field; rated: the design by the fits
    comfort: weighted acceleration, RMS [m/s^2]; road_holding: RMS, dimensionless; recovered: mean power to the battery
    [W]; with the commands that give them
    """

    number: int | None
    rated: RatedDesign
    comfort: float
    comfort_command: str
    road_holding: float
    holding_command: str
    recovered: float
    recovered_command: str

    @property
    def costs(self) -> tuple[float, ...]:
        """As ``road_costs`` [kg, 1, 1, W], (4,); less is better."""
        return road_costs(self.rated.values.objectives[_MASS], self.comfort, self.road_holding, self.recovered)


@dataclass(frozen=True)
class JudgedDesigns:
    """Designs on the road: those solved by the field in their order, then the front; refused: designs, by place, whose
    ride could not be driven, with the reason."""

    designs: tuple[JudgedDesign, ...]
    refused: dict[str, str]

    @property
    def best(self) -> tuple[JudgedDesign, ...]:
        """Designs that no other betters in mass, comfort, road holding and recovered power together, by mass."""
        places = non_dominated(np.array([one.costs for one in self.designs]))
        return tuple(self.designs[k] for k in places)


def judged_stage(search: WholeSearch, case: RideCase, own: DesignedActuator, workers: Workers) -> JudgedDesigns:
    """Every design of a search over the first random road with every damping of the case.

    Raises VehicleError where no design can be driven.
    """
    rated = (*(one.model for one in search.solved), *search.front)
    tasks = {
        _name(k, len(search.solved)): _task(case, own, one, machine)
        for k, (one, machine) in enumerate(zip(rated, search.machines, strict=True))
    }
    found = workers.map("designs on the road", driven, tasks)
    refused = {name: one for name, one in found.items() if isinstance(one, str)}
    if len(refused) == len(tasks):
        raise VehicleError(f"no design of the search can be driven: {next(iter(refused.values()))}")
    numbers = (*range(1, len(search.solved) + 1), *[None] * len(search.front))
    kept = [
        _judged(number, one, case.damping, energies)
        for number, one, energies in zip(numbers, rated, found.values(), strict=True)
        if not isinstance(energies, str)
    ]
    return JudgedDesigns(tuple(kept), refused)


def _name(place: int, solved: int) -> str:
    return f"design {place + 1}" if place < solved else f"front {place - solved + 1}"


def _task(case: RideCase, own: DesignedActuator, rated: RatedDesign, machine: RoadMachine) -> RoadTask:
    return road_task(case, actuator_of_design(own.actuator, rated, machine), own.loop)


def actuator_of_design(own: Actuator, rated: RatedDesign, machine: RoadMachine) -> Actuator:
    """The designed actuator with the motor, ratio and equivalent mass of another design.

    The torque is bounded by the overload current alone: what voltage leaves at speed is for the winding to say, which
    the search does not choose.
    """
    scale = rated.design.transmission_ratio / own.ratio.nominal
    limit = flat_limit(machine.peak_torque, own.drive.limit.speed[-1] / scale)
    return replace(
        own,
        drive=MappedMotor(limit, DesignLoss(machine), own.drive.time_constant),
        ratio=Ratio(own.ratio.stroke, tuple(scale * value for value in own.ratio.value)),
        equivalent_mass=rated.values.objectives[_EQUIVALENT_MASS],
    )


def driven(task: RoadTask) -> tuple[RideEnergy, ...] | str:
    """The energy of a design with every command, or why it cannot be driven."""
    return read_of_rides(task, ride_energy)


def _judged(
    number: int | None, rated: RatedDesign, commands: Sequence[DamperCurve], energies: tuple[RideEnergy, ...]
) -> JudgedDesign:
    pairs = list(zip((one.name for one in commands), energies, strict=True))
    comfort = min(pairs, key=lambda pair: pair[1].comfort)
    holding = min(pairs, key=lambda pair: pair[1].road_holding)
    recovered = max(pairs, key=lambda pair: pair[1].battery.active)
    return JudgedDesign(
        number=number,
        rated=rated,
        comfort=comfort[1].comfort,
        comfort_command=comfort[0],
        road_holding=holding[1].road_holding,
        holding_command=holding[0],
        recovered=recovered[1].battery.active,
        recovered_command=recovered[0],
    )
