"""Conventions of a laboratory: what a file means by its columns, written down in ``[conventions]`` of campaign.toml.

    [conventions]
    "back_emf.csv" = { swap = [["v_b_V", "v_c_V"]], factor = { v_a_V = 0.001 }, angle = "electrical" }

Columns are named as in the file, or without their unit. For each file, applied in this order:

    swap             lists of columns, each holding the readings of the next one, the last those of the first
    ignore           readings that are not looked at
    temperature      { winding_T_degC = "kelvin" }: the scale that the numbers are in, "kelvin" or "fahrenheit"
    factor           { column = f }: true = f * reading
    offset           { column = o }: true = reading - o, o in the unit at the end of the name, else of the file
    invert           columns whose sign is turned round
    angle            what the angle column holds: "electrical", "degrees", "radians" or "turns"
    angle_direction  -1: angles, speeds, directions and torques count clockwise
    angle_zero_deg   reading of the angle [mechanical deg] where the angle of the model is zero
    shift            { column = k }: its readings stand k rows too late; rows that are left without one fall away
    voltages         "line": the columns v_a, v_b, v_c hold v_ab, v_bc, v_ca
    leave_out        { column = value }: rows where the column stands at this value (clipped, stuck) fall away

Each is a frozen dataclass, a pure change of a table. Names of what may be wrong, as ``diagnosis.json`` gives them:
``NAMES``.
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from units import DEGREE
from workbench.data.column_units import factor, split_unit
from workbench.data.stack import rows_of
from workbench.data.table import Campaign, Response, Table
from workbench.errors import WorkbenchError

NAMES: dict[str, str] = {
    "swapped_phases": "phases stand in each other's columns",
    "inverted_phase": "one phase is connected the other way round",
    "sign": "a reading counts the other way round",
    "motoring_or_generating": "currents or power count as of a generator instead of a motor, or the reverse",
    "angle_direction": "the angle counts the other way round",
    "angle_zero": "the zero of the angle is elsewhere",
    "electrical_or_mechanical": "electrical and mechanical angles or speeds are confused",
    "poles": "poles and pole pairs are confused",
    "unit_factor": "numbers are in another unit than declared",
    "line_or_phase": "line and phase quantities are confused",
    "rms_or_peak": "RMS and peak values are confused",
    "peak_to_peak": "amplitudes and what they are from peak to peak are confused",
    "zero": "the zero of an instrument was not set",
    "swapped_columns": "two columns stand under each other's names",
    "shifted_column": "a column is off by rows",
    "clipped": "a reading stops at the end of its range",
    "stuck": "a reading does not change any more",
}
DEVICE = "[device]"  # in the place of a file, where a constant of the device is meant
ANGLE = "angle_mech"
LINES = {"v_a": "v_ab", "v_b": "v_bc", "v_c": "v_ca"}
TURNING = ("speed", "direction", "torque")  # what changes its sign with the sense of rotation, besides the angle
KELVIN = 273.15
# degC = a * (reading - b); the reading was declared in degrees Celsius, that of the last scale in kelvin
SCALES = {"kelvin": (1.0, KELVIN), "fahrenheit": (5 / 9, 32.0), "celsius": (1.0, -KELVIN)}
HALF_ULP = 1e-9  # relative; two readings that are nearer are the same number


@dataclass(frozen=True)
class Fix:
    """What one file means by some of its columns. file: "" stands for any file that has the columns."""

    file: str
    place: ClassVar[int]  # in the order of application

    @property
    def names(self) -> tuple[str, ...]:
        """What is wrong without it, from ``NAMES``."""
        raise NotImplementedError

    @property
    def words(self) -> str:
        """What the file looks like, after its name: "v_b and v_c look swapped"."""
        raise NotImplementedError

    @property
    def entry(self) -> dict[str, object]:
        """Its keys in ``[conventions]``."""
        raise NotImplementedError

    def apply(self, table: Table) -> Table:
        """The table as it was meant."""
        raise NotImplementedError

    @property
    def anywhere(self) -> Fix:
        """The same for any file: one habit of a laboratory."""
        return replace(self, file="")


@dataclass(frozen=True)
class SwappedColumns(Fix):
    """columns: each holds the readings of the next one, the last those of the first."""

    columns: tuple[str, ...]
    place: ClassVar[int] = 0

    @property
    def names(self) -> tuple[str, ...]:
        return ("swapped_phases" if all(is_phase(c) for c in self.columns) else "swapped_columns",)

    @property
    def words(self) -> str:
        listed = f"{', '.join(self.columns[:-1])} and {self.columns[-1]}"
        return f"{listed} look {'swapped' if len(self.columns) == 2 else 'rotated'}"

    @property
    def entry(self) -> dict[str, object]:
        return {"swap": [list(self.columns)]}

    def apply(self, table: Table) -> Table:
        before = self.columns[-1:] + self.columns[:-1]  # the column that holds the readings of this one
        swapped = table
        for column, holder in zip(self.columns, before):
            values, random = _numbers_of(table, holder)
            swapped = _with_numbers(swapped, column, values, random)
        return swapped


@dataclass(frozen=True)
class IgnoredColumns(Fix):
    """Readings that are not looked at."""

    columns: tuple[str, ...]
    place: ClassVar[int] = 1

    @property
    def names(self) -> tuple[str, ...]:
        return ("stuck",)

    @property
    def words(self) -> str:
        return f"{' and '.join(self.columns)} never changes: a stuck channel"

    @property
    def entry(self) -> dict[str, object]:
        return {"ignore": list(self.columns)}

    def apply(self, table: Table) -> Table:
        left = {name: r for name, r in table.responses.items() if name not in self.columns}
        if not left:
            raise WorkbenchError(f"[conventions] {table.file}: ignore leaves no reading; leave the table out instead.")
        return replace(table, responses=left)


@dataclass(frozen=True)
class TemperatureScale(Fix):
    """The scale that the numbers of a temperature are in."""

    column: str
    scale: str
    place: ClassVar[int] = 2

    @property
    def names(self) -> tuple[str, ...]:
        return ("unit_factor",)

    @property
    def words(self) -> str:
        return f"{self.column} looks like {self.scale}"

    @property
    def entry(self) -> dict[str, object]:
        return {"temperature": {self.column: self.scale}}

    def apply(self, table: Table) -> Table:
        size, zero = SCALES[self.scale]
        return _changed(table, (self.column,), lambda v: size * (v - zero), size)


@dataclass(frozen=True)
class Scaled(Fix):
    """true = factor * reading. means: names of what is wrong, for people"""

    columns: tuple[str, ...]
    factor: float
    means: tuple[str, ...] = ("unit_factor",)
    place: ClassVar[int] = 3

    @property
    def names(self) -> tuple[str, ...]:
        return self.means

    @property
    def words(self) -> str:
        many = len(self.columns) > 1
        return f"{', '.join(self.columns)} look{'' if many else 's'} {_off_by(self.factor, self.means)}"

    @property
    def entry(self) -> dict[str, object]:
        return {"factor": dict.fromkeys(self.columns, self.factor)}

    def apply(self, table: Table) -> Table:
        return _changed(table, self.columns, lambda v: self.factor * v, self.factor)


def _off_by(factor: float, means: Sequence[str]) -> str:
    """How a number looks that has to be multiplied by a factor, and why."""
    size = f"{1 / factor:.6g} times too large" if factor < 1 else f"{factor:.6g} times too small"
    return f"{size}: {' and '.join(_FACTOR_WORDS[name] for name in means)}"


_FACTOR_WORDS = {
    "unit_factor": "another unit",
    "line_or_phase": "line for phase values or the reverse",
    "rms_or_peak": "peak for RMS values or the reverse",
    "peak_to_peak": "peak to peak for an amplitude or the reverse",
    "electrical_or_mechanical": "electrical for mechanical or the reverse",
    "poles": "poles for pole pairs or the reverse",
}


@dataclass(frozen=True)
class Offset(Fix):
    """true = reading - offset [SI]."""

    column: str
    offset: float
    unit: str = ""
    place: ClassVar[int] = 4

    @property
    def names(self) -> tuple[str, ...]:
        return ("zero",)

    @property
    def words(self) -> str:
        return f"{self.column} reads {self._shown:.4g} {self.unit} where it is nothing: its zero was not set"

    @property
    def _shown(self) -> float:
        return self.offset / (factor(self.unit, "offset") if self.unit else 1.0)

    @property
    def entry(self) -> dict[str, object]:
        return {"offset": {f"{self.column}_{self.unit}" if self.unit else self.column: self._shown}}

    def apply(self, table: Table) -> Table:
        return _changed(table, (self.column,), lambda v: v - self.offset, 1.0)


@dataclass(frozen=True)
class InvertedColumns(Fix):
    """Columns whose sign is turned round."""

    columns: tuple[str, ...]
    place: ClassVar[int] = 5

    @property
    def names(self) -> tuple[str, ...]:
        if self.columns == (ANGLE,):
            return ("angle_direction",)
        if self._is_one_phase:
            return ("inverted_phase",)
        swaps_power = (
            "power" in self.columns or all(c.startswith("i_") for c in self.columns) and "i_d" != self.columns[-1]
        )
        return ("motoring_or_generating",) if swaps_power else ("sign",)

    @property
    def _is_one_phase(self) -> bool:
        return len(self.columns) < 3 and all(is_phase(c) for c in self.columns)

    @property
    def words(self) -> str:
        if self.columns == (ANGLE,):
            return "the angle looks counted clockwise"
        return f"{', '.join(self.columns)} look{'s' if len(self.columns) == 1 else ''} inverted"

    @property
    def entry(self) -> dict[str, object]:
        return {"invert": list(self.columns)}

    def apply(self, table: Table) -> Table:
        return _changed(table, self.columns, np.negative, 1.0)


@dataclass(frozen=True)
class AngleUnit(Fix):
    """What the angle column holds, whatever its header says. factor: from what was read [rad] to the angle [rad]"""

    holds: str
    factor: float
    place: ClassVar[int] = 6

    @property
    def names(self) -> tuple[str, ...]:
        return ("electrical_or_mechanical" if self.holds == "electrical" else "unit_factor",)

    @property
    def words(self) -> str:
        what = {"electrical": "electrical instead of mechanical angles"}.get(self.holds, self.holds)
        return f"the angle column looks like {what}"

    @property
    def entry(self) -> dict[str, object]:
        return {"angle": self.holds}

    def apply(self, table: Table) -> Table:
        return _changed(table, (ANGLE,), lambda v: self.factor * v, abs(self.factor))


@dataclass(frozen=True)
class AngleDirection(Fix):
    """Angles, speeds, directions and torques count clockwise."""

    place: ClassVar[int] = 7

    @property
    def names(self) -> tuple[str, ...]:
        return ("angle_direction",)

    @property
    def words(self) -> str:
        return "angle, speed and torque look counted clockwise"

    @property
    def entry(self) -> dict[str, object]:
        return {"angle_direction": -1}

    def apply(self, table: Table) -> Table:
        have = tuple(c for c in (ANGLE, *TURNING) if c in table.conditions or c in table.responses)
        return _changed(table, have, np.negative, 1.0)


@dataclass(frozen=True)
class AngleZero(Fix):
    """zero: reading [mechanical rad] where the angle of the model is zero."""

    zero: float
    place: ClassVar[int] = 8

    @property
    def names(self) -> tuple[str, ...]:
        return ("angle_zero",)

    @property
    def words(self) -> str:
        return f"the angle reads {self.zero / DEGREE:.2f} mechanical degrees where it should be zero"

    @property
    def entry(self) -> dict[str, object]:
        return {"angle_zero_deg": round(self.zero / DEGREE, 3)}

    def apply(self, table: Table) -> Table:
        return _changed(table, (ANGLE,), lambda v: v - self.zero, 1.0)


@dataclass(frozen=True)
class ShiftedColumn(Fix):
    """The readings of a column stand ``rows`` rows too late (negative: too early)."""

    columns: tuple[str, ...]
    rows: int
    place: ClassVar[int] = 9

    @property
    def names(self) -> tuple[str, ...]:
        return ("shifted_column",)

    @property
    def words(self) -> str:
        late = "late" if self.rows > 0 else "early"
        return f"{', '.join(self.columns)} looks {abs(self.rows)} row{'s' if abs(self.rows) > 1 else ''} too {late}"

    @property
    def entry(self) -> dict[str, object]:
        return {"shift": dict.fromkeys(self.columns, self.rows)}

    def apply(self, table: Table) -> Table:
        moved = table
        for column in self.columns:
            values, random = _numbers_of(table, column)
            moved = _with_numbers(moved, column, np.roll(values, -self.rows), np.roll(random, -self.rows))
        whole = slice(None, -self.rows) if self.rows > 0 else slice(-self.rows, None)
        return rows_of(moved, np.arange(table.rows)[whole])


@dataclass(frozen=True)
class LineVoltages(Fix):
    """The columns v_a, v_b, v_c hold v_ab, v_bc, v_ca."""

    place: ClassVar[int] = 10

    @property
    def names(self) -> tuple[str, ...]:
        return ("line_or_phase",)

    @property
    def words(self) -> str:
        return "v_a, v_b, v_c look like the voltages between the lines"

    @property
    def entry(self) -> dict[str, object]:
        return {"voltages": "line"}

    def apply(self, table: Table) -> Table:
        renamed = {LINES.get(n, n): replace(r, name=LINES.get(n, n)) for n, r in table.responses.items()}
        return replace(table, responses=renamed)


@dataclass(frozen=True)
class LeftOut(Fix):
    """Rows where a reading stands at a value [SI]. why: "clipped" or "stuck\""""

    column: str
    value: float
    unit: str = ""
    why: str = "clipped"
    place: ClassVar[int] = 11

    @property
    def names(self) -> tuple[str, ...]:
        return (self.why,)

    @property
    def words(self) -> str:
        what = "stops at the end of its range," if self.why == "clipped" else "was stuck at"
        return f"{self.column} {what} {self._shown:.6g} {self.unit}".rstrip()

    @property
    def _shown(self) -> float:
        return self.value / (factor(self.unit, "leave_out") if self.unit else 1.0)

    @property
    def entry(self) -> dict[str, object]:
        return {"leave_out": {f"{self.column}_{self.unit}" if self.unit else self.column: self._shown}}

    def apply(self, table: Table) -> Table:
        values = _numbers_of(table, self.column)[0] * _scale(table, self.column)
        keep = np.abs(values - self.value) > HALF_ULP * max(abs(self.value), 1e-300)
        if not keep.any():
            raise WorkbenchError(f"[conventions] {table.file}: leave_out of {self.column} leaves no row.")
        return rows_of(table, keep)


@dataclass(frozen=True)
class DeviceFactor(Fix):
    """true = factor * constant of ``[device]``, which every table goes with. file: ``DEVICE``

    means: names of what is wrong, for people
    """

    key: str
    declared: float
    factor: float
    means: tuple[str, ...]
    place: ClassVar[int] = 12

    @property
    def names(self) -> tuple[str, ...]:
        return self.means

    @property
    def words(self) -> str:
        return f"{self.key} looks {_off_by(self.factor, self.means)}"

    @property
    def entry(self) -> dict[str, object]:
        true = self.factor * self.declared
        return {self.key: round(true) if isinstance(self.declared, int) and true == round(true) else true}


def is_phase(column: str) -> bool:
    """v_a, i_b, dpsi_c: a quantity of one of three phases."""
    return len(column) > 2 and column[-2:] in ("_a", "_b", "_c")


# ---- columns of a table, whatever their role -----------------------------------------------------------------------


def _scale(table: Table, column: str) -> float:
    if column in table.responses:
        return table.responses[column].scale
    unit = table.condition_units.get(column, "")
    return factor(unit, table.file) if unit else 1.0


def _numbers_of(table: Table, column: str) -> tuple[np.ndarray, np.ndarray]:
    """Values and random uncertainty as the file has them; of a condition nothing is known but the size."""
    scale = _scale(table, column)
    if column in table.responses:
        return table.responses[column].values / scale, table.responses[column].random / scale
    values = table.conditions[column] / scale
    size = float(np.sqrt(np.mean(values**2)))
    return values, np.full(len(values), 0.01 * size if size else 1.0)


def _with_numbers(table: Table, column: str, values: np.ndarray, random: np.ndarray) -> Table:
    """The table with the numbers of a column as the file would have them."""
    scale = _scale(table, column)
    if column in table.conditions:
        return replace(table, conditions={**table.conditions, column: values * scale})
    response = replace(table.responses[column], values=values * scale, random=random * scale)
    return replace(table, responses={**table.responses, column: response})


def _changed(table: Table, columns: Sequence[str], change: Callable[[np.ndarray], np.ndarray], size: float) -> Table:
    """The table with columns changed; their uncertainty grows by ``size``."""
    conditions = {n: change(v) if n in columns else v for n, v in table.conditions.items()}
    random = {n: abs(size) * u if n in columns else u for n, u in table.condition_random.items()}
    responses = {n: _response(r, change, size) if n in columns else r for n, r in table.responses.items()}
    return replace(table, conditions=conditions, responses=responses, condition_random=random)


def _response(r: Response, change: Callable[[np.ndarray], np.ndarray], size: float) -> Response:
    return replace(r, values=change(r.values), random=abs(size) * r.random)


# ---- the section of campaign.toml -----------------------------------------------------------------------------------


def with_conventions(campaign: Campaign) -> Campaign:
    """The campaign with its section ``[conventions]`` applied to its tables.

    Raises:
        WorkbenchError: a file, key, column or value that is not known.
    """
    return applied(campaign, fixes_of(campaign))


def applied(campaign: Campaign, fixes: Iterable[Fix]) -> Campaign:
    """The campaign with fixes applied in their order."""
    ordered = sorted(fixes, key=lambda fix: fix.place)
    tables = []
    for table in campaign.tables:
        for fix in (f for f in ordered if f.file == table.file):
            table = fix.apply(table)
        tables.append(table)
    device = {**campaign.device, **section_of(f for f in ordered if f.file == DEVICE).get(DEVICE, {})}
    return replace(campaign, tables=tuple(tables), device=device)


def fixes_of(campaign: Campaign) -> tuple[Fix, ...]:
    """The fixes that the section ``[conventions]`` of a campaign states."""
    found: list[Fix] = []
    for file, entry in campaign.conventions.items():
        table = next((t for t in campaign.tables if t.file == file), None)
        if table is None:
            known = ", ".join(t.file for t in campaign.tables)
            raise WorkbenchError(f"[conventions] {file!r} is no file of this campaign; it has {known}.")
        if not isinstance(entry, Mapping):
            raise WorkbenchError(f"[conventions] {file}: write a table of keys, {{ invert = [...] }}.")
        for key, value in entry.items():
            found += _fixes(campaign, table, key, value)
    return tuple(found)


def accepted(campaign: Campaign, text: str) -> Campaign:
    """The campaign with the text of a further section ``[conventions]`` applied to its tables."""
    more = tomllib.loads(text)["conventions"]
    fixes = fixes_of(replace(campaign, conventions=more))
    return replace(applied(campaign, fixes), conventions=merged(campaign.conventions, more))


def merged(have: Mapping[str, Mapping[str, object]], more: Mapping[str, Mapping[str, object]]) -> dict:
    """Both sections; keys of a file that both have stay with what was found last."""
    return {file: {**have.get(file, {}), **more.get(file, {})} for file in dict.fromkeys([*have, *more])}


def stated_factors(campaign: Campaign, file: str) -> frozenset[str]:
    """Columns of a file whose factor the campaign states, be it 1: it is not doubted again."""
    entry = campaign.conventions.get(file, {})
    return frozenset(part for name in entry.get("factor", {}) for part in (name, split_unit(name)[0]))


def _fixes(campaign: Campaign, table: Table, key: str, value: object) -> list[Fix]:
    where = f"[conventions] {table.file}: {key}"
    if key not in _READERS:
        raise WorkbenchError(f"{where} is not known; use one of {', '.join(_READERS)}.")
    try:
        return _READERS[key](campaign, table, value, where)
    except (TypeError, AttributeError, ValueError) as error:
        if isinstance(error, WorkbenchError):
            raise
        raise WorkbenchError(f"{where} = {value!r} cannot be read; see the manual of [conventions].") from None


def _column(table: Table, name: str, where: str) -> str:
    for found in (name, split_unit(name)[0]):
        if found in table.conditions or found in table.responses:
            return found
    known = ", ".join([*table.conditions, *table.responses])
    raise WorkbenchError(f"{where}: there is no column {name!r}; the table has {known}.")


def _columns(table: Table, names: object, where: str) -> tuple[str, ...]:
    if isinstance(names, str) or not isinstance(names, Sequence):
        raise WorkbenchError(f"{where}: write a list of columns.")
    return tuple(_column(table, name, where) for name in names)


def _number(value: object, where: str) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise WorkbenchError(f"{where}: a number is needed, found {value!r}.")
    return float(value)


def _swap(campaign: Campaign, table: Table, value: Sequence[object], where: str) -> list[Fix]:
    return [SwappedColumns(table.file, _at_least_two(_columns(table, names, where), where)) for names in value]


def _at_least_two(columns: tuple[str, ...], where: str) -> tuple[str, ...]:
    if len(set(columns)) < 2 or len(set(columns)) != len(columns):
        raise WorkbenchError(f"{where}: a swap needs at least two different columns.")
    return columns


def _ignore(campaign: Campaign, table: Table, value: object, where: str) -> list[Fix]:
    return [IgnoredColumns(table.file, _columns(table, value, where))]


def _temperature(campaign: Campaign, table: Table, value: Mapping[str, str], where: str) -> list[Fix]:
    wrong = [scale for scale in value.values() if scale not in SCALES]
    if wrong:
        raise WorkbenchError(f"{where}: the scale {wrong[0]!r} is not known; use one of {', '.join(SCALES)}.")
    return [TemperatureScale(table.file, _column(table, name, where), scale) for name, scale in value.items()]


def _factor(campaign: Campaign, table: Table, value: Mapping[str, float], where: str) -> list[Fix]:
    sizes = {_column(table, name, where): _number(size, where) for name, size in value.items()}
    if 0.0 in sizes.values():
        raise WorkbenchError(f"{where}: a factor of zero leaves nothing; leave the column out by `ignore`.")
    return [Scaled(table.file, (name,), size) for name, size in sizes.items()]


def _offset(campaign: Campaign, table: Table, value: Mapping[str, float], where: str) -> list[Fix]:
    return [Offset(table.file, *_with_unit(table, name, size, where)) for name, size in value.items()]


def _with_unit(table: Table, name: str, size: object, where: str) -> tuple[str, float, str]:
    """Column, value in SI, unit of a number whose unit stands at the end of its name, else that of the file."""
    column, unit = _column(table, name, where), split_unit(name)[1]
    scale = factor(unit, where) if unit and name != column else _scale(table, column)
    return column, _number(size, where) * scale, unit


def _invert(campaign: Campaign, table: Table, value: object, where: str) -> list[Fix]:
    return [InvertedColumns(table.file, _columns(table, value, where))]


def _angle(campaign: Campaign, table: Table, value: str, where: str) -> list[Fix]:
    known = angle_factors(campaign, table)
    if value not in known:
        raise WorkbenchError(f"{where}: {value!r} is not known here; use one of {', '.join(known)}.")
    return [AngleUnit(table.file, value, known[value])]


def angle_factors(campaign: Campaign, table: Table) -> dict[str, float]:
    """From what was read as an angle [rad] to the angle [rad], by what the column may hold."""
    if ANGLE not in table.conditions:
        raise WorkbenchError(f"[conventions] {table.file}: there is no column {ANGLE}.")
    read = _scale(table, ANGLE)
    found = {"degrees": DEGREE / read, "radians": 1 / read, "turns": 2 * math.pi / read}
    pairs = pole_pairs(campaign)
    return found | ({"electrical": 1 / pairs} if pairs else {})


def pole_pairs(campaign: Campaign) -> float | None:
    """Of the device, None where it has none."""
    device = campaign.device
    pairs = device.get(
        "pole_pairs", None if "poles" not in device else 0.5 * _number(device["poles"], "[device] poles")
    )
    return None if pairs is None else _number(pairs, "[device] pole_pairs")


def _direction(campaign: Campaign, table: Table, value: object, where: str) -> list[Fix]:
    if value not in (-1, 1):
        raise WorkbenchError(f"{where}: write -1 for clockwise, found {value!r}.")
    return [AngleDirection(table.file)] if value == -1 else []


def _zero(campaign: Campaign, table: Table, value: object, where: str) -> list[Fix]:
    _column(table, ANGLE, where)
    return [AngleZero(table.file, _number(value, where) * DEGREE)]


def _shift(campaign: Campaign, table: Table, value: Mapping[str, int], where: str) -> list[Fix]:
    for rows in value.values():
        if not isinstance(rows, int) or isinstance(rows, bool) or not 0 < abs(rows) < table.rows:
            raise WorkbenchError(f"{where}: a whole number of rows is needed, found {rows!r}.")
    by_rows: dict[int, list[str]] = {}
    for name, rows in value.items():
        by_rows.setdefault(rows, []).append(_column(table, name, where))
    return [ShiftedColumn(table.file, tuple(columns), rows) for rows, columns in by_rows.items()]


def _voltages(campaign: Campaign, table: Table, value: object, where: str) -> list[Fix]:
    if value != "line" or not set(LINES) <= set(table.responses):
        raise WorkbenchError(f'{where}: only "line" is known, for a table with the columns v_a, v_b and v_c.')
    return [LineVoltages(table.file)]


def _leave_out(campaign: Campaign, table: Table, value: Mapping[str, float], where: str) -> list[Fix]:
    return [LeftOut(table.file, *_with_unit(table, name, size, where)) for name, size in value.items()]


_READERS: dict[str, Callable[..., list[Fix]]] = {
    "swap": _swap, "ignore": _ignore, "temperature": _temperature, "factor": _factor, "offset": _offset,
    "invert": _invert, "angle": _angle, "angle_direction": _direction, "angle_zero_deg": _zero, "shift": _shift,
    "voltages": _voltages, "leave_out": _leave_out,
}  # fmt: skip


def section_of(fixes: Iterable[Fix]) -> dict[str, dict[str, object]]:
    """The fixes as the section ``[conventions]``: file -> keys."""
    section: dict[str, dict[str, object]] = {}
    for fix in sorted(fixes, key=lambda f: f.place):
        mine = section.setdefault(fix.file, {})
        for key, value in fix.entry.items():
            mine[key] = _joined(mine.get(key), value)
    return section


def _joined(have: object, more: object) -> object:
    if isinstance(have, list) and isinstance(more, list):
        return have + more
    if isinstance(have, dict) and isinstance(more, dict):
        return have | more
    return more


def section_text(section: Mapping[str, Mapping[str, object]]) -> str:
    """The text to put into campaign.toml."""
    files = [f"{_quoted(file)} = {_toml(entry)}" for file, entry in section.items() if file != DEVICE]
    constants = [f"{key} = {_toml(value)}" for key, value in section.get(DEVICE, {}).items()]
    parts = {"[conventions]": files, DEVICE: constants}
    return "\n".join("\n".join([head, *lines]) + "\n" for head, lines in parts.items() if lines)


def _quoted(text: str) -> str:
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def _toml(value: object) -> str:
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_key(k)} = {_toml(v)}" for k, v in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(_toml(v) for v in value) + "]"
    if isinstance(value, str):
        return _quoted(value)
    return repr(value) if isinstance(value, int) else repr(float(f"{value:.12g}"))


def _key(name: str) -> str:
    return name if name.replace("_", "").replace("-", "").isalnum() and name.isascii() else _quoted(name)
