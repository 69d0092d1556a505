"""What a file may mean by its columns: every reading of a table that is tried, and what each is believed to cost."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations
from math import log, pi, sqrt

import numpy as np

from units import DEGREE
from workbench.data.column_units import split_unit
from workbench.data.conventions import (
    ANGLE,
    KELVIN,
    LINES,
    AngleDirection,
    AngleUnit,
    Fix,
    InvertedColumns,
    LineVoltages,
    Offset,
    Scaled,
    ShiftedColumn,
    SwappedColumns,
    TemperatureScale,
    is_phase,
)
from workbench.data.table import Table

OVERWHELMING = 7.0  # nats, odds of 1000 to 1, by which the data must prefer each fix beyond what it is believed
COLDEST, HOTTEST = -80.0, 450.0  # degC, between which a column of temperatures reads, be it one of kelvins
UNBEARABLE = 240.0  # degC in every row: hotter than the insulation of windings bears (IEC 60085, class 220 and 250)
COMMON, USUAL, RARE = 4.0, 5.5, 7.5  # minus ln of how often a first file has this mistake
NEAR = 0.2  # of the logarithm of a factor, beyond which it is another one; effects reach 20 %
NEAR_TEN = 0.5  # the same for a power of ten, which no effect comes near
HAND_SET = 20 * DEGREE  # electrical, that a hand misses when it turns a rotor to its zero; less is an encoder's offset
SENSELESS = ("angle", "phase", "direction")  # quantities that no factor is looked for in
SIGNED = ("speed", "velocity", "i", "torque", "displacement", "v")


@dataclass(frozen=True)
class Nice:
    """A factor that has a name. value: true = value * reading"""

    value: float
    cost: float
    means: tuple[str, ...] = ("unit_factor",)


def _both(value: float, cost: float, *means: str) -> list[Nice]:
    return [Nice(v, cost, means or ("unit_factor",)) for v in (value, 1 / value)]


_TENS = [*_both(1e3, COMMON), *_both(1e6, RARE), *_both(10.0, USUAL), *_both(100.0, USUAL)]
_TWO = _both(2.0, USUAL)
_PEAK = _both(sqrt(2), COMMON, "rms_or_peak")
_LINE = _both(sqrt(3), COMMON, "line_or_phase")
_BOTH = [
    *_both(sqrt(6), USUAL, "line_or_phase", "rms_or_peak"),
    *_both(sqrt(1.5), RARE, "line_or_phase", "rms_or_peak"),
]
_POUND = _both(4.4482216, USUAL)  # N in a pound-force
_KILOGRAM = _both(9.80665, USUAL)  # N in a kilogram-force
_INCH = _both(0.11298483, USUAL)  # Nm in an inch-pound
_BY_QUANTITY: dict[str, list[Nice]] = {
    "v": _TENS + _TWO + _PEAK + _LINE + _BOTH,
    "i": _TENS + _TWO + _PEAK + _LINE,
    "power": _TENS + _TWO + _both(3.0, USUAL, "line_or_phase"),
    "torque": _TENS + _TWO + _KILOGRAM + _INCH,
    "force": _TENS + _TWO + _KILOGRAM + _POUND,
    "speed": _both(2 * pi / 60, COMMON) + _both(2 * pi, USUAL) + _both(60.0, USUAL),
    "velocity": _both(1e3, COMMON) + _both(100.0, USUAL) + _both(3.6, USUAL),
    "shunt": _TENS,
    "frequency": _both(2 * pi, COMMON) + _both(60.0, USUAL) + _both(1e3, USUAL),
    "amplitude": _both(1e3, COMMON) + _both(2.0, COMMON, "peak_to_peak") + _both(sqrt(2), RARE, "rms_or_peak"),
}
_SAME = {"voltage": "v", "current": "i", "re": "force", "im": "force", "damping": "force"}


def quantity(column: str) -> str:
    """v of v_a and v_ll, i of current."""
    first = column.split("_")[0]
    return _SAME.get(first, first)


def factors(column: str, pole_pairs: float | None) -> list[Nice]:
    """The factors that have a name in a column."""
    what = quantity(column)
    if what in SENSELESS or column.endswith("_T"):
        return []
    found = list(_BY_QUANTITY.get(what, _TENS + _TWO))
    if what == "speed" and pole_pairs and pole_pairs > 1:
        found += _both(pole_pairs, COMMON, "electrical_or_mechanical")
        found += _both(pole_pairs * 60 / (2 * pi), RARE, "electrical_or_mechanical", "unit_factor")
    return found


def factors_of_constant(key: str) -> list[Nice]:
    """The factors that have a name of a constant of the device. That of a resistance between two lines has none: a hot
    winding with weak magnets behind a rectifier looks like twice the resistance."""
    name, unit = split_unit(key)
    if name == "pole_pairs":
        return _both(2.0, USUAL, "poles")
    return _TENS if unit not in ("", "degC") else []


def nearest(column: str, value: float, pole_pairs: float | None, alone: bool) -> list[Nice]:
    """The factors with a name that are near a value, at most two.

    alone: one channel of several of its quantity, for which only another power of ten is believed
    """
    if not value > 0:
        return []
    known = _TENS if alone else factors(column, pole_pairs)
    near = [nice for nice in known if abs(log(nice.value / value)) < (NEAR_TEN if nice in _TENS else NEAR)]
    return sorted(near, key=lambda nice: abs(log(nice.value / value)))[:2]


# ---- readings of a table that need another answer of the model -----------------------------------------------------


def of_the_table(table: Table, pole_pairs: float | None, angles: dict[str, float]) -> list[tuple[Fix, float]]:
    """Fixes of single columns with what each costs; angles: what the angle may hold -> factor."""
    found = [*scales(table, pole_pairs), *_signs(table), *_exchanges(table), *_shifts(table), *_temperatures(table)]
    found += [(AngleUnit(table.file, what, f), COMMON) for what, f in angles.items() if abs(log(f)) > NEAR]
    found += [*power_flow(table), *_phases(table)]
    if ANGLE in table.conditions:
        found.append((AngleDirection(table.file), COMMON + 1.5))
    if set(LINES) <= set(table.responses):
        found.append((LineVoltages(table.file), COMMON))
    return found


def _groups(columns: Sequence[str]) -> list[tuple[str, ...]]:
    """Columns of one quantity together."""
    found: dict[str, list[str]] = {}
    for column in columns:
        found.setdefault(quantity(column), []).append(column)
    return [tuple(group) for group in found.values()]


def _asked(table: Table) -> list[str]:
    """Conditions that are not the same nothing in every row."""
    return [name for name, values in table.conditions.items() if np.any(values) and name != "direction"]


def scales(table: Table, pole_pairs: float | None) -> Iterator[tuple[Scaled, float]]:
    """Factors on conditions, with what each costs."""
    for group in _groups(_asked(table)):
        for nice in factors(group[0], pole_pairs):
            yield Scaled(table.file, group, nice.value, nice.means), nice.cost


def _signs(table: Table) -> Iterator[tuple[Fix, float]]:
    for group in _groups(_asked(table)):
        if quantity(group[0]) in SIGNED and not group[0].startswith("v_ll") or group == (ANGLE,):
            yield InvertedColumns(table.file, group), COMMON
            for column in group if len(group) > 1 else ():
                yield InvertedColumns(table.file, (column,)), COMMON


def _phases(table: Table) -> Iterator[tuple[Fix, float]]:
    """A sine that is counted from its top, or the other way, instead of from where it rises."""
    if "phase" in table.conditions:
        unit = table.condition_units.get("phase", "")
        for zero in (-pi / 2, pi / 2, pi):
            yield Offset(table.file, "phase", zero, unit), COMMON


def power_flow(table: Table) -> Iterator[tuple[Fix, float]]:
    """Power at the shaft and at the terminals both counted as a generator gives them."""
    columns = tuple(n for n in ("torque", "power") if n in table.conditions or n in table.responses)
    if len(columns) == 2:
        yield InvertedColumns(table.file, columns), COMMON


def _exchanges(table: Table) -> Iterator[tuple[Fix, float]]:
    asked = _asked(table)
    for one, other in combinations([*asked, *table.responses], 2):
        differ = not np.array_equal(_values(table, one), _values(table, other))
        if one in asked and differ and _can_be_exchanged(table, one, other):
            alike = quantity(one) == quantity(other)
            yield SwappedColumns(table.file, (one, other)), COMMON if alike else RARE
    phases = tuple(c for c in asked if is_phase(c))
    if len(phases) == 3:
        yield SwappedColumns(table.file, phases), COMMON
        yield SwappedColumns(table.file, phases[::-1]), COMMON


def _can_be_exchanged(table: Table, one: str, other: str) -> bool:
    """Whether what would stand in a column of temperatures can be any."""
    held = [_values(table, b) for a, b in ((one, other), (other, one)) if a.endswith("_T")]
    return all(COLDEST < values.min() and values.max() < HOTTEST for values in held)


def _values(table: Table, column: str) -> np.ndarray:
    return table.conditions[column] if column in table.conditions else table.responses[column].values


def _shifts(table: Table) -> Iterator[tuple[Fix, float]]:
    for column in [*_asked(table), *table.responses]:
        if np.ptp(_values(table, column)) > 0 and table.rows > 4:
            for rows in (1, -1):
                yield ShiftedColumn(table.file, (column,), rows), RARE


def _temperatures(table: Table) -> Iterator[tuple[Fix, float]]:
    for column in (c for c in table.conditions if c.endswith("_T")):
        if float(np.median(table.conditions[column])) > 50.0:
            yield TemperatureScale(table.file, column, "fahrenheit"), COMMON


def wrong_kelvins(table: Table) -> Iterator[TemperatureScale]:
    """Temperatures that no winding and no magnet withstands, or no room has, be it in one row: no model has to be
    asked."""
    for column, values in table.conditions.items():
        if column.endswith("_T") and values.min() > UNBEARABLE and values.max() < HOTTEST:
            yield TemperatureScale(table.file, column, "kelvin")
        if column.endswith("_T") and values.max() < COLDEST and values.min() + KELVIN > COLDEST:
            yield TemperatureScale(table.file, column, "celsius")


# ---- readings of the responses that do not --------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class Order:
    """holds: model column whose readings each channel holds (r,);  sign (r,);  fixes and what they cost"""

    holds: np.ndarray
    sign: np.ndarray
    fixes: tuple[Fix, ...]
    cost: float


def orders(file: str, names: tuple[str, ...]) -> list[Order]:
    """Every exchange of channels with every choice of signs."""
    return [
        Order(holds, sign, swap + turn, cost + more)
        for holds, swap, cost in _permutations(file, names)
        for sign, turn, more in _turns(file, names)
    ]


def _permutations(file: str, names: tuple[str, ...]) -> Iterator[tuple[np.ndarray, tuple[Fix, ...], float]]:
    same = np.arange(len(names))
    yield same, (), 0.0
    for j, k in combinations(range(len(names)), 2):
        holds = same.copy()
        holds[[j, k]] = k, j
        alike = quantity(names[j]) == quantity(names[k])
        yield holds, (SwappedColumns(file, (names[j], names[k])),), COMMON if alike else RARE
    phases = [k for k, name in enumerate(names) if is_phase(name)] or [k for k, n in enumerate(names) if _is_line(n)]
    for cycle in (phases, phases[::-1]) if len(phases) == 3 else ():
        holds = same.copy()
        holds[cycle] = cycle[1:] + cycle[:1]
        yield holds, (SwappedColumns(file, tuple(names[k] for k in cycle)),), COMMON


def _is_line(name: str) -> bool:
    return name in LINES.values()


def _turns(file: str, names: tuple[str, ...]) -> Iterator[tuple[np.ndarray, tuple[Fix, ...], float]]:
    groups = _groups(names)
    chosen = {(): 0.0, names: COMMON}
    chosen |= {group: COMMON for group in groups}
    for group in groups:
        chosen |= {part: COMMON for size in (1, 2) for part in combinations(group, size)} if len(group) <= 3 else {}
    for columns, cost in chosen.items():
        sign = np.array([-1.0 if name in columns else 1.0 for name in names])
        yield sign, (InvertedColumns(file, columns),) if columns else (), cost


def scaled_groups(names: tuple[str, ...]) -> list[tuple[str, ...]]:
    """Channels that may share a factor: all of a quantity, or one of them."""
    groups = _groups(names)
    return list(dict.fromkeys([*groups, *((name,) for group in groups for name in group)]))


def cost_of_zero(zero: float, slots: float | None, pole_pairs: float) -> float:
    """Of an offset of the angle [rad]; less where it is a slot, a pole or 120 electrical degrees."""
    special = [pi / pole_pairs, 2 * pi / (3 * pole_pairs)] + ([2 * pi / slots] if slots else [])
    off = min(abs(zero / step - round(zero / step)) * step * pole_pairs for step in special)
    return COMMON + 1.0 if off < 3 * DEGREE else USUAL + 1.0


def zero_grid(pole_pairs: float) -> np.ndarray:
    """Offsets over the full turn [rad], five electrical degrees apart, the small ones first."""
    count = int(72 * pole_pairs)
    grid = (np.arange(count) - count // 2) * 2 * pi / count
    return grid[np.argsort(np.abs(grid), kind="stable")]


def slack(pole_pairs: float) -> np.ndarray:
    """Offsets of an encoder that are no convention [rad]."""
    return np.linspace(-1.0, 1.0, 17) * HAND_SET / pole_pairs


def compatible(fixes: tuple[Fix, ...], more: Fix) -> bool:
    """Whether two fixes say different things."""
    return all(
        type(more) is not type(fix) or isinstance(fix, (Scaled, InvertedColumns)) and fix != more for fix in fixes
    )
