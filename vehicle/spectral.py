"""Indices of the linear quarter car on a random road: stationary, from rest, and over many simulated roads."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import sqrt

import numpy as np
from scipy.linalg import expm, solve_continuous_lyapunov

from vehicle.commands import Feedback
from vehicle.errors import VehicleError
from vehicle.models import QuarterCar
from vehicle.quarter_car import LinearRide, linear_ride
from vehicle.road import NOISE_INTENSITY, IsoRoad


@dataclass(frozen=True)
class RideIndices:
    """Root mean squares of a ride, and the mean power into the actuator.

    comfort: weighted acceleration [m/s^2]; road_holding: dimensionless; stroke [m], force [N], velocity [m/s];
    mean_power: E[F_act v_act] [W]
    """

    comfort: float
    road_holding: float
    stroke: float
    force: float
    velocity: float
    mean_power: float


def ride_of(car: QuarterCar, feedback: Feedback, road: IsoRoad, speed: float) -> LinearRide:
    """Closed loop on this road at this speed [m/s]."""
    return linear_ride(car, feedback, cutoff=road.cutoff(speed), noise_gain=road.noise_gain(speed))


def stationary_indices(ride: LinearRide) -> RideIndices:
    """Indices far from the start, from the covariance P of A P + P A' + 0.5 B B' = 0.

    Raises VehicleError for a loop that is not stable: it has no stationary ride, see ``indices_from_rest``.
    """
    slowest = np.linalg.eigvals(ride.a).real.max()
    if not slowest < 0:
        raise VehicleError(
            f"the closed loop is not stable (slowest pole {slowest:.3g} /s): it has no stationary indices; change the "
            "control law or ask for the indices from rest"
        )
    noise = NOISE_INTENSITY * np.outer(ride.b, ride.b)
    return _indices(ride, solve_continuous_lyapunov(ride.a, -noise))


def stationary_covariances(a: np.ndarray, noise: np.ndarray) -> np.ndarray:
    """P of A P + P A' + Q = 0 for many loops at once, NaN where one is not stable.

    a: A [SI], (n, s, s); noise: Q, of all of them [SI], (s, s); stationary_covariances: P [SI], (n, s, s)
    As linear equations for the elements of P, (A x 1 + 1 x A) vec P = -vec Q, whatever the eigenvectors are.
    """
    size = a.shape[-1]
    found = np.full(a.shape, np.nan)
    stable = np.flatnonzero(np.linalg.eigvals(a).real.max(axis=-1) < 0)
    for some in np.array_split(stable, max(1, len(stable) // _TOGETHER)):
        both = np.einsum("nij,kl->nikjl", a[some], np.eye(size)) + np.einsum("ij,nkl->nikjl", np.eye(size), a[some])
        matrix = both.reshape(len(some), size**2, size**2)
        found[some] = np.linalg.solve(matrix, -noise.reshape(-1, 1))[..., 0].reshape(-1, size, size)
    return found


_TOGETHER = 256  # loops whose equations are in memory at the same time, 32 kB each


def indices_from_rest(ride: LinearRide, duration: float, step: float = 5e-3) -> RideIndices:
    """Expected mean squares over a run of this duration [s] that begins at rest on a flat start.

    step: of the average over time [s]; the covariance at each instant is exact
    """
    transition = expm(ride.a * step)
    growth = _covariance_of_step(ride, step)
    covariance, mean = np.zeros_like(ride.a), np.zeros_like(ride.a)
    steps = round(duration / step)
    for _ in range(steps):
        following = transition @ covariance @ transition.T + growth
        mean += (covariance + following) / (2 * steps)
        covariance = following
    return _indices(ride, mean)


def _covariance_of_step(ride: LinearRide, step: float) -> np.ndarray:
    """Integral of exp(A s) 0.5 B B' exp(A' s) over a step (van Loan)."""
    size = len(ride.a)
    noise = NOISE_INTENSITY * np.outer(ride.b, ride.b)
    block = expm(np.block([[-ride.a, noise], [np.zeros_like(ride.a), ride.a.T]]) * step)
    return block[size:, size:].T @ block[:size, size:]


def _indices(ride: LinearRide, covariance: np.ndarray) -> RideIndices:
    def root(row: np.ndarray) -> float:
        """RMS of an output [its unit]; row: over the states [SI], (8,)."""
        return sqrt(max(row @ covariance @ row, 0.0))

    return RideIndices(
        comfort=root(ride.comfort),
        road_holding=root(ride.road_holding),
        stroke=root(ride.stroke),
        force=root(ride.force),
        velocity=root(ride.velocity),
        mean_power=float(ride.force @ covariance @ ride.velocity),
    )


def mean_power_theorem(tyre_stiffness: float, road: IsoRoad, speed: float) -> float:
    """Mean power that a white road gives to a tyre, and any stabilising control without energy source dissipates [W].

    speed: of the vehicle [m/s]
    E[P] = 1/2 k_u (2 pi)^2 G_r v 1/2: half the stiffness times the intensity of the road's velocity
    """
    return tyre_stiffness / 2 * NOISE_INTENSITY * road.noise_gain(speed) ** 2


@dataclass(frozen=True, eq=False)
class EnsembleIndices:
    """Indices of many simulated roads as in ``RideIndices``.

    comfort: [m/s^2], (seeds,); road_holding: dimensionless, (seeds,)
    stroke_peak: largest magnitude [m], (seeds,); mean_power: [W], (seeds,)
    """

    comfort: np.ndarray
    road_holding: np.ndarray
    stroke_peak: np.ndarray
    mean_power: np.ndarray


def ensemble_indices(ride: LinearRide, duration: float, seeds: Sequence[int], sample_time: float) -> EnsembleIndices:
    """The linear ride simulated from rest over one road a seed, exactly between the samples.

    duration [s]; sample_time: the noise is held so long [s]
    """
    size, steps = len(ride.a), round(duration / sample_time)
    held = expm(np.block([[ride.a, ride.b[:, None]], [np.zeros((1, size + 1))]]) * sample_time)
    transition, input_column = held[:size, :size], held[:size, size:]
    outputs = np.array([ride.comfort, ride.road_holding, ride.stroke, ride.force, ride.velocity])
    noise = _noise(seeds, steps, sample_time)
    state, squares = np.zeros((size, len(seeds))), np.zeros((2, len(seeds)))
    peak, work = np.zeros(len(seeds)), np.zeros(len(seeds))
    for k in range(steps):
        state = transition @ state + input_column * noise[k]
        seen = outputs @ state
        squares += seen[:2] ** 2
        np.maximum(peak, np.abs(seen[2]), out=peak)
        work += seen[3] * seen[4]
    comfort, holding = np.sqrt(squares / steps)
    return EnsembleIndices(comfort, holding, peak, work / steps)


def _noise(seeds: Sequence[int], steps: int, sample_time: float) -> np.ndarray:
    """Held white noise, (steps, seeds)."""
    columns = [np.random.default_rng(seed).standard_normal(steps) for seed in seeds]
    return np.stack(columns, axis=1) * sqrt(NOISE_INTENSITY / sample_time)


@dataclass(frozen=True, eq=False)
class Carpet:
    """Indices over two tuning parameters; NaN where there are none.

    first, second: parameters [unit of the law], (n,), (m,); comfort: [m/s^2], (n, m)
    road_holding: dimensionless, (n, m); stroke: [m], (n, m)
    """

    first: np.ndarray
    second: np.ndarray
    comfort: np.ndarray
    road_holding: np.ndarray
    stroke: np.ndarray

    def best(self, index: np.ndarray) -> tuple[float, float, float]:
        """Both parameters where an index, ``comfort`` or ``road_holding``, is least, and its value there [its unit].

        index: [its unit], (n, m)
        """
        i, j = np.unravel_index(np.nanargmin(index), index.shape)
        return float(self.first[i]), float(self.second[j]), float(index[i, j])


def carpet(
    car: QuarterCar,
    road: IsoRoad,
    speed: float,
    law: Callable[[float, float], Feedback],
    first: np.ndarray,
    second: np.ndarray,
) -> Carpet:
    """A control law over its two tuning parameters, stationary (thesis Figs 4.13-4.17); NaN where it is not stable.

    first, second: parameters [unit of the law], (n,), (m,); speed: of the vehicle [m/s]
    law: the control law of a first and a second parameter [its units]
    """
    rides = [ride_of(car, law(one, other), road, speed) for one in first for other in second]
    b = rides[0].b
    covariance = stationary_covariances(np.array([ride.a for ride in rides]), NOISE_INTENSITY * np.outer(b, b))
    rows = np.array([rides[0].comfort, rides[0].road_holding, rides[0].stroke])
    squares = np.einsum("ki,nij,kj->kn", rows, covariance, rows)
    indices = np.sqrt(np.maximum(squares, 0.0)).reshape(3, len(first), len(second))
    return Carpet(np.asarray(first), np.asarray(second), *indices)


def carpet_from_rest(
    car: QuarterCar,
    road: IsoRoad,
    speed: float,
    law: Callable[[float, float], Feedback],
    first: np.ndarray,
    second: np.ndarray,
    duration: float,
) -> Carpet:
    """The same over a run of a duration [s] that begins at rest, of loops that need not be stable.

    first, second: parameters [unit of the law], (n,), (m,); speed: of the vehicle [m/s]
    law: the control law of a first and a second parameter [its units]
    """
    rides = (ride_of(car, law(one, other), road, speed) for one in first for other in second)
    seen = [indices_from_rest(ride, duration, _COARSE) for ride in rides]
    table = np.array([[one.comfort, one.road_holding, one.stroke] for one in seen]).T
    return Carpet(np.asarray(first), np.asarray(second), *table.reshape(3, len(first), len(second)))


_COARSE = 1e-2  # s, of the average over time
