"""What an effect claims to do to readings, as objects that a test can hold against a model.

A claim speaks of one place, "kind.column", and of the *change* of its readings by a vanishing size of the effect. Its
``error`` is how far the change is from the claim, in the claim's own measure; ``within`` is how far it may be.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fnmatch import fnmatch
from typing import ClassVar

import numpy as np

Columns = Mapping[str, np.ndarray]
NOTHING = 1e-6  # change over the largest reading below which none is claimed: no instrument of a bench would show it
FAINT = 1e-6  # change over the largest change whose power is not looked at


class Claim:
    """One statement about the change at one place."""

    place: str
    within: ClassVar[float]

    def error(self, conditions: Columns, change: np.ndarray) -> float:
        """How far the change (n,) at the conditions (n,) is from what is claimed."""
        raise NotImplementedError


@dataclass(frozen=True)
class Touches(Claim):
    """Readings change at this place; at places that no claim names they do not."""

    place: str
    within: ClassVar[float] = 0.5

    def error(self, conditions: Columns, change: np.ndarray) -> float:
        return 0.0 if np.any(change != 0.0) else 1.0


@dataclass(frozen=True)
class Power(Claim):
    """The change grows as a power of the size of a condition, all other conditions being the same.

    of: the condition;  low, high: where, in SI
    """

    place: str
    of: str
    exponent: float
    low: float = 0.0
    high: float = np.inf
    within: ClassVar[float] = 0.1

    def error(self, conditions: Columns, change: np.ndarray) -> float:
        size = np.abs(conditions[self.of])
        rows = (size >= self.low) & (size <= self.high) & (np.abs(change) > FAINT * np.abs(change).max()) & (size > 0.0)
        groups = _groups({k: v for k, v in conditions.items() if k not in (self.of, "order")}, rows)
        slopes = [_slope(size[g], change[g]) for g in groups if len(np.unique(size[g])) > 1]
        return float(np.max(np.abs(np.array(slopes) - self.exponent))) if slopes else np.inf


@dataclass(frozen=True)
class Odd(Claim):
    """The change turns round with the sign of all these conditions together."""

    place: str
    of: tuple[str, ...]
    within: ClassVar[float] = 0.02
    sign: ClassVar[float] = -1.0

    def error(self, conditions: Columns, change: np.ndarray) -> float:
        here, there = _mirrored(conditions, self.of)
        if not len(here):
            return np.inf
        return float(np.abs(change[there] - self.sign * change[here]).max() / np.abs(change).max())


@dataclass(frozen=True)
class Even(Odd):
    """The change stays the same when all these conditions turn their sign."""

    sign: ClassVar[float] = 1.0


@dataclass(frozen=True)
class Orders(Claim):
    """Over a turn the change has these orders alone."""

    place: str
    orders: tuple[int, ...]
    within: ClassVar[float] = 0.02

    def error(self, conditions: Columns, change: np.ndarray) -> float:
        angle = conditions["angle_mech"]
        basis = np.column_stack([f(k * angle) for k in self.orders for f in (np.cos, np.sin)])
        left = change - basis @ np.linalg.lstsq(basis, change, rcond=None)[0]
        return float(np.abs(left).max() / np.abs(change).max())


@dataclass(frozen=True)
class Like(Claim):
    """The change is in proportion to a function of the conditions.

    law: conditions -> (n,)
    """

    place: str
    law: Callable[[Columns], np.ndarray]
    within: ClassVar[float] = 0.02

    def error(self, conditions: Columns, change: np.ndarray) -> float:
        shape = self.law(conditions)
        left = change - shape * (shape @ change) / (shape @ shape)
        return float(np.abs(left).max() / np.abs(change).max())


def names(claims: tuple[Claim, ...], place: str) -> bool:
    """Whether a claim speaks of the place."""
    return any(fnmatch(place, claim.place) for claim in claims)


def _groups(others: Columns, rows: np.ndarray) -> list[np.ndarray]:
    """Indices of the rows that agree in all other conditions."""
    keys = np.stack([np.zeros(len(rows)), *others.values()], axis=1)
    _, group = np.unique(keys, axis=0, return_inverse=True)
    return [np.flatnonzero(rows & (group.ravel() == g)) for g in np.unique(group[rows])]


def _slope(size: np.ndarray, change: np.ndarray) -> float:
    return float(np.polyfit(np.log(size), np.log(np.abs(change)), 1)[0])


def _mirrored(conditions: Columns, of: tuple[str, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Pairs of rows whose named conditions have the opposite sign and whose others are the same."""
    columns = {name: values for name, values in conditions.items() if name != "order"}
    plain = np.stack(list(columns.values()), axis=1)
    turned = np.stack([-values if name in of else values for name, values in columns.items()], axis=1)
    same = np.all(np.isclose(plain[None], turned[:, None], rtol=1e-12, atol=1e-12), axis=2)
    return np.nonzero(same)
