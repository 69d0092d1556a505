"""Residuals turned into independent ones of size one, what is integrated out taken with them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.linalg.lapack import dtbtrs

from workbench.data.repeats import follows
from workbench.data.stack import Channel, Stack
from workbench.likelihood.noise import ChannelNoise, Noise, scan_shapes

AT_ONCE = 64  # columns that are freed of their course together: more of them would be copied at a time
LEAST_ERROR = 0.03  # of a law, in standard deviations of a row, below which it is none: a hundred are 0.01 nats


@dataclass(frozen=True, eq=False)
class LawError:
    """Directions in the whitened rows of a channel along which a law may be wrong, and how much (n_c, q), (q,)."""

    rows: slice
    directions: np.ndarray
    size: np.ndarray

    @property
    def half_log_det(self) -> float:
        return 0.5 * float(np.log1p(self.size**2).sum())

    @cached_property
    def _shrunk(self) -> np.ndarray:
        """The directions, each times the share that is taken of what lies along it (n_c, q)."""
        return self.directions * (1 - 1 / np.sqrt(1 + self.size**2))

    def apply(self, z: np.ndarray) -> np.ndarray:
        """(1 + F F^T)^(-1/2) z of the rows of the channel (n_c,) or (n_c, m), F = directions * size."""
        return z - self._shrunk @ (self.directions.T @ z)

    def taken(self, z: np.ndarray) -> np.ndarray:
        """What ``apply`` takes of the products of rows of the channel (n_c, m) with one another, as the products of
        these (q, m): Z^T Z - apply(Z)^T apply(Z)."""
        return (self.size / np.sqrt(1 + self.size**2) * self.directions).T @ z


def _length(rows: slice) -> int:
    return rows.stop - rows.start


def law_error(rows: slice, wrong: np.ndarray) -> LawError:
    """Of whitened shapes with standard normal weights (n_c, q).

    Left singular vectors by the smaller one of both products of the shapes, in less than half the time of all three
    factors; what rounding does to the smallest of them is below what ``apply`` makes of it, size^2 / 2.
    """
    by_rows = wrong.shape[0] <= wrong.shape[1]
    squares, turned = np.linalg.eigh(wrong @ wrong.T if by_rows else wrong.T @ wrong)
    keep = squares > LEAST_ERROR**2
    size = np.sqrt(squares[keep])
    return LawError(rows, turned[:, keep] if by_rows else wrong @ turned[:, keep] / size, size)


@dataclass(frozen=True, eq=False)
class Course:
    """How noise of size one goes from row to row: a part that wanders, and a floor that does not.

    rho: correlation of what wanders with the row before, 0 where there is none (n,)
    floor: share of the variance that is independent (n,)
    """

    rho: np.ndarray
    floor: np.ndarray

    @classmethod
    def independent(cls, rows: int) -> Course:
        return cls(np.zeros(rows), np.zeros(rows))

    def of(self, rows: np.ndarray) -> Course:
        return Course(self.rho[rows], self.floor[rows])

    @cached_property
    def _innovations(self) -> tuple[np.ndarray, np.ndarray]:
        """Share of the innovation before and standard deviation of one, of every row (n,), (n,)."""
        echo, variance = np.zeros((2, len(self.rho)))
        if not self.floor.any():  # the reading before tells all that there is to know
            return echo, np.sqrt(1 - self.rho**2)
        missed = left = 0.0  # share of the innovation before that is no wandering; variance of it that is left
        for k, (rho, floor) in enumerate(zip(self.rho.tolist(), self.floor.tolist())):
            expected = rho**2 * left + (1 - rho**2) * (1 - floor)
            variance[k] = expected + floor
            echo[k] = rho * missed
            missed = floor / variance[k]
            left = expected * missed
        return echo, np.sqrt(variance)

    def take_from(self, z: np.ndarray) -> None:
        """Make rows independent and of size one, in place: a library of shapes has 100 MB. z: (n,) or (n, m)"""
        shape = (-1,) + (1,) * (z.ndim - 1)
        echo, size = self._innovations
        z[1:] -= self.rho.reshape(shape)[1:] * z[:-1]
        if echo.any():
            _add_echo(echo, z.reshape(len(z), -1))
        z /= size.reshape(shape)


def _add_echo(echo: np.ndarray, z: np.ndarray) -> None:
    """z_k + echo_k z_(k-1), one row after the other, in place. z: (n, m)"""
    band = np.vstack([np.ones(len(echo)), -np.append(echo[1:], 0.0)])
    for first in range(0, z.shape[1], AT_ONCE):
        some = slice(first, first + AT_ONCE)
        z[:, some] = dtbtrs(band, z[:, some], uplo="L", diag="U")[0]


@dataclass(frozen=True, eq=False)
class Whitener:
    """Turns stacked residuals into independent ones of size one.

    z = r / sigma, then what the rows before it in the scan do not tell of a row, over its standard deviation:
        e_k = z_k - rho z_(k-1) + c_k e_(k-1),   c_k = rho (1 - g_(k-1))
    with the gain g of Kalman's filter (Trans. ASME D 82 (1960), 35) for what wanders; g = 1, c = 0 without a floor.
    sigma: standard uncertainty of a row (n,);  laws: errors of laws that are integrated out besides
    """

    sigma: np.ndarray
    course: Course
    laws: tuple[LawError, ...] = ()

    def __call__(self, residual: np.ndarray) -> np.ndarray:
        """residual (n,) or (n, m) -> whitened, same shape"""
        z = np.divide(residual, self.sigma.reshape((-1,) + (1,) * (residual.ndim - 1)), order="C")
        self.course.take_from(z)
        for law in self.laws:
            z[law.rows] = law.apply(z[law.rows])
        return z

    def with_laws(self, laws: Iterable[LawError]) -> Whitener:
        """The same with further errors of laws, those that are none left out: most fits ask for many."""
        return replace(self, laws=self.laws + tuple(law for law in laws if len(law.size)))

    def of(self, rows: np.ndarray) -> Whitener:
        """That of the rows of some channels alone, each whole (k,)."""
        own = (replace(law, rows=slice(first, first + _length(law.rows))) for law, first in self._among(rows))
        return Whitener(self.sigma[rows], self.course.of(rows), tuple(own))

    def _among(self, rows: np.ndarray) -> Iterator[tuple[LawError, int]]:
        """Errors of laws of some of the rows, and the place of their first row among these."""
        for law in self.laws:
            for first in np.flatnonzero(rows == law.rows.start):
                yield law, int(first)

    def beyond(self, other: Whitener) -> tuple[LawError, ...]:
        """The errors of laws that this has besides those of another, which it must begin with."""
        count = len(other.laws)
        if self.sigma is not other.sigma or self.laws[:count] != other.laws:
            raise ValueError("one whitener does not begin with the other")
        return self.laws[count:]


def whitener(stack: Stack, noise: Noise) -> Whitener:
    """The whitener of a stack; noise must have its channels and rows."""
    sigma, rho, floor = np.empty(stack.size), np.zeros(stack.size), np.zeros(stack.size)
    for channel, found in zip(stack.channels, noise.channels):
        rows = channel.rows
        sigma[rows] = stack.u[rows] * found.scale * noise.inflation[rows]
        rho[rows] = np.where(follows(stack.tables[channel.table]), found.rho, 0.0)
        floor[rows] = found.floor
    white = Whitener(sigma, Course(rho, floor))
    laws = (_unknown(stack, channel, found, white) for channel, found in zip(stack.channels, noise.channels))
    return white.with_laws(laws)


def variance_of_readings(stack: Stack, white: Whitener, channels: Sequence[ChannelNoise]) -> np.ndarray:
    """Of a reading, SI (n,): its own, what its scan as a whole may be off by, and what the model leaves open.

    white: whitener of the stack;  channels: their noise
    """
    of_scans = np.empty(stack.size)
    for channel, found in zip(stack.channels, channels):
        of_scans[channel.rows] = 2 * np.square(stack.u[channel.rows] * found.scale * found.scans)  # offset and slope
    return white.sigma**2 + of_scans + np.square(stack.left_open).sum(axis=1)


def _unknown(stack: Stack, channel: Channel, found: ChannelNoise, white: Whitener) -> LawError:
    """What every scan of a channel may be off by as a whole, and what the model leaves open in it."""
    raw = np.hstack([_of_scans(stack, channel, found), stack.left_open[channel.rows]])
    return law_error(channel.rows, white.of(np.arange(stack.size)[channel.rows])(raw))


def _of_scans(stack: Stack, channel: Channel, found: ChannelNoise) -> np.ndarray:
    """What every scan of a channel may be off by as a whole, an offset and a slope each (rows, 2 scans), straight
    through its wild readings too."""
    scans = stack.tables[channel.table].scans if channel.size and found.scans else ()
    columns = np.zeros((channel.size, 2 * len(scans)))
    for k, rows in enumerate(scans):
        u = stack.u[channel.rows][rows]
        columns[rows, 2 * k : 2 * k + 2] = found.scans * found.scale * u[:, None] * scan_shapes(u)
    return columns
