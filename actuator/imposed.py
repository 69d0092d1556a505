"""An actuator on a bench: the motion of its output is imposed, its torque commanded, its force measured."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil

import numpy as np

from actuator.compiled import Record, inside, limited_torque, rotor_speed
from actuator.errors import ActuatorError
from actuator.model import Actuator
from actuator.stiffness import fastest_rate
from compiling import compiled

_STABLE = 2.0  # step times the fastest rate; the limit of the Runge-Kutta rule is 2.78
_MASS, _VELOCITY, _TORQUE, _LOST, _STATES = 0, 1, 2, 3, 7  # x, x', T, then works taken by mount, gears, friction, motor


@dataclass(frozen=True, eq=False)
class ImposedHistory:
    """A bench run over time, arrays (t,); a positive force opposes rebound.

    time [s], (t,); stroke [m], (t,), velocity [m/s], (t,), of the output; force: that must be applied to it [N], (t,)
    mass_stroke [m], (t,), mass_velocity [m/s], (t,), of the equivalent mass; rotor_speed [rad/s], (t,); torque: of the
    rotor [Nm], (t,)
    mount_work, gear_work, friction_work, motor_work: taken since the start [J], (t,)
    """

    time: np.ndarray
    stroke: np.ndarray
    velocity: np.ndarray
    force: np.ndarray
    mass_stroke: np.ndarray
    mass_velocity: np.ndarray
    rotor_speed: np.ndarray
    torque: np.ndarray
    mount_work: np.ndarray
    gear_work: np.ndarray
    friction_work: np.ndarray
    motor_work: np.ndarray

    @property
    def work(self) -> float:
        """Put into the output over the run [J], by the trapezoidal rule."""
        return float(np.trapezoid(self.force * self.velocity, self.time))


def imposed_motion(
    actuator: Actuator,
    time: np.ndarray,
    stroke: np.ndarray,
    velocity: np.ndarray,
    torque: np.ndarray,
    finest: float | None = None,
) -> ImposedHistory:
    """The force that an actuator answers a motion with.

    time [s], (t,), equally spaced; stroke [m], (t,), and velocity [m/s], (t,), of the output, a cubic between the
    samples; torque: commanded, of the rotor, passive sign [Nm], (t,), straight between them
    finest: largest step of the integration [s]; None: what the fastest rate of the actuator asks for
    The equivalent mass starts with the motion of the output. Classical Runge-Kutta; on the identified prototype the
    force is within 1e-4 of its peak of one with a fifth of the step.
    Raises ActuatorError for histories that do not match, or a motion without bounds.
    """
    columns = [np.ascontiguousarray(one, dtype=float) for one in (time, stroke, velocity, torque)]
    _require_alike(*columns)
    step = float(columns[0][1] - columns[0][0])
    largest = _STABLE / fastest_rate(actuator) if finest is None else finest
    parts = max(ceil(step / largest), 1)
    numbers = actuator.numbers
    states, force = _impose(*numbers, step, parts, *columns[1:])
    if not np.isfinite(states).all():
        raise ActuatorError(f"the actuator's motion has no bounds with steps of {step / parts:g} s; give finer ones")
    x, v = states[:, _MASS], states[:, _VELOCITY]
    speed = v / actuator.ratio.at(x)
    drawn = states[:, _TORQUE] if actuator.drive.time_constant > 0 else _aimed(*numbers, speed, columns[3])
    mount, gears, friction, motor = states[:, _LOST:].T
    time, stroke, velocity, _ = columns
    return ImposedHistory(time, stroke, velocity, force, x, v, speed, drawn, mount, gears, friction, motor)


def _require_alike(time: np.ndarray, *others: np.ndarray) -> None:
    steps = np.diff(time)
    sound = time.ndim == 1 and time.size >= 2 and all(one.shape == time.shape for one in others)
    if not (sound and np.isfinite([time, *others]).all() and np.allclose(steps, steps[0], rtol=1e-6) and steps[0] > 0):
        raise ActuatorError(
            "imposed motion: expected finite stroke, velocity and torque over the same equally spaced times, found "
            f"{time.size} times with {', '.join(str(one.size) for one in others)} values; resample the record"
        )


@compiled
def _aimed(part: Record, _: np.ndarray, limit: np.ndarray, speed: np.ndarray, command: np.ndarray) -> np.ndarray:
    aimed = np.empty_like(speed)
    for k in range(speed.size):
        aimed[k] = limited_torque(part, limit, speed[k], command[k])
    return aimed


@compiled
def _impose(
    part: Record,
    ratio: np.ndarray,
    limit: np.ndarray,
    step: float,
    parts: int,
    stroke: np.ndarray,
    velocity: np.ndarray,
    torque: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """States (t, states) and forces (t,)."""
    states, force = np.zeros((stroke.size, _STATES)), np.empty(stroke.size)
    state, trial = np.zeros(_STATES), np.empty(_STATES)
    slopes = np.empty((4, _STATES))
    state[_MASS], state[_VELOCITY], state[_TORQUE] = stroke[0], velocity[0], torque[0]
    h = step / parts
    for k in range(stroke.size):
        if k > 0:
            for piece in range(parts):
                for stage in range(4):
                    ahead = 0.0 if stage == 0 else (1.0 if stage == 3 else 0.5)
                    for i in range(_STATES):
                        trial[i] = state[i] + (ahead * h * slopes[stage - 1, i] if stage else 0.0)
                    share = (piece + ahead) / parts
                    _rates(part, ratio, limit, step, share, k, stroke, velocity, torque, trial, slopes[stage])
                for i in range(_STATES):
                    middle = slopes[1, i] + slopes[2, i]
                    state[i] += h / 6 * (slopes[0, i] + 2 * middle + slopes[3, i])
        share = 1.0 if k else 0.0
        force[k] = _rates(part, ratio, limit, step, share, max(k, 1), stroke, velocity, torque, state, slopes[0])
        if part.rigid:
            state[_MASS], state[_VELOCITY] = stroke[k], velocity[k]
        for i in range(_STATES):
            states[k, i] = state[i]
    return states, force


@compiled
def _rates(
    part: Record,
    ratio: np.ndarray,
    limit: np.ndarray,
    step: float,
    share: float,
    k: int,
    stroke: np.ndarray,
    velocity: np.ndarray,
    torque: np.ndarray,
    state: np.ndarray,
    change: np.ndarray,
) -> float:
    """Rates of a state within the step that ends at sample k, and the force at the output."""
    z, rate, bend = _cubic(stroke[k - 1], stroke[k], velocity[k - 1] * step, velocity[k] * step, share)
    rate, bend = rate / step, bend / step**2
    x, v = (z, rate) if part.rigid else (state[_MASS], state[_VELOCITY])
    command = torque[k - 1] + share * (torque[k] - torque[k - 1])
    aimed = limited_torque(part, limit, rotor_speed(ratio, x, v), command)
    acting = state[_TORQUE] if part.time_constant > 0 else aimed
    seen = inside(part, ratio, z, rate, x, v, acting)
    change[_MASS], change[_VELOCITY] = v, seen.acceleration
    change[_TORQUE] = (aimed - state[_TORQUE]) / part.time_constant if part.time_constant > 0 else 0.0
    change[_LOST], change[_LOST + 1] = seen.mount, seen.gears
    change[_LOST + 2], change[_LOST + 3] = seen.friction, seen.motor
    return seen.force + seen.inertia * bend


@compiled
def _cubic(start: float, end: float, leaving: float, arriving: float, share: float) -> tuple[float, float, float]:
    """Hermite's cubic between two samples with its first two derivatives, over the share of the step."""
    rise = end - start
    c, d = 3 * rise - 2 * leaving - arriving, leaving + arriving - 2 * rise
    value = start + share * (leaving + share * (c + share * d))
    return value, leaving + share * (2 * c + 3 * share * d), 2 * c + 6 * share * d
