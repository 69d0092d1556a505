"""Equations of motion of a vehicle with its actuator and control, compiled, and their integration in time.

Heights and rates as in ``vehicle.models``, the actuator as in ``actuator.model``, commands as in ``vehicle.commands``.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from actuator.compiled import TORQUE, Inner, Record, Response, inner_motion, inside, respond
from compiling import compiled

BODY = np.dtype([(name, np.float64) for name in ("mass", "pitch_inertia", "cog_height", "propulsion")])
_AXLE = ("position", "unsprung_mass", "spring", "bump", "rebound", "stop", "tyre", "load")
AXLE = np.dtype([(name, np.float64) for name in _AXLE])
FOLLOWS_CURVE, FEEDS_BACK, HELD = 0, 1, 2  # where the wanted force comes from
_GAINS = ("proportional", "integral", "derivative", "filter")
CONTROL = np.dtype([("source", np.int64), ("closed", np.bool_), *((name, np.float64) for name in _GAINS)])

# Behind the coordinates and their rates a state holds these, from ``own`` on: those of the actuator, the integrated and
# the filtered error of the force loop, then works since the start.
INTEGRAL, FILTERED = TORQUE + 1, TORQUE + 2
WORKS = ("road", "propulsion", "lift", "passive", "shaft", "mount", "gears", "friction", "motor")
WORK = 5
PROPULSION, LIFT, PASSIVE, SHAFT = (WORKS.index(name) for name in ("propulsion", "lift", "passive", "shaft"))
OWN = WORK + len(WORKS)
_NUDGE = 1e-9  # m, m/s, Nm, Ns, N: small against a play
# What is seen of a moment; then, for all axles, tyre forces, strokes, their rates and the forces of the end stops.
SEEN = ("acceleration", "force", "wanted", "motor_force", "rotor_speed", "torque")


class Equations(NamedTuple):
    """A vehicle with actuator and control, for the compiled equations.

    body: record of ``BODY``; axles: records of ``AXLE``, (n,); dampers: curves of all axles but the last, velocity
    [m/s] and force [N], (n - 1, 2, k); part, ratio [m, m/rad], (2, k), limit [rad/s, Nm], (3, k): the actuator as in
    ``actuator.compiled.ActuatorNumbers``
    control: record of ``CONTROL``; curve: wanted force [N] over velocity [m/s], (2, k); row: of the feedback [N/m, N/m,
    Ns/m, Ns/m], (4,); held: wanted force that somebody else sets [N], (1,)
    """

    body: Record
    axles: np.ndarray
    dampers: np.ndarray
    part: Record
    ratio: np.ndarray
    limit: np.ndarray
    control: Record
    curve: np.ndarray
    row: np.ndarray
    held: np.ndarray

    @property
    def size(self) -> int:
        """Length of a state."""
        return 2 * (2 + len(self.axles)) + OWN

    @property
    def seen(self) -> int:
        """How much is seen of a moment."""
        return len(SEEN) + 4 * len(self.axles)


@compiled
def line(v: float, table: np.ndarray) -> float:
    """Force [N] of a curve, going straight on beyond its ends; v: [m/s]; table: [m/s, N], (2, n)."""
    high, low = table.shape[1] - 1, 0
    while high - low > 1:
        middle = (low + high) // 2
        if table[0, middle] <= v:
            low = middle
        else:
            high = middle
    slope = (table[1, high] - table[1, low]) / (table[0, high] - table[0, low])
    return table[1, low] + slope * (v - table[0, low])


@compiled
def stop_force(axle: Record, stroke: float) -> float:
    """Force of the end stops [N] at a stroke [m]."""
    if stroke > axle.rebound:
        return axle.stop * (stroke - axle.rebound)
    if stroke < axle.bump:
        return axle.stop * (stroke - axle.bump)
    return 0.0


@compiled
def ride(
    e: Equations, state: np.ndarray, imposed: np.ndarray, climb: np.ndarray, change: np.ndarray, seen: np.ndarray
) -> None:
    """What springs, stops, tyres and the passive dampers do with a state, before the actuator acts.

    m_s z_s'' = P - sum F_i,       F_i = k_s,i dz_i + F_stop,i + F_d,i
    J_s theta'' = -cos(theta) sum x_i F_i + (z_s + h_COG) F_prop
    m_u,i z_u,i'' = F_i - min(k_u,i (z_u,i - z_r,i), W_i)

    Thesis eqs 3.8-3.16, 4.3-4.5 with the forces counted from static equilibrium: printed 3.8 balances the weights with
    F_e = k dz; with null stroke at static equilibrium, as the text has it, F_e = k dz - m_s,i g and the weights cancel.
    x_i: position ahead of the centre of gravity; W_i: static load; P: a force on the body at the centre of gravity.

    state, change: [SI], (size,); imposed: heights of the road [m] and then P [N], (n + 1,); climb: rates of the heights
    [m/s], (n,) at least; seen: [SI], (seen,)
    """
    rest(e, state, change)
    for i in range(e.axles.size):
        suspend(e, i, state, imposed[i], climb[i], change, seen)
    drive_body(e, state, imposed[e.axles.size], change)


@compiled
def rest(e: Equations, state: np.ndarray, change: np.ndarray) -> None:
    """Rates of a vehicle on which nothing acts: heights and pitch move on, works stay; state, change: [SI], (size,)."""
    rate = 2 + e.axles.size
    for i in range(rate):
        change[i], change[rate + i] = state[rate + i], 0.0
    for i in range(len(WORKS)):
        change[2 * rate + WORK + i] = 0.0


@compiled
def suspend(
    e: Equations, i: int, state: np.ndarray, height: float, climb: float, change: np.ndarray, seen: np.ndarray
) -> None:
    """What tyre, spring, stop and passive damper of axle ``i`` do with a state.

    height: of the road [m]; climb: its rate [m/s]; state, change: [SI], (size,); seen: [SI], (seen,)
    """
    count, axle, work = e.axles.size, e.axles[i], 2 * (2 + e.axles.size) + WORK
    stroke, moving = stretch(e, i, state)
    tyre = min(axle.tyre * (state[2 + i] - height), axle.load)
    stop = stop_force(axle, stroke)
    damper = line(moving, e.dampers[i]) if i < count - 1 else 0.0
    pull_down(e, i, axle.spring * stroke + stop + damper, state, change)
    change[4 + count + i] -= tyre / axle.unsprung_mass
    change[work] -= tyre * climb
    change[work + PASSIVE] += damper * moving
    for k, value in enumerate((tyre, stroke, moving, stop)):
        seen[len(SEEN) + k * count + i] = value


@compiled
def stretch(e: Equations, i: int, state: np.ndarray) -> tuple[float, float]:
    """Stroke of axle ``i`` [m] and its rate [m/s]; state: [SI], (size,)."""
    rate, position = 2 + e.axles.size, e.axles[i].position
    stroke = state[0] + position * np.sin(state[1]) - state[2 + i]
    return stroke, state[rate] + position * np.cos(state[1]) * state[rate + 1] - state[rate + 2 + i]


@compiled
def pull_down(e: Equations, i: int, force: float, state: np.ndarray, change: np.ndarray) -> None:
    """Let a force [N] pull the body down and the wheel of axle ``i`` up; state, change: [SI], (size,)."""
    body, axle, rate = e.body, e.axles[i], 2 + e.axles.size
    change[rate] -= force / body.mass
    change[rate + 1] -= np.cos(state[1]) * axle.position * force / body.pitch_inertia
    change[rate + 2 + i] += force / axle.unsprung_mass


@compiled
def drive_body(e: Equations, state: np.ndarray, force: float, change: np.ndarray) -> None:
    """Let the propulsion turn the body and a force [N] lift it; state, change: [SI], (size,)."""
    body, rate = e.body, 2 + e.axles.size
    work = 2 * rate + WORK
    turning = (state[0] + body.cog_height) * body.propulsion
    change[rate + 1] += turning / body.pitch_inertia
    change[rate] += force / body.mass
    change[work + PROPULSION], change[work + LIFT] = turning * state[rate + 1], force * state[rate]


@compiled
def wanted_force(e: Equations, state: np.ndarray, stroke: float, moving: float) -> float:
    """Force that is asked of the actuator [N]; stroke [m], moving: its rate [m/s]; state: [SI], (size,)."""
    if e.control.source == FOLLOWS_CURVE:
        return line(moving, e.curve)
    if e.control.source == FEEDS_BACK:
        last = 1 + e.axles.size
        wheel, wheel_rate = state[last], state[2 * last + 1]
        row = e.row
        return row[0] * stroke + row[1] * wheel + row[2] * (moving + wheel_rate) + row[3] * wheel_rate
    return e.held[0]


@compiled
def loop_output(control: Record, error: float, own: np.ndarray) -> float:
    """P e + I integral(e) + D N (e - e_f) [N] of the error e [N] (4.30); own: the actuator's state [SI], (own,)."""
    derivative = control.derivative * control.filter * (error - own[FILTERED])
    return control.proportional * error + control.integral * own[INTEGRAL] + derivative


@compiled
def force_error(e: Equations, inner: Inner, wanted: float, stroke: float, moving: float, torque: float) -> float:
    """What the force at the suspension lacks of the wanted one [N], for the loop; 0 without one.

    stroke [m], moving: its rate [m/s]; torque: of the rotor [Nm]
    """
    if not e.control.closed:
        return 0.0
    return wanted - inside(e.part, e.ratio, stroke, moving, inner.stroke, inner.velocity, torque).force


@compiled
def loop_moves(control: Record, error: float, rests: bool, own: np.ndarray, change: np.ndarray) -> None:
    """Rates of the loop's states; error [N]; rests: whether the integral does; own, change: [SI], (own,).

    Conditional integration with dynamic saturation (section 4.2.1): it rests while the loop asks for too much.
    """
    change[INTEGRAL] = 0.0 if rests else error
    change[FILTERED] = control.filter * (error - own[FILTERED])


@compiled
def act(e: Equations, state: np.ndarray, change: np.ndarray, seen: np.ndarray) -> None:
    """What the actuator does with a state, after ``ride``; state, change: [SI], (size,); seen: [SI], (seen,)."""
    count, first = e.axles.size, 2 * (2 + e.axles.size)
    stroke, moving = seen[len(SEEN) + 2 * count - 1], seen[len(SEEN) + 3 * count - 1]
    own, own_change = state[first:], change[first:]
    inner = inner_motion(e.part, e.ratio, own, stroke, moving)
    wanted = wanted_force(e, state, stroke, moving)
    error = force_error(e, inner, wanted, stroke, moving, own[TORQUE])
    asked = loop_output(e.control, error, own) if e.control.closed else wanted
    command = inner.ratio * asked
    found = respond(e.part, e.ratio, e.limit, inner, stroke, moving, command, own, own_change)
    loop_moves(e.control, error, found.aimed != command and asked * error > 0, own, own_change)
    force = push(e, found.inside.force, found.inside.inertia, state, change)
    show(found, inner, force, moving, wanted, change[2 + count], own_change, seen)


@compiled
def show(
    found: Response,
    inner: Inner,
    force: float,
    moving: float,
    wanted: float,
    acceleration: float,
    change: np.ndarray,
    seen: np.ndarray,
) -> None:
    """Write down the powers as rates of the works, and what is seen of the moment.

    force: at the suspension [N]; moving: rate of the stroke [m/s]; wanted: force [N]; acceleration: of the body [m/s^2]
    change: of the actuator's state [SI], (own,); seen: [SI], (seen,)
    """
    inside = found.inside
    for k, power in enumerate((force * moving, inside.mount, inside.gears, inside.friction, inside.motor)):
        change[WORK + SHAFT + k] = power
    motor_force, speed = found.torque / inner.ratio, inner.velocity / inner.ratio
    for k, value in enumerate((acceleration, force, wanted, motor_force, speed, found.torque)):
        seen[k] = value


@compiled
def push(e: Equations, force: float, mass: float, state: np.ndarray, change: np.ndarray) -> float:
    """Let a force [N] and an inerter of a mass [kg] act on body and wheel of the last axle; their sum as a force [N].

    F = F_0 + m w / (1 + m mu), w: relative acceleration without the mass, mu: mobility [1/kg]
    state, change: [SI], (size,)
    """
    count, body, axle = e.axles.size, e.body, e.axles[e.axles.size - 1]
    rate, cosine = 2 + count, np.cos(state[1])
    lever = axle.position * cosine
    mobility = 1 / body.mass + lever**2 / body.pitch_inertia + 1 / axle.unsprung_mass
    if mass > 0:
        turning = cosine * change[rate + 1] - np.sin(state[1]) * state[rate + 1] ** 2
        free = change[rate] + axle.position * turning - change[rate + 1 + count] - force * mobility
        force += mass * free / (1 + mass * mobility)
    pull_down(e, count - 1, force, state, change)
    return force


@compiled
def advance(
    e: Equations, state: np.ndarray, imposed: np.ndarray, rise: np.ndarray, step: float, work: np.ndarray
) -> None:
    """One step [s] of the classical Runge-Kutta rule, in place.

    state: [SI], (size,); imposed: at its start, as in ``ride`` [m, N], (n + 1,); rise: over the step [m, N], (n + 1,)
    work: room for slopes and a trial state [SI], (8, size) at least
    """
    size = state.size
    under, climb, seen, trial = work[4, : rise.size], work[5, : rise.size], work[6], work[7]
    for i in range(rise.size):
        climb[i] = rise[i] / step
    for stage in range(4):
        ahead = (stage + 1) // 2 / 2
        for i in range(rise.size):
            under[i] = imposed[i] + ahead * rise[i]
        for i in range(size):
            trial[i] = state[i] + (ahead * step * work[stage - 1, i] if stage > 0 else 0.0)
        ride(e, trial, under, climb, work[stage], seen)
        act(e, trial, work[stage], seen)
    for i in range(size):
        state[i] += step / 6 * (work[0, i] + 2 * (work[1, i] + work[2, i]) + work[3, i])


@compiled
def follow(
    e: Equations, state: np.ndarray, imposed: np.ndarray, step: float, parts: int, states: np.ndarray, seen: np.ndarray
) -> None:
    """Go on from a state over a road, straight between the samples, and keep every state and what is seen of it.

    state: at the first sample, moved on to the last [SI], (size,); imposed: as in ``ride`` [m, N], (t, n + 1)
    step: between samples [s], divided by ``parts``; states: [SI], (t, size); seen: [SI], (t, seen)
    """
    count = imposed.shape[1]
    work = np.zeros((8, max(state.size, seen.shape[1])))
    here, rise, still = np.empty(count), np.zeros(count), np.zeros(count)
    for k in range(imposed.shape[0]):
        if k > 0:
            for i in range(count):
                rise[i] = (imposed[k, i] - imposed[k - 1, i]) / parts
            for part in range(parts):
                for i in range(count):
                    here[i] = imposed[k - 1, i] + part * rise[i]
                advance(e, state, here, rise, step / parts, work)
        ride(e, state, imposed[k], still, work[0], seen[k])
        act(e, state, work[0], seen[k])
        for i in range(state.size):
            states[k, i] = state[i]


@compiled
def jacobian(e: Equations, state: np.ndarray) -> np.ndarray:
    """Slopes of the rates over the states, works left out [1/s and others], (n, n), by central differences.

    state: [SI], (size,)
    """
    size, count = state.size - len(WORKS), e.axles.size
    found, trial = np.empty((size, size)), state.copy()
    rates, seen = np.empty((2, state.size)), np.empty(len(SEEN) + 4 * count)
    flat = np.zeros(count + 1)
    for k in range(size):
        for side in range(2):
            trial[k] = state[k] + _NUDGE * (1 - 2 * side)
            ride(e, trial, flat, flat, rates[side], seen)
            act(e, trial, rates[side], seen)
        trial[k] = state[k]
        for i in range(size):
            found[i, k] = (rates[0, i] - rates[1, i]) / (2 * _NUDGE)
    return found
