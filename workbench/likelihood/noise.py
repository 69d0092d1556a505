"""Noise of every channel from what repeats disagree by: size, correlation of neighbours, what a scan as a whole is off
by (remounting, drift), single wild readings.

The declared uncertainty gives the shape over the rows; its size is measured. Differences between repeats are taken of
reading minus model, so that conditions that were not set quite alike do no harm. The model has a vote, like each
repeat, on which reading is the wild one: of two alone nobody could tell. Of a scan

    z = (offset + slope (t - 1/2)) / u + AR(1) noise of size 1,   t: how far through the scan, 0 to 1
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from workbench.data.repeats import follows, matched_rows
from workbench.data.stack import Channel, Stack
from workbench.data.table import Table

WILD = 2.5  # standard deviations of disagreement from which a reading counts less: u grows with the disagreement
TAME_SHARE = 0.9749  # mean of min(d^2, WILD^2) of a standard normal d
REPORTED = 4.5  # standard deviations of disagreement from which a reading is called wild
DECLARED_WEIGHT = 4.0  # readings that the declared size counts for beside the repeats
DOF_WITHOUT_REPEATS = 20.0  # degrees of freedom of the size where there are no repeats
POOLED_PAIRS = 30.0  # neighbours that the correlation common to all channels counts for in each channel
LARGEST_CORRELATION = 0.95
POOLED_SCANS = 6.0  # offsets and slopes that the spread common to all channels counts for in each channel
SHORTEST_SCAN = 6  # rows of a scan in which an offset and a slope can be told from noise


@dataclass(frozen=True)
class ChannelNoise:
    """scale: measured over declared size;  rho: correlation of neighbours in a scan

    dof: degrees of freedom of the scale;  pairs: differences used;  wild: readings found wild
    scans: standard deviation of offset and of slope of a scan as a whole, of the size of the noise
    """

    channel: str
    scale: float
    rho: float
    dof: float
    pairs: int
    wild: int
    scans: float = 0.0


@dataclass(frozen=True, eq=False)
class Noise:
    """channels: in the order of the stack;  inflation: factor on u of each row, above 1 for wild readings (n,)"""

    channels: tuple[ChannelNoise, ...]
    inflation: np.ndarray


def _through(rows: int) -> np.ndarray:
    """How far every row is through its scan, from the middle on (rows,)."""
    return np.linspace(-0.5, 0.5, rows) if rows > 1 else np.zeros(rows)


def measured_noise(stack: Stack, predicted: np.ndarray) -> Noise:
    """Noise of each channel of a stack from its repeats.

    predicted: readings of the model (n,)
    """
    residual = (stack.y - predicted) / stack.u
    raw = _disagreements(stack, residual)
    tame = _disagreements(stack, residual - _wild_part(stack, raw))
    rhos = _correlations(stack, tame.within, tame.scales)
    found = [_of_channel(c.name, s, r) for c, s, r in zip(stack.channels, tame.scales, rhos)]
    scans = [
        _of_whole_scans(stack.tables[c.table], stack.u[c.rows], d, own)
        for c, d, own in zip(stack.channels, tame.whole, found)
    ]
    channels = [replace(own, scans=spread) for own, spread in zip(found, _spreads(scans))]
    return with_wild_readings(channels, stack, predicted)


def with_wild_readings(channels: Sequence[ChannelNoise], stack: Stack, predicted: np.ndarray) -> Noise:
    """Noise of known size on rows of a stack, those that are off their repeats counting less.

    channels: in the order of the stack;  predicted: readings of the model (n,)
    """
    rows = [d.row for d in _disagreements(stack, (stack.y - predicted) / stack.u).within]
    ratios = [np.nan_to_num(np.abs(row) / own.scale) for row, own in zip(rows, channels)]
    counted = tuple(replace(own, wild=int((ratio > REPORTED).sum())) for own, ratio in zip(channels, ratios))
    return Noise(counted, np.maximum(np.concatenate(ratios) / WILD, 1.0) if ratios else np.ones(0))


def _of_channel(name: str, scale: _Scale, rho: float) -> ChannelNoise:
    """The measured size drawn towards the declared one."""
    size = np.sqrt((DECLARED_WEIGHT + scale.pairs * scale.size**2) / (DECLARED_WEIGHT + scale.pairs))
    return ChannelNoise(name, float(size), float(rho), _dof(scale.pairs, rho), scale.pairs, 0)


@dataclass(frozen=True, eq=False)
class _Disagreements:
    """Of the repeats of every channel. within: less what a scan as a whole is off by"""

    whole: list[_Deviation]
    within: list[_Deviation]
    scales: list[_Scale]


def _disagreements(stack: Stack, residual: np.ndarray) -> _Disagreements:
    whole = [_deviation(stack, channel, residual) for channel in stack.channels]
    within = [_within_scans(stack, c, residual, d) for c, d in zip(stack.channels, whole)]
    return _Disagreements(whole, within, [_scale(d) for d in within])


def _wild_part(stack: Stack, found: _Disagreements) -> np.ndarray:
    """By how much every reading is further off its repeats than WILD, of u (n,): left in, it would move their mean and
    make all of them look noisy. The model has no vote here: a wrong one must not look like noise."""
    parts = [
        np.nan_to_num(np.sign(d.middle) * np.maximum(np.abs(d.middle) - WILD * scale.size, 0.0))
        for d, scale in zip(found.within, found.scales)
    ]
    return np.concatenate(parts) if parts else np.zeros(0)


def noise_on_rows(noise: Noise, stack: Stack, chosen: Sequence[np.ndarray]) -> Noise:
    """The noise for the chosen rows (one mask a table) of the stack it was measured on."""
    keep = np.concatenate([chosen[c.table] for c in stack.channels])
    return Noise(noise.channels, noise.inflation[keep])


@dataclass(frozen=True, eq=False)
class _Deviation:
    """Of the size of the noise of one reading over u, NaN where a row has no partner (n,).

    spread: from the mean of the repeats, for the size of the noise;  middle: from their median, which no wild reading
    moves;  row: from the median of them and the model, which shows which one is wild
    dof: differences that are independent;  growth: factor on the spread, as the mean of few is nearer than the truth
    """

    spread: np.ndarray
    middle: np.ndarray
    row: np.ndarray
    dof: int
    growth: float


@dataclass(frozen=True)
class _Scale:
    size: float
    pairs: int


def _deviation(stack: Stack, channel: Channel, residual: np.ndarray) -> _Deviation:
    stations = matched_rows(stack.tables[channel.table])
    spread, middle, row = np.full((3, channel.size), np.nan)
    if stations is None:
        return _Deviation(spread, middle, row, 0, 1.0)
    values = residual[channel.rows][stations]  # (stations, repeats)
    repeats = values.shape[1]
    votes = np.column_stack([values, np.zeros(len(values))])
    growth = float(np.sqrt(repeats / (repeats - 1)))
    spread[stations] = (values - values.mean(axis=1, keepdims=True)) * growth
    middle[stations] = values - np.median(values, axis=1, keepdims=True)
    row[stations] = values - np.median(votes, axis=1, keepdims=True)
    return _Deviation(spread, middle, row, len(stations) * (repeats - 1), growth)


def _within_scans(stack: Stack, channel: Channel, residual: np.ndarray, whole: _Deviation) -> _Deviation:
    """The deviations less mean and slope of every scan that is long enough to have them."""
    u, off, free = stack.u[channel.rows], np.zeros(channel.size), np.ones(channel.size)
    for rows in stack.tables[channel.table].scans:
        known = rows[np.isfinite(whole.spread[rows])]
        if len(known) < SHORTEST_SCAN:
            continue
        shapes = scan_shapes(u[rows])[np.searchsorted(rows, known)]
        values = np.clip(whole.spread[known], *_fence(whole.spread[known]))
        off[known] = shapes @ np.linalg.lstsq(shapes, values, rcond=None)[0] / whole.growth
        free[known] = np.sqrt(len(known) / (len(known) - 2))
    left = residual.copy()
    left[channel.rows] -= off
    found = _deviation(stack, channel, left)
    return replace(found, spread=found.spread * free)


def _fence(values: np.ndarray) -> tuple[float, float]:
    """Where a wild reading is cut before a line is drawn through the others."""
    middle = float(np.median(values))
    reach = WILD * 1.4826 * float(np.median(np.abs(values - middle))) + 1e-300
    return middle - reach, middle + reach


@dataclass(frozen=True, eq=False)
class _Scans:
    """Offsets and slopes of the scans of a channel, of the size of its noise, and their variance by noise (s,).

    free: how many of them are independent, as they are taken from the mean of the repeats
    """

    found: np.ndarray
    noise: np.ndarray
    free: float


def _of_whole_scans(table: Table, u: np.ndarray, deviation: _Deviation, own: ChannelNoise) -> _Scans:
    z, rho = deviation.spread / own.scale, own.rho
    found, noise = [], []
    for rows in table.scans:
        known = rows[np.isfinite(z[rows])]
        if len(known) >= SHORTEST_SCAN:
            shapes = scan_shapes(u[rows])[np.searchsorted(rows, known)]
            values = np.clip(z[known], *_fence(z[known]))
            found += list(np.linalg.lstsq(shapes, values, rcond=None)[0])
            noise += list((1 + rho) / (1 - rho) * np.diagonal(np.linalg.pinv(shapes.T @ shapes)))
    return _Scans(np.array(found), np.array(noise), len(found) / deviation.growth**2)


def scan_shapes(u: np.ndarray) -> np.ndarray:
    """An offset and a slope in the unit of the reading over the rows of a scan, of rms 1 over their u (n, 2)."""
    shapes = np.column_stack([np.ones(len(u)), _through(len(u))]) / u[:, None]
    size = np.sqrt(np.mean(shapes**2, axis=0))
    return shapes / np.where(size > 0, size, 1.0)


def _spreads(scans: Sequence[_Scans]) -> list[float]:
    """Standard deviation of offset and of slope of the scans of every channel beyond what noise gives them, drawn
    towards the one common to all, as three repeats alone say little of it: that of the next scan, which is one of
    Student's t as the variance of n scans is not known but has a posterior of n degrees of freedom."""
    found, noise = (np.concatenate([getattr(s, name) for s in scans]) for name in ("found", "noise"))
    common = _excess(found, noise)
    own = [(_excess(s.found, s.noise), s.free) for s in scans]
    return [float(np.sqrt((POOLED_SCANS * common + n * e) / (POOLED_SCANS + n - 2.0))) for e, n in own]


def _excess(found: np.ndarray, noise: np.ndarray) -> float:
    """Variance of values beyond that of their noise, each weighed by how well it tells."""
    excess = 0.0
    for _ in range(5):
        weight = 1.0 / (noise + excess) ** 2
        excess = max(float(np.sum(weight * (found**2 - noise)) / weight.sum()), 0.0) if len(found) else 0.0
    return excess


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
        next_to = follows(stack.tables[channel.table]) & np.isfinite(z) & np.isfinite(np.roll(z, 1))
        share = scale.pairs / max(np.isfinite(z).sum(), 1)
        sums.append(((z * np.roll(z, 1))[next_to].sum() * share, (z**2)[next_to].sum() * share))
    over, under = np.array(sums).T if sums else (np.zeros(1), np.zeros(1))
    pooled = over.sum() / under.sum() if under.sum() > 0 else 0.0
    rho = (over + POOLED_PAIRS * pooled) / (under + POOLED_PAIRS)
    rho = rho + np.array([_lost_by_lines(stack.tables[c.table], r) for c, r in zip(stack.channels, rho)])
    return list(np.clip(rho, -LARGEST_CORRELATION, LARGEST_CORRELATION))


def _lost_by_lines(table: Table, rho: float) -> float:
    """By how much a line through every scan makes the correlation of neighbours look smaller, 2 (1 + 2 rho) / n."""
    sizes = [len(rows) for rows in table.scans if len(rows) >= SHORTEST_SCAN]
    return 2 * (1 + 2 * max(rho, 0.0)) / float(np.mean(sizes)) if sizes else 0.0


def _dof(pairs: int, rho: float) -> float:
    if pairs == 0:
        return DOF_WITHOUT_REPEATS
    return float(DECLARED_WEIGHT + pairs * (1 - rho**2) / (1 + rho**2))


def drawn_noise(stack: Stack, noise: Noise, random: np.random.Generator, count: int) -> np.ndarray:
    """Whitened noise of simulated campaigns (n, count): its size and correlation are known only as well as the repeats
    tell."""
    z = random.standard_normal((stack.size, count))
    out = np.empty_like(z)
    for channel, found in zip(stack.channels, noise.channels):
        size = np.sqrt(found.dof / random.chisquare(found.dof, count))
        more = random.normal(0.0, np.sqrt((1 - found.rho**2) / max(found.dof, 10.0)), count)
        part = z[channel.rows]
        out[channel.rows] = size * (part + more * np.vstack([np.zeros((1, count)), part[:-1]])) / np.sqrt(1 + more**2)
    return out
