"""Repeats that stand beside one another, in columns F1, F2, F3 of a file or in files of their own: read as if they
stood one below the other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import chain

import numpy as np

from workbench.data.columns import place_of
from workbench.data.raw_table import Heading, RawTable
from workbench.data.schema import ColumnEntry, TableEntry
from workbench.errors import WorkbenchError

NUMBER = Heading("number of the repeat", "repeat", "")


def stacked(raws: Sequence[RawTable], entry: TableEntry) -> tuple[RawTable, TableEntry]:
    """The rows of all repeats, and their declaration with a column that counts them; as they are where there is one.

    raws: of the file and of those that repeat it
    Raises:
        WorkbenchError: a column is not there, responses have unlike numbers of repeats, or a column counts them, too.
    """
    repeats = [repeat for raw in raws for repeat in _beside(raw, entry)]
    if len(repeats) == 1:
        return repeats[0], entry
    raw = _below(repeats)
    if _are_counted(raw, entry):
        raise WorkbenchError(f"{raw.where}: repeats stand beside one another and are counted by a column; keep one.")
    numbers = np.repeat(np.arange(float(len(repeats))), [repeat.rows for repeat in repeats])
    counted = replace(raw, headings=(*raw.headings, NUMBER), columns=(*raw.columns, numbers), _known={})
    if entry.columns is None:
        return counted, entry
    columns = {key: column.model_copy(update={"repeats": ()}) for key, column in entry.columns.items()}
    return counted, entry.model_copy(update={"columns": {**columns, NUMBER.written: ColumnEntry(role="repeat")}})


def _are_counted(raw: RawTable, entry: TableEntry) -> bool:
    if entry.columns is None:
        return any(heading.name == "repeat" for heading in raw.headings)
    return any(column.role == "repeat" for column in entry.columns.values())


def _beside(raw: RawTable, entry: TableEntry) -> list[RawTable]:
    """The file once for every repeat in its columns, with the readings of that one."""
    declared = entry.columns or {}
    if not any(column.repeats for column in declared.values()):
        return [raw]
    answers = {key: _places(raw, key, column) for key, column in declared.items() if column.role == "response"}
    counts = {key: len(places) for key, places in answers.items()}
    if len(set(counts.values())) > 1:
        listed = ", ".join(f"{key!r} {number}" for key, number in counts.items())
        raise WorkbenchError(
            f"{raw.where}: repeats that stand beside one another must be as many for every response; found {listed}."
        )
    first = [places[0] for places in answers.values()]
    return [_with_columns(raw, dict(zip(first, these))) for these in zip(*answers.values())]


def _places(raw: RawTable, key: str, column: ColumnEntry) -> list[int]:
    """Columns of a response, that of the first repeat first."""
    return [place_of(raw, raw.headings, heading, "columns") for heading in (column.from_ or key, *column.repeats)]


def _with_columns(raw: RawTable, held: dict[int, int]) -> RawTable:
    """With the cells of other columns. held: which, by place"""
    columns = (raw.columns[held.get(place, place)] for place in range(len(raw.columns)))
    return replace(raw, columns=tuple(columns), _known={})


def _below(repeats: Sequence[RawTable]) -> RawTable:
    """Rows of files with the same columns, one below the other.

    Raises:
        WorkbenchError: a file has other columns or another decimal sign than the first.
    """
    first = repeats[0]
    for other in repeats[1:]:
        if [h.written for h in other.headings] != [h.written for h in first.headings]:
            raise WorkbenchError(f"{other.where}: has other columns than {first.where}, which it is to repeat.")
        if other.decimal != first.decimal:
            raise WorkbenchError(f"{other.where}: has another decimal sign than {first.where}, which it is to repeat.")
    columns = [_joined([repeat.columns[place] for repeat in repeats]) for place in range(len(first.columns))]
    return replace(
        first,
        where=", ".join(dict.fromkeys(repeat.where for repeat in repeats)),
        columns=tuple(columns),
        lines=[line for repeat in repeats for line in repeat.lines],
        remarks=tuple(dict.fromkeys(chain.from_iterable(repeat.remarks for repeat in repeats))),
        _known={},
    )


def _joined(parts: Sequence[Sequence]) -> Sequence:
    """Cells of columns one below the other."""
    if all(isinstance(part, np.ndarray) for part in parts):
        return np.concatenate(parts)
    return [str(cell) for part in parts for cell in part]
