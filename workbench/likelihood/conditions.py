"""Readings where a model may have no answer in some rows, and what uncertain conditions make of their uncertainty."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from workbench.data.stack import Stack, rows_of
from workbench.data.table import Table
from workbench.errors import WorkbenchError
from workbench.models.model import Model

MOST = 1e-3  # of the range of a condition, to see how its own uncertainty acts
LEAST = 1e-7  # of its value: below, rounding is seen


def readings(model: Model, stack: Stack) -> np.ndarray:
    """Readings of a stack; NaN where the model has no steady state (n,)."""
    return stack.vector([_answers(model, table) for table in stack.tables])


def with_conditions(model: Model, stack: Stack, here: np.ndarray) -> np.ndarray:
    """u of every row with the uncertainty of its conditions, through the slope of this model (n,).

    here: its readings (n,)
    """
    variance = stack.u**2
    for number, table in enumerate(stack.tables):
        channels = [c for c in stack.channels if c.table == number and c.size]
        for name, u in table.condition_random.items() if channels else ():
            step = _step(table.conditions[name], u)
            ahead, behind = (_answers(model, _moved(table, name, side * step)) for side in (1.0, -1.0))
            for c in channels:
                slope = _slope(here[c.rows], ahead[c.response], behind[c.response], step)
                variance[c.rows] += (slope * u) ** 2
    return np.sqrt(variance)


def _step(condition: np.ndarray, u: np.ndarray) -> np.ndarray:
    """As large as the uncertainty of the row, where that is small: a range may span decades (rows,)."""
    most = MOST * (np.ptp(condition) or 1.0)
    return np.minimum(np.where(u > 0, np.maximum(u, LEAST * np.abs(condition)), most), most)


def _slope(here: np.ndarray, ahead: np.ndarray, behind: np.ndarray, step: np.ndarray) -> np.ndarray:
    """Central; to the one side that has an answer where the other has none; none where neither has."""
    one_sided = np.where(np.isfinite(ahead), ahead - here, here - behind) / step
    central = (ahead - behind) / (2 * step)
    return np.nan_to_num(np.where(np.isfinite(central), central, one_sided))


def _answers(model: Model, table: Table) -> Mapping[str, np.ndarray]:
    """Response columns, the rows without an answer found by halves."""
    try:
        return model.answers(table)
    except WorkbenchError:
        if table.rows == 1:
            return {name: np.array([np.nan]) for name in table.responses}
    middle = table.rows // 2
    halves = [_answers(model, rows_of(table, part)) for part in (slice(None, middle), slice(middle, None))]
    return {name: np.concatenate([half[name] for half in halves]) for name in table.responses}


def _moved(table: Table, name: str, step: np.ndarray) -> Table:
    return replace(table, conditions={**table.conditions, name: table.conditions[name] + step})
