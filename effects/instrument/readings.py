"""Gain, offset and drift of an instrument; a concrete effect says which columns it reads.

Columns are named by patterns: "v_*" is every phase voltage. ``readings`` are responses that the instrument shows,
``inverse_readings`` responses computed by dividing by what it shows, ``set_points`` conditions that were read with it.
"""

from __future__ import annotations

from collections.abc import Callable
from fnmatch import fnmatch
from functools import cache
from itertools import accumulate
from typing import ClassVar

import numpy as np

from effects.base import Columns, Effect, InstrumentEffect

PHASES = "abc"


def changed(columns: Columns, patterns: tuple[str, ...], change: Callable[[np.ndarray], np.ndarray]) -> Columns:
    """The columns with those that match a pattern changed."""
    hit = _named(tuple(columns), patterns)
    return {**columns, **{name: change(columns[name]) for name in hit}}


def one_a_phase(cls: type[Effect]) -> tuple[Effect, ...]:
    """The same effect on the channel of each of the three phases, as alternatives."""
    return tuple(cls(phase=x) for x in PHASES)


@cache
def _named(columns: tuple[str, ...], patterns: tuple[str, ...]) -> tuple[str, ...]:
    """The columns that match a pattern; few tables, asked thousands of times in a fit."""
    return tuple(name for name in columns if any(fnmatch(name, pattern) for pattern in patterns))


class ReadingGain(InstrumentEffect):
    """Reading = (1 + gain) * truth."""

    readings: ClassVar[tuple[str, ...]]
    inverse_readings: ClassVar[tuple[str, ...]] = ()
    set_points: ClassVar[tuple[str, ...]] = ()

    def on_condition(self, conditions: Columns, kind: str) -> Columns:
        return changed(conditions, self.set_points, lambda read: read / (1.0 + self.gain))

    def on_reading(self, response: Columns, conditions: Columns, kind: str) -> Columns:
        shown = changed(response, self.readings, lambda truth: truth * (1.0 + self.gain))
        return changed(shown, self.inverse_readings, lambda truth: truth / (1.0 + self.gain))


class ReadingOffset(InstrumentEffect):
    """Reading = truth + offset."""

    readings: ClassVar[tuple[str, ...]]

    def on_reading(self, response: Columns, conditions: Columns, kind: str) -> Columns:
        return changed(response, self.readings, lambda truth: truth + self.offset)


class ReadingDrift(InstrumentEffect):
    """Reading = truth + drift * order; order runs from 0 to 1 through each scan, before which one zeroes."""

    readings: ClassVar[tuple[str, ...]]

    def on_reading(self, response: Columns, conditions: Columns, kind: str) -> Columns:
        return changed(response, self.readings, lambda truth: truth + self.drift * conditions["order"])


class ReadingHysteresis(InstrumentEffect):
    """Reading = truth - level z;  z goes towards the sign of each change of the truth over a ``width`` of it:

    z_k = s + (z_(k-1) - s) exp(-|change| / width),  s = sign(change);  z = 0 where a scan begins (Dahl 1968)
    """

    readings: ClassVar[tuple[str, ...]]

    def on_reading(self, response: Columns, conditions: Columns, kind: str) -> Columns:
        if self.is_null:
            return response
        order = conditions["order"]
        return changed(response, self.readings, lambda truth: truth - self.level * self.loop(truth, order))

    def loop(self, truth: np.ndarray, order: np.ndarray) -> np.ndarray:
        """z of each row (n,)."""
        change = np.diff(truth, prepend=truth[:1])
        kept, sign = np.where(order > 0.0, np.exp(-np.abs(change) / self.width), 0.0), np.sign(change)
        towards = np.where(order > 0.0, sign * (1.0 - kept), 0.0)
        return np.array(list(accumulate(zip(kept, towards), _next, initial=0.0))[1:])


def _next(z: float, row: tuple[float, float]) -> float:
    kept, towards = row
    return z * kept + towards
