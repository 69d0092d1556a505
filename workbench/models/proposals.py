"""Proposals of measurements with the instruments that a campaign shows to have.

The uncertainty of a reading is that of the same kind of table, else the least that a reading of the same quantity has.
Where nothing of a quantity was measured, nothing that needs it is proposed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from workbench.data.kinds import KINDS
from workbench.data.table import Table
from workbench.models.base import Option


def proposal(
    kind: str, words: str, conditions: Mapping[str, np.ndarray], responses: Sequence[str], tables: Sequence[Table]
) -> Option | None:
    """An option with the uncertainties of the tables' instruments; None where there is none for a response."""
    sizes = [uncertainty(kind, name, tables) for name in responses]
    if None in sizes:
        return None
    rows = len(next(iter(conditions.values())))
    random = {name: np.full(rows, size) for name, size in zip(responses, sizes)}
    return Option(kind, words, conditions, random, KINDS[kind].cost)


def uncertainty(kind: str, name: str, tables: Sequence[Table]) -> float | None:
    """Of one reading, SI; None where no instrument for it is known."""
    quantity = name.split("_")[0]
    found = [
        (table.kind != kind, float(np.median(response.random)))
        for table in tables
        for response in table.responses.values()
        if response.name.split("_")[0] == quantity
    ]
    return min(found)[1] if found else None
