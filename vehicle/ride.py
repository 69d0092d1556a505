"""One run of a vehicle over a road: what goes in, the history that comes out, and its energy balance."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import ceil
from typing import TypeVar

import numpy as np

from actuator.compiled import MASS, VELOCITY
from actuator.linear import require_stable
from actuator.model import IDEAL, Actuator
from actuator.parts import RigidMount
from control.force_loop import ForceLoop
from vehicle.comfort import weighted_acceleration
from vehicle.commands import Command, Controller, Feedback, Felt
from vehicle.damping import DamperCurve
from vehicle.equations import equations, largest_step, require_stable_law, stored_energy
from vehicle.errors import VehicleError, require_not_negative, require_positive
from vehicle.models import Vehicle
from vehicle.motion import SEEN, SHAFT, WORK, WORKS, Equations, follow
from vehicle.road import FlatRoad, Road

Kept = TypeVar("Kept")
BALANCE_TOLERANCE = 5e-3  # of the energy that went through the vehicle


@dataclass(frozen=True)
class BodyForce:
    """A vertical force on the body at its centre of gravity; this one is none."""

    def at(self, time: np.ndarray) -> np.ndarray:
        """[N], (t,), positive upwards; time: [s], (t,)."""
        return np.zeros_like(time)


@dataclass(frozen=True)
class HarmonicForce(BodyForce):
    """F sin(2 pi f t) (text to thesis Fig. 4.35); amplitude: F [N]; frequency: f [Hz]."""

    amplitude: float
    frequency: float

    def __post_init__(self) -> None:
        require_positive("harmonic force on the body", amplitude=self.amplitude, frequency=self.frequency)

    def at(self, time: np.ndarray) -> np.ndarray:
        """[N], (t,), positive upwards; time: [s], (t,)."""
        return self.amplitude * np.sin(2 * np.pi * self.frequency * time)


NO_FORCE = BodyForce()


@dataclass(frozen=True)
class Scenario:
    """What the vehicle does: a road at a speed, an acceleration, or a force that shakes its body.

    name: the same for random roads that differ by their seed alone
    speed [m/s], duration [s], road; longitudinal: acceleration a_x that the propulsion force gives [m/s^2] (3.25);
    body_force: on the body; time_step [s] of the history; the integration divides it where the motion is stiffer.
    """

    name: str
    speed: float
    duration: float
    road: Road = FlatRoad()
    longitudinal: float = 0.0
    body_force: BodyForce = NO_FORCE
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
    """A vehicle in a scenario with an actuator that is asked for a force.

    loop: force loop around the actuator; None: the motor is asked for the wanted force itself
    Raises VehicleError for a loop around an actuator whose force is its motor's.
    """

    vehicle: Vehicle
    command: Command
    scenario: Scenario
    actuator: Actuator = IDEAL
    loop: ForceLoop | None = None

    def __post_init__(self) -> None:
        if self.loop is not None and (isinstance(self.actuator.mount, RigidMount) or self.actuator.is_passive):
            raise VehicleError(
                "a force loop needs an actuator under torque control behind a compliant mount, found one whose force "
                "follows its motor at once or takes no command; leave the loop out"
            )


@dataclass(frozen=True)
class EnergyBalance:
    """Where the energy of a run came from and went to [J].

    road: work of the road on the tyres above the static load [J]; propulsion: of its force on the pitch [J]
    lift: work of a force on the body [J]
    passive: taken by the dampers of the other axles [J]; actuator: by machine, friction, gears and mount [J]
    stored: left in masses, springs and tyres at the end, of the actuator too [J]
    """

    road: float
    propulsion: float
    lift: float
    passive: float
    actuator: float
    stored: float

    @property
    def residual(self) -> float:
        """What the numbers leave unexplained [J]."""
        return self.road + self.propulsion + self.lift - self.passive - self.actuator - self.stored

    @property
    def error(self) -> float:
        """Residual relative to the energy that was dissipated or stored; zero for a vehicle that nothing moves."""
        moved = abs(self.passive) + abs(self.actuator) + abs(self.stored)
        return abs(self.residual) / moved if moved or self.residual else 0.0


@dataclass(frozen=True, eq=False)
class InsideActuator:
    """What goes on inside the actuator over time, arrays (t,).

    wanted: force that was asked for [N], (t,); torque: of the rotor, positive against rebound [Nm], (t,); rotor_speed
    [rad/s], (t,); mass_stroke [m], (t,), mass_velocity [m/s], (t,): of the equivalent mass, at the wheel
    shaft: work of the suspension since the start [J], (t,); mount [J], (t,), gears [J], (t,), friction [J], (t,), and
    motor [J], (t,): what they have taken of it
    """

    wanted: np.ndarray
    torque: np.ndarray
    rotor_speed: np.ndarray
    mass_stroke: np.ndarray
    mass_velocity: np.ndarray
    shaft: np.ndarray
    mount: np.ndarray
    gears: np.ndarray
    friction: np.ndarray
    motor: np.ndarray


@dataclass(frozen=True, eq=False)
class RideHistory:
    """A run over time, arrays (t,) unless noted.

    time [s]; road: heights under the wheels [m], (n, t); body_height [m], pitch [rad] and wheel_heights [m], (n, t),
    above static equilibrium; body_acceleration [m/s^2], (t,), vertical; tyre_loads: on the road [N], (n, t).
    Of the actuated axle: stroke [m], (t,), and velocity [m/s], (t,), positive in rebound
    actuator_force: of the machine [N], (t,); suspension_force: with friction, inertia and mount [N], (t,)
    stop_force [N], (t,); inside: the actuator
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
    inside: InsideActuator
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

    Classical Runge-Kutta of fourth order; the scenario's step is divided where something moves faster.
    Raises VehicleError when a suspension is faster than its damper curve knows, the energy balance is off by more than
    0.5 %, or the motion has no bounds.
    """
    return [what(ride_of_run(run)) for run in runs]


def ride_of_run(run: Run) -> RideHistory:
    """One run; see ``simulate_and_keep``."""
    scenario = run.scenario
    time = np.arange(round(scenario.duration / scenario.time_step) + 1) * scenario.time_step
    road = road_under_wheels(run, time)
    _require_stable_control(run)
    e = equations(run.vehicle, run.actuator, run.command, run.loop, run.vehicle.total_mass * scenario.longitudinal)
    parts = ceil(scenario.time_step / largest_step(run.vehicle, run.actuator, run.command, e))
    states, seen = _followed(run, e, np.column_stack([*road, scenario.body_force.at(time)]), parts)
    if not np.isfinite(states[-1]).all():
        step = scenario.time_step / parts
        raise VehicleError(
            f"scenario '{scenario.title}': the motion has no bounds (steps of {step:g} s); the control is unstable, or "
            "give a smaller time step"
        )
    return _history(run, time, road, states, seen)


def _require_stable_control(run: Run) -> None:
    if run.loop is not None:
        require_stable(run.actuator, run.loop)
    if isinstance(run.command, Feedback):
        require_stable_law(run.vehicle, run.command)


def _followed(run: Run, e: Equations, imposed: np.ndarray, parts: int) -> tuple[np.ndarray, np.ndarray]:
    """States (t, size) and what is seen (t, seen); imposed: as in ``vehicle.motion.ride`` [m, N], (t, n + 1)."""
    step = run.scenario.time_step
    states, seen, state = np.empty((len(imposed), e.size)), np.empty((len(imposed), e.seen)), np.zeros(e.size)
    if not isinstance(run.command, Controller):
        follow(e, state, imposed, step, parts, states, seen)
        return states, seen
    every = _samples_between(run.command, step)
    follow(e, state, imposed[:1], step, parts, states[:1], seen[:1])
    for k in range(0, len(imposed) - 1, every):
        here = slice(k, k + every + 1)
        e.held[0] = run.command.law(felt(k * step, states[k], seen[k], len(run.vehicle.axles)))
        follow(e, state, imposed[here], step, parts, states[here], seen[here])
    return states, seen


def _samples_between(controller: Controller, step: float) -> int:
    every = round(controller.sample_time / step)
    if every < 1 or abs(every * step - controller.sample_time) > 1e-9:
        raise VehicleError(
            f"controller '{controller.name}': its sample time must be a multiple of the scenario's step of {step:g} s, "
            f"found {controller.sample_time:g} s; change one of them"
        )
    return every


def felt(time: float, state: np.ndarray, seen: np.ndarray, count: int) -> Felt:
    """What a controller is told; time [s]; state [SI], (size,), seen [SI], (seen,): of the motion; count: of axles."""
    of_axles = seen[len(SEEN) :].reshape(4, count)
    stroke, moving = of_axles[1, -1], of_axles[2, -1]
    wheel, wheel_rate = state[1 + count], state[3 + 2 * count]
    return Felt(time, stroke, wheel, moving + wheel_rate, wheel_rate, seen[1], seen[0])


def road_under_wheels(run: Run, time: np.ndarray) -> np.ndarray:
    """Heights of the road under each wheel [m], (n, t); time: [s], (t,)."""
    scenario = run.scenario
    if scenario.speed == 0:
        return np.zeros((len(run.vehicle.axles), len(time)))
    delays = run.vehicle.delays(scenario.speed)
    return np.array([scenario.road.heights(time - delay, scenario.speed) for delay in delays])


def _history(run: Run, time: np.ndarray, road: np.ndarray, states: np.ndarray, seen: np.ndarray) -> RideHistory:
    count = len(run.vehicle.axles)
    state, of_axles = states.T, seen.T[len(SEEN) :].reshape(4, count, -1)
    own = state[2 * (2 + count) :]
    tyre, stroke, velocity, stop = of_axles
    acceleration, force, wanted, machine, speed, torque = seen.T[: len(SEEN)]
    _require_known_velocities(run, velocity)
    rigid = isinstance(run.actuator.mount, RigidMount)
    x, v = (stroke[-1], velocity[-1]) if rigid else (own[MASS], own[VELOCITY])
    loads = np.array([[axle.static_load] for axle in run.vehicle.axles])
    history = RideHistory(
        run=run,
        time=time,
        road=road,
        body_height=state[0],
        pitch=state[1],
        wheel_heights=state[2 : 2 + count],
        body_acceleration=acceleration,
        tyre_loads=loads - tyre,
        stroke=stroke[-1],
        velocity=velocity[-1],
        actuator_force=machine,
        suspension_force=force,
        stop_force=stop[-1],
        inside=InsideActuator(wanted, torque, speed, x, v, *own[WORK + SHAFT :]),
        energy=_balance(run, road, states),
    )
    _require_balance(history)
    return history


def _balance(run: Run, road: np.ndarray, states: np.ndarray) -> EnergyBalance:
    works = dict(zip(WORKS, (float(work) for work in states[-1, -len(WORKS) :]), strict=True))
    return EnergyBalance(
        road=works["road"],
        propulsion=works["propulsion"],
        lift=works["lift"],
        passive=works["passive"],
        actuator=works["mount"] + works["gears"] + works["friction"] + works["motor"],
        stored=stored_energy(run.vehicle, run.actuator, states[-1], road[:, -1])
        - stored_energy(run.vehicle, run.actuator, states[0], road[:, 0]),
    )


def _require_known_velocities(run: Run, rates: np.ndarray) -> None:
    own = (run.command,) if isinstance(run.command, DamperCurve) else ()
    for curve, rate in zip((*run.vehicle.passive_dampers, *own), rates, strict=False):
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
