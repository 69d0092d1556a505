"""What no effect of the library is: an unknown function of the conditions in a channel, its size in the channel's unit.

Three families stand for it: smooth functions (a Gaussian process of some length over the conditions, periodic in
angles, or over the reading of an instrument in all its tables), single orders of an angle, which are what something
that rings or ripples looks like, and plain laws c |x|^p sign(x)^s of one condition x, which are what a missing law most
often looks like. The size is a share of the rms reading of the channel, whatever the noise of its sensor is. Phases of
one quantity have functions of their own of the same size and length.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from math import log

import numpy as np
import pandas as pd

from workbench.data.stack import Channel, Stack
from workbench.data.table import Table
from workbench.likelihood.whitening import Whitener

SIZES = (0.001, 0.003, 0.01, 0.03, 0.1, 0.3)  # of the rms reading of the channel: six levels alike
LENGTHS = (0.3, 0.8, 2.0)  # over which it changes, of the standard deviation of a condition
TURNS = (0.1, 0.35, 1.2)  # the same for an angle over a revolution [rad]
POWERS = (-1.0, 0.0, 0.5, 1.0, 1.5, 2.0, 3.0)  # of plain laws
PLACES = 6  # of a condition, from which a function of it alone is more than a few numbers
MANY = 24  # places of an angle, from which its orders are looked at one by one
LANDMARKS = 60  # shapes of a smooth function in one channel


@dataclass(frozen=True, eq=False)
class Shape:
    """One kind of unknown function: what its rows have in common.

    channels: names;  law: "smooth", "along" (one condition), "order" (of an angle), "opposite order" (its sign goes
        with the direction), "reading" (what the instrument shows) or "power"
    of: that condition or response;  detail: length, order or power
    rows: numbers of the rows it acts on (n_c,);  columns: whitened, of size 1 [rms reading] (n_c, k)
    parts: the same of every channel before whitening, SI
    log_prior: ln of its prior share, each of SIZES having the same
    """

    channels: tuple[str, ...]
    law: str
    of: str
    detail: float
    rows: np.ndarray
    columns: np.ndarray
    parts: tuple[np.ndarray, ...]
    log_prior: float

    @property
    def raw(self) -> np.ndarray:
        """The columns before whitening, SI (n_c, k); most of it is zero, so it is not kept."""
        return _blocks(self.parts)

    @cached_property
    def products(self) -> np.ndarray:
        """Of the whitened columns with each other (k, k); every explanation asks for them."""
        return self.columns.T @ self.columns

    def words(self) -> str:
        """For people."""
        where = ", ".join(self.channels)
        if self.law == "along":
            return f"a smooth function of {self.of} in {where}"
        if "order" in self.law:
            return f"order {self.detail:g} of {self.of} in {where}" + ", opposite both ways" * (self.law != "order")
        if self.law == "reading":
            return f"a smooth function of the reading itself in {where}"
        if self.law == "power":
            return f"a law of {where} that goes with {self.of} to the power {self.detail:g}"
        return f"a smooth function of the conditions in {where}"


@dataclass(frozen=True, eq=False)
class Seen:
    """A shape beside an explanation. gains: ln p gained at each of SIZES, priors left out [nats]"""

    shape: Shape
    gains: np.ndarray

    @property
    def log_evidence(self) -> float:
        """ln p gained with the size integrated out and the prior of the shape included [nats]."""
        return float(np.logaddexp.reduce(self.gains)) - log(len(SIZES)) + self.shape.log_prior

    @property
    def size(self) -> float:
        """The most probable of SIZES."""
        return SIZES[int(np.argmax(self.gains))]

    def columns(self, rows: int) -> np.ndarray:
        """Whitened columns at that size for all rows (n, k)."""
        out = np.zeros((rows, self.shape.columns.shape[1]))
        out[self.shape.rows] = self.size * self.shape.columns
        return out


def shapes_of(stack: Stack, white: Whitener, answers: np.ndarray) -> tuple[Shape, ...]:
    """Every unknown function that is thought of: equal shares of the prior for smooth functions of all conditions, for
    smooth functions of one of them, for orders, for those of the reading itself, and for plain laws.

    answers: readings as the model has them (n,): those of the table would betray their own noise
    """
    found = [shape for group in _groups(stack) for shape in _of_group(stack, white, group)]
    found += [shape for group in _instruments(stack) for shape in _of_readings(stack, white, answers, group)]
    counts = Counter(shape.law for shape in found)
    return tuple(replace(shape, log_prior=-log(len(counts) * counts[shape.law])) for shape in found)


def _groups(stack: Stack) -> list[list[Channel]]:
    """Channels of one table that are phases, or parts, of one quantity."""
    found: dict[tuple[int, str], list[Channel]] = {}
    for channel in stack.channels:
        found.setdefault((channel.table, _quantity(channel.response)), []).append(channel)
    return list(found.values())


def _quantity(response: str) -> str:
    if response in ("re", "im"):
        return "complex"
    stem, _, phase = response.rpartition("_")
    return stem if stem and phase in ("a", "b", "c") else response


def _instruments(stack: Stack) -> list[list[Channel]]:
    """Channels of all tables that show one quantity, those of one instrument together."""
    found: dict[str, list[Channel]] = {}
    for channel in sorted(stack.channels, key=lambda c: c.response):
        found.setdefault(_quantity(channel.response), []).append(channel)
    return list(found.values())


def _of_group(stack: Stack, white: Whitener, group: Sequence[Channel]) -> Iterator[Shape]:
    table = stack.tables[group[0].table]
    each = lambda law: tuple(_rms(stack, c) * law for c in group)  # noqa: E731
    for length in range(len(LENGTHS)):
        yield _shape(stack, white, group, "smooth", "", LENGTHS[length], each(smooth(table, length)))
    for of in _alone(table):
        only = {of: table.conditions[of]}
        for length in range(len(LENGTHS)):
            yield _shape(stack, white, group, "along", of, LENGTHS[length], each(smooth_over(only, length)))
    for law, of, order, waves in _orders(table):
        yield _shape(stack, white, group, law, of, order, each(waves))
    for of, power, law in _laws(table):
        yield _shape(stack, white, group, "power", of, power, each(law[:, None]))


def _of_readings(stack: Stack, white: Whitener, answers: np.ndarray, group: Sequence[Channel]) -> Iterator[Shape]:
    """Smooth functions of what each instrument reads, the same in all its tables, in proportion to it."""
    instruments = [[c for c in group if c.response == r] for r in dict.fromkeys(c.response for c in group)]
    readings = [np.concatenate([answers[c.rows] for c in one]) for one in instruments]
    for length in range(len(LENGTHS)):
        parts = tuple(np.abs(y)[:, None] * smooth_over({"reading": y}, length) for y in readings)
        yield _shape(stack, white, group, "reading", _quantity(group[0].response), LENGTHS[length], parts)


def _shape(
    stack: Stack,
    white: Whitener,
    group: Sequence[Channel],
    law: str,
    of: str,
    detail: float,
    parts: tuple[np.ndarray, ...],
) -> Shape:
    """A shape of channels, its prior still open."""
    rows = np.concatenate([np.arange(c.rows.start, c.rows.stop) for c in group])
    names = tuple(channel.name for channel in group)
    return Shape(names, law, of, detail, rows, white.of(rows)(_blocks(parts)), parts, 0.0)


def _rms(stack: Stack, channel: Channel) -> float:
    return float(np.sqrt(np.mean(stack.y[channel.rows] ** 2)))


def _blocks(parts: Sequence[np.ndarray]) -> np.ndarray:
    """Side by side, each in its own rows and columns."""
    out = np.zeros((sum(len(p) for p in parts), sum(p.shape[1] for p in parts)))
    row = column = 0
    for part in parts:
        out[row : row + len(part), column : column + part.shape[1]] = part
        row, column = row + len(part), column + part.shape[1]
    return out


def _alone(table: Table) -> list[str]:
    """Conditions beside others that have enough places for a function of them alone."""
    varying = [name for name, values in table.conditions.items() if np.ptp(values) > 0 and name != "direction"]
    return [name for name in varying if len(varying) > 1 and len(np.unique(table.conditions[name])) >= PLACES]


def _orders(table: Table) -> Iterator[tuple[str, str, int, np.ndarray]]:
    """(law, angle, order, cosine and sine of rms 1 (n, 2)) of every angle of a scan up to two readings a wave; where
    both directions were read, those that change their sign with it too. A smooth function has too few shapes for many
    waves a revolution."""
    for name, angle in table.conditions.items():
        places = np.unique(np.round(np.mod(angle, 2 * np.pi), 6))
        if "angle" not in name or len(places) < MANY:
            continue
        for order in range(1, int(2 * np.pi / np.median(np.diff(places)) / 2)):
            waves = np.sqrt(2) * np.column_stack((np.cos(order * angle), np.sin(order * angle)))
            yield "order", name, order, waves
            if np.ptp(table.conditions.get("direction", np.zeros(1))) > 0:
                yield "opposite order", name, order, waves * np.sign(table.conditions["direction"])[:, None]


def _laws(table: Table) -> Iterator[tuple[str, float, np.ndarray]]:
    """(condition, power, law of rms 1 (n,)) of every condition that varies, odd where it has both signs."""
    for name, x in table.conditions.items():
        if np.ptp(x) == 0 or "angle" in name or name == "direction" or name.endswith("_T"):
            continue
        size = np.abs(x) / np.abs(x).max()
        for power in POWERS:
            if power < 0 and size.min() < 1e-3:
                continue
            law = np.sign(x) * size**power if x.min() < 0 else size**power
            if np.ptp(law) > 0 or power == 0:
                yield name, power, law / np.sqrt(np.mean(law**2))


@lru_cache(maxsize=16)  # every fit asks at the same few tables for the errors of its laws
def smooth(table: Table, length: int) -> np.ndarray:
    """Phi (n, q) with Phi Phi^T = exp(-d^2 / 2) over all conditions of a table."""
    return smooth_over(table.conditions, length)


def smooth_over(conditions: Mapping[str, np.ndarray], length: int) -> np.ndarray:
    """Phi (n, q) with Phi Phi^T = exp(-d^2 / 2) as far as LANDMARKS reach (Nystroem); d: distance over the length."""
    places = _places(conditions, length)
    unique = np.unique(np.round(places, 6), axis=0)
    marks = unique[:: max(1, -(-len(unique) // LANDMARKS))]
    between = _kernel(marks, marks) + 1e-6 * np.eye(len(marks))
    return np.linalg.solve(np.linalg.cholesky(between), _kernel(marks, places)).T


def _places(conditions: Mapping[str, np.ndarray], length: int) -> np.ndarray:
    """Conditions over the length (n, d): an angle on its circle, others by their ranks with standard deviation 1."""
    columns: list[np.ndarray] = []
    for name, values in conditions.items():
        if np.ptp(values) == 0:
            continue
        if "angle" in name:
            columns += [np.cos(values) / TURNS[length], np.sin(values) / TURNS[length]]
        else:
            rank = pd.Series(np.round(values, 12)).rank().to_numpy()
            columns.append((rank - rank.mean()) / rank.std() / LENGTHS[length])
    return np.array(columns).T if columns else np.zeros((len(next(iter(conditions.values()))), 1))


def _kernel(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    square = np.sum(a**2, axis=1)[:, None] + np.sum(b**2, axis=1) - 2 * a @ b.T
    return np.exp(-0.5 * np.maximum(square, 0.0))


def seen(shapes: Sequence[Shape], background: np.ndarray, residual: np.ndarray) -> tuple[Seen, ...]:
    """Every shape beside an explanation. background: its columns (n, m);  residual: whitened (n,)"""
    turned = np.linalg.inv(np.linalg.cholesky(np.eye(background.shape[1]) + background.T @ background))
    own = turned @ (background.T @ residual)
    taken = turned @ background.T
    return tuple(Seen(shape, _gains(shape, taken, residual, own)) for shape in shapes)


def _gains(shape: Shape, taken: np.ndarray, residual: np.ndarray, own: np.ndarray) -> np.ndarray:
    """1/2 sum over the principal shapes of (a^2 c^2 / (1 + a^2 e) - ln(1 + a^2 e)) at every size a (sizes,)."""
    x = shape.columns
    beside = taken[:, shape.rows] @ x
    energy, turn = np.linalg.eigh(shape.products - beside.T @ beside)
    pull = turn.T @ (x.T @ residual[shape.rows] - beside.T @ own)
    a2e = np.square(SIZES)[:, None] * np.maximum(energy, 0.0)
    return 0.5 * np.sum(np.square(SIZES)[:, None] * pull**2 / (1 + a2e) - np.log1p(a2e), axis=1)


@dataclass(frozen=True, eq=False)
class Beside:
    """Shapes beside one background, made ready for many residuals. background: (n, m)"""

    shapes: tuple[Shape, ...]
    background: np.ndarray

    @cached_property
    def _root(self) -> np.ndarray:
        return np.linalg.cholesky(np.eye(self.background.shape[1]) + self.background.T @ self.background)

    @cached_property
    def _principal(self) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
        """Of every shape: energies (q,), turn of its columns (k, q) and what the background takes of these (m, q)."""
        found = []
        for shape in self.shapes:
            beside = np.linalg.solve(self._root, self.background[shape.rows].T @ shape.columns)
            energy, turn = np.linalg.eigh(shape.products - beside.T @ beside)
            keep = energy > 1e-9 * max(energy.max(initial=0.0), 1e-300)
            found.append((energy[keep], turn[:, keep], beside @ turn[:, keep]))
        return found

    def log_evidences(self, residuals: np.ndarray) -> np.ndarray:
        """ln p gained by an unknown function, shapes and sizes averaged over, for residuals (n, R): (R,) [nats]."""
        own = np.linalg.solve(self._root, self.background.T @ residuals)
        found = []
        for shape, (energy, turn, beside) in zip(self.shapes, self._principal):
            square = (turn.T @ (shape.columns.T @ residuals[shape.rows]) - beside.T @ own) ** 2
            for size in SIZES:
                a2e = size**2 * energy
                gain = 0.5 * ((size**2 / (1 + a2e)) @ square - np.log1p(a2e).sum())
                found.append(gain + shape.log_prior - log(len(SIZES)))
        return np.logaddexp.reduce(found, axis=0)


def expected(seen_: Seen, background: np.ndarray, residual: np.ndarray) -> np.ndarray:
    """Expected unknown function at its most probable size, of the shape's rows, SI (n_c,)."""
    x = np.hstack([background, seen_.columns(len(residual))])
    weights = np.linalg.solve(np.eye(x.shape[1]) + x.T @ x, x.T @ residual)
    return seen_.size * seen_.shape.raw @ weights[background.shape[1] :]
