"""Which quantity each column of a file holds, in what unit and in which role: in either spelling of a campaign."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from difflib import get_close_matches
from typing import Any, Final

from workbench.data.column_units import split_unit
from workbench.data.dimensions import check_reading
from workbench.data.headings import known_unit
from workbench.data.kinds import Kind
from workbench.data.raw_table import Heading, RawTable, used_twice
from workbench.data.schema import FILE, ColumnEntry, TableEntry
from workbench.errors import WorkbenchError

BOOKKEEPING: Final = ("scan", "repeat", "holdout")


@dataclass(frozen=True)
class Column:
    """How one column of a file is understood.

    place: of the column in the file;  heading: as written there;  name: quantity without unit
    random: standard uncertainty as written, number or formula;  bandwidth: of its recorder [Hz], None where not known
    """

    place: int
    heading: str
    name: str
    unit: str
    role: str
    random: Any = None
    bandwidth: float | None = None


def columns_of(raw: RawTable, entry: TableEntry, kind: Kind) -> tuple[tuple[Column, ...], list[str]]:
    """The columns that take part, in the order of the declaration or the file, and what is to be said about the others.

    Raises:
        WorkbenchError: a column that is spoken of is not there or twice, has no unit, no uncertainty or no proper name.
    """
    headings = _renamed(raw, entry.alias)
    if entry.columns is not None:
        found, remarks = _declared(raw, headings, entry.columns), []
    else:
        found, remarks = _by_names(raw, headings, entry.u_random or {}, kind)
    for column in found:
        _check_name(column, raw.where)
        if kind.responses and column.role in ("condition", "response"):
            check_reading(column.name, column.unit, f"{raw.where}: column {column.heading!r}")
    _refuse_doubles(found, raw.where)
    return tuple(_with_bandwidth(column, entry.bandwidth_Hz) for column in found), remarks


def _with_bandwidth(column: Column, of_table: float | None) -> Column:
    return column if column.bandwidth is not None else replace(column, bandwidth=of_table)


def _renamed(raw: RawTable, alias: Mapping[str, str]) -> tuple[Heading, ...]:
    """Headings with the names of ``alias``: "force_kN", or "force" where the heading has the unit."""
    headings = list(raw.headings)
    for written, meant in alias.items():
        place = place_of(raw, headings, written, "alias")
        name, unit = split_unit(meant)
        headings[place] = Heading(headings[place].written, name, unit or headings[place].unit)
    return tuple(headings)


def place_of(raw: RawTable, headings: Sequence[Heading], key: str, by: str) -> int:
    """The column that a key means: by its heading, else by its quantity with or without unit. by: what speaks of it

    Raises:
        WorkbenchError: there is no such column, or more than one.
    """
    places = _places(headings, key)
    if not places:
        known = [h.written for h in headings if h.written]
        close = get_close_matches(key, known, n=1)
        hint = f"; the nearest heading is {close[0]!r}" if close else ""
        raise WorkbenchError(
            f"{raw.where}: the column {key!r} of {FILE} ({by}) is not there; found {', '.join(known)}{hint}."
        )
    if len(places) > 1:
        raise used_twice(raw.where, len(places), key)
    return places[0]


def _places(headings: Sequence[Heading], key: str) -> list[int]:
    wanted = " ".join(key.split())
    spelled = [[h.written for h in headings], [f"{h.name}_{h.unit}" for h in headings], [h.name for h in headings]]
    for names in spelled:
        if places := [k for k, name in enumerate(names) if name == wanted and wanted]:
            return places
    return []


# ---- declared in [table.columns] -----------------------------------------------------------------------------------


def _declared(raw: RawTable, headings: Sequence[Heading], entries: Mapping[str, ColumnEntry]) -> list[Column]:
    found = []
    for key, entry in entries.items():
        heading = entry.from_ or key
        if entry.optional and not _places(headings, heading):
            continue
        place = place_of(raw, headings, heading, "columns")
        found.append(_of_entry(place, headings[place], key, entry, raw))
    return found


def _of_entry(place: int, heading: Heading, key: str, entry: ColumnEntry, raw: RawTable) -> Column:
    where = f"{raw.where}: column {key!r}"
    meant = entry.name or (key if entry.from_ else None)
    name, unit_of_name = (heading.name, "") if meant is None else split_unit(meant)
    unit = _unit(where, entry, heading.unit or unit_of_name or _clock(raw, place))
    if entry.role in ("condition", "response") and not unit:
        raise WorkbenchError(f'{where} has no unit; add unit = "..." ("1" for a pure number).')
    random = entry.u if entry.u_random is None else entry.u_random
    if entry.role == "response" and random is None:
        raise WorkbenchError(
            f"{raw.where}: the response {key!r} has no u_random; give its random standard uncertainty."
        )
    return Column(place, key, name, unit, entry.role, random, entry.bandwidth)


def _clock(raw: RawTable, place: int) -> str:
    return "s" if raw.holds_times(place) else ""


def _unit(where: str, entry: ColumnEntry, of_name: str) -> str:
    unit = of_name if entry.unit is None else known_unit(entry.unit) or entry.unit
    if of_name and unit != of_name:
        raise WorkbenchError(f"{where} says {of_name} in its heading and {entry.unit} in {FILE}; keep one.")
    return unit


# ---- said by the headings ------------------------------------------------------------------------------------------


def _by_names(
    raw: RawTable, headings: Sequence[Heading], random: Mapping[str, Any], kind: Kind
) -> tuple[list[Column], list[str]]:
    sizes = {place_of(raw, headings, key, "u_random"): size for key, size in random.items()}
    found, remarks = [], []
    for place, heading in enumerate(headings):
        if place not in sizes and (words := _unreadable(raw, place, heading)):
            remarks.append(words)
            continue
        found.append(_named(raw, place, heading, sizes.get(place), kind))
    _require_sizes(found, raw.where)
    return found, remarks


def _unreadable(raw: RawTable, place: int, heading: Heading) -> str:
    """Why a column cannot take part; nothing where it can."""
    if not heading.written:
        held = "is empty" if raw.is_empty(place) else "has no heading"
        return f"{raw.where}: column {place + 1} {held} and is not read"
    if heading.unit or heading.name in (*BOOKKEEPING, "direction"):
        return ""
    if not raw.holds_numbers(place):
        return f"{raw.where}: {heading.written!r} holds no number and is not read"
    return ""


def _named(raw: RawTable, place: int, heading: Heading, random: object, kind: Kind) -> Column:
    key, name, unit = heading.written, heading.name, heading.unit or _clock(raw, place)
    if name in BOOKKEEPING:
        return Column(place, key, name, "", name)
    if name == "direction":
        return Column(place, key, name, "", "group")
    if not unit:
        raise WorkbenchError(
            f"{raw.where}: column {key!r} has no unit; end the name with it ({name}_V) or declare [table.columns]."
        )
    is_response = kind.is_response(name) or (not kind.responses and random is not None)
    return Column(place, key, name, unit, "response" if is_response else "condition", random)


def _require_sizes(columns: Sequence[Column], where: str) -> None:
    for column in columns:
        if column.role == "response" and column.random is None:
            raise WorkbenchError(
                f"{where}: the response {column.heading!r} has no random uncertainty; add it to u_random."
            )


# ---- both ----------------------------------------------------------------------------------------------------------


def _check_name(column: Column, where: str) -> None:
    """A quantity is one word: it is used in formulas, in names of channels and in the code of a new effect."""
    if column.role in ("condition", "response", "group") and not column.name.isidentifier():
        raise WorkbenchError(
            f'{where}: {column.name[:60]!r} is no name of a quantity; give the column one word, name = "force" in '
            "[table.columns] or alias in [[table]]."
        )


def _refuse_doubles(columns: Sequence[Column], where: str) -> None:
    for number, column in enumerate(columns):
        for other in columns[:number]:
            if column.place == other.place:
                raise WorkbenchError(f"{where}: the column {column.heading!r} is declared twice; keep one.")
            same = column.name == other.name if column.role not in BOOKKEEPING else column.role == other.role
            if same:
                what = column.role if column.role in BOOKKEEPING else column.name
                raise WorkbenchError(
                    f"{where}: the columns {other.heading!r} and {column.heading!r} are both {what}; keep one, or name "
                    "them apart."
                )
