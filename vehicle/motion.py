"""Equations of motion of many runs at once, and their integration in time.

A state is an array (2, 2 + n, runs): coordinates (body height, pitch, wheel heights) and their rates.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import ceil
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from vehicle.damping import DamperCurve
from vehicle.errors import VehicleError
from vehicle.models import Vehicle

_STABLE = 2.0  # step times the fastest rate; the limit of the Runge-Kutta rule is 2.78 when damped, 2.83 when not


class Hinges:
    """Several damper curves as one sum of ramps away from rest, where the force is exactly zero.

    F(v) = s v + sum_{v_j >= 0} s_j max(v - v_j, 0) + sum_{v_j < 0} s_j min(v - v_j, 0)
    curves: one for each entry of the velocities, (axles, runs)
    """

    def __init__(self, curves: Sequence[Sequence[DamperCurve]]) -> None:
        terms = [[_hinge_terms(curve) for curve in row] for row in curves]
        most = max(len(knots) for row in terms for _, knots, _ in row)
        self.slope = np.array([[slope for slope, *_ in row] for row in terms])
        self.steepest = np.array([max(curve.steepest for curve in row) for row in curves])  # of each axle
        self.knots = _stacked([[_padded(knots, most) for _, knots, _ in row] for row in terms])
        self.changes = _stacked([[_padded(changes, most) for *_, changes in row] for row in terms])
        self.lowest = np.where(self.knots < 0, -np.inf, 0.0)
        self.highest = np.where(self.knots < 0, 0.0, np.inf)

    def at(self, velocity: np.ndarray) -> np.ndarray:
        """Forces [N], (axles, runs); velocity: [m/s], (axles, runs)."""
        ramps = np.minimum(np.maximum(velocity - self.knots, self.lowest), self.highest)
        ramps *= self.changes
        return self.slope * velocity + np.add.reduce(ramps)


def _hinge_terms(curve: DamperCurve) -> tuple[float, np.ndarray, np.ndarray]:
    """Slope next to rest, below it where they differ; inner knots; changes of slope at them, away from rest."""
    v, f = np.array(curve.velocity), np.array(curve.force)
    slopes, knots = np.diff(f) / np.diff(v), v[1:-1]
    at_rest = np.count_nonzero(v[1:] < 0)  # the segment that ends at rest or holds it
    return slopes[at_rest], knots, np.where(knots < 0, -1, 1) * np.diff(slopes)


def _padded(values: np.ndarray, length: int) -> np.ndarray:
    return np.pad(values, (0, length - len(values)))


def _stacked(values: Sequence[Sequence[np.ndarray]]) -> np.ndarray:
    """(axles, runs, knots) as (knots, axles, runs)."""
    return np.moveaxis(np.array(values, dtype=float).reshape(len(values), len(values[0]), -1), -1, 0)


class ClippedSum:
    """Accelerations as one weighted sum of clipped linear functions of heights and rates; what an integration needs.

    a = P [w (clip(C u - r, low, high) - o)]

    The same forces as ``Motion.forces``, in half the time: springs and slopes of dampers are not clipped, stops and
    ramps of dampers on one side, tyres where the wheel leaves the road. Every row is exactly zero at rest.
    """

    def __init__(self, motion: Motion) -> None:
        axles = range(len(motion.unsprung))
        rows = [row for axle in axles for row in _suspension_rows(motion, axle)]
        rows += [_tyre_row(motion, axle) for axle in axles]  # last, where the road is taken off
        see, low, high, offset, weight, push = zip(*rows, strict=True)
        self._first_tyre = -len(axles)
        runs = motion.dampers.slope.shape[1]
        self._see, self._push = np.array(see), np.array(push).T
        columns = (np.array([np.broadcast_to(value, runs) for value in one]) for one in (low, high, offset, weight))
        self._low, self._high, self._offset, self._weight = columns

    def accelerations(self, heights: np.ndarray, road: np.ndarray) -> np.ndarray:
        """Of the coordinates [m/s^2, rad/s^2], (2 + n, runs), with the pitch as if level.

        heights: of the coordinates and their rates [m, rad, per s], (2, 2 + n, runs); road: heights [m], (n, runs)
        """
        pieces = self._see @ heights.reshape(-1, heights.shape[-1])
        pieces[self._first_tyre :] -= road
        np.maximum(pieces, self._low, out=pieces)
        np.minimum(pieces, self._high, out=pieces)
        pieces -= self._offset
        pieces *= self._weight
        return self._push @ pieces


# C, low, high, o, w, P of one row of a clipped sum; scalars or one number a run.
_Row = tuple[np.ndarray, ArrayLike, ArrayLike, ArrayLike, ArrayLike, np.ndarray]


def _suspension_rows(motion: Motion, axle: int) -> list[_Row]:
    """(C, low, high, o, w, P) of spring, stops and damper of one axle; they pull body and wheel together."""
    stretch, nothing = motion.strokes[axle], np.zeros(motion.strokes.shape[1])
    stroke, rate = np.concatenate([stretch, nothing]), np.concatenate([nothing, stretch])
    pull = _push_on_wheel(motion, axle)
    pull[:2] = motion.to_body[:, axle]
    rows: list[_Row] = [(stroke, -np.inf, np.inf, 0.0, motion.spring[axle, 0], pull)]
    bump, rebound, stiffness = (column[axle, 0] for column in (motion.bump, motion.rebound, motion.stop))
    for low, high, end in ((rebound, np.inf, rebound), (-np.inf, bump, bump)):
        if stiffness > 0 and np.isfinite(end):
            rows.append((stroke, low, high, end, stiffness, pull))
    dampers = motion.dampers
    rows.append((rate, -np.inf, np.inf, 0.0, dampers.slope[axle], pull))
    for knot, change in zip(dampers.knots[:, axle], dampers.changes[:, axle], strict=True):
        rows.append((rate, np.where(knot < 0, -np.inf, knot), np.where(knot < 0, knot, np.inf), knot, change, pull))
    return rows


def _tyre_row(motion: Motion, axle: int) -> _Row:
    """The same of a tyre: on the wheel alone, at most its static load is missing."""
    height = np.zeros(2 * motion.strokes.shape[1])
    height[2 + axle] = 1.0
    lifted = motion.load[axle, 0] / motion.tyre[axle, 0]
    return height, -np.inf, lifted, 0.0, motion.tyre[axle, 0], -_push_on_wheel(motion, axle)


def _push_on_wheel(motion: Motion, axle: int) -> np.ndarray:
    """Accelerations of the coordinates per newton upwards on the wheel [1/kg]."""
    push = np.zeros(motion.strokes.shape[1])
    push[2 + axle] = 1 / motion.unsprung[axle, 0]
    return push


class AxleForces(NamedTuple):
    """Strokes, their rates and forces; positive forces pull body and wheel together.

    stroke [m], rate [m/s], spring [N], stop [N], damper [N]: (axles, runs)
    tyre: force that the tyre adds to the static load, downwards on the wheel [N], (axles, runs)
    """

    stroke: np.ndarray
    rate: np.ndarray
    spring: np.ndarray
    stop: np.ndarray
    damper: np.ndarray
    tyre: np.ndarray


class Motion:
    """Equations 3.8-3.16 with the forces counted from static equilibrium.

    m_s z_s'' = -sum F_i,          F_i = k_s,i dz_i + F_stop,i + F_d,i
    J_s theta'' = -cos(theta) sum x_i F_i + (z_s + h_COG) F_prop
    m_u,i z_u,i'' = F_i - min(k_u,i (z_u,i - z_r,i), W_i)

    x_i: position ahead of the centre of gravity; W_i: static load. Printed 3.8 balances the weights with F_e = k dz;
    with null stroke at static equilibrium, as the text has it, F_e = k dz - m_s,i g and the weights cancel.
    A mass m_eq between body and wheel (3.5) adds m_eq dz'' to F of the last axle.

    dampers: curve of each axle and run, (axles, runs); equivalent_mass [kg] and propulsion F_prop [N]: (runs,)
    """

    def __init__(
        self,
        vehicle: Vehicle,
        dampers: Sequence[Sequence[DamperCurve]],
        equivalent_mass: ArrayLike,
        propulsion: ArrayLike,
    ) -> None:
        axles = vehicle.axles
        self.vehicle = vehicle
        self.strokes = vehicle.stretch_matrix
        self.position = _column(axle.position for axle in axles)
        self.spring = _column(axle.spring_stiffness for axle in axles)
        self.bump = _column(axle.stops.bump for axle in axles)
        self.rebound = _column(axle.stops.rebound for axle in axles)
        self.stop = _column(axle.stops.stiffness for axle in axles)
        self.tyre = _column(axle.tyre.stiffness for axle in axles)
        self.load = _column(axle.static_load for axle in axles)
        self.unsprung = _column(axle.unsprung_mass for axle in axles)
        self.dampers = Hinges(dampers)
        self.equivalent_mass = np.asarray(equivalent_mass, dtype=float)
        self.has_inertia = bool(self.equivalent_mass.any())
        self.propulsion = np.asarray(propulsion, dtype=float)
        self.is_propelled = bool(self.propulsion.any())
        self.to_body = np.hstack([-np.ones_like(self.position) / vehicle.sprung_mass, -self.position]).T
        self.to_body[1] /= vehicle.pitch_inertia
        self.sum = ClippedSum(self)

    def forces(self, state: np.ndarray, road: np.ndarray) -> AxleForces:
        """Forces at every axle.

        state: heights and pitch, and their rates [m, rad, per s], (2, 2 + n, runs); road: heights [m], (n, runs)
        """
        stroke, rate = self.strokes @ self._vertical(state)
        stop = self.stop * (stroke - np.minimum(np.maximum(stroke, self.bump), self.rebound))
        tyre = np.minimum(self.tyre * (state[0, 2:] - road), self.load)
        return AxleForces(stroke, rate, self.spring * stroke, stop, self.dampers.at(rate), tyre)

    def derivative(self, state: np.ndarray, road: np.ndarray) -> np.ndarray:
        """Time derivative [per s] of the state, (2, 2 + n, runs).

        state: as in ``forces`` [m, rad, per s], (2, 2 + n, runs); road: heights [m], (n, runs)
        """
        change = np.empty_like(state)
        change[0] = state[1]
        change[1] = self.sum.accelerations(self._vertical(state), road)
        change[1, 1] *= np.cos(state[0, 1])
        if self.is_propelled:
            change[1, 1] += (state[0, 0] + self.vehicle.cog_height) * self.propulsion / self.vehicle.pitch_inertia
        if self.has_inertia:
            self._add_inertia(state, change)
        return change

    def inertia_force(self, state: np.ndarray, change: np.ndarray) -> np.ndarray:
        """Force of the equivalent mass [N], (runs,).

        state, change: as in ``forces`` and its derivative [m, rad, per s], (2, 2 + n, runs)
        """
        return self.equivalent_mass * self._relative_acceleration(state, change)

    def _add_inertia(self, state: np.ndarray, change: np.ndarray) -> None:
        """F = m w / (1 + m mu) for the relative acceleration w without the mass and the mobility mu [1/kg]."""
        vehicle, lever = self.vehicle, self.position[-1] * np.cos(state[0, 1])
        mobility = 1 / vehicle.sprung_mass + lever**2 / vehicle.pitch_inertia + 1 / vehicle.actuated.unsprung_mass
        force = self.inertia_force(state, change) / (1 + self.equivalent_mass * mobility)
        change[1, 0] -= force / vehicle.sprung_mass
        change[1, 1] -= lever * force / vehicle.pitch_inertia
        change[1, -1] += force / vehicle.actuated.unsprung_mass

    def _relative_acceleration(self, state: np.ndarray, change: np.ndarray) -> np.ndarray:
        pitch, rate = state[0, 1], state[1, 1]
        turning = np.cos(pitch) * change[1, 1] - np.sin(pitch) * rate**2
        return change[1, 0] + self.position[-1] * turning - change[1, -1]

    @staticmethod
    def _vertical(state: np.ndarray) -> np.ndarray:
        """Heights and their rates: sine of the pitch in the place of the angle."""
        heights = state.copy()
        np.sin(state[0, 1], out=heights[0, 1])
        heights[1, 1] *= np.cos(state[0, 1])
        return heights

    def energy(self, state: np.ndarray, road: np.ndarray) -> np.ndarray:
        """Kinetic and elastic energy above static equilibrium [J], (runs,).

        state: as in ``forces`` [m, rad, per s], (2, 2 + n, runs); road: heights [m], (n, runs)
        """
        vehicle, forces = self.vehicle, self.forces(state, road)
        masses = np.array([vehicle.sprung_mass, vehicle.pitch_inertia, *self.unsprung[:, 0]])
        kinetic = masses @ state[1] ** 2 + self.equivalent_mass * forces.rate[-1] ** 2
        springs = (self.spring * forces.stroke**2).sum(axis=0)
        springs += np.divide(forces.stop**2, self.stop, out=np.zeros_like(forces.stop), where=self.stop > 0).sum(axis=0)
        compression = forces.tyre / self.tyre  # in the air the wheel goes on rising against its weight
        lifted = np.maximum(state[0, 2:] - road - compression, 0.0)
        tyres = (self.tyre * compression**2 + 2 * self.load * lifted).sum(axis=0)
        return (kinetic + springs + tyres) / 2

    @property
    def fastest_rate(self) -> float:
        """Bound of the rates in the motion [1/s], for the step of the integration."""
        vehicle = self.vehicle
        mobility = 1 / vehicle.sprung_mass + self.position**2 / vehicle.pitch_inertia + 1 / self.unsprung
        damped = self.dampers.steepest * mobility[:, 0]
        sprung = np.sqrt((self.spring + self.stop + self.tyre) * mobility)
        return float(max(damped.max(), sprung.max()))


def _column(values: Iterable[float]) -> np.ndarray:
    return np.array([[value] for value in values], dtype=float)


def integrate(motion: Motion, road: np.ndarray, step: float) -> np.ndarray:
    """States at every step from rest, classical Runge-Kutta of fourth order.

    road: heights [m], (steps + 1, n, runs), straight between the steps; step [s]
    integrate: the states [m, rad, per s], (steps + 1, 2, 2 + n, runs)
    The step is divided where the stiffest part of the motion needs it.
    Raises VehicleError when the motion grows beyond all bounds.
    """
    parts = ceil(step * motion.fastest_rate / _STABLE)
    axles, runs = road.shape[1:]
    states = np.zeros((len(road), 2, 2 + axles, runs))
    state = states[0]
    for k in range(len(road) - 1):
        start, rise = road[k], (road[k + 1] - road[k]) / parts
        for part in range(parts):
            state = _runge_kutta(motion, state, start + part * rise, rise, step / parts)
        states[k + 1] = state
    if not np.isfinite(state).all():
        raise VehicleError(f"the motion has no bounds with steps of {step / parts:g} s; give a smaller time step")
    return states


def _runge_kutta(motion: Motion, state: np.ndarray, road: np.ndarray, rise: np.ndarray, step: float) -> np.ndarray:
    middle = road + rise / 2
    first = motion.derivative(state, road)
    second = motion.derivative(state + step / 2 * first, middle)
    third = motion.derivative(state + step / 2 * second, middle)
    fourth = motion.derivative(state + step * third, road + rise)
    second += third
    second *= 2
    second += first
    second += fourth
    second *= step / 6
    return second + state
