"""What looks wrong in a table before any model is asked: few rows, stuck or copied columns, a clock that runs
backwards. Nothing is left out for it; each is one sentence."""

from __future__ import annotations

from fnmatch import fnmatch

import numpy as np

from workbench.data.kinds import KINDS
from workbench.data.table import Table

FEW_ROWS = 12  # below this a table says little; the campaign says so
FALSE_ALARM = 1e-3  # chance that a column of a sound sensor is called stuck
LONG_RUN = 0.05  # share of the rows that a run of equal readings must reach to be called stuck


def suspicions(table: Table) -> list[str]:
    """Sentences about a table."""
    found = []
    for check in (_few, _same_in_every_row, _stuck, _copied_columns, _still, _backwards):
        found += check(table)
    return [f"{table.file}: {words}" for words in found]


def _few(table: Table) -> list[str]:
    return [f"only {table.rows} rows; its noise and its residuals say little"] if table.rows < FEW_ROWS else []


def _same_in_every_row(table: Table) -> list[str]:
    return [
        f"{name} has the same value in every row; is it stuck?"
        for name, response in table.responses.items()
        if table.rows > 2 and np.ptp(response.values) == 0
    ]


def _stuck(table: Table) -> list[str]:
    """Long runs of readings that are equal to the last digit, which the other readings make unlikely."""
    found = []
    for name, response in table.responses.items():
        same = (np.diff(response.values) == 0) & (np.diff(table.scan) == 0)
        start, length = _longest_run(same)
        others = (same.sum() - length + 1) / max(len(same) - length + 1, 1)
        unlikely = len(same) * others**length < FALSE_ALARM
        if unlikely and length >= max(4, LONG_RUN * table.rows) and np.ptp(response.values) > 0:
            found.append(
                f"{name} has the same value in {length + 1} rows from line {int(table.lines[start])} on; is it stuck?"
            )
    return found


def _longest_run(same: np.ndarray) -> tuple[int, int]:
    """Start and length of the longest run of True."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], same.astype(int), [0]])))
    starts, lengths = edges[::2], edges[1::2] - edges[::2]
    return (int(starts[np.argmax(lengths)]), int(lengths.max())) if lengths.size else (0, 0)


def _copied_columns(table: Table) -> list[str]:
    found, seen = [], {}
    for name, response in table.responses.items():
        content = response.values.tobytes()
        if content in seen and np.ptp(response.values) > 0:
            found.append(f"{seen[content]} and {name} are equal in every row; is one a copy of the other?")
        seen.setdefault(content, name)
    return found


def _still(table: Table) -> list[str]:
    """Nothing that the kind varies has been varied."""
    axes = [n for n in table.conditions if any(fnmatch(n, pattern) for pattern in KINDS[table.kind].axes)]
    if table.rows < FEW_ROWS or not axes or any(np.ptp(table.conditions[name]) > 0 for name in axes):
        return []
    return [f"{' and '.join(axes)} {'has' if len(axes) == 1 else 'have'} the same value in every row; stuck?"]


def _backwards(table: Table) -> list[str]:
    if "time" not in table.conditions:
        return []
    back = np.flatnonzero((np.diff(table.conditions["time"]) < 0) & (np.diff(table.scan) == 0))
    return [f"time runs backwards in line {int(table.lines[back[0] + 1])}"] if back.size else []
