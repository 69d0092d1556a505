"""One run of a vehicle over a road: what goes in, the history that comes out, and its energy balance."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import TypeVar

import numpy as np

from vehicle.actuator import IDEAL, Actuator
from vehicle.comfort import weighted_acceleration
from vehicle.damping import DamperCurve
from vehicle.errors import VehicleError, require_not_negative, require_positive
from vehicle.models import Vehicle
from vehicle.motion import AxleForces, Motion, integrate
from vehicle.road import FlatRoad, Road

Kept = TypeVar("Kept")
_MOST_TOGETHER = 64  # runs in one integration, which bounds the memory
BALANCE_TOLERANCE = 5e-3  # of the energy that went through the vehicle


@dataclass(frozen=True)
class Scenario:
    """What the vehicle does: a road at a speed, or an acceleration.

    name: the same for random roads that differ by their seed alone
    speed [m/s], duration [s], road; longitudinal: acceleration a_x that the propulsion force gives [m/s^2] (3.25);
    time_step [s] of the history; the integration divides it where the motion is stiffer.
    """

    name: str
    speed: float
    duration: float
    road: Road = FlatRoad()
    longitudinal: float = 0.0
    time_step: float = 1e-3

    def __post_init__(self) -> None:
        owner = f"scenario '{self.name}'"
        require_not_negative(owner, speed=self.speed)
        require_positive(owner, duration=self.duration, time_step=self.time_step)
        if self.speed == 0 and not isinstance(self.road, FlatRoad):
            raise VehicleError(f"{owner}: a road with heights needs a speed above zero, found 0; give a speed")

    @property
    def title(self) -> str:
        """The name with the seed of a random road, which tells one run from another."""
        seed = self.road.random_seed
        return self.name if seed is None else f"{self.name}, seed {seed}"


@dataclass(frozen=True)
class Run:
    """A vehicle in a scenario with an actuator that is commanded a damper curve."""

    vehicle: Vehicle
    damping: DamperCurve
    scenario: Scenario
    actuator: Actuator = IDEAL


@dataclass(frozen=True)
class EnergyBalance:
    """Where the energy of a run came from and went to [J].

    road: work of the road on the tyres above the static load [J]; propulsion: of its force on the pitch [J]
    passive: taken by the dampers of the other axles [J]; actuator: by the actuated axle (machine and friction) [J]
    stored: left in masses, springs and tyres at the end [J]
    """

    road: float
    propulsion: float
    passive: float
    actuator: float
    stored: float

    @property
    def residual(self) -> float:
        """What the numbers leave unexplained [J]."""
        return self.road + self.propulsion - self.passive - self.actuator - self.stored

    @property
    def error(self) -> float:
        """Residual relative to the energy that was dissipated or stored; zero for a vehicle that nothing moves."""
        moved = self.passive + self.actuator + abs(self.stored)
        return abs(self.residual) / moved if moved or self.residual else 0.0


@dataclass(frozen=True, eq=False)
class RideHistory:
    """A run over time, arrays (t,) unless noted.

    time [s]; road: heights under the wheels [m], (n, t); body_height [m], pitch [rad] and wheel_heights [m], (n, t),
    above static equilibrium; body_acceleration [m/s^2], (t,), vertical; tyre_loads: on the road [N], (n, t).
    Of the actuated axle: stroke [m], (t,), and velocity [m/s], (t,), positive in rebound
    actuator_force: of the machine [N], (t,); suspension_force: with friction and reflected inertia [N], (t,)
    stop_force [N], (t,)
    """

    run: Run
    time: np.ndarray
    road: np.ndarray
    body_height: np.ndarray
    pitch: np.ndarray
    wheel_heights: np.ndarray
    body_acceleration: np.ndarray
    tyre_loads: np.ndarray
    stroke: np.ndarray
    velocity: np.ndarray
    actuator_force: np.ndarray
    suspension_force: np.ndarray
    stop_force: np.ndarray
    energy: EnergyBalance

    @property
    def actuator_power(self) -> np.ndarray:
        """P = F v [W], (t,), positive from the suspension to the actuator."""
        return self.actuator_force * self.velocity

    @property
    def weighted_acceleration(self) -> np.ndarray:
        """Acceleration of the body as it is felt [m/s^2], (t,) (3.23)."""
        return weighted_acceleration(self.body_acceleration, self.run.scenario.time_step)

    @property
    def road_holding(self) -> np.ndarray:
        """Missing tyre load of the actuated axle relative to its static load (3.24), (t,): 1 in the air."""
        return 1 - self.tyre_loads[-1] / self.run.vehicle.actuated.static_load


def simulate(runs: Sequence[Run]) -> list[RideHistory]:
    """Histories of the runs, in their order, from rest in static equilibrium; see ``simulate_and_keep``."""
    return simulate_and_keep(lambda history: history, runs)


def simulate_and_keep(what: Callable[[RideHistory], Kept], runs: Sequence[Run]) -> list[Kept]:
    """``what(history)`` of every run, in their order; the histories themselves are let go.

    Runs of the same vehicle, duration and time step are integrated together, which costs little more than one.
    Raises VehicleError when a suspension is faster than its damper curve knows, the energy balance is off by more than
    0.5 %, or the motion has no bounds.
    """
    found: dict[int, Kept] = {}
    order = sorted(range(len(runs)), key=lambda k: _kind(runs, k))
    for _, group in groupby(order, key=lambda k: _kind(runs, k)):
        alike = list(group)
        for first in range(0, len(alike), _MOST_TOGETHER):
            numbers = alike[first : first + _MOST_TOGETHER]
            found |= zip(numbers, map(what, _together([runs[k] for k in numbers])), strict=True)
    return [found[k] for k in range(len(runs))]


def _kind(runs: Sequence[Run], number: int) -> tuple[int, float, float]:
    """What runs must share to be integrated together; the vehicle by its first place in the list."""
    run = runs[number]
    vehicle = next(k for k, other in enumerate(runs) if other.vehicle == run.vehicle)
    return vehicle, run.scenario.duration, run.scenario.time_step


def _together(runs: Sequence[Run]) -> Iterator[RideHistory]:
    scenario = runs[0].scenario
    steps = round(scenario.duration / scenario.time_step)
    time = np.arange(steps + 1) * scenario.time_step
    road = np.stack([road_under_wheels(run, time) for run in runs], axis=-1)
    motion = motion_of(runs)
    states = integrate(motion, np.moveaxis(road, 1, 0), scenario.time_step)
    return (_history(run, time, road[..., k], states[..., k]) for k, run in enumerate(runs))


def road_under_wheels(run: Run, time: np.ndarray) -> np.ndarray:
    """Heights of the road under each wheel [m], (n, t); time: [s], (t,)."""
    scenario = run.scenario
    if scenario.speed == 0:
        return np.zeros((len(run.vehicle.axles), len(time)))
    delays = run.vehicle.delays(scenario.speed)
    return np.array([scenario.road.heights(time - delay, scenario.speed) for delay in delays])


def motion_of(runs: Sequence[Run]) -> Motion:
    """The equations of motion of runs of one vehicle."""
    vehicle = runs[0].vehicle
    dampers = [[curve] * len(runs) for curve in vehicle.passive_dampers]
    dampers.append([run.actuator.suspension_curve(run.damping) for run in runs])
    masses = [run.actuator.equivalent_mass for run in runs]
    return Motion(vehicle, dampers, masses, [vehicle.total_mass * run.scenario.longitudinal for run in runs])


def _history(run: Run, time: np.ndarray, road: np.ndarray, states: np.ndarray) -> RideHistory:
    motion = motion_of([run])
    state = np.moveaxis(states, 0, -1)  # the moments take the place of the runs
    forces, change = motion.forces(state, road), motion.derivative(state, road)
    _require_known_velocities(run, forces)
    history = RideHistory(
        run=run,
        time=time,
        road=road,
        body_height=state[0, 0],
        pitch=state[0, 1],
        wheel_heights=state[0, 2:],
        body_acceleration=change[1, 0],
        tyre_loads=motion.load - forces.tyre,
        stroke=forces.stroke[-1],
        velocity=forces.rate[-1],
        actuator_force=run.actuator.machine_curve(run.damping).at(forces.rate[-1]),
        suspension_force=forces.damper[-1] + motion.inertia_force(state, change),
        stop_force=forces.stop[-1],
        energy=_balance(motion, time, state, road, forces),
    )
    _require_balance(history)
    return history


def _balance(
    motion: Motion, time: np.ndarray, state: np.ndarray, road: np.ndarray, forces: AxleForces
) -> EnergyBalance:
    """Works by the trapezoidal rule over the history."""
    dissipated = np.trapezoid(forces.damper * forces.rate, time)
    lift = -(forces.tyre[:, 1:] + forces.tyre[:, :-1]) / 2 * np.diff(road)
    moment = (state[0, 0] + motion.vehicle.cog_height) * motion.propulsion
    energy = motion.energy(state[..., [0, -1]], road[:, [0, -1]])
    return EnergyBalance(
        road=float(lift.sum()),
        propulsion=float(np.trapezoid(moment * state[1, 1], time)),
        passive=float(dissipated[:-1].sum()),
        actuator=float(dissipated[-1]),
        stored=float(energy[1] - energy[0]),
    )


def _require_known_velocities(run: Run, forces: AxleForces) -> None:
    curves = (*run.vehicle.passive_dampers, run.damping)
    for curve, rate in zip(curves, forces.rate, strict=True):
        if rate.min() < curve.velocity[0] or rate.max() > curve.velocity[-1]:
            raise VehicleError(
                f"scenario '{run.scenario.title}': the suspension moves at {rate.min():.3g} to {rate.max():.3g} m/s, "
                f"the damper curve '{curve.name}' is known from {curve.velocity[0]:g} to {curve.velocity[-1]:g} m/s; "
                "extend the curve"
            )


def _require_balance(history: RideHistory) -> None:
    scenario, error = history.run.scenario, history.energy.error
    if not error <= BALANCE_TOLERANCE:
        raise VehicleError(
            f"scenario '{scenario.title}': the energy balance is off by {100 * error:.2g} %, more than "
            f"{100 * BALANCE_TOLERANCE:g} %; give a time step below {scenario.time_step:g} s"
        )
