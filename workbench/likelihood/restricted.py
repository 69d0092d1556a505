"""Restricted likelihood of what repeats disagree by: the size and correlation of the noise of a channel, and what its
scans are off by as a whole.

    z = value of the station + s (AR(1) noise of correlation rho + tau (offset and slope of the scan)),   ~ N(0, 1)

all over the declared uncertainty. The values of the stations are free, so that no model is asked and what they take of
the readings is no lack of noise (Patterson and Thompson, Biometrika 58 (1971), 545). The size s is integrated out, with
the declared one counting for a few readings; rho and tau lie on a grid. Few repeats say little of them, so that those
of a channel are drawn towards what the channels have in common.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import cho_solve_banded, cholesky_banded

DECLARED_WEIGHT = 4.0  # readings that the declared size counts for beside the repeats
CORRELATIONS = np.linspace(-0.4, 0.95, 28)
SPREADS = np.concatenate([[0.0], np.geomspace(0.1, 8.0, 14)])  # of offset and slope of a scan, of the size of the noise
ALIKE = 0.15  # standard deviation of the correlations of channels of one bench about what they have in common
AS_LARGE = 0.3  # the same of the logarithm of their spreads
SHARES = np.where(SPREADS > 0, 0.5 / np.count_nonzero(SPREADS), 0.5)  # of benches: with no spread as many as with one
ODD = 0.05  # share of channels that have a spread where the others have none, or none where they have one


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
    """Of the noise of a channel. scale: over the declared one;  rho: correlation of neighbours;  scans: standard
    deviation of offset and slope of the next scan, of the size of the noise"""

    scale: float
    rho: float
    scans: float


@dataclass(frozen=True, eq=False)
class _Likelihood:
    """log_p: ln p of what repeats disagree by, the size integrated out (R, T) [nats];  variance: s^2 there (R, T)"""

    log_p: np.ndarray
    variance: np.ndarray


def sizes_of(channels: Sequence[Repeated]) -> list[Size]:
    """Sizes of the noise of channels of one bench; as declared where nothing was repeated."""
    if not any(channel.free for channel in channels):
        return [Size(1.0, 0.0, 0.0) for _ in channels]
    found = [_likelihood(channel) for channel in channels]
    return [_mean(one.variance, posterior) for one, posterior in zip(found, _posteriors([f.log_p for f in found]))]


def _mean(variance: np.ndarray, posterior: np.ndarray) -> Size:
    """The scan that comes next has the mean of the variances that are possible."""
    rho, spread = CORRELATIONS @ posterior.sum(axis=1), SPREADS**2 @ posterior.sum(axis=0)
    return Size(float(np.sqrt(np.sum(variance * posterior))), float(rho), float(np.sqrt(spread)))


# ---- one channel -----------------------------------------------------------------------------------------------------


def _likelihood(channel: Repeated) -> _Likelihood:
    """Over all correlations and spreads; the same everywhere where nothing was repeated."""
    if not channel.free:
        flat = np.ones((len(CORRELATIONS), len(SPREADS)))
        return _Likelihood(0.0 * flat, flat)
    chains = _Chains.of(channel)
    square, log_det = np.array([_at(chains, rho) for rho in CORRELATIONS]).transpose(1, 0, 2)
    known = DECLARED_WEIGHT + channel.free
    return _Likelihood(-0.5 * (known * np.log(DECLARED_WEIGHT + square) + log_det), (DECLARED_WEIGHT + square) / known)


def _at(chains: _Chains, rho: float) -> tuple[np.ndarray, np.ndarray]:
    """Sum of squares and ln det of the restricted likelihood at a correlation, for every spread (T,), (T,)."""
    products, on, band = (each.at(rho) for each in (chains.products, chains.on, chains.band))
    root = cholesky_banded(band, lower=True, check_finite=False)
    products = products - on.T @ cho_solve_banded((root, True), on, check_finite=False)
    log_det = 2 * np.log(root[0]).sum() + chains.following * np.log(1 - rho**2)
    eigenvalues, turned = np.linalg.eigh(products[1:, 1:])
    along = np.square(turned.T @ products[1:, 0])
    more = 1 + np.outer(SPREADS**2, np.maximum(eigenvalues, 0.0))
    square = products[0, 0] - (SPREADS[:, None] ** 2 * along / more).sum(axis=1)
    return np.maximum(square, 0.0), log_det + np.log(more).sum(axis=1)


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
    """What a channel adds to the normal equations. products: of readings and shapes with one another (1 + q, 1 + q)

    on: the same with the stations (S, 1 + q);  band: of the stations, lower band (b, S);  following: rows that do
    """

    products: _Sum
    on: _Sum
    band: _Sum
    following: int

    @classmethod
    def of(cls, channel: Repeated) -> _Chains:
        row, start = np.flatnonzero(channel.follows), np.flatnonzero(~channel.follows)
        pairs = (start, start), (row, row), (row - 1, row - 1), (row, row - 1)
        columns = np.column_stack([channel.values, channel.shapes])
        station = _numbered(channel.station)
        count = int(station.max()) + 1
        products = [columns[a].T @ columns[b] for a, b in pairs]
        on = [_gathered(station[a], columns[b], count) for a, b in pairs]
        products[3] = products[3] + products[3].T
        on[3] += _gathered(station[row - 1], columns[row], count)
        width = int(np.abs(np.diff(station))[channel.follows[1:]].max(initial=0)) + 1
        band = [_banded(station[a], station[b], width, count) for a, b in pairs]
        return cls(_Sum(*products), _Sum(*on), _Sum(*band), len(row))


def _numbered(station: np.ndarray) -> np.ndarray:
    """Stations numbered as they are met: neighbours in a scan are neighbours in the equations."""
    _, first, which = np.unique(station, return_index=True, return_inverse=True)
    return np.argsort(np.argsort(first))[which]


def _gathered(station: np.ndarray, columns: np.ndarray, count: int) -> np.ndarray:
    """Sums of the rows of every station (count, q)."""
    out = np.zeros((count, columns.shape[1]))
    np.add.at(out, station, columns)
    return out


def _banded(one: np.ndarray, other: np.ndarray, width: int, count: int) -> np.ndarray:
    """How often two stations meet, as the lower band of a matrix (width, count)."""
    out = np.zeros((width, count))
    np.add.at(out, (np.abs(one - other), np.minimum(one, other)), 1.0)
    return out


# ---- channels of one bench -------------------------------------------------------------------------------------------


def _posteriors(log_p: Sequence[np.ndarray]) -> list[np.ndarray]:
    """Of correlation and spread of every channel (R, T), which scatter about what all have in common."""
    own = [np.exp(one - one.max()) for one in log_p]
    correlation, spread = _scatter()
    seen = [np.log(correlation.T @ one @ spread) for one in own]  # of what is common, by each channel
    every = sum(seen)
    out = []
    for one, mine in zip(own, seen):
        others = every - mine
        prior = correlation @ np.exp(others - others.max()) * SHARES @ spread.T
        out.append(one * prior / np.sum(one * prior))
    return out


def _scatter() -> tuple[np.ndarray, np.ndarray]:
    """Probability of a channel's correlation (R, R) and of its spread (T, T) where the common one is that of the
    column."""
    correlation = np.exp(-0.5 * np.square(np.subtract.outer(CORRELATIONS, CORRELATIONS) / ALIKE))
    logs = np.log(SPREADS[1:])
    spread = np.full((len(SPREADS), len(SPREADS)), ODD / len(logs))
    among = np.exp(-0.5 * np.square(np.subtract.outer(logs, logs) / AS_LARGE))
    spread[1:, 1:] = (1 - ODD) * among / among.sum(axis=0)
    spread[0] = ODD
    spread[0, 0] = 1 - ODD
    return correlation / correlation.sum(axis=0), spread
