"""Residuals turned into independent ones of size one, what is integrated out taken with them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from workbench.data.repeats import follows
from workbench.data.stack import Channel, Stack
from workbench.likelihood.noise import ChannelNoise, Noise, scan_shapes

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
class Whitener:
    """Turns stacked residuals into independent ones of size one.

    z = r / sigma, then (z_k - rho z_(k-1)) / sqrt(1 - rho^2) inside each scan
    sigma: standard uncertainty of a row (n,);  rho: correlation with the row before, 0 where there is none (n,)
    laws: errors of laws that are integrated out besides
    """

    sigma: np.ndarray
    rho: np.ndarray
    laws: tuple[LawError, ...] = ()

    def __call__(self, residual: np.ndarray) -> np.ndarray:
        """residual (n,) or (n, m) -> whitened, same shape"""
        shape = (-1,) + (1,) * (residual.ndim - 1)
        z = residual / self.sigma.reshape(shape)
        rho = self.rho.reshape(shape)
        z[1:] -= rho[1:] * z[:-1]  # in place: a library of shapes has 100 MB
        z /= np.sqrt(1 - rho**2)
        for law in self.laws:
            z[law.rows] = law.apply(z[law.rows])
        return z

    def with_laws(self, laws: Iterable[LawError]) -> Whitener:
        """The same with further errors of laws, those that are none left out: most fits ask for many."""
        return replace(self, laws=self.laws + tuple(law for law in laws if len(law.size)))

    def of(self, rows: np.ndarray) -> Whitener:
        """That of the rows of some channels alone, each whole (k,)."""
        own = (replace(law, rows=slice(first, first + _length(law.rows))) for law, first in self._among(rows))
        return Whitener(self.sigma[rows], self.rho[rows], tuple(own))

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
    sigma, rho = np.empty(stack.size), np.zeros(stack.size)
    for channel, found in zip(stack.channels, noise.channels):
        rows = channel.rows
        sigma[rows] = stack.u[rows] * found.scale * noise.inflation[rows]
        rho[rows] = np.where(follows(stack.tables[channel.table]), found.rho, 0.0)
    white = Whitener(sigma, rho)
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
