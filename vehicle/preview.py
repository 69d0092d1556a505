"""An obstacle that is seen ahead: the force of the actuator over time by trajectory optimisation (thesis 4.2.2, 6.1).

The thesis names the method (collocation-type optimisation after Coric) and leaves it to future work. Here the car is
linear with a rigid actuator, so that with the motor force u straight between equally spaced nodes all states follow
linearly and exactly, and the optimum is that of a convex quadratic program (cvxopt):

    min sum a_s^2 + q_t (z_u - z_r)^2 + q_s dz^2 + q_r (u' / m_s)^2
    |u| <= limit(v): current and voltage,   bump <= dz <= rebound,   z_u - z_r <= W / k_u: the tyre stays on the road

    m_s a_s = -k_s dz - F,   m_u a_u = k_s dz + F - k_u (z_u - z_r),   F = u + c dz' + m (a_s - a_u)

The limit depends on the velocity that comes out: solved again with the limit at the velocities found before, each node
with the narrowest of all limits so far, until no node is beyond its own. That is feasible, and near the optimum, since
only some nodes are narrowed. Travel and contact yield, at a price, where nothing else is possible, and it is said.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import cvxopt
import numpy as np
from scipy.linalg import expm

from actuator.model import Actuator
from vehicle.commands import Controller, Feedback, Felt
from vehicle.errors import VehicleError, require_not_negative, require_positive
from vehicle.models import QuarterCar
from vehicle.ride import Scenario
from vehicle.road import Road

_KILONEWTON = 1e3  # N, of the unknowns, so that all are of the order of one
_PRICE = 1e5  # 1/m of travel or lift, in the cost of one second: dearer than any ride that keeps them
_ROUNDS = 30
_BEYOND = 1e-3  # of the limit; a node that is beyond by less keeps it
_CLOSE = {"abstol": 1e-9, "reltol": 1e-8, "feastol": 1e-8, "show_progress": False, "maxiters": 100}


@dataclass(frozen=True)
class Later(Road):
    """A road that begins later; delay: by which every height comes later [s]."""

    road: Road
    delay: float

    def heights(self, time: np.ndarray, speed: float) -> np.ndarray:
        """Height [m], (t,); time: [s], (t,); speed: [m/s]."""
        return self.road.heights(np.asarray(time) - self.delay, speed)


@dataclass(frozen=True)
class PreviewWeights:
    """What the plan weighs against the squared acceleration of the body.

    tyre: q_t [1/s^4]; stroke: q_s [1/s^4]; rate: q_r [s^2]; the first two are the LQR's r_h / m_s and r_s / m_s
    """

    tyre: float
    stroke: float
    rate: float = 1e-6

    def __post_init__(self) -> None:
        require_not_negative("preview weights", tyre=self.tyre, stroke=self.stroke)
        require_positive("preview weights", rate=self.rate)


@dataclass(frozen=True)
class PreviewTask:
    """An obstacle that is seen ahead.

    car: its stops bound the travel; actuator: its limit, mass and friction count; road, speed [m/s]: what comes
    duration: of the plan [s]; weights; step: between nodes [s]
    """

    car: QuarterCar
    actuator: Actuator
    road: Road
    speed: float
    duration: float
    weights: PreviewWeights
    step: float = 5e-3

    def __post_init__(self) -> None:
        require_positive("preview", speed=self.speed, duration=self.duration, step=self.step)
        if self.actuator.is_passive:
            raise VehicleError("preview: expected an actuator that takes a command, found a diode bridge; give a motor")

    @property
    def time(self) -> np.ndarray:
        """Of the nodes [s], (n,)."""
        return np.arange(round(self.duration / self.step) + 1) * self.step


@dataclass(frozen=True, eq=False)
class Plan:
    """A force over time, arrays (n,) unless noted.

    time [s], (n,); motor_force: u [N], (n,); force: on the suspension [N], (n,); states: z_s, z_u [m] and their rates
    [m/s], (4, n); acceleration: of the body [m/s^2], (n,); tyre: z_u - z_r [m], (n,)
    lowest, highest: motor force that current and voltage allow at the velocity [N], (n,)
    overtravel, lift: what the travel and the tyre could not keep [m]; rounds: quadratic programs solved
    """

    time: np.ndarray
    motor_force: np.ndarray
    force: np.ndarray
    states: np.ndarray
    acceleration: np.ndarray
    tyre: np.ndarray
    lowest: np.ndarray
    highest: np.ndarray
    overtravel: float
    lift: float
    rounds: int

    @property
    def stroke(self) -> np.ndarray:
        """dz [m], (n,)."""
        return self.states[0] - self.states[1]

    def controller(self, feedback: Feedback, sample_time: float) -> Controller:
        """The planned force, and a feedback of what differs from the plan; sample_time [s]."""
        planned = np.array([self.stroke, *self.states[1:]])

        def law(felt: Felt) -> float:
            """Wanted force [N]."""
            expected = [float(np.interp(felt.time, self.time, one)) for one in planned]
            seen = (felt.stroke, felt.wheel_height, felt.body_velocity, felt.wheel_velocity)
            error = np.array(seen) - np.array(expected)
            return float(np.interp(felt.time, self.time, self.force)) + float(np.dot(feedback.row, error))

        return Controller(law, sample_time, "preview")


def plan(task: PreviewTask) -> Plan:
    """The best force for what is seen.

    Raises VehicleError where the quadratic program has no solution, or no force within the limits is found.
    """
    motion = _Motion.of(task)
    lowest, highest = (np.full(task.time.size, side * _largest_force(task.actuator)) for side in (-1.0, 1.0))
    for rounds in range(1, _ROUNDS + 1):
        force, slack = _solved(task, motion, lowest, highest)
        states = motion.states(force)
        allowed = force_limits(task.actuator, states)
        if _within(force, *allowed):
            return _plan(task, motion, force, states, allowed, slack, rounds)
        lowest, highest = np.maximum(lowest, allowed[0]), np.minimum(highest, allowed[1])
    raise VehicleError(
        f"preview: no force within current and voltage was found in {_ROUNDS} rounds, the motor lacks up to "
        f"{float(np.max(np.maximum(force - allowed[1], allowed[0] - force))):.3g} N; drive more slowly or give a "
        "finer step"
    )


def force_limits(actuator: Actuator, states: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Smallest and largest motor force at the wheel that current and voltage allow [N], (n,).

    states: z_s, z_u [m] and their rates [m/s], (4, n)
    A force along the velocity brakes (passive sign), one against it drives.
    """
    ratio = actuator.ratio.at(states[0] - states[1])
    speed = (states[2] - states[3]) / ratio
    driving, braking = actuator.drive.limit.driving_at(speed) / ratio, actuator.drive.limit.braking_at(speed) / ratio
    return np.where(speed > 0, -driving, -braking), np.where(speed > 0, braking, driving)


def _largest_force(actuator: Actuator) -> float:
    limit = actuator.drive.limit
    return max(*limit.driving, *limit.braking) / min(actuator.ratio.value)


def _within(force: np.ndarray, lowest: np.ndarray, highest: np.ndarray) -> bool:
    slack = _BEYOND * max(float(np.max(np.abs(force))), 1.0)
    return bool(np.all(force <= highest + slack) and np.all(force >= lowest - slack))


@dataclass(frozen=True, eq=False)
class _Motion:
    """States over the nodes as an affine function of the forces: states(u) = free + response u.

    free: [SI], (4, n); response: [SI per N], (4, n, n); accelerations: rows of both accelerations over
    (z, u, z_r), (2, 6); road: heights [m], (n,); force_row: F over (z, u, z_r), (6,)
    """

    free: np.ndarray
    response: np.ndarray
    accelerations: np.ndarray
    road: np.ndarray
    force_row: np.ndarray

    @classmethod
    def of(cls, task: PreviewTask) -> _Motion:
        """Of a task, from rest."""
        accelerations, force_row = _rates(task.car, task.actuator)
        road = task.road.heights(task.time, task.speed)
        free, response = _over_nodes(accelerations, task.step, road)
        return cls(free, response, accelerations, road, force_row)

    def states(self, force: np.ndarray) -> np.ndarray:
        """[SI], (4, n); force: at the nodes [N], (n,)."""
        return self.free + self.response @ force

    def output(self, row: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """An output, a row over (z, u, z_r), as free part (n,) and response to the forces (n, n) [its unit]."""
        count = len(self.road)
        response = np.einsum("i,ijk->jk", row[:4], self.response) + row[4] * np.eye(count)
        return row[:4] @ self.free + row[5] * self.road, response


def _rates(car: QuarterCar, actuator: Actuator) -> tuple[np.ndarray, np.ndarray]:
    """Accelerations of body and wheel, (2, 6), and F, (6,), over (z_s, z_u, z_s', z_u', u, z_r)."""
    spring = car.spring_stiffness * np.array([1.0, -1, 0, 0, 0, 0])
    pull = spring + np.array([0.0, 0, actuator.loss.viscous, -actuator.loss.viscous, 1, 0])
    tyre = car.tyre_stiffness * np.array([0.0, 1, 0, 0, 0, -1])
    mass = actuator.equivalent_mass
    inertia = np.array([[car.sprung_mass + mass, -mass], [-mass, car.unsprung_mass + mass]])
    accelerations = np.linalg.solve(inertia, np.array([-pull, pull - tyre]))
    return accelerations, pull - spring + mass * (accelerations[0] - accelerations[1])


def _over_nodes(accelerations: np.ndarray, step: float, road: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Free motion (4, n) and response to every force (4, n, n), exact for inputs straight between the nodes."""
    a, b = np.zeros((4, 4)), np.zeros((4, 2))
    a[:2, 2:] = np.eye(2)
    a[2:], b[2:] = accelerations[:, :4], accelerations[:, 4:]
    block = np.zeros((8, 8))
    block[:4, :4], block[:4, 4:6], block[4:6, 6:] = a * step, b * step, np.eye(2)
    whole = expm(block)
    transition, at_end = whole[:4, :4], whole[:4, 6:]
    at_start = whole[:4, 4:6] - at_end
    count = len(road)
    free, response = np.zeros((4, count)), np.zeros((4, count, count))
    for k in range(1, count):
        free[:, k] = transition @ free[:, k - 1] + at_start[:, 1] * road[k - 1] + at_end[:, 1] * road[k]
        response[:, k] = transition @ response[:, k - 1]
        response[:, k, k - 1] += at_start[:, 0]
        response[:, k, k] += at_end[:, 0]
    return free, response


_TYRE, _STROKE = np.array([0.0, 1, 0, 0, 0, -1]), np.array([1.0, -1, 0, 0, 0, 0])


def _solved(
    task: PreviewTask, motion: _Motion, lowest: np.ndarray, highest: np.ndarray
) -> tuple[np.ndarray, tuple[float, float]]:
    """Forces [N], (n,), and by how much travel and contact yield [m]."""
    p, q = _cost(task, motion)
    g, h = _bounds(task, motion, lowest, highest)
    matrices = [cvxopt.matrix(one) for one in (p, q, g, h)]
    found = cvxopt.solvers.qp(*matrices, options=_CLOSE)
    if found["status"] != "optimal":
        raise VehicleError(
            f"preview: the quadratic program ended as '{found['status']}'; give a longer plan or other weights"
        )
    unknown = np.array(found["x"]).ravel()
    return unknown[:-2] * _KILONEWTON, (float(unknown[-2]), float(unknown[-1]))


def _cost(task: PreviewTask, motion: _Motion) -> tuple[np.ndarray, np.ndarray]:
    """P and q of x'Px/2 + q'x; x: forces [kN] and what travel and contact yield [m]."""
    count, weights = len(motion.road), task.weights
    rows = ((motion.accelerations[0], 1.0), (_TYRE, weights.tyre), (_STROKE, weights.stroke))
    p, q = np.zeros((count, count)), np.zeros(count)
    for row, weight in rows:
        free, response = motion.output(row)
        response = _KILONEWTON * response
        p += 2 * weight * task.step * response.T @ response
        q += 2 * weight * task.step * response.T @ free
    change = _KILONEWTON / (task.car.sprung_mass * task.step) * np.diff(np.eye(count), axis=0)
    p += 2 * weights.rate * task.step * change.T @ change
    whole = np.zeros((count + 2, count + 2))
    whole[:count, :count] = p
    whole[count:, count:] = np.eye(2)
    return whole, np.concatenate([q, [_PRICE, _PRICE]])


def _bounds(
    task: PreviewTask, motion: _Motion, lowest: np.ndarray, highest: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """G and h of G x <= h."""
    count, stops = len(motion.road), task.car.stops
    each = np.eye(count)
    sides: list[tuple[np.ndarray, np.ndarray, int | None]]
    sides = [(each, highest / _KILONEWTON, None), (-each, -lowest / _KILONEWTON, None)]
    free, response = motion.output(_STROKE)
    travel = ((1.0, stops.rebound), (-1.0, -stops.bump))
    sides += [(s * _KILONEWTON * response, end - s * free, 0) for s, end in travel if np.isfinite(end)]
    free, response = motion.output(_TYRE)
    sides.append((_KILONEWTON * response, task.car.actuated.static_tyre_deflection - free, 1))
    sides.append((np.zeros((2, count)), np.zeros(2), None))  # what yields is not negative
    yields = [np.zeros((len(h), 2)) for _, h, _ in sides]
    for one, (_, _, place) in zip(yields, sides, strict=True):
        if place is not None:
            one[:, place] = -1.0
    yields[-1][:] = -np.eye(2)
    g = np.vstack([np.hstack([a, b]) for (a, _, _), b in zip(sides, yields, strict=True)])
    return g, np.concatenate([h for _, h, _ in sides])


def _plan(
    task: PreviewTask,
    motion: _Motion,
    force: np.ndarray,
    states: np.ndarray,
    allowed: tuple[np.ndarray, np.ndarray],
    slack: tuple[float, float],
    rounds: int,
) -> Plan:
    inputs = np.vstack([states, force, motion.road])
    return Plan(
        time=task.time,
        motor_force=force,
        force=motion.force_row @ inputs,
        states=states,
        acceleration=motion.accelerations[0] @ inputs,
        tyre=states[1] - motion.road,
        lowest=allowed[0],
        highest=allowed[1],
        overtravel=slack[0],
        lift=slack[1],
        rounds=rounds,
    )


def with_preview(scenario: Scenario, ahead: float) -> Scenario:
    """The scenario with its road coming later, so that a plan may begin before; ahead: preview [s]."""
    name = f"{scenario.name}, seen {ahead:g} s ahead"
    return replace(scenario, road=Later(scenario.road, ahead), duration=scenario.duration + ahead, name=name)
