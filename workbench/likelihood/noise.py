"""Noise of every channel from what repeats disagree by: size, correlation of neighbours, what a scan as a whole is off
by (remounting, drift), single wild readings.

The declared uncertainty gives the shape over the rows; its size is measured. Differences between repeats are taken of
reading minus model, so that conditions that were not set quite alike do no harm. The model has a vote, like each
repeat, on which reading is the wild one: of two alone nobody could tell. Of a scan

    z = (offset + slope (t - 1/2)) / u + AR(1) noise and independent noise, of size 1 together
    t: how far through the scan, 0 to 1
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from workbench.data.repeats import follows, matched_rows, near_rows
from workbench.data.robust import ROUNDS, WILD, size_of
from workbench.data.stack import Channel, Stack
from workbench.data.table import Table
from workbench.likelihood.restricted import DECLARED_WEIGHT, Repeated, Size, sizes_of

REPORTED = 4.5  # standard deviations of disagreement from which a reading is called wild
DOF_WITHOUT_REPEATS = 20.0  # degrees of freedom of the size where there are no repeats
MOST_STATIONS = 4000  # that are asked how large the noise of a channel is; so many know it to 1 %
MOST_SHUFFLED = 250  # of them where repeats go through them in other orders: each then meets all others
ORDERED = 50  # stations that neighbours in a scan are apart at most, where repeats go through them in one order
MOST_SCANS = 80  # that are asked what a scan as a whole is off by; so many know it to 6 %
RUN = 50  # neighbouring stations of a longer table that are kept together
SHORTEST_SCAN = 6  # rows of a scan in which an offset and a slope can be told from noise


@dataclass(frozen=True)
class ChannelNoise(Size):
    """The noise of one channel, and what it is known by.

    dof: degrees of freedom of the scale;  pairs: differences used;  wild: readings found wild
    """

    channel: str
    dof: float
    pairs: int
    wild: int


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
    within = _within(stack, residual)
    tame = residual - _wild_part(within)
    repeated = [_repeated(stack, channel, tame) for channel in stack.channels]
    channels = [_of_channel(*each) for each in zip((c.name for c in stack.channels), repeated, sizes_of(repeated))]
    return _with_wild(channels, within)


def with_wild_readings(channels: Sequence[ChannelNoise], stack: Stack, predicted: np.ndarray) -> Noise:
    """Noise of known size on rows of a stack, those that are off their repeats counting less.

    channels: in the order of the stack;  predicted: readings of the model (n,)
    """
    return _with_wild(channels, _within(stack, (stack.y - predicted) / stack.u))


def _with_wild(channels: Sequence[ChannelNoise], within: Sequence[_Deviation]) -> Noise:
    ratios = [np.nan_to_num(np.abs(d.row) / own.scale) for d, own in zip(within, channels)]
    counted = tuple(replace(own, wild=int((ratio > REPORTED).sum())) for own, ratio in zip(channels, ratios))
    return Noise(counted, np.maximum(np.concatenate(ratios) / WILD, 1.0) if ratios else np.ones(0))


def _of_channel(name: str, repeated: Repeated, size: Size) -> ChannelNoise:
    dof = DECLARED_WEIGHT + repeated.free if repeated.free else DOF_WITHOUT_REPEATS
    return ChannelNoise(**vars(size), channel=name, dof=float(dof), pairs=repeated.free, wild=0)


def _repeated(stack: Stack, channel: Channel, residual: np.ndarray) -> Repeated:
    """The readings of a channel that have partners, in the order they were taken; residual: over u (n,)"""
    table, u = stack.tables[channel.table], stack.u[channel.rows]
    rows, place, next_to = _linked(table, _some(table))
    if np.abs(np.diff(place, prepend=0)[next_to]).max(initial=0) > ORDERED:
        rows, place, next_to = _linked(table, _some(table)[:MOST_SHUFFLED])
    return Repeated(residual[channel.rows][rows], place, next_to, _shapes(table, u, rows))


def _linked(table: Table, stations: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Rows of some stations (stations, repeats), the station of each, and whether it continues the scan of the one
    before (rows,) each."""
    place = np.full(table.rows, -1)
    place[stations] = np.arange(len(stations))[:, None]
    rows = np.flatnonzero(place >= 0)
    return rows, place[rows], follows(table)[rows] & (np.diff(rows, prepend=-2) == 1)


def _some(table: Table) -> np.ndarray:
    """Stations of a table (stations, repeats), no row where nothing was repeated; of a long one runs of neighbours all
    over it, of very many scans some."""
    stations = matched_rows(table)
    if stations is None:
        return np.zeros((0, 1), dtype=int)
    kept = np.unique(table.scan)[:: -(-len(table.scans) // MOST_SCANS)]
    stations = stations[np.isin(table.scan[stations[:, 0]], kept)]
    step = -(-len(stations) // MOST_STATIONS)
    runs = np.array_split(stations, -(-len(stations) // RUN)) if step > 1 else [stations]
    return np.concatenate(runs[::step])


def _shapes(table: Table, u: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Offset and slope of every scan that is long enough to have them, at some rows of a table (rows, 2 scans)."""
    place, columns = np.full(len(u), -1), [np.zeros((len(rows), 0))]
    place[rows] = np.arange(len(rows))
    for scan in table.scans:
        known = place[scan] >= 0
        if len(scan) >= SHORTEST_SCAN and known.any():
            columns.append(np.zeros((len(rows), 2)))
            columns[-1][place[scan[known]]] = scan_shapes(u[scan])[known]
    return np.hstack(columns)


def _within(stack: Stack, residual: np.ndarray) -> list[_Deviation]:
    """What repeats of every channel disagree by, less what a scan as a whole is off by. residual: over u (n,)"""
    return [_within_scans(stack, c, residual, _deviation(stack, c, residual, np.zeros(c.size))) for c in stack.channels]


def _wild_part(within: Sequence[_Deviation]) -> np.ndarray:
    """By how much every reading is further off its repeats than WILD, of u (n,): left in, it would move their mean and
    make all of them look noisy. The model has no vote here: a wrong one must not look like noise."""
    parts = [np.nan_to_num(np.sign(d.middle) * np.maximum(np.abs(d.middle) - WILD * _size(d), 0.0)) for d in within]
    return np.concatenate(parts) if parts else np.zeros(0)


def noise_on_rows(noise: Noise, stack: Stack, chosen: Sequence[np.ndarray]) -> Noise:
    """The noise for the chosen rows (one mask a table) of the stack it was measured on."""
    keep = np.concatenate([chosen[c.table] for c in stack.channels])
    return Noise(noise.channels, noise.inflation[keep])


@dataclass(frozen=True, eq=False)
class _Deviation:
    """Of the size of the noise of one reading over u, NaN where a row has no partner in every repeat (n,).

    spread: from the mean of the repeats, for the size of the noise;  middle: from their median, which no wild reading
    moves;  row: from the median of them and the model, which shows which one is wild; of a reading that has lost its
    partners, from that of its neighbours and the model
    growth: factor on the spread, as the mean of few is nearer than the truth
    """

    spread: np.ndarray
    middle: np.ndarray
    row: np.ndarray
    growth: float


def _deviation(stack: Stack, channel: Channel, residual: np.ndarray, vote: np.ndarray) -> _Deviation:
    """vote: of the model on every row of the channel (n_c,)"""
    stations = matched_rows(stack.tables[channel.table])
    spread, middle, row = np.full((3, channel.size), np.nan)
    if stations is None:
        return _Deviation(spread, middle, row, 1.0)
    values = residual[channel.rows][stations]  # (stations, repeats)
    repeats = values.shape[1]
    votes = np.column_stack([values, vote[stations].mean(axis=1)])
    growth = float(np.sqrt(repeats / (repeats - 1)))
    spread[stations] = (values - values.mean(axis=1, keepdims=True)) * growth
    middle[stations] = values - np.median(values, axis=1, keepdims=True)
    row[stations] = values - np.median(votes, axis=1, keepdims=True)
    lost = np.flatnonzero(np.bincount(stations.ravel(), minlength=channel.size) == 0)
    if 0 < len(lost) < stations.size:
        row[lost] = _of_lost(stack.tables[channel.table], residual[channel.rows], vote, lost)
    return _Deviation(spread, middle, row, growth)


def _of_lost(table: Table, values: np.ndarray, vote: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """By how much readings of which another repeat has none are off the median of those that there are and of the
    model; where there are none, of their neighbours in the scan and of the model (rows,)."""
    near, next_to = near_rows(table, rows), np.append(follows(table), False)
    alone = (near >= 0).sum(axis=1) == 1
    before = np.where(alone & next_to[rows], rows - 1, -1)
    after = np.where(alone & next_to[rows + 1], rows + 1, -1)
    asked = np.column_stack([near, before, after])
    votes = np.column_stack([np.where(asked >= 0, values[asked], np.nan), vote[rows]])
    return values[rows] - np.nanmedian(votes, axis=1)


def _within_scans(stack: Stack, channel: Channel, residual: np.ndarray, whole: _Deviation) -> _Deviation:
    """The deviations less mean and slope of every scan that is long enough to have them. What all repeats are off the
    model by in the same way is no vote of the model for one of them."""
    u, free = stack.u[channel.rows], np.ones(channel.size)
    off, vote = np.zeros((2, channel.size))
    common = residual[channel.rows] - whole.spread / whole.growth
    for rows in stack.tables[channel.table].scans:
        known = rows[np.isfinite(whole.spread[rows])]
        if len(known) < SHORTEST_SCAN:
            continue
        shapes = scan_shapes(u[rows])
        among = shapes[np.searchsorted(rows, known)]
        off[rows] = shapes @ _robust_weights(among, whole.spread[known]) / whole.growth
        vote[rows] = shapes @ _robust_weights(among, common[known])
        free[known] = np.sqrt(len(known) / (len(known) - 2))
    left = residual.copy()
    left[channel.rows] -= off
    found = _deviation(stack, channel, left, vote)
    return replace(found, spread=found.spread * free)


def _robust_weights(shapes: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Of shapes (n, q) in values (n,), what is left cut at WILD times its size (Huber, Robust Statistics (1981), 7.8).

    Where the uncertainty of a reading is small, an offset of a whole scan is many of it: it is what is left that tells
    a wild reading.
    """
    inverse, found = np.linalg.pinv(shapes), np.zeros(len(values))
    for _ in range(ROUNDS):
        left = values - found
        middle = np.median(left)
        reach = WILD * 1.4826 * np.median(np.abs(left - middle)) + 1e-300
        weights = inverse @ (found + np.clip(left, middle - reach, middle + reach))
        found = shapes @ weights
    return weights


def scan_shapes(u: np.ndarray) -> np.ndarray:
    """An offset and a slope in the unit of the reading over the rows of a scan, of rms 1 over their u (n, 2)."""
    shapes = np.column_stack([np.ones(len(u)), _through(len(u))]) / u[:, None]
    size = np.sqrt(np.mean(shapes**2, axis=0))
    return shapes / np.where(size > 0, size, 1.0)


def _size(deviation: _Deviation) -> float:
    """Standard deviation of what repeats disagree by, wild ones cut; that declared where nothing was repeated."""
    d = deviation.spread[np.isfinite(deviation.spread)]
    return size_of(d) if len(d) else 1.0


def drawn_noise(stack: Stack, noise: Noise, random: np.random.Generator, count: int) -> np.ndarray:
    """Whitened noise of simulated campaigns (n, count): its size and correlation are known only as well as the repeats
    tell."""
    z = random.standard_normal((stack.size, count))
    out = np.empty_like(z)
    for channel, found in zip(stack.channels, noise.channels):
        size = np.sqrt(found.dof / random.chisquare(found.dof, count))
        unsure = np.sqrt((1 - found.neighbours**2) / max(found.dof, 10.0))
        more = random.normal(0.0, unsure, count)
        part = z[channel.rows]
        out[channel.rows] = size * (part + more * np.vstack([np.zeros((1, count)), part[:-1]])) / np.sqrt(1 + more**2)
    return out
