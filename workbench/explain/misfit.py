"""How badly the readings of a table miss the nominal model, for many readings of its columns at once.

What a device really does may differ from its drawing by something nobody knows the size of, so each channel counts as
PIECES independent pieces of a curve whose misfit has an unknown scale. Integrated over that scale, in the unit of the
file,

    ln L = - sum over channels n_c / 2 ln( sum w (D - S/f)^2 + a^2 sum w (S/f)^2 ) / sum w D^2

D: reading;  S/f: what it should have been if true = f * reading;  w: 1/u^2;  a: what a device may always be off by
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from workbench.data.conventions import ANGLE
from workbench.data.stack import thinned
from workbench.data.table import Table, Tolerance
from workbench.errors import WorkbenchError
from workbench.models.model import Model

PIECES = 12  # independent pieces of the curve of a channel; a physical effect is smooth over the conditions
ALLOWANCE = 0.05  # of the reading, that a device may be off by without any convention being suspected
ROUGH_WITH_CURRENT = 0.15  # what proportion leaves of fields with current, see ``models.machine.rough``
MOST_ALLOWED = 0.3  # with the declared tolerances
MOST_ROWS = 160  # of a table that are looked at
LARGER = 3.0  # times what the model says, that a reading may be before it is strange
STRANGE, MOST_STRANGE = 2.0, 10.0  # nats for each power of e beyond, and at most
TINY = 1e-12


@dataclass(frozen=True, eq=False)
class Sums:
    """Of r channels at g offsets of the angle: A = sum w D^2 (r,), B = sum w D S, C = sum w S^2 (g, r, r).

    pieces: of each channel (r,);  allowed: share of the model that it may be off by (r,)
    """

    names: tuple[str, ...]
    a: np.ndarray
    b: np.ndarray
    c: np.ndarray
    pieces: np.ndarray
    allowed: np.ndarray

    def log_likelihood(self, holds: np.ndarray, gain: np.ndarray) -> np.ndarray:
        """ln L (g, o) when channel j holds the readings of model column holds[o, j], gain[o, j] times too large."""
        fit = -0.5 * np.sum(self.pieces * np.log(self.squares(holds, gain) + TINY), axis=2)
        return fit - self._strange(holds, gain)

    def _strange(self, holds: np.ndarray, gain: np.ndarray) -> np.ndarray:
        """Nats (g, o) for readings that are far larger than all that the model says: no effect is that large."""
        c = gain**2 * self.c[:, np.arange(len(self.names)), holds]
        larger = np.log(np.maximum(self.a / (LARGER**2 * c + TINY * self.a), 1.0)) * (c > 0)
        return np.minimum(STRANGE * larger, MOST_STRANGE).sum(axis=2)

    def errors(self, holds: np.ndarray, gain: np.ndarray) -> np.ndarray:
        """Misfit of each channel relative to its readings at the best offset of the angle, nothing allowed (o, r)."""
        bare = np.sqrt(replace(self, allowed=0 * self.allowed).squares(holds, gain))
        best = self.log_likelihood(holds, gain).argmax(axis=0)
        return bare[best, np.arange(len(holds))]

    def squares(self, holds: np.ndarray, gain: np.ndarray) -> np.ndarray:
        """Square of the misfit of each channel relative to its readings, with what is allowed (g, o, r)."""
        j = np.arange(len(self.names))
        b, c = self.b[:, j, holds], self.c[:, j, holds]
        allowed = 1 + self.allowed[holds] ** 2
        return np.maximum(self.a - 2 * gain * b + gain**2 * allowed * c, 0.0) / self.a

    def gains(self, holds: np.ndarray, sign: np.ndarray, members: np.ndarray) -> float:
        """By how much some channels read more than the model, best offset of the angle."""
        j = np.flatnonzero(members)
        b, c = self.b[:, j, holds[j]] * sign[j] / self.a[j], self.c[:, j, holds[j]] / self.a[j]
        best = int(np.argmax(b.sum(1) / np.sqrt(c.sum(1) + TINY)))
        return float(b[best].sum() / (c[best].sum() + TINY))


def sums(model: Model, table: Table, offsets: np.ndarray, allowed: np.ndarray, most: int = MOST_ROWS) -> Sums:
    """The sums of a table; offsets: true angle = reading - offset [rad] (g,);  most: rows that are looked at."""
    table = thinned(table, most)
    names = tuple(table.responses)
    d = np.array([r.values for r in table.responses.values()])
    w = 1 / np.array([r.random for r in table.responses.values()]) ** 2
    s = predicted(model, table, offsets)
    a = np.maximum(np.sum(w * d**2, axis=1), TINY)
    b, c = np.einsum("jn,gkn->gjk", w * d, s), np.einsum("jn,gkn->gjk", w, s**2)
    repeats = max(len(np.unique(table.repeat)), 1)
    pieces = np.full(len(names), min(PIECES, max(table.rows // repeats, 1)), dtype=float)
    return Sums(names, a, b, c, pieces, allowed)


def predicted(model: Model, table: Table, offsets: np.ndarray) -> np.ndarray:
    """Readings of the model (g, r, n); nothing at all where it has no answer."""
    asked = _many(table, offsets)
    shape = (len(offsets), len(table.responses), table.rows)
    try:
        with np.errstate(all="ignore"):  # a wrong reading may ask for what no machine does
            answers = model.answers(asked)
        found = np.array([np.broadcast_to(answers[n], asked.rows) for n in table.responses])
    except (WorkbenchError, ArithmeticError, KeyError, ValueError):
        return np.zeros(shape)
    found = np.nan_to_num(found, nan=0.0, posinf=0.0, neginf=0.0)
    return _passive(found.reshape(len(table.responses), len(offsets), table.rows).swapaxes(0, 1), table)


def _many(table: Table, offsets: np.ndarray) -> Table:
    if ANGLE not in table.conditions:
        return table
    tiled = {n: np.tile(v, len(offsets)) for n, v in table.conditions.items()}
    tiled[ANGLE] = (table.conditions[ANGLE] - offsets[:, None]).ravel()
    rows = {n: np.tile(getattr(table, n), len(offsets)) for n in ("scan", "repeat", "held_out")}
    return replace(table, conditions=tiled, lines=np.zeros(0, dtype=int), **rows)


def _passive(found: np.ndarray, table: Table) -> np.ndarray:
    """What a model says nothing about, the drag, takes power all the same."""
    moving = table.conditions.get("speed", table.conditions.get("velocity"))
    if table.kind != "drag" or moving is None or np.any(found):
        return found
    size = np.array([np.abs(r.values) for r in table.responses.values()])
    return np.broadcast_to(size * np.sign(moving), found.shape)


def allowances(model: Model, table: Table, tolerances: tuple[Tolerance, ...]) -> np.ndarray:
    """What the device may be off by in each channel, relative: ALLOWANCE and the declared tolerances (r,)."""
    table, here = thinned(table, MOST_ROWS), np.zeros(1)
    nominal = predicted(model, table, here)[0]
    loaded = model.base.is_expansion and any(name.startswith("i_") for name in table.conditions)
    square = np.full(len(nominal), ROUGH_WITH_CURRENT**2 if loaded else ALLOWANCE**2)
    for tolerance in () if model.base.is_expansion else tolerances:
        moved = replace(model, design=model.base.with_tolerance(model.design, tolerance, 1.0))
        change = predicted(moved, table, here)[0] - nominal
        square = square + np.sum(change**2, axis=1) / (np.sum(nominal**2, axis=1) + TINY)
    return np.minimum(np.sqrt(square), MOST_ALLOWED)
