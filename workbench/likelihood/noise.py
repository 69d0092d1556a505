"""Noise of every channel from what repeats disagree by: size, correlation of neighbours, single wild readings.

The declared uncertainty gives the shape over the rows; its size is measured. Differences between repeats are taken of
reading minus nominal model, so that conditions that were not set quite alike do no harm.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from workbench.data.stack import Channel, Stack
from workbench.data.table import Table

WILD = 2.5  # standard deviations of disagreement from which a reading counts less: u grows with the disagreement
TAME_SHARE = 0.9749  # mean of min(d^2, WILD^2) of a standard normal d
REPORTED = 4.5  # standard deviations of disagreement from which a reading is called wild
DECLARED_WEIGHT = 4.0  # readings that the declared size counts for beside the repeats
DOF_WITHOUT_REPEATS = 20.0  # degrees of freedom of the size where there are no repeats
POOLED_PAIRS = 30.0  # neighbours that the correlation common to all channels counts for in each channel
LARGEST_CORRELATION = 0.95


@dataclass(frozen=True)
class ChannelNoise:
    """scale: measured over declared size;  rho: correlation of neighbours in a scan

    dof: degrees of freedom of the scale;  pairs: differences used;  wild: readings found wild
    """

    channel: str
    scale: float
    rho: float
    dof: float
    pairs: int
    wild: int


@dataclass(frozen=True, eq=False)
class Noise:
    """channels: in the order of the stack;  inflation: factor on u of each row, above 1 for wild readings (n,)"""

    channels: tuple[ChannelNoise, ...]
    inflation: np.ndarray


@dataclass(frozen=True, eq=False)
class LawError:
    """Directions in the whitened rows of a channel along which a law may be wrong, and how much (n_c, q), (q,)."""

    rows: slice
    directions: np.ndarray
    size: np.ndarray

    @property
    def half_log_det(self) -> float:
        return 0.5 * float(np.log1p(self.size**2).sum())

    def apply(self, z: np.ndarray) -> np.ndarray:
        """(1 + F F^T)^(-1/2) z of the rows of the channel, F = directions * size."""
        shrink = 1 - 1 / np.sqrt(1 + self.size**2)
        return z - self.directions @ ((shrink * self.directions).T @ z)


def law_error(rows: slice, wrong: np.ndarray) -> LawError:
    """Of whitened shapes with standard normal weights (n_c, q)."""
    directions, size, _ = np.linalg.svd(wrong, full_matrices=False)
    keep = size > 1e-3
    return LawError(rows, directions[:, keep], size[keep])


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
        before = np.zeros_like(z)
        before[1:] = z[:-1]
        z = (z - rho * before) / np.sqrt(1 - rho**2)
        for law in self.laws:
            z[law.rows] = law.apply(z[law.rows])
        return z


def whitener(stack: Stack, noise: Noise) -> Whitener:
    """The whitener of a stack; noise must have its channels and rows."""
    sigma, rho = np.empty(stack.size), np.zeros(stack.size)
    for channel, found in zip(stack.channels, noise.channels):
        rows = channel.rows
        sigma[rows] = stack.u[rows] * found.scale * noise.inflation[rows]
        rho[rows] = np.where(_follows(stack.tables[channel.table]), found.rho, 0.0)
    return Whitener(sigma, rho)


def measured_noise(stack: Stack, nominal: np.ndarray) -> Noise:
    """Noise of each channel of a stack from its repeats.

    nominal: readings of the nominal model (n,)
    """
    deviations = [_deviation(stack, channel, nominal) for channel in stack.channels]
    scales = [_scale(d) for d in deviations]
    rhos = _correlations(stack, deviations, scales)
    inflation = np.ones(stack.size)
    channels = []
    for channel, d, scale, rho in zip(stack.channels, deviations, scales, rhos):
        ratio = np.nan_to_num(np.abs(d.row) / scale.size) if scale.pairs else np.zeros(channel.size)
        inflation[channel.rows] = np.maximum(ratio / WILD, 1.0)
        dof = _dof(scale.pairs, rho)
        size = np.sqrt((DECLARED_WEIGHT + scale.pairs * scale.size**2) / (DECLARED_WEIGHT + scale.pairs))
        channels.append(
            ChannelNoise(channel.name, float(size), float(rho), dof, scale.pairs, int((ratio > REPORTED).sum()))
        )
    return Noise(tuple(channels), inflation)


def noise_on_rows(noise: Noise, stack: Stack, chosen: Sequence[np.ndarray]) -> Noise:
    """The noise for the chosen rows (one mask a table) of the stack it was measured on."""
    keep = np.concatenate([chosen[c.table] for c in stack.channels])
    return Noise(noise.channels, noise.inflation[keep])


@dataclass(frozen=True, eq=False)
class _Deviation:
    """Of the size of the noise of one reading over u, NaN where a row has no partner (n,).

    spread: from the mean of the repeats, for the size of the noise;  row: from their median, which shows which one
    is wild
    dof: differences that are independent
    """

    spread: np.ndarray
    row: np.ndarray
    dof: int


@dataclass(frozen=True)
class _Scale:
    size: float
    pairs: int


def _deviation(stack: Stack, channel: Channel, nominal: np.ndarray) -> _Deviation:
    table = stack.tables[channel.table]
    rows = channel.rows
    residual = (stack.y[rows] - nominal[rows]) / stack.u[rows]
    stations = matched_rows(table)
    spread, row = np.full(channel.size, np.nan), np.full(channel.size, np.nan)
    if stations is None:
        return _Deviation(spread, row, 0)
    values = residual[stations]  # (stations, repeats)
    repeats = values.shape[1]
    growth = np.sqrt(repeats / (repeats - 1))
    spread[stations] = (values - values.mean(axis=1, keepdims=True)) * growth
    row[stations] = (values - np.median(values, axis=1, keepdims=True)) * growth
    return _Deviation(spread, row, len(stations) * (repeats - 1))


def matched_rows(table: Table) -> np.ndarray | None:
    """Row numbers (stations, repeats) of readings taken at the same conditions, None where there is one repeat."""
    repeats = [np.flatnonzero(table.repeat == r) for r in np.unique(table.repeat)]
    if len(repeats) < 2:
        return None
    if len({len(rows) for rows in repeats}) == 1 and _alike(table, repeats):
        return np.array(repeats).T
    return _nearest(table, repeats)


def _places(table: Table) -> np.ndarray:
    """Conditions over their range (n, c)."""
    columns = [v / np.ptp(v) for v in table.conditions.values() if np.ptp(v) > 0]
    return np.array(columns).T if columns else np.zeros((table.rows, 1))


def _alike(table: Table, repeats: list[np.ndarray]) -> bool:
    """True when the k-th rows of all repeats were taken at the same place, but for what the readings scatter."""
    places = _places(table)
    apart = np.median(np.abs(places[repeats[0]] - places[repeats[-1]]), axis=0)
    between = np.median(np.abs(places - np.median(places, axis=0)), axis=0) + 1e-12
    return bool((apart < 0.2 * between).mean() >= 0.5)


def _nearest(table: Table, repeats: list[np.ndarray]) -> np.ndarray | None:
    """Stations by nearest conditions; a row of the first repeat without near partners in all others is left out."""
    places = _places(table)
    first, partners = repeats[0], []
    for rows in repeats[1:]:
        apart, partner = cKDTree(places[rows]).query(places[first])
        partners.append(np.where(apart < 0.02, rows[partner], -1))
    stations = np.column_stack([first, *partners])
    stations = stations[(stations >= 0).all(axis=1)]
    return stations if len(stations) >= 2 else None


def _scale(deviation: _Deviation) -> _Scale:
    """Standard deviation with disagreements cut at WILD times it (Huber's proposal 2)."""
    d = deviation.spread[np.isfinite(deviation.spread)]
    if len(d) == 0:
        return _Scale(1.0, 0)
    size = np.sqrt(np.mean(d**2)) + 1e-12
    for _ in range(20):
        size = np.sqrt(np.mean(np.minimum(d**2, (WILD * size) ** 2)) / TAME_SHARE) + 1e-12
    return _Scale(float(size), deviation.dof)


def _correlations(stack: Stack, deviations, scales) -> list[float]:
    """Correlation of neighbours of each channel, drawn towards the one common to all."""
    sums = []
    for channel, d, scale in zip(stack.channels, deviations, scales):
        z = np.clip(d.spread / scale.size, -3, 3)
        follows = _follows(stack.tables[channel.table]) & np.isfinite(z) & np.isfinite(np.roll(z, 1))
        share = scale.pairs / max(np.isfinite(z).sum(), 1)
        sums.append(((z * np.roll(z, 1))[follows].sum() * share, (z**2)[follows].sum() * share))
    over, under = np.array(sums).T if sums else (np.zeros(1), np.zeros(1))
    pooled = over.sum() / under.sum() if under.sum() > 0 else 0.0
    rho = (over + POOLED_PAIRS * pooled) / (under + POOLED_PAIRS)
    return list(np.clip(rho, -LARGEST_CORRELATION, LARGEST_CORRELATION))


def _dof(pairs: int, rho: float) -> float:
    if pairs == 0:
        return DOF_WITHOUT_REPEATS
    return float(DECLARED_WEIGHT + pairs * (1 - rho**2) / (1 + rho**2))


def _follows(table: Table) -> np.ndarray:
    """True where a row continues the scan of the row before (n,)."""
    same = np.zeros(table.rows, dtype=bool)
    same[1:] = (table.scan[1:] == table.scan[:-1]) & (table.repeat[1:] == table.repeat[:-1])
    return same
