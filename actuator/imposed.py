"""An actuator on a bench: the motion of its output is imposed, its torque commanded, its force measured."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from actuator.compiled import MASS, TORQUE, VELOCITY, ActuatorNumbers
from actuator.errors import ActuatorError
from actuator.model import Actuator
from actuator.step import LOST, STATES, Imposed, carry, pieces, rates, stable_step
from compiling import compiled


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
    parts = pieces(step, stable_step(actuator) if finest is None else finest)
    states, answers = _impose(actuator.numbers, step, parts, *columns[1:])
    if not np.isfinite(states).all():
        raise ActuatorError(f"the actuator's motion has no bounds with steps of {step / parts:g} s; give finer ones")
    force, drawn, speed = answers.T
    time, stroke, velocity, _ = columns
    mount, gears, friction, motor = states[:, LOST:].T
    x, v = states[:, MASS], states[:, VELOCITY]
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
def _impose(
    actuator: ActuatorNumbers, step: float, parts: int, stroke: np.ndarray, velocity: np.ndarray, torque: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """States (t, states) and answers (t, 3)."""
    states, answers = np.empty((stroke.size, STATES)), np.empty((stroke.size, 3))
    state, change = np.zeros(STATES), np.empty(STATES)
    state[MASS], state[VELOCITY], state[TORQUE] = stroke[0], velocity[0], torque[0]
    for k in range(stroke.size):
        to = max(k, 1)
        ends = Imposed(step, stroke[to - 1], stroke[to], velocity[to - 1], velocity[to], torque[to - 1], torque[to])
        found = rates(actuator, ends, 0.0, state, change) if k == 0 else carry(actuator, ends, parts, state)
        states[k] = state
        answers[k, 0], answers[k, 1], answers[k, 2] = found.force, found.torque, found.speed
    return states, answers
