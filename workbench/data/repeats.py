"""What belongs together in a table: rows of one scan that follow, and readings of several repeats at one place."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from workbench.data.table import Table

NEAR = 0.02  # of the range of the conditions: readings that are no further apart were taken at the same place
LOGGED_WITHIN = 10.0  # K; a temperature that varies by less was logged, not set, and says nothing of the place
SAME_WARMTH = 25.0  # K that readings at one place differ by, where their temperature was logged and varies by more


def follows(table: Table) -> np.ndarray:
    """True where a row continues the scan of the row before (n,)."""
    same = np.zeros(table.rows, dtype=bool)
    same[1:] = (table.scan[1:] == table.scan[:-1]) & (table.repeat[1:] == table.repeat[:-1])
    return same


def matched_rows(table: Table) -> np.ndarray | None:
    """Row numbers (stations, repeats) of readings taken at the same conditions, None where there is one repeat."""
    repeats = [np.flatnonzero(table.repeat == r) for r in np.unique(table.repeat)]
    if len(repeats) < 2:
        return None
    if len({len(rows) for rows in repeats}) == 1 and _alike(table, repeats) and not _shifted(table, repeats):
        return np.array(repeats).T
    return _nearest(table, repeats)


def places_of(table: Table) -> np.ndarray:
    """Conditions over their range (n, c); temperatures that were only logged by what they may differ by."""
    varied = {n: v for n, v in table.conditions.items() if np.ptp(v) > (LOGGED_WITHIN if n.endswith("_T") else 0.0)}
    columns = {n: _spread(v) / np.ptp(_spread(v)) for n, v in varied.items()}
    warm = [name for name in columns if name.endswith("_T")]
    if warm and _tell_apart(table, [column for name, column in columns.items() if name not in warm]):
        columns |= {name: varied[name] * NEAR / SAME_WARMTH for name in warm}
    return np.array(list(columns.values())).T if columns else np.zeros((table.rows, 1))


def _tell_apart(table: Table, columns: list[np.ndarray]) -> bool:
    """Whether conditions without temperatures tell all rows of a repeat apart: then no temperature was set, but the
    device became warm as it was loaded, and warmer in the next repeat."""
    cells = np.array([table.repeat, *(np.round(column / NEAR) for column in columns)])
    return len(np.unique(cells, axis=1).T) == table.rows


def _spread(values: np.ndarray) -> np.ndarray:
    """The values, by their logarithm where they span decades: 1e6 ohm for open terminals leaves 0.3 and 1 ohm apart."""
    return np.log(values) if values.min() > 0 and values.max() > 1e3 * values.min() else values


def _alike(table: Table, repeats: list[np.ndarray]) -> bool:
    """True when the k-th rows of all repeats were taken at the same place, but for what the readings scatter."""
    places = places_of(table)
    apart = np.median(np.abs(places[repeats[0]] - places[repeats[-1]]), axis=0)
    between = np.median(np.abs(places - np.median(places, axis=0)), axis=0) + 1e-12
    return bool((apart < 0.2 * between).mean() >= 0.5)


def _shifted(table: Table, repeats: list[np.ndarray]) -> bool:
    """True where most of the k-th rows of all repeats stand at the very same place, and some do not: each repeat has
    lost another row, and those between are out of step."""
    places = places_of(table)
    apart = np.max([np.linalg.norm(places[rows] - places[repeats[0]], axis=1) for rows in repeats], axis=0)
    return bool(np.median(apart) < NEAR < apart.max())


def near_rows(table: Table, rows: np.ndarray) -> np.ndarray:
    """Of every repeat the reading at the place of each of some rows, which stand for themselves (rows, repeats); -1
    where it has none."""
    places, number = places_of(table), table.repeat[rows]
    found = np.empty((len(rows), len(np.unique(table.repeat))), dtype=int)
    for column, repeat in enumerate(np.unique(table.repeat)):
        there = np.flatnonzero(table.repeat == repeat)
        apart, nearest = cKDTree(places[there]).query(places[rows])
        found[:, column] = np.where(number == repeat, rows, np.where(apart < NEAR, there[nearest], -1))
    return found


def _nearest(table: Table, repeats: list[np.ndarray]) -> np.ndarray | None:
    """Stations by nearest conditions; a row of the first repeat without near partners in all others is left out."""
    stations = near_rows(table, repeats[0])
    stations = stations[(stations >= 0).all(axis=1)]
    return stations if len(stations) >= 2 else None
