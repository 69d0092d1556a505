"""The ride of a study with its actuator: energy and duty of every command, quasi-ideal and real (thesis 4.3)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from actuator.linear import stiffness_about, tangent_plant
from actuator.model import Actuator
from actuator.parts import LOSSLESS, NO_LOSS, RIGID
from control.design import loop_for
from control.errors import ControlError
from control.force_loop import ForceLoop
from control.transfer import bandwidth, margins
from labelled import xr
from tasks import Workers
from thermal.stage import Assembled
from vehicle.commands import Feedback
from vehicle.damping import DamperCurve
from vehicle.demands import RideCase
from vehicle.designed import DesignedActuator
from vehicle.energy import RideEnergy, reactive_powers, ride_energy
from vehicle.models import QuarterCar, Vehicle
from vehicle.printed_car import HANDLING, TRADE_OFF
from vehicle.quarter_car import lqr
from vehicle.ride import RideHistory, Run, simulate
from vehicle.ride_heat import RideTemperature, ride_temperature

QUASI_IDEAL, REAL, OPEN = "quasi-ideal", "real", "real, no force loop"
LQR_SETTINGS = {"LQR trade-off": TRADE_OFF, "LQR handling": HANDLING}
STEP = 5e-4  # s, of the histories: means of powers are taken over their samples
SHOWN = (4.0, 8.0)  # s, of the first road, in figures; of a shorter one its second half
WORKING_FORCES = (100.0, 300.0, 1000.0)  # N, about which the force loop is looked at
WANTED_BANDWIDTH, WANTED_MARGIN = 60.0, np.radians(50.0)  # Hz (text to Table 4.5) and rad (a usual choice)


@dataclass(frozen=True)
class EnergyTask:
    """One run of which the energy is wanted."""

    run: Run


@dataclass(frozen=True)
class EnergyCase:
    """A command with one of the actuators; energies: one a seed."""

    command: str
    actuator: str
    energies: tuple[RideEnergy, ...]

    @property
    def swings(self) -> bool:
        """Whether it swings by itself: the mount takes more than the suspension gives."""
        return sum(one.mount_loss for one in self.energies) > sum(one.shaft.active for one in self.energies)


@dataclass(frozen=True)
class LoopPoint:
    """The force loop about one working force.

    force [N]; stiffness: of the mount there [N/m]; bandwidth [Hz], phase_margin [rad]: of the loop as it is
    designed: the loop for the wanted bandwidth and margin there, None where no PID has them
    """

    force: float
    stiffness: float
    bandwidth: float
    phase_margin: float
    designed: ForceLoop | None


@dataclass(frozen=True, eq=False)
class EnergyOutcome:
    """What the rides come to.

    own: the actuator and its loop; cases: every command with every actuator; loop: about the working forces
    traces: of the first road, over (actuator, command, time), quasi-ideal and real: time [s], (t,), wanted, force [N],
    shaft, electrical, lost, elastic, inertial: powers [W], velocity [m/s], torque [Nm], rotor_speed [rad/s], tyre_load
    [N], felt: weighted acceleration [m/s^2], each (actuator, command, t)
    temperatures: under the first road with the real actuator, one a command; none where no thermal model was given
    """

    own: DesignedActuator
    cases: tuple[EnergyCase, ...]
    loop: tuple[LoopPoint, ...]
    traces: xr.Dataset
    temperatures: tuple[RideTemperature, ...]


def energy_of(task: EnergyTask) -> RideEnergy:
    """The energy of one run."""
    return ride_energy(simulate([task.run])[0])


def energy_stage(case: RideCase, own: DesignedActuator, machine: Assembled | None, workers: Workers) -> EnergyOutcome:
    """Every seed of the road with every command: quasi-ideal, real, and the damper curves without force loop.

    Raises ControlError where the force loop is unstable on the mount, VehicleError or ActuatorError where a motion or
    a map does not allow the ride.
    """
    runs = {name: list(group) for name, group in _groups(case, own)}
    tasks = {
        f"{'; '.join(name)}, seed {k}": EnergyTask(run) for name, group in runs.items() for k, run in enumerate(group)
    }
    found = iter(workers.map("rides", energy_of, tasks).values())
    cases = tuple(EnergyCase(*name, tuple(next(found) for _ in group)) for name, group in runs.items())
    first = [[runs[command, kind][0] for command in commands_of(case)] for kind in (QUASI_IDEAL, REAL)]
    ideal, histories = (dict(zip(commands_of(case), simulate(group), strict=True)) for group in first)
    warm = () if machine is None else (ride_temperature(name, one, machine) for name, one in histories.items())
    traces = traces_of({QUASI_IDEAL: ideal, REAL: histories})
    return EnergyOutcome(own, cases, tuple(loop_points(own)), traces, tuple(warm))


def outcome_of(own: DesignedActuator, runs: Mapping[str, Run]) -> EnergyOutcome:
    """Some runs with a real actuator as an outcome, each a command by the name that it is given."""
    histories = dict(zip(runs, simulate(list(runs.values())), strict=True))
    cases = tuple(EnergyCase(name, REAL, (ride_energy(one),)) for name, one in histories.items())
    return EnergyOutcome(own, cases, (), traces_of({REAL: histories}), ())


def commands_of(case: RideCase) -> dict[str, DamperCurve | Feedback]:
    """The damper curves of a case, and for a quarter car the LQR settings of the thesis."""
    found: dict[str, DamperCurve | Feedback] = {curve.name: curve for curve in case.damping}
    return found | _feedbacks(case.vehicle)


def _feedbacks(vehicle: Vehicle) -> dict[str, Feedback]:
    if not isinstance(vehicle, QuarterCar):
        return {}
    return {name: replace(lqr(vehicle, weights), name=name) for name, weights in LQR_SETTINGS.items()}


def _groups(case: RideCase, own: DesignedActuator) -> Iterator[tuple[tuple[str, str], Iterator[Run]]]:
    """Command and actuator by name, and a run for each seed."""
    roads = [replace(road, time_step=min(road.time_step, STEP)) for road in case.road]
    for name, command in commands_of(case).items():
        yield (name, QUASI_IDEAL), (Run(case.vehicle, command, road, quasi_ideal(own)) for road in roads)
        yield (name, REAL), (Run(case.vehicle, command, road, own.actuator, own.loop) for road in roads)
        if isinstance(command, DamperCurve):
            yield (name, OPEN), (Run(case.vehicle, command, road, own.actuator) for road in roads)


def quasi_ideal(own: DesignedActuator) -> Actuator:
    """The same machine and ratio without inertia, friction, gear losses and mount."""
    return replace(own.actuator, equivalent_mass=0.0, mount=RIGID, loss=NO_LOSS, gears=LOSSLESS)


def loop_points(own: DesignedActuator) -> Iterator[LoopPoint]:
    """The loop as it is, and the one that would have the wanted bandwidth, about each working force."""
    for force in WORKING_FORCES:
        plant = tangent_plant(own.actuator, force)
        through = plant.times(own.loop.transfer)
        try:
            designed = loop_for(plant, WANTED_BANDWIDTH, WANTED_MARGIN)
        except ControlError:
            designed = None
        stiffness = stiffness_about(own.actuator, force)
        yield LoopPoint(force, stiffness, bandwidth(through.closed), margins(through).phase, designed)


def traces_of(histories: dict[str, dict[str, RideHistory]]) -> xr.Dataset:
    """What figures show of histories by actuator and command; see ``EnergyOutcome``."""
    actuators, commands = list(histories), list(next(iter(histories.values())))
    time = histories[actuators[0]][commands[0]].time
    shown = (time >= min(SHOWN[0], time[-1] / 2)) & (time <= SHOWN[1])
    seen = [[_seen(one) for one in group.values()] for group in histories.values()]
    data = {
        name: (("actuator", "command", "time"), np.array([[one[name][shown] for one in group] for group in seen]))
        for name in seen[0][0]
    }
    return xr.Dataset(data, {"actuator": actuators, "command": commands, "time": time[shown]})


def _seen(history: RideHistory) -> dict[str, np.ndarray]:
    """What figures show of a ride, each (t,)."""
    inside = history.inside
    lost = history.run.actuator.drive.loss.at(inside.torque, inside.rotor_speed)
    elastic, inertial = reactive_powers(history)
    return {
        "wanted": inside.wanted,
        "force": history.suspension_force,
        "shaft": history.suspension_force * history.velocity,
        "electrical": inside.torque * inside.rotor_speed - lost,
        "lost": lost,
        "elastic": elastic,
        "inertial": inertial,
        "velocity": history.velocity,
        "torque": inside.torque,
        "rotor_speed": inside.rotor_speed,
        "tyre_load": history.tyre_loads[-1],
        "felt": history.weighted_acceleration,
    }
