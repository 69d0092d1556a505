"""Restricted likelihood of what repeats disagree by: the size and correlation of the noise of a channel, and what its
scans are off by as a whole.

    z = value of the station + s (a + e + tau (offset and slope of the scan))
    a: AR(1) noise of correlation rho and variance 1 - w;  e: independent noise of variance w;  tau: size of N(0, 1)

all over the declared uncertainty. The values of the stations are free, so that no model is asked and what they take of
the readings is no lack of noise (Patterson and Thompson, Biometrika 58 (1971), 545). The size s is integrated out, with
the declared one counting for a few readings; rho, the floor w and tau lie on a grid. Few repeats say little of them, so
that those of a channel are drawn towards what the channels have in common.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import cholesky_banded
from scipy.linalg.lapack import dtbtrs

DECLARED_WEIGHT = 4.0  # readings that the declared size counts for beside the repeats
CORRELATIONS = np.linspace(-0.4, 0.95, 28)
SPREADS = np.concatenate([[0.0], np.geomspace(0.1, 8.0, 14)])  # of offset and slope of a scan, of the size of the noise
WANDERING = np.linspace(0.35, 0.95, 7)  # correlations that can be told from a floor beside them
FLOORS = np.array([0.35, 0.6, 0.8])  # shares of independent noise beside one that wanders
FLOORED = 0.5  # of benches whose noise wanders: with a floor as many as without
ALIKE = 0.15  # standard deviation of the correlations of channels of one bench about what they have in common
ALIKE_FLOORS = 0.25  # the same of their floors
AS_LARGE = 0.3  # the same of the logarithm of their spreads
SHARES = np.where(SPREADS > 0, 0.5 / np.count_nonzero(SPREADS), 0.5)  # of benches: with no spread as many as with one
ODD = 0.05  # share of channels that have a spread where the others have none, or none where they have one


def _courses() -> tuple[np.ndarray, np.ndarray]:
    """How noise may go from reading to reading: correlation and floor (C, 2), and the share of benches of each (C,)."""
    plain = [(rho, 0.0) for rho in CORRELATIONS]
    floored = [(rho, floor) for rho in WANDERING for floor in FLOORS]
    wanders = CORRELATIONS > WANDERING[0] - 1e-9
    shares = np.where(wanders, 1 - FLOORED, 1.0)
    of_floored = np.full(len(floored), FLOORED * wanders.sum() / len(floored))
    return np.array(plain + floored), np.concatenate([shares, of_floored]) / len(CORRELATIONS)


COURSES, COMMON = _courses()


@dataclass(frozen=True, eq=False)
class Repeated:
    """Readings of a channel that were taken at the same places, over their declared uncertainty.

    values: (n,);  station: number of the place of each (n,);  follows: whether it continues the scan of the one before
    shapes: offset and slope of every scan (n, 2 scans)
    """

    values: np.ndarray
    station: np.ndarray
    follows: np.ndarray
    shapes: np.ndarray

    @property
    def free(self) -> int:
        """Differences that are independent."""
        return len(self.values) - (int(self.station.max()) + 1 if len(self.station) else 0)


@dataclass(frozen=True)
class Size:
    """Of the noise of a channel. scale: over the declared one;  rho: correlation from reading to reading of what
    wanders;  floor: share of the variance that does not;  scans: standard deviation of offset and slope of the next
    scan, of the size of the noise"""

    scale: float
    rho: float
    floor: float
    scans: float

    @property
    def neighbours(self) -> float:
        """Correlation of a reading with the one before."""
        return self.rho * (1 - self.floor)


@dataclass(frozen=True, eq=False)
class _Likelihood:
    """log_p: ln p of what repeats disagree by, the size integrated out (C, T) [nats];  variance: s^2 there (C, T)"""

    log_p: np.ndarray
    variance: np.ndarray


def sizes_of(channels: Sequence[Repeated]) -> list[Size]:
    """Sizes of the noise of channels of one bench; as declared where nothing was repeated."""
    if not any(channel.free for channel in channels):
        return [Size(1.0, 0.0, 0.0, 0.0) for _ in channels]
    found = [_likelihood(channel) for channel in channels]
    return [_mean(one.variance, posterior) for one, posterior in zip(found, _posteriors([f.log_p for f in found]))]


def _mean(variance: np.ndarray, posterior: np.ndarray) -> Size:
    """The scan that comes next has the mean of the variances that are possible, and goes on as ``_going_on`` says."""
    rho, floor = _going_on(posterior.sum(axis=1))
    spread = SPREADS**2 @ posterior.sum(axis=0)
    return Size(float(np.sqrt(np.sum(variance * posterior))), rho, floor, float(np.sqrt(spread)))


def _going_on(course: np.ndarray) -> tuple[float, float]:
    """Correlation and floor of one course instead of many (C,) that are possible.

    It has the means of the covariance of neighbours, (1 - w) rho, and of the sum of the covariances with all that
    follow, (1 - w) rho / (1 - rho): the variance of the mean of a scan goes with it, and at the mean of rho it would be
    too small, as it grows ever faster with rho. Since it is convex in rho, there is such a course, 0 <= w <= 1.
    """
    rho, wandering = COURSES[:, 0], 1 - COURSES[:, 1]
    neighbours, following = float(course @ (wandering * rho)), float(course @ (wandering * rho / (1 - rho)))
    if neighbours <= 0:
        return neighbours, 0.0
    going_on = 1 - neighbours / following
    return going_on, 1 - neighbours / going_on


# ---- one channel -----------------------------------------------------------------------------------------------------


def _likelihood(channel: Repeated) -> _Likelihood:
    """Over all courses and spreads; the same everywhere where nothing was repeated."""
    if not channel.free:
        flat = np.ones((len(COURSES), len(SPREADS)))
        return _Likelihood(0.0 * flat, flat)
    chains = _Chains.of(channel)
    square, log_det = _of_spreads(*map(np.array, zip(*(_at(chains, *course) for course in COURSES))))
    known = DECLARED_WEIGHT + channel.free
    return _Likelihood(-0.5 * (known * np.log(DECLARED_WEIGHT + square) + log_det), (DECLARED_WEIGHT + square) / known)


def _at(chains: _Chains, rho: float, floor: float) -> tuple[np.ndarray, float]:
    """Products of readings and shapes with one another at a course, stations and independent parts integrated out
    (1 + q, 1 + q), and ln det of that."""
    products, on, band = chains.at(rho, floor)
    root = cholesky_banded(band, lower=True, check_finite=False)
    taken = dtbtrs(root, on, uplo="L")[0]
    log_det = 2 * np.log(root[0]).sum() + chains.following * np.log(1 - rho**2) + chains.rows * np.log(1 - floor)
    return products - taken.T @ taken, float(log_det)


def _of_spreads(products: np.ndarray, log_det: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Sum of squares and ln det of the restricted likelihood at every course, for every spread (C, T), (C, T).

    products, log_det: see ``_at``, of every course (C, 1 + q, 1 + q), (C,)
    """
    eigenvalues, turned = np.linalg.eigh(products[:, 1:, 1:])
    along = np.square(turned.transpose(0, 2, 1) @ products[:, 1:, :1])[:, None, :, 0]
    variance = SPREADS[:, None] ** 2
    more = 1 + variance * np.maximum(eigenvalues, 0.0)[:, None]
    square = products[:, 0, 0, None] - (variance * along / more).sum(axis=2)
    return np.maximum(square, 0.0), log_det[:, None] + np.log(more).sum(axis=2)


@dataclass(frozen=True, eq=False)
class _Sum:
    """Sum over rows of products of whitened quantities, for any correlation.

    Of a row that follows another (f after p) (f f + rho^2 p p - rho (f p + p f)) / (1 - rho^2), else f f
    """

    alone: np.ndarray
    own: np.ndarray
    before: np.ndarray
    across: np.ndarray

    def at(self, rho: float) -> np.ndarray:
        return self.alone + (self.own + rho**2 * self.before - rho * self.across) / (1 - rho**2)


@dataclass(frozen=True, eq=False)
class _Chains:
    """What a channel adds to the normal equations of the values of its stations and of the independent part of every
    reading, e = sqrt(w) f with f ~ N(0, 1): those of a station stand behind it, so that the equations are a band.

    products: of readings and shapes with one another (1 + q, 1 + q);  on: the same with the unknowns (U, 1 + q)
    band: of the unknowns, lower band (b, U);  own: whether an unknown is the part of a reading (U,)
    """

    products: _Sum
    on: _Sum
    band: _Sum
    own: np.ndarray
    following: int

    @property
    def rows(self) -> int:
        return int(self.own.sum())

    def at(self, rho: float, floor: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Products, those on the unknowns, and the band of the unknowns."""
        weight = np.where(self.own, np.sqrt(floor), 1.0)
        products, on, band = (each.at(rho) / (1 - floor) for each in (self.products, self.on, self.band))
        for below, diagonal in enumerate(band):
            diagonal[: len(weight) - below] *= weight[below:] * weight[: len(weight) - below]
        band[0] += self.own
        return products, on * weight[:, None], band

    @classmethod
    def of(cls, channel: Repeated) -> _Chains:
        row, start = np.flatnonzero(channel.follows), np.flatnonzero(~channel.follows)
        before = row - 1
        sums = ((start, start),), ((row, row),), ((before, before),), ((row, before), (before, row))
        columns, unknowns = np.column_stack([channel.values, channel.shapes]), _unknowns(channel.station)
        count = int(unknowns.max()) + 1
        products = [sum(columns[a].T @ columns[b] for a, b in pairs) for pairs in sums]
        on = [sum(_gathered(unknowns[a], columns[b], count) for a, b in pairs) for pairs in sums]
        met = [np.hstack([_met(unknowns[a], unknowns[b]) for a, b in pairs]) for pairs in sums]
        width = int(max(np.ptp(each, axis=0).max(initial=0) for each in met)) + 1
        band = [_banded(each, width, count) for each in met]
        own = np.isin(np.arange(count), unknowns[:, 1])
        return cls(_Sum(*products), _Sum(*on), _Sum(*band), own, len(row))


def _unknowns(station: np.ndarray) -> np.ndarray:
    """Numbers of the value of its station and of its own independent part, of every reading (n, 2).

    Stations are numbered as they are met: neighbours in a scan are neighbours in the equations.
    """
    _, first, which = np.unique(station, return_index=True, return_inverse=True)
    met = np.argsort(np.argsort(first))[which]
    readings = np.bincount(met)
    value = np.cumsum(readings + 1) - readings - 1
    own = np.empty(len(met), dtype=int)
    own[np.argsort(met, kind="stable")] = np.setdiff1d(np.arange(len(met) + len(readings)), value)
    return np.column_stack([value[met], own])


def _met(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Every unknown of a reading with every one of another (2, 4 n)."""
    return np.array([np.repeat(one, 2, axis=1).ravel(), np.tile(other, 2).ravel()])


def _gathered(unknowns: np.ndarray, columns: np.ndarray, count: int) -> np.ndarray:
    """Sums of the rows of every unknown (count, q)."""
    out = np.zeros((count, columns.shape[1]))
    for own in unknowns.T:
        np.add.at(out, own, columns)
    return out


def _banded(met: np.ndarray, width: int, count: int) -> np.ndarray:
    """How often unknowns meet, as the lower band of a matrix (width, count). met: pairs of their numbers (2, m)"""
    out = np.zeros((width, count))
    one, other = met[:, met[0] >= met[1]]
    np.add.at(out, (one - other, other), 1.0)
    return out


# ---- channels of one bench -------------------------------------------------------------------------------------------


def _posteriors(log_p: Sequence[np.ndarray]) -> list[np.ndarray]:
    """Of course and spread of every channel (C, T), which scatter about what all have in common."""
    own = [np.exp(one - one.max()) for one in log_p]
    course, spread = _scatter()
    seen = [np.log(course.T @ one @ spread) for one in own]  # of what is common, by each channel
    every = sum(seen)
    out = []
    for one, mine in zip(own, seen):
        others = every - mine
        prior = course @ (COMMON[:, None] * np.exp(others - others.max()) * SHARES) @ spread.T
        out.append(one * prior / np.sum(one * prior))
    return out


def _scatter() -> tuple[np.ndarray, np.ndarray]:
    """Probability of a channel's course (C, C) and of its spread (T, T) where the common one is that of the column."""
    rho, floor = (np.subtract.outer(values, values) for values in COURSES.T)
    course = COMMON[:, None] * np.exp(-0.5 * (np.square(rho / ALIKE) + np.square(floor / ALIKE_FLOORS)))
    logs = np.log(SPREADS[1:])
    spread = np.full((len(SPREADS), len(SPREADS)), ODD / len(logs))
    among = np.exp(-0.5 * np.square(np.subtract.outer(logs, logs) / AS_LARGE))
    spread[1:, 1:] = (1 - ODD) * among / among.sum(axis=0)
    spread[0] = ODD
    spread[0, 0] = 1 - ODD
    return course / course.sum(axis=0), spread
