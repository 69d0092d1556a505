"""The equations of ``actuator.model.Actuator``, compiled: they are evaluated some million times for a ride.

``actuator.parts`` says the force laws a second time, on arrays; a test holds the two together.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from compiling import compiled

Record = Any  # of numpy, whose fields the compiled code reads as attributes


# The numbers of an actuator, a record of this type; names and units as in ``actuator.parts`` and ``actuator.drive``.
_NAMES = (
    "stiffness", "damping", "play", "contact_damping", "transition", "mass", "viscous", "coulomb", "breakaway",
    "driven", "driving", "nominal_ratio", "time_constant",
)  # fmt: skip
NUMBERS = np.dtype([("rigid", np.bool_), ("passive", np.bool_), *((name, np.float64) for name in _NAMES)])
MASS, VELOCITY, TORQUE = range(3)  # of a state: where the equivalent mass is, how fast, and the torque of the rotor


class ActuatorNumbers(NamedTuple):
    """An actuator for the compiled equations.

    numbers: record of the type ``NUMBERS``
    ratio: strokes [m] and tau_t [m/rad], (2, n); limit: speeds [rad/s], driving and braking torques [Nm], (3, m)
    """

    numbers: Record
    ratio: np.ndarray
    limit: np.ndarray


class Inside(NamedTuple):
    """What goes on inside an actuator at one instant; powers are those that are lost.

    force: at the suspension, without the inertia of a rigid mount [N]; acceleration: of the equivalent mass [m/s^2]
    inertia: of a rigid mount, at the suspension [kg]; mount, gears, friction, motor: powers taken [W]
    """

    force: float
    acceleration: float
    inertia: float
    mount: float
    gears: float
    friction: float
    motor: float


@compiled
def at(x: float, table: np.ndarray, row: int) -> float:
    """A row of a table over its first row, straight between the points; beyond the ends the last value stays.

    at: [unit of the row]; x: [unit of the first row]; table: [any units], (rows, n), the first row rising
    """
    high = table.shape[1] - 1
    if x <= table[0, 0]:
        return table[row, 0]
    if x >= table[0, high]:
        return table[row, high]
    low = 0
    while high - low > 1:
        middle = (low + high) // 2
        if table[0, middle] <= x:
            low = middle
        else:
            high = middle
    share = (x - table[0, low]) / (table[0, high] - table[0, low])
    return table[row, low] + share * (table[row, high] - table[row, low])


@compiled
def slope_at(x: float, table: np.ndarray) -> float:
    """Slope of the second row over the first.

    slope_at: [units of the rows], 0 beyond the ends; x: [unit of the first]; table: [any units], (2, n)
    """
    last = table.shape[1] - 1
    if x <= table[0, 0] or x >= table[0, last]:
        return 0.0
    k = 1
    while table[0, k] < x:
        k += 1
    return (table[1, k] - table[1, k - 1]) / (table[0, k] - table[0, k - 1])


@compiled
def engagement(mount: Record, beyond: float) -> float:
    """s, dimensionless, as far beyond the play [m]."""
    if beyond <= 0:
        return 0.0
    if beyond >= mount.transition:
        return 1.0
    share = beyond / mount.transition
    return share * share * (3 - 2 * share)


@compiled
def elastic_force(mount: Record, deformation: float) -> float:
    """Part of the mount's force that stores energy [N] at a deformation [m]."""
    beyond = abs(deformation) - mount.play
    force = engagement(mount, beyond) * mount.stiffness * beyond
    return force if deformation > 0 else -force


@compiled
def damping_of(mount: Record, deformation: float) -> float:
    """Damping of the mount [Ns/m] at a deformation [m]."""
    return mount.damping + engagement(mount, abs(deformation) - mount.play) * mount.contact_damping


@compiled
def largest_torque(limit: np.ndarray, speed: float, torque: float) -> float:
    """[Nm] at a speed [rad/s] in the quadrant of a torque [Nm]; limit: see ``ActuatorNumbers`` [rad/s, Nm], (3, m)."""
    fast = abs(speed)
    if fast > limit[0, limit.shape[1] - 1]:
        return 0.0
    return at(fast, limit, 2 if torque * speed >= 0 else 1)


@compiled
def limited_torque(drive: Record, limit: np.ndarray, speed: float, command: float) -> float:
    """Torque that the drive aims at [Nm]: the command [Nm] within the limit at a speed [rad/s]; a bridge has its own.

    limit: as in ``ActuatorNumbers`` [rad/s, Nm], (3, m)
    """
    if drive.passive:
        return largest_torque(limit, speed, speed) * (1.0 if speed > 0 else -1.0)
    most = largest_torque(limit, speed, command)
    return min(max(command, -most), most)


@compiled
def inside(part: Record, ratio: np.ndarray, stroke: float, rate: float, x: float, v: float, torque: float) -> Inside:
    """Forces and powers at a stroke [m] and its rate [m/s], with the equivalent mass at x [m] and v [m/s].

    torque: of the rotor [Nm]; ratio: as in ``ActuatorNumbers`` [m, m/rad], (2, n)
    """
    tau = at(x, ratio, 1)
    scale = part.nominal_ratio / tau
    mass = part.mass * scale * scale
    sense = min(max(v / part.breakaway, -1.0), 1.0)
    friction = part.viscous * scale * scale * v + part.coulomb * scale * sense
    motor = torque / tau
    # A mass J / tau(x)^2 that changes along the stroke takes m'(x) v^2 / 2.
    bending = -mass * slope_at(x, ratio) / tau * v * v
    if part.rigid:
        through = motor + friction + bending
        share = 1 / part.driven - 1 if through * sense > 0 else 1 - part.driving
        gears = abs(through) * share * sense
        return Inside(through + gears, 0.0, mass, 0.0, gears * v, friction * v, motor * v)
    damper = damping_of(part, stroke - x) * (rate - v)
    force = elastic_force(part, stroke - x) + damper
    share = 1 - part.driven if force * sense > 0 else 1 / part.driving - 1
    gears = abs(force) * share * sense
    acceleration = (force - gears - friction - motor - bending) / mass
    return Inside(force, acceleration, 0.0, damper * (rate - v), gears * v, friction * v, motor * v)


class Inner(NamedTuple):
    """Where the equivalent mass is [m], its velocity [m/s], and the ratio tau_t there [m/rad]."""

    stroke: float
    velocity: float
    ratio: float


@compiled
def inner_motion(part: Record, ratio: np.ndarray, own: np.ndarray, stroke: float, rate: float) -> Inner:
    """Of the state of an actuator at a stroke [m] and its rate [m/s]; a rigid mount leaves it to them.

    ratio: as in ``ActuatorNumbers`` [m, m/rad], (2, n); own: the state [SI], (3,) at least
    """
    x, v = (stroke, rate) if part.rigid else (own[MASS], own[VELOCITY])
    return Inner(x, v, at(x, ratio, 1))


class Response(NamedTuple):
    """What an actuator does at one instant.

    inside: its forces and powers; torque: of the rotor [Nm]; aimed: torque that the drive goes to [Nm]
    """

    inside: Inside
    torque: float
    aimed: float


@compiled
def respond(
    part: Record,
    ratio: np.ndarray,
    limit: np.ndarray,
    inner: Inner,
    stroke: float,
    rate: float,
    command: float,
    own: np.ndarray,
    change: np.ndarray,
) -> Response:
    """What an actuator does with the motion of its output and a torque command: the equations of ``actuator.model``.

    ratio, limit: as in ``ActuatorNumbers`` [m, m/rad], (2, n), and [rad/s, Nm], (3, m); stroke [m], rate: of it [m/s]
    command: for the rotor [Nm]; own, change: a state and its rates [SI], (3,) at least
    """
    aimed, lags = limited_torque(part, limit, inner.velocity / inner.ratio, command), part.time_constant > 0
    torque = own[TORQUE] if lags else aimed
    change[TORQUE] = (aimed - torque) / part.time_constant if lags else 0.0
    found = inside(part, ratio, stroke, rate, inner.stroke, inner.velocity, torque)
    change[MASS], change[VELOCITY] = (0.0, 0.0) if part.rigid else (inner.velocity, found.acceleration)
    return Response(found, torque, aimed)
