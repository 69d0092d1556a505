"""Conditions that were the same in all rows of a file and stand in campaign.toml in the place of a column."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from workbench.data.column_units import split_unit
from workbench.data.raw_table import Heading, RawTable
from workbench.data.schema import FILE, ColumnEntry, TableEntry
from workbench.errors import WorkbenchError


def with_constants(raw: RawTable, entry: TableEntry) -> tuple[RawTable, TableEntry]:
    """The file with a column for each of them, and their declaration as conditions where columns are declared.

    Raises:
        WorkbenchError: the file has such a column already.
    """
    if not entry.constants:
        return raw, entry
    headings = tuple(Heading(key, *split_unit(key)) for key in entry.constants)
    for heading in headings:
        _refuse_twice(raw, heading)
    columns = tuple(np.full(raw.rows, value) for value in entry.constants.values())
    raw = replace(raw, headings=(*raw.headings, *headings), columns=(*raw.columns, *columns), _known={})
    if entry.columns is None:
        return raw, entry
    declared = {key: ColumnEntry(role="condition") for key in entry.constants}
    return raw, entry.model_copy(update={"columns": {**entry.columns, **declared}})


def _refuse_twice(raw: RawTable, constant: Heading) -> None:
    found = next((h.written for h in raw.headings if h.name == constant.name), None)
    if found is not None:
        raise WorkbenchError(
            f"{raw.where}: {constant.written!r} is a constant in {FILE}, and the file has the column {found!r}; keep "
            "one."
        )
