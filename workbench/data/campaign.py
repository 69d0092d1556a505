"""Reads a campaign: a folder with ``campaign.toml`` and one CSV file a table. Everything is data; nothing is
executed or written.

Two spellings are read. Columns declared in ``[table.columns]`` with unit, role and uncertainty; or columns that
carry their
unit in the name (``torque_Nm``) with ``u_random = { column = value or formula }`` of the table.
"""

from __future__ import annotations

import hashlib
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from workbench.data.column_units import factor, split_unit
from workbench.data.conventions import with_conventions
from workbench.data.expression import evaluate
from workbench.data.kinds import Kind, kind_of
from workbench.data.table import Campaign, Response, Systematic, Table, Tolerance
from workbench.errors import WorkbenchError

FILE = "campaign.toml"
BOOKKEEPING = ("scan", "repeat", "holdout")
LAST_REPEAT = "last repeat of every table"
NO_HOLDOUT = "none"
FEW_ROWS = 12  # below this a table says little; the campaign says so


def read_campaign(folder: str | Path) -> Campaign:
    """The campaign of a folder.

    Raises:
        WorkbenchError: one sentence, what is wrong and where.
    """
    folder = Path(folder)
    content = _toml(folder / FILE)
    head = _section(content, "campaign")
    reader = _Reader(folder, content, holdout_rule(head.get("holdout", NO_HOLDOUT)))
    tables = tuple(reader.table(number, entry) for number, entry in enumerate(_tables(content), 1))
    repeats = _repeats(head, tables, reader.complaints)
    if not any(table.held_out.any() for table in tables):
        reader.complaints.append(
            "no row is held out: an accepted effect cannot be checked on data that no fit has seen"
        )
    campaign = Campaign(
        id=str(head.get("id", folder.name)),
        folder=str(folder),
        device=_section(content, "device") if "device" in content else {},
        tables=tables,
        tolerances=tuple(_tolerance(name, entry) for name, entry in content.get("tolerance", {}).items()),
        systematics=tuple(_systematic(name, entry) for name, entry in content.get("systematic", {}).items()),
        repeats=repeats,
        file_hashes=reader.hashes,
        complaints=tuple(reader.complaints),
        conventions=_section(content, "conventions") if "conventions" in content else {},
    )
    return with_conventions(campaign)


def columns_of_systematics(folder: str | Path) -> dict[str, tuple[tuple[str, str], ...]]:
    """(file, column) that name a systematic in ``u_sys``; empty where columns carry their unit in the name."""
    found: dict[str, list] = {}
    for entry in _tables(_toml(Path(folder) / FILE)):
        for column, declared in entry.get("columns", {}).items():
            names = declared.get("u_sys", [])
            for name in [names] if isinstance(names, str) else names:
                found.setdefault(name, []).append((entry["file"], column))
    return {name: tuple(columns) for name, columns in found.items()}


def holdout_rule(entry: object) -> str:
    """ "last repeat of every table", "column:NAME" or "none".

    Raises:
        WorkbenchError: the rule is another one.
    """
    rule = (
        entry.get("rule", f"column:{entry['column']}" if "column" in entry else "")
        if isinstance(entry, dict)
        else entry
    )
    if rule in (LAST_REPEAT, NO_HOLDOUT) or (isinstance(rule, str) and rule.startswith("column:")):
        return rule
    raise WorkbenchError(
        f'{FILE}: holdout = {entry!r} is not understood; write {{ rule = "{LAST_REPEAT}" }}, "column:NAME" or "none".'
    )


@dataclass
class _Reader:
    """What is collected while the tables of one campaign are read."""

    folder: Path
    content: Mapping[str, Any]
    rule: str
    hashes: dict[str, str] = field(default_factory=dict)
    complaints: list[str] = field(default_factory=list)

    def table(self, number: int, entry: Mapping[str, Any]) -> Table:
        where = f"{FILE}, table {number}"
        for key in ("file", "kind"):
            if not isinstance(entry.get(key), str):
                raise WorkbenchError(f"{where}: the key {key!r} is missing; give the name of a CSV file and its kind.")
        kind = kind_of(entry["kind"], where)
        frame = self._frame(entry["file"])
        columns = declared_columns(frame, entry, kind, entry["file"])
        frame = self._complete_rows(frame, columns, entry["file"])
        return self._assembled(frame, columns, entry)

    def _frame(self, name: str) -> pd.DataFrame:
        path = self.folder / name
        if Path(name).is_absolute() or ".." in Path(name).parts:
            raise WorkbenchError(f"{FILE}: the file {name!r} must lie in the folder of the campaign.")
        if not path.is_file():
            raise WorkbenchError(f"{self.folder}: the data file {name!r} of {FILE} does not exist; put it there.")
        self.hashes[name] = _sha256(path)
        try:
            frame = pd.read_parquet(path) if path.suffix == ".parquet" else pd.read_csv(path, skipinitialspace=True)
        except (ValueError, pd.errors.ParserError, UnicodeDecodeError, ImportError) as error:
            raise WorkbenchError(f"{path}: cannot be read as a table: {error}.") from None
        if frame.empty:
            raise WorkbenchError(f"{path}: has no rows; at least one measured row is needed.")
        return frame.rename(columns=str.strip)

    def _complete_rows(self, frame: pd.DataFrame, columns: dict[str, Column], name: str) -> pd.DataFrame:
        needed = list(columns)
        numbers = frame[needed].apply(pd.to_numeric, errors="coerce")
        whole = np.isfinite(numbers.to_numpy(dtype=float)).all(axis=1)
        if not whole.any():
            raise WorkbenchError(f"{name}: no row has a number in every one of its columns {', '.join(needed)}.")
        if not whole.all():
            first = int(np.flatnonzero(~whole)[0]) + 2
            self.complaints.append(
                f"{name}: {int((~whole).sum())} of {len(whole)} rows have a gap or no number (first in line "
                f"{first}) and are left out"
            )
        return numbers[whole].reset_index(drop=True)

    def _assembled(self, frame: pd.DataFrame, columns: dict[str, Column], entry: Mapping[str, Any]) -> Table:
        name = entry["file"]
        repeat = _numbers(frame, columns, "repeat")
        scan = _numbers(frame, columns, "scan") if "scan" in _roles(columns) else repeat
        raw = {c: frame[c].to_numpy(dtype=float) for c in columns}
        responses = {
            column.name: _response(key, column, raw, columns, name)
            for key, column in columns.items()
            if column.role == "response"
        }
        self._complain_of(responses, len(frame), name)
        conditions = {
            c.name: raw[key] * factor(c.unit or "1", name)
            for key, c in columns.items()
            if c.role in ("condition", "group")
        }
        condition_random = {
            c.name: np.broadcast_to(evaluate(c.random, {}, name) * factor(c.unit or "1", name), len(frame))
            for c in columns.values()
            if c.role == "condition" and c.random is not None
        }
        held_out = self._held_out(frame, columns, repeat, name)
        units = {c.name: c.unit for c in columns.values() if c.role in ("condition", "group")}
        return Table(entry["kind"], name, conditions, responses, scan, repeat, held_out, condition_random, units)

    def _complain_of(self, responses: Mapping[str, Response], rows: int, name: str) -> None:
        if not responses:
            raise WorkbenchError(f"{name}: no column is a measured response; name one in u_random or give it the role.")
        if rows < FEW_ROWS:
            self.complaints.append(f"{name}: only {rows} rows; its noise and its residuals say little")
        for response in responses.values():
            if rows > 2 and np.ptp(response.values) == 0:
                self.complaints.append(f"{name}: {response.name} has the same value in every row; is it stuck?")

    def _held_out(self, frame, columns, repeat, name) -> np.ndarray:
        if self.rule == NO_HOLDOUT:
            return np.zeros(len(frame), dtype=bool)
        if self.rule == LAST_REPEAT:
            if len(np.unique(repeat)) > 1:
                return repeat == repeat.max()
            self.complaints.append(
                f"{name}: one repeat only, so no row of it is held out and its noise is only declared"
            )
            return np.zeros(len(frame), dtype=bool)
        column = self.rule.removeprefix("column:")
        if column not in frame:
            raise WorkbenchError(f"{name}: the hold-out column {column!r} of {FILE} is not in the file.")
        return frame[column].to_numpy() != 0


@dataclass(frozen=True)
class Column:
    """How one column of a file is understood: name without unit, unit, role, random uncertainty as written."""

    name: str
    unit: str
    role: str
    random: object = None


def declared_columns(frame: pd.DataFrame, entry: Mapping[str, Any], kind: Kind, where: str) -> dict[str, Column]:
    """Column of the file -> how it is understood, in either spelling."""
    if "columns" in entry:
        return _columns_of_the_table(frame, entry["columns"], where)
    return _columns_of_the_names(frame, entry.get("u_random", {}), kind, where)


def _columns_of_the_table(frame, declared: Mapping[str, Any], where: str) -> dict[str, Column]:
    columns = {}
    for name, entry in declared.items():
        if name not in frame:
            if entry.get("optional", False):
                continue
            raise WorkbenchError(f"{where}: the column {name!r} of {FILE} is not there; found {', '.join(frame)}.")
        columns[name] = _declared(name, entry, where)
    return columns


def _declared(name: str, entry: Mapping[str, Any], where: str) -> Column:
    role = entry.get("role")
    if role not in ("condition", "response", "scan", "repeat", "group", "holdout"):
        raise WorkbenchError(
            f"{where}: column {name!r} has the role {role!r}; use condition, response, scan, repeat, group or holdout."
        )
    quantity, unit_of_name = split_unit(name)
    unit = entry.get("unit", unit_of_name)
    if role in ("condition", "response") and not unit:
        raise WorkbenchError(f'{where}: column {name!r} has no unit; add unit = "..." ("1" for a pure number).')
    if unit_of_name and unit_of_name != unit:
        raise WorkbenchError(
            f"{where}: column {name!r} says {unit_of_name} in its name and {unit} in {FILE}; keep one."
        )
    random = entry.get("u_random", entry.get("u"))
    if role == "response" and random is None:
        raise WorkbenchError(f"{where}: the response {name!r} has no u_random; give its random standard uncertainty.")
    return Column(quantity, unit, role, random)


def _columns_of_the_names(frame, random: Mapping[str, Any], kind: Kind, where: str) -> dict[str, Column]:
    unknown = [name for name in random if name not in frame]
    if unknown:
        raise WorkbenchError(f"{where}: u_random names {unknown[0]!r}, which is no column; found {', '.join(frame)}.")
    columns = {name: _named(name, random, kind, where) for name in frame}
    for name, column in columns.items():
        if column.role == "response" and column.random is None:
            raise WorkbenchError(f"{where}: the response {name!r} has no random uncertainty; add it to u_random.")
    return columns


def _named(name: str, random: Mapping[str, Any], kind: Kind, where: str) -> Column:
    quantity, unit = split_unit(name)
    if name in BOOKKEEPING:
        return Column(name, "", name)
    if name == "direction":
        return Column(name, "", "group")
    is_response = kind.is_response(quantity) or (not kind.responses and name in random)
    if not unit:
        raise WorkbenchError(
            f"{where}: column {name!r} has no unit; end the name with it ({name}_V) or declare [table.columns]."
        )
    return Column(quantity, unit, "response" if is_response else "condition", random.get(name))


def _response(key: str, column: Column, raw: Mapping[str, np.ndarray], columns, where: str) -> Response:
    """y, z and the conditions of a formula are in the units of the file; z is the size of a complex response."""
    names = {"y": raw[key], **{c: raw[c] for c, other in columns.items() if other.role == "condition"}}
    parts = [raw[c] for c, other in columns.items() if other.name in ("re", "im")]
    if len(parts) == 2:
        names["z"] = np.hypot(*parts)
    scale = factor(column.unit, where)
    random = np.broadcast_to(evaluate(column.random, names, where) * scale, raw[key].shape).astype(float)
    if not (random > 0).all():
        raise WorkbenchError(f"{where}: the random uncertainty of {key!r} must be positive in every row.")
    return Response(column.name, raw[key] * scale, random, column.unit, scale)


def _roles(columns: Mapping[str, Column]) -> set[str]:
    return {column.role for column in columns.values()}


def _numbers(frame: pd.DataFrame, columns: Mapping[str, Column], role: str) -> np.ndarray:
    for key, column in columns.items():
        if column.role == role:
            return frame[key].to_numpy().astype(int)
    return np.zeros(len(frame), dtype=int)


def _repeats(head: Mapping[str, Any], tables: tuple[Table, ...], complaints: list[str]) -> int:
    found = max(len(np.unique(table.repeat)) for table in tables)
    declared = head.get("repeats", found)
    if declared != found:
        complaints.append(f"{FILE} declares {declared} repeats, the tables have {found}")
    if found < 2:
        complaints.append("one repeat only: the size of the noise is taken as declared and its correlation is unknown")
    return int(found)


def _tolerance(name: str, entry: Any) -> Tolerance:
    where = f"{FILE}, [tolerance] {name}"
    quantity, unit = split_unit(name)
    if not isinstance(entry, dict) or ("sigma" in entry) == ("sigma_rel" in entry):
        raise WorkbenchError(f"{where}: give either sigma (in the unit of the name) or sigma_rel.")
    relative = "sigma_rel" in entry
    sigma = _positive(entry["sigma_rel" if relative else "sigma"], where)
    scale = 1.0 if relative else factor(entry.get("unit", unit) or "1", where)
    return Tolerance(quantity, sigma * scale, relative, str(entry.get("source", "")))


def _systematic(name: str, entry: Any) -> Systematic:
    where = f"{FILE}, [systematic] {name}"
    quantity, unit = split_unit(name)
    if not isinstance(entry, dict) or entry.get("kind") not in ("gain", "offset"):
        raise WorkbenchError(f'{where}: give sigma and kind = "gain" or "offset".')
    scale = 1.0 if entry["kind"] == "gain" else factor(entry.get("unit", unit) or "1", where)
    return Systematic(quantity, entry["kind"], _positive(entry.get("sigma"), where) * scale)


def _positive(value: object, where: str) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not value > 0:
        raise WorkbenchError(f"{where}: sigma must be a positive number, found {value!r}.")
    return float(value)


def _toml(path: Path) -> dict[str, Any]:
    if not path.is_file():
        raise WorkbenchError(
            f"{path.parent}: there is no {FILE}; a campaign is a folder with that file and its CSV tables."
        )
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise WorkbenchError(f"{path}: is not valid TOML: {error}.") from None


def _section(content: Mapping[str, Any], name: str) -> dict[str, Any]:
    section = content.get(name)
    if not isinstance(section, dict):
        raise WorkbenchError(f"{FILE}: the section [{name}] is missing.")
    return section


def _tables(content: Mapping[str, Any]) -> list[dict[str, Any]]:
    tables = content.get("table")
    if not isinstance(tables, list) or not tables:
        raise WorkbenchError(f"{FILE}: no [[table]] is given; name at least one CSV file and its kind.")
    return tables


def _sha256(path: Path) -> str:
    digest = hashlib.sha256()
    with path.open("rb") as stream:
        for block in iter(lambda: stream.read(1 << 20), b""):
            digest.update(block)
    return digest.hexdigest()
