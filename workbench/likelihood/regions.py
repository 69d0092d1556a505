"""Regions of operating conditions: blocks for cross-validation, and one region that is sealed until the end.

A repeat of a station, or another angle of the same revolution, says nothing about prediction. A speed, a current or an
amplitude that no fit has seen does. Where a campaign varies nothing but the angle there is no such region.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from workbench.data.column_units import for_people
from workbench.data.kinds import KINDS
from workbench.data.repeats import matched_rows
from workbench.data.table import Table

SAME_SETTING = 0.02  # relative difference of two readings of a condition that were meant to be one setting
BLOCKS = 5  # of a table, each left out once
SEALED_SHARE = 0.2  # of the rows of the tables concerned that are sealed, where settings allow
LEAST_SETTINGS = 3  # of a condition: with one sealed, two are left to see a slope
ZERO_CELSIUS = 273.15  # K; what is near in temperature is so in kelvin
_AXES = ("angle", "phase", "time")  # no operating condition: a place in the revolution, or when it was read
_PHASE_CURRENTS = ("i_a", "i_b", "i_c")
CURRENT = "current"  # amplitude of the phase currents


@dataclass(frozen=True, eq=False)
class Condition:
    """One operating condition of a table.

    size: SI (n,), temperatures in kelvin, without its sign where it has both: a speed is one whichever way it turns
    signed: whether it has both signs;  largest: of all conditions of its quantity, to tell a setting from a zero that
    scatters
    """

    name: str
    size: np.ndarray
    signed: bool
    largest: float

    @property
    def varies(self) -> bool:
        return bool(np.ptp(self.size) > SAME_SETTING * self.largest)

    @cached_property
    def settings(self) -> np.ndarray:
        """Number of the setting of each row, counted from the smallest; every value its own where it was swept (n,)."""
        values, place = np.unique(self.size, return_inverse=True)
        new = np.diff(values) > SAME_SETTING * np.abs(values[1:])
        number = np.concatenate([[0], np.cumsum(new)])
        edges = np.flatnonzero(np.diff(number, prepend=-1))
        widths = np.maximum.reduceat(values, edges) - values[edges]
        swept = (widths > 2 * SAME_SETTING * np.abs(values[edges])) & (widths > SAME_SETTING * self.largest)
        return place if swept.any() else number[place]

    @property
    def count(self) -> int:
        """Of settings."""
        return int(self.settings.max()) + 1


def conditions_of(table: Table) -> tuple[Condition, ...]:
    """Operating conditions that vary in a table, natural axes of its kind first."""
    columns = _columns(table)
    largest: dict[str, float] = {}
    for name, values in columns.items():
        largest[_quantity(name)] = max(largest.get(_quantity(name), 0.0), float(np.abs(values).max(initial=0.0)))
    found = [_condition(name, values, largest[_quantity(name)]) for name, values in columns.items()]
    axes = [axis.split("_")[0] if "?" in axis else axis for axis in KINDS[table.kind].axes]
    rank = {name: axes.index(key) for name in columns for key in (_axis(name),) if key in axes}
    varying = [c for c in found if table.rows and c.varies]
    return tuple(sorted(varying, key=lambda c: rank.get(c.name, len(axes))))


def _columns(table: Table) -> Mapping[str, np.ndarray]:
    """Conditions without places in the revolution; three phase currents are one, their amplitude."""
    kept = {n: _kelvin(n, v) for n, v in table.conditions.items() if not any(axis in n for axis in _AXES)}
    if not all(name in kept for name in _PHASE_CURRENTS):
        return kept
    amplitude = np.sqrt(2 / 3 * sum(kept[name] ** 2 for name in _PHASE_CURRENTS))
    return {CURRENT: amplitude, **{n: v for n, v in kept.items() if n not in _PHASE_CURRENTS}}


def _kelvin(name: str, values: np.ndarray) -> np.ndarray:
    return values + ZERO_CELSIUS if name.endswith("_T") else values


def _quantity(name: str) -> str:
    """What is measured in the same unit: i_d and i_q are both currents."""
    return name if name.endswith("_T") else name.split("_")[0]


def _axis(name: str) -> str:
    """How the axes of a kind name it: all currents are i."""
    return "i" if name == CURRENT or name.startswith("i_") else name


def _condition(name: str, values: np.ndarray, largest: float) -> Condition:
    signed = bool((values > 0).any() and (values < 0).any())
    return Condition(name, np.abs(values) if signed else values, signed, largest)


# ---- blocks ---------------------------------------------------------------------------------------------------------


def blocks_of(table: Table, most: int = BLOCKS) -> np.ndarray:
    """Block of operating conditions of each row of a table, 0, 1, ... from low to high (n,).

    Blocks are ranges of the dominating condition, the first natural axis that has several settings, of about as many
    rows each; all repeats of a station are in one. All rows are in block 0 where nothing but the angle varies.

    most: blocks at most
    """
    varying = [c for c in conditions_of(table) if c.count > 1]
    if not varying:
        return np.zeros(table.rows, dtype=int)
    condition = varying[0]
    return _together(table, _shared_out(condition.settings, min(most, condition.count)))


def _shared_out(settings: np.ndarray, blocks: int) -> np.ndarray:
    """Consecutive settings in so many blocks of about as many rows, none of them empty (n,)."""
    rows = np.bincount(settings)
    middle = (np.cumsum(rows) - 0.5 * rows) / rows.sum()
    wanted = np.floor(middle * blocks).astype(int)
    return np.unique(wanted, return_inverse=True)[1][settings]


def _together(table: Table, blocks: np.ndarray) -> np.ndarray:
    """The same with all repeats of a station in the block of the first."""
    stations = matched_rows(table)
    if stations is None:
        return blocks
    joined = blocks.copy()
    joined[stations] = blocks[stations[:, :1]]
    return joined


# ---- the sealed region ----------------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class SealedRegion:
    """The rows of each table that no fit may see, and in words where they lie; no words where there is no region.

    masks: one a table (n,);  words: "velocity above 0.42 m/s"
    """

    masks: tuple[np.ndarray, ...]
    words: str = ""


def sealed_region(tables: Sequence[Table]) -> SealedRegion:
    """The edge of the range of one condition of a campaign: the highest settings of the condition that dominates most
    rows, in all tables where it has three settings or more.

    About a fifth of the rows of these tables, at least one setting, and never the majority. Deterministic.
    """
    found = [region for name in _dominating(tables) for region in (_edge(name, tables),) if region is not None]
    if not found:
        return SealedRegion(tuple(np.zeros(table.rows, dtype=bool) for table in tables))
    return max(found, key=lambda region: sum(int(mask.sum()) for mask in region.masks))


def _dominating(tables: Sequence[Table]) -> list[str]:
    """The first condition with enough settings of every table."""
    names = (next((c.name for c in conditions_of(t) if c.count >= LEAST_SETTINGS), None) for t in tables)
    return [name for name in dict.fromkeys(names) if name is not None]


def _edge(name: str, tables: Sequence[Table]) -> SealedRegion | None:
    """The region above a bound of a condition, or none where settings do not allow one."""
    concerned = [
        next((c for c in conditions_of(t) if c.name == name and c.count >= LEAST_SETTINGS), None) for t in tables
    ]
    bound = _bound([c for c in concerned if c is not None])
    if bound is None:
        return None
    masks = tuple(
        np.zeros(t.rows, dtype=bool) if c is None else _together(t, (c.size > bound).astype(int)).astype(bool)
        for t, c in zip(tables, concerned)
    )
    signed = any(c.signed for c in concerned if c is not None)
    return SealedRegion(masks, _words(name, bound, signed))


def _bound(conditions: Sequence[Condition]) -> float | None:
    """Lowest bound above which lies no more than the share to be sealed, at least one setting, and below which every
    table keeps two settings and most of its rows."""
    values = np.unique(np.concatenate([c.size for c in conditions]))
    gaps = np.flatnonzero(np.diff(values) > SAME_SETTING * np.abs(values[1:]))
    swept = any(c.count > len(gaps) + 1 for c in conditions)
    places = np.arange(len(values) - 1) if swept else gaps
    bounds = 0.5 * (values[places] + values[places + 1])
    allowed = [b for b in bounds if _sealed(conditions, b) and all(_leaves_enough(c, b) for c in conditions)]
    small = [b for b in allowed if _share(conditions, b) <= SEALED_SHARE]
    return float(min(small)) if small else float(max(allowed)) if allowed else None


def _share(conditions: Sequence[Condition], bound: float) -> float:
    return sum(int((c.size > bound).sum()) for c in conditions) / sum(len(c.size) for c in conditions)


def _sealed(conditions: Sequence[Condition], bound: float) -> bool:
    return any((c.size > bound).any() for c in conditions)


def _leaves_enough(c: Condition, bound: float) -> bool:
    below = c.size <= bound
    return bool(2 * below.sum() > len(below)) and len(np.unique(c.settings[below])) >= LEAST_SETTINGS - 1


def _words(name: str, bound: float, signed: bool) -> str:
    unit, factor = ("A", 1.0) if name == CURRENT else for_people(name)
    shown = bound - ZERO_CELSIUS if name.endswith("_T") else factor * bound
    either = " either way" if signed else ""
    return f"{name.replace('_', ' ')} above {shown:{'.0f' if abs(shown) >= 1000 else '.3g'}} {unit}".rstrip() + either
