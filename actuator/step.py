"""One step of an actuator whose output is moved and whose torque is commanded: the step of every simulation of it.

A whole record (``actuator.imposed``), a bench that asks at every sample, a loop in real time and an exported unit all
take the actuator from one instant to the next by ``carry``.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import ceil
from typing import NamedTuple

import numpy as np

from actuator.compiled import MASS, TORQUE, VELOCITY, ActuatorNumbers, inner_motion, respond
from actuator.errors import ActuatorError, require_positive
from actuator.model import Actuator
from actuator.parts import RigidMount
from actuator.stiffness import fastest_rate
from compiling import compiled

LOST = TORQUE + 1  # from here on a state holds the works taken by mount, gears, friction and motor
STATES = LOST + 4
_STABLE = 2.0  # step times the fastest rate; the limit of the Runge-Kutta rule is 2.78


class Imposed(NamedTuple):
    """What is imposed over one step: a motion of the output, Hermite's cubic, and a torque command, straight.

    duration [s]; start, end: stroke [m]; leaving, arriving: velocity [m/s]; first, last: torque command [Nm]
    """

    duration: float
    start: float
    end: float
    leaving: float
    arriving: float
    first: float
    last: float


class Answer(NamedTuple):
    """What an actuator answers at one instant: force at the output [N]; torque [Nm] and speed [rad/s] of the rotor."""

    force: float
    torque: float
    speed: float


@compiled
def motion_at(step: Imposed, share: float) -> tuple[float, float, float]:
    """Stroke [m], velocity [m/s] and acceleration [m/s^2] of the output at a share of the step, dimensionless."""
    h, rise = step.duration, step.end - step.start
    leaving, arriving = step.leaving * h, step.arriving * h
    c, d = 3 * rise - 2 * leaving - arriving, leaving + arriving - 2 * rise
    stroke = step.start + share * (leaving + share * (c + share * d))
    return stroke, (leaving + share * (2 * c + 3 * share * d)) / h, (2 * c + 6 * share * d) / h**2


@compiled
def rates(actuator: ActuatorNumbers, step: Imposed, share: float, state: np.ndarray, change: np.ndarray) -> Answer:
    """Rates of a state at a share of the step, dimensionless, and the answer; state, change: [SI], (7,)."""
    stroke, velocity, acceleration = motion_at(step, share)
    command = step.first + share * (step.last - step.first)
    part, ratio, limit = actuator
    inner = inner_motion(part, ratio, state, stroke, velocity)
    found = respond(part, ratio, limit, inner, stroke, velocity, command, state, change)
    inside = found.inside
    change[LOST], change[LOST + 1] = inside.mount, inside.gears
    change[LOST + 2], change[LOST + 3] = inside.friction, inside.motor
    return Answer(inside.force + inside.inertia * acceleration, found.torque, inner.velocity / inner.ratio)


@compiled
def carry(actuator: ActuatorNumbers, step: Imposed, parts: int, state: np.ndarray) -> Answer:
    """Take a state over a step, in place, by the classical Runge-Kutta rule in ``parts`` pieces; the answer at its end.

    state: [SI], (7,)
    """
    slopes, trial, h = np.empty((4, STATES)), np.empty(STATES), step.duration / parts
    for piece in range(parts):
        for stage in range(4):
            ahead = (stage + 1) // 2 / 2
            for i in range(STATES):
                trial[i] = state[i] + (ahead * h * slopes[stage - 1, i] if stage > 0 else 0.0)
            rates(actuator, step, (piece + ahead) / parts, trial, slopes[stage])
        for i in range(STATES):
            state[i] += h / 6 * (slopes[0, i] + 2 * (slopes[1, i] + slopes[2, i]) + slopes[3, i])
    if actuator.numbers.rigid:
        state[MASS], state[VELOCITY] = step.end, step.arriving
    return rates(actuator, step, 1.0, state, slopes[0])


def stable_step(actuator: Actuator) -> float:
    """Largest step that the integration stays stable with [s]."""
    return _STABLE / fastest_rate(actuator)


def pieces(duration: float, finest: float) -> int:
    """Into how many equal pieces a step [s] is divided; finest: largest piece [s]."""
    return max(ceil(duration / finest), 1)


@dataclass(frozen=True, eq=False)
class Moment:
    """An actuator between two steps; a positive force opposes rebound.

    state: as ``carry`` takes it [SI], (7,); stroke [m] and velocity [m/s] of the output; answer: force, torque, speed
    """

    state: np.ndarray
    stroke: float
    velocity: float
    answer: Answer

    @property
    def mass_stroke(self) -> float:
        """Of the equivalent mass [m]."""
        return float(self.state[MASS])


@dataclass(frozen=True)
class SteppedActuator:
    """An actuator that is asked step by step, velocity and motor force held over each.

    With the velocity held the stroke goes straight, so that the answer comes near that to a smooth motion as the step
    does. Raises ActuatorError for a rigid mount with a mass behind it, which a jump of the velocity asks too much of.
    """

    actuator: Actuator

    def __post_init__(self) -> None:
        if isinstance(self.actuator.mount, RigidMount) and self.actuator.equivalent_mass > 0:
            raise ActuatorError(
                "stepped actuator: expected a compliant mount in front of the equivalent mass, found a rigid one, "
                "which a velocity that jumps from step to step would meet with a force without bounds; give a mount"
            )

    @cached_property
    def _numbers(self) -> ActuatorNumbers:
        return self.actuator.numbers

    @cached_property
    def _finest(self) -> float:
        return stable_step(self.actuator)

    def at_rest(self, stroke: float = 0.0) -> Moment:
        """Nothing moves and nothing pulls; stroke: of output and equivalent mass [m]."""
        state = np.zeros(STATES)
        state[MASS] = stroke
        return Moment(state, stroke, 0.0, Answer(0.0, 0.0, 0.0))

    def after(self, moment: Moment, velocity: float, force: float, duration: float) -> Moment:
        """One step on.

        velocity: of the output over the step [m/s]; force: asked of the motor over the step, at the wheel [N]
        duration: of the step [s]; the integration divides it where the actuator is faster
        The force becomes a torque with the ratio at the beginning. Raises ActuatorError where an input is not a number.
        """
        require_positive("stepped actuator", duration=duration)
        torque = force * float(self.actuator.ratio.at(moment.mass_stroke))
        end, state = moment.stroke + duration * velocity, moment.state.copy()
        imposed = Imposed(duration, moment.stroke, end, velocity, velocity, torque, torque)
        answer = carry(self._numbers, imposed, pieces(duration, self._finest), state)
        if not np.isfinite(state).all():
            raise ActuatorError(
                f"stepped actuator: expected a finite velocity and force, found {velocity:g} m/s and {force:g} N that "
                "left it without bounds; connect both, or give shorter steps"
            )
        return Moment(state, end, velocity, answer)
