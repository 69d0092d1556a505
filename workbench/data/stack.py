"""All readings of a campaign as one vector, channel after channel; a channel is one response column of one table."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from workbench.data.table import Table


@dataclass(frozen=True, eq=False)
class Channel:
    """name: "force_velocity.force";  table, response: what it is;  rows: its place in the vector"""

    name: str
    table: int
    response: str
    rows: slice
    unit: str
    scale: float

    @property
    def size(self) -> int:
        return self.rows.stop - self.rows.start


@dataclass(frozen=True, eq=False)
class Stack:
    """tables: with the rows that are used;  y, u: reading and declared random uncertainty, SI (n,)

    left_open: what the model cannot say of the readings of a channel, one standard deviation of each, SI (n, L)
    """

    tables: tuple[Table, ...]
    channels: tuple[Channel, ...]
    y: np.ndarray
    u: np.ndarray
    left_open: np.ndarray

    def vector(self, answers: Sequence[Mapping[str, np.ndarray]]) -> np.ndarray:
        """Response columns of every table as one vector (n,)."""
        return np.concatenate([answers[c.table][c.response] for c in self.channels]) if self.channels else np.zeros(0)

    @property
    def size(self) -> int:
        return len(self.y)

    @cached_property
    def sizes(self) -> np.ndarray:
        """Rows of every channel (channels,)."""
        return np.array([c.size for c in self.channels], dtype=int)

    def by_channel(self, values: np.ndarray) -> np.ndarray:
        """Sums over the rows (n,) of every channel (channels,)."""
        return np.bincount(self._channel, values, len(self.channels))

    @cached_property
    def _channel(self) -> np.ndarray:
        """Number of the channel of every row (n,)."""
        return np.repeat(np.arange(len(self.channels)), self.sizes)


def stacked(tables: Sequence[Table]) -> Stack:
    """The stack of all tables that have rows."""
    channels, start = [], 0
    for number, table in enumerate(tables):
        for response in table.responses.values():
            rows = slice(start, start + table.rows)
            name = f"{Path(table.file).stem}.{response.name}"
            channels.append(Channel(name, number, response.name, rows, response.unit, response.scale))
            start = rows.stop
    responses = [table.responses[c.response] for c in channels for table in [tables[c.table]]]
    y = np.concatenate([r.values for r in responses]) if responses else np.zeros(0)
    u = np.concatenate([r.random for r in responses]) if responses else np.zeros(0)
    return Stack(tuple(tables), tuple(channels), y, u, np.zeros((len(y), 0)))


def part_of(stack: Stack, masks: Sequence[np.ndarray]) -> Stack:
    """The chosen rows (one mask a table) of a stack, what is known of them as it is in the whole."""
    rows = rows_in(stack, masks)
    part = stacked([rows_of(table, mask) for table, mask in zip(stack.tables, masks)])
    return replace(part, u=stack.u[rows], left_open=stack.left_open[rows])


def rows_in(stack: Stack, masks: Sequence[np.ndarray]) -> np.ndarray:
    """One mask a table -> one of the rows of the stack (n,)."""
    return np.concatenate([masks[c.table] for c in stack.channels])


def rows_of(table: Table, chosen: np.ndarray) -> Table:
    """The table with the chosen rows only (a mask or row numbers), in their order."""
    responses = {
        name: replace(r, values=r.values[chosen], random=r.random[chosen]) for name, r in table.responses.items()
    }
    return replace(
        table,
        conditions={name: v[chosen] for name, v in table.conditions.items()},
        responses=responses,
        scan=table.scan[chosen],
        repeat=table.repeat[chosen],
        held_out=table.held_out[chosen],
        condition_random={name: v[chosen] for name, v in table.condition_random.items()},
        lines=table.lines[chosen] if len(table.lines) else table.lines,
    )


GOLDEN = 0.5 * (5**0.5 - 1)  # its multiples modulo 1 never keep step with a pattern in the rows


def thinned(table: Table, most: int) -> Table:
    """At most so many rows: one of each block of rows, at places that keep step with no cycle of the measurement.

    Where all repeats are equally long the same places of each are kept, so that they can still be compared.
    """
    if table.rows <= most:
        return table
    repeats = [np.flatnonzero(table.repeat == r) for r in np.unique(table.repeat)]
    if len({len(rows) for rows in repeats}) > 1:
        repeats = [np.arange(table.rows)]
    length = len(repeats[0])
    step = -(-length * len(repeats) // most)
    blocks = np.arange(length // step)
    places = blocks * step + (np.mod(blocks * GOLDEN, 1.0) * step).astype(int)
    return rows_of(table, np.sort(np.concatenate([rows[places] for rows in repeats])))
