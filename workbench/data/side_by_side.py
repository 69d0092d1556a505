"""Repeats that stand beside one another in a file, F1, F2, F3: read as if they stood one below the other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import chain

import numpy as np

from workbench.data.columns import place_of
from workbench.data.raw_table import Heading, RawTable
from workbench.data.schema import ColumnEntry, TableEntry
from workbench.errors import WorkbenchError

NUMBER = "number of the column"  # heading of the repeats that are made


def stacked(raw: RawTable, entry: TableEntry) -> tuple[RawTable, TableEntry]:
    """The file with all its rows once for every repeat, and its declaration with a column that counts them; both as
    they are where no column has ``repeats``.

    Raises:
        WorkbenchError: a column is not there, responses have unlike numbers of repeats, or a column counts them, too.
    """
    declared = entry.columns or {}
    if not any(column.repeats for column in declared.values()):
        return raw, entry
    beside = {key: _places(raw, key, column) for key, column in declared.items() if column.role == "response"}
    count = _count(raw, beside)
    if any(column.role == "repeat" for column in declared.values()):
        raise WorkbenchError(f"{raw.where}: repeats stand beside one another and are counted by a column; keep one.")
    held = {places[0]: places for places in beside.values()}
    columns = [_below([raw.columns[k] for k in held.get(place, [place] * count)]) for place in range(len(raw.columns))]
    number = np.repeat(np.arange(count, dtype=float), raw.rows)
    longer = replace(
        raw,
        headings=(*raw.headings, Heading(NUMBER, NUMBER, "")),
        columns=(*columns, number),
        lines=list(raw.lines) * count,
        _known={},
    )
    single = {key: column.model_copy(update={"repeats": ()}) for key, column in declared.items()}
    return longer, entry.model_copy(update={"columns": {**single, NUMBER: ColumnEntry(role="repeat")}})


def _places(raw: RawTable, key: str, column: ColumnEntry) -> list[int]:
    """Columns of a response, that of the first repeat first."""
    return [place_of(raw, raw.headings, heading, "columns") for heading in (column.from_ or key, *column.repeats)]


def _count(raw: RawTable, beside: dict[str, list[int]]) -> int:
    counts = {key: len(places) for key, places in beside.items()}
    if len(set(counts.values())) > 1:
        listed = ", ".join(f"{key!r} {number}" for key, number in counts.items())
        raise WorkbenchError(
            f"{raw.where}: repeats that stand beside one another must be as many for every response; found {listed}."
        )
    return next(iter(counts.values()))


def _below(parts: Sequence[Sequence]) -> Sequence:
    """Cells of columns one below the other."""
    if all(isinstance(part, np.ndarray) for part in parts):
        return np.concatenate(parts)
    return list(chain.from_iterable(map(_cells, parts)))


def _cells(part: Sequence) -> Sequence:
    return [str(number) for number in part] if isinstance(part, np.ndarray) else part
