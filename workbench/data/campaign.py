"""Reads a campaign: a folder with ``campaign.toml`` and one CSV or Parquet file a table. Everything is data; nothing is
executed or written.

Two spellings are read. Columns declared in ``[table.columns]`` with unit, role and uncertainty; or columns that carry
their unit in the heading (``torque_Nm``, ``torque [Nm]``) with ``u_random = { column = value or formula }`` of the
table. ``docs/campaign.md`` lists every key.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np

from labelled import pd
from workbench.data.column_units import difference, factor, split_unit, to_inside
from workbench.data.columns import BOOKKEEPING, Column, columns_of
from workbench.data.constants import with_constants
from workbench.data.conventions import with_conventions
from workbench.data.dimensions import check_input, check_reading
from workbench.data.expression import evaluate
from workbench.data.kinds import kind_of
from workbench.data.predictions import read_predictions
from workbench.data.raw_table import Layout, RawTable, read_raw
from workbench.data.schema import (
    BY_REGION,
    FILE,
    LAST_REPEAT,
    NO_HOLDOUT,
    OF_A_COLUMN,
    CampaignFile,
    SystematicEntry,
    TableEntry,
    ToleranceEntry,
    campaign_file,
    folder_name,
    holdout_rule,
)  # fmt: skip
from workbench.data.side_by_side import stacked
from workbench.data.suspicions import FEW_ROWS, suspicions
from workbench.data.table import OPEN_CIRCUIT, Campaign, Conditions, Response, Systematic, Table, Tolerance
from workbench.errors import WorkbenchError
from workbench.findings import Prediction

__all__ = [
    "BOOKKEEPING", "BY_REGION", "FEW_ROWS", "FILE", "LAST_REPEAT", "NO_HOLDOUT", "columns_of_systematics",
    "holdout_rule", "read_campaign",
]  # fmt: skip

SPARSE = 0.05  # share of a table's readings that gaps of another column may cost before that column is kept apart
FINEST = 1e-12  # of the largest reading: no instrument resolves less
MOST = 2**31  # repeats, scans: numbers of them are counted with


def read_campaign(folder: str | Path) -> Campaign:
    """The campaign of a folder.

    Raises:
        WorkbenchError: one sentence, what is wrong and where.
    """
    folder = Path(folder)
    content = campaign_file(folder)
    reader = _Reader(folder, content)
    tables = tuple(table for number, entry in enumerate(content.table, 1) for table in reader.tables(number, entry))
    _refuse_twins(tables)
    repeats = _repeats(content.campaign.repeats, tables, reader.complaints)
    campaign = Campaign(
        id=_id(content.campaign.id, folder),
        folder=str(folder),
        device=_checked_inputs(content.device),
        tables=tables,
        tolerances=tuple(_tolerance(name, entry) for name, entry in content.tolerance.items()),
        systematics=tuple(_systematic(name, entry) for name, entry in content.systematic.items()),
        repeats=repeats,
        file_hashes=reader.hashes,
        complaints=tuple(reader.complaints),
        holdout=content.campaign.holdout,
        conventions=content.conventions,
        predictions=reader.predictions(),
    )
    return with_conventions(campaign)


def columns_of_systematics(folder: str | Path) -> dict[str, tuple[tuple[str, str], ...]]:
    """(file, quantity) that name a systematic in ``u_sys``; empty where columns carry their unit in the name."""
    found: dict[str, list[tuple[str, str]]] = {}
    for entry in campaign_file(Path(folder)).table:
        for key, column in (entry.columns or {}).items():
            for name in column.u_sys:
                found.setdefault(name, []).append((entry.file, column.name or entry.alias.get(key, key)))
    return {name: tuple(columns) for name, columns in found.items()}


@dataclass
class _Reader:
    """What is collected while the tables of one campaign are read."""

    folder: Path
    content: CampaignFile
    hashes: dict[str, str] = field(default_factory=dict)
    complaints: list[str] = field(default_factory=list)

    def tables(self, number: int, entry: TableEntry) -> list[Table]:
        """The tables of a file: one, or more where columns with many gaps are kept apart."""
        kind = kind_of(entry.kind, f"{FILE}, table {number}")
        files = (entry.model_copy(update={"file": name}) for name in (entry.file, *entry.repeats))
        raw, entry = with_constants(*stacked([self._raw(one) for one in files], entry))
        self.complaints += raw.remarks
        columns, remarks = columns_of(raw, entry, kind)
        self.complaints += remarks
        if not any(column.role == "response" for column in columns):
            raise WorkbenchError(
                f"{entry.file}: no column is a measured response; name one in u_random or give it the role."
            )
        whole = _WholeTable(raw, columns, entry)
        masks = whole.masks(self.complaints)
        held_out = self._held_out(whole)
        parts = [whole.part(names, rows, held_out) for names, rows in masks]
        for part in parts:
            self.complaints += suspicions(part)
        return parts

    def predictions(self) -> tuple[Prediction, ...]:
        """Of the file that [campaign] names; none where it names none."""
        name = self.content.campaign.predictions
        if name is None:
            return ()
        path = self._path(name)
        self.hashes[name] = _sha256(path)
        return read_predictions(path)

    def _raw(self, entry: TableEntry) -> RawTable:
        path = self._path(entry.file)
        digest = _sha256(path)
        for name, known in self.hashes.items():
            if known == digest and name != entry.file:
                self.complaints.append(f"{name} and {entry.file} are the same file under two names")
        self.hashes[entry.file] = digest
        return read_raw(path, Layout(entry.delimiter, entry.decimal, entry.encoding))

    def _path(self, name: str) -> Path:
        """The file in the folder of the campaign."""
        if Path(name).is_absolute() or ".." in Path(name).parts:
            raise WorkbenchError(f"{FILE}: the file {name!r} must lie in the folder of the campaign.")
        try:
            found = (self.folder / name).is_file()
        except (OSError, ValueError):  # a name that no file can have
            found = False
        if not found:
            raise WorkbenchError(f"{self.folder}: the data file {name[:100]!r} of {FILE} does not exist; put it there.")
        return self.folder / name

    def _held_out(self, whole: _WholeTable) -> np.ndarray:
        rule, name = self.content.campaign.holdout, whole.name
        none = np.zeros(whole.raw.rows, dtype=bool)
        if rule == LAST_REPEAT:
            usable = whole.repeat[whole.complete & ~whole.is_copy]
            if len(np.unique(usable)) > 1:
                return whole.repeat == usable.max()
            self.complaints.append(
                f"{name}: one repeat only, so no row of it is held out and its noise is only declared"
            )
        if rule.startswith(OF_A_COLUMN):
            return whole.marked(rule.removeprefix(OF_A_COLUMN))
        if rule == BY_REGION and "holdout" not in self.content.campaign.model_fields_set and whole.marks:
            self.complaints.append(
                f'{name}: its column {whole.marks!r} is not used; say holdout = "column:{whole.marks}" in [campaign]'
            )
        return none


@dataclass(frozen=True, eq=False)
class _WholeTable:
    """All rows of a file, with the columns that take part."""

    raw: RawTable
    columns: tuple[Column, ...]
    entry: TableEntry

    @property
    def name(self) -> str:
        return self.entry.file

    def of_role(self, *roles: str) -> list[Column]:
        return [column for column in self.columns if column.role in roles]

    # ---- rows -------------------------------------------------------------------------------------------------------

    @cached_property
    def complete(self) -> np.ndarray:
        """Rows with a number in every column that is no response (n,)."""
        others = [self.values(column) for column in self.columns if column.role != "response"]
        return np.logical_and.reduce([np.isfinite(v) for v in others], initial=True) & np.ones(
            self.raw.rows, dtype=bool
        )

    def masks(self, complaints: list[str]) -> list[tuple[list[str], np.ndarray]]:
        """Responses and the rows that they have readings in. A row with a gap is left out; where that would cost other
        responses more than SPARSE of the readings, a response with gaps is kept in a table of its own."""
        given = {c.name: self.complete & np.isfinite(self.values(c)) for c in self.of_role("response")}
        self._require_rows(given)
        whole = np.logical_and.reduce(list(given.values()))
        readings = sum(int(mask.sum()) for mask in given.values())
        lost = readings - len(given) * int(whole.sum())
        groups = {whole.tobytes(): (list(given), whole)} if lost <= SPARSE * readings else _alike(given)
        if not whole.all() and len(groups) == 1:
            number, first = self._counted(~whole)
            complaints.append(f"{self.name}: {number} have a gap or no number (first in {first}) and are left out")
        if len(groups) > 1:
            complaints += [self._apart(names, rows) for names, rows in groups.values() if not rows.all()]
        complaints += [self._copied(*pair) for pair in self.copies.items()] + self._pasted()
        return [(names, rows & ~self.is_copy) for names, rows in groups.values()]

    @cached_property
    def copies(self) -> dict[int, int]:
        """Every repeat that is a copy to the last digit of one before, which it says nothing beside -> that one; so
        few rows as may be alike by chance are none."""
        taken = [self.values(c) for c in self.columns if c.role in ("condition", "group", "response")]
        seen, found = dict[bytes, int](), dict[int, int]()
        for repeat in np.unique(self.repeat[self.complete]).tolist():
            rows = self.complete & (self.repeat == repeat)
            first = seen.setdefault(np.array([values[rows] for values in taken]).tobytes(), repeat)
            if first != repeat and rows.sum() >= FEW_ROWS:
                found[repeat] = first
        return found

    @cached_property
    def is_copy(self) -> np.ndarray:
        """Rows of such repeats (n,)."""
        return np.isin(self.repeat, list(self.copies))

    def _pasted(self) -> list[str]:
        """A sentence where rows are those of before in all cells, those that are not read included: else readings in
        coarse digits would be."""
        again = pd.DataFrame(dict(enumerate(self.raw.columns))).duplicated().to_numpy()
        if not again.any():
            return []
        number, first = self._counted(again)
        said = f"{self.name}: {number} are exact copies of an earlier row (first in {first})"
        return [f"{said}; they count as readings of their own: delete what was pasted twice"]

    def _copied(self, repeat: int, of: int) -> str:
        return f"{self.name}: repeat {repeat} is an exact copy of repeat {of}; it says nothing new and is left out"

    def _counted(self, gaps: np.ndarray) -> tuple[str, str]:
        """("3 of 40 rows", "line 7")."""
        return f"{int(gaps.sum())} of {len(gaps)} rows", f"line {self.raw.lines[int(np.flatnonzero(gaps)[0])]}"

    def _apart(self, names: Sequence[str], rows: np.ndarray) -> str:
        what = f"{' and '.join(names)} {'has' if len(names) == 1 else 'have'}"
        number, first = self._counted(~rows)
        return f"{self.name}: {what} no reading in {number} (first in {first}); the other responses keep those rows"

    def _require_rows(self, given: Mapping[str, np.ndarray]) -> None:
        missing = [name for name, mask in given.items() if not mask.any()]
        if missing:
            needed = ", ".join(c.heading for c in self.columns if c.role != "response" or c.name == missing[0])
            raise WorkbenchError(f"{self.name}: no row has a number in every one of its columns {needed}.")

    # ---- values -----------------------------------------------------------------------------------------------------

    def values(self, column: Column) -> np.ndarray:
        """Numbers in the unit of the file (n,), NaN where there is none; an open shunt is a very large one."""
        values = self.raw.values(column.place)
        if column.role in ("scan", "repeat") and np.isnan(values).all():
            return self.raw.labels(column.place)
        if column.name == "shunt":
            values[values == np.inf] = OPEN_CIRCUIT / factor(column.unit, f"{self.name}, {column.name}")
        return np.where(np.isinf(values), np.nan, values)

    def numbers(self, role: str) -> np.ndarray | None:
        """Whole numbers of the scan or the repeat (n,), 0 where there is none; None without such a column."""
        found = self.of_role(role)
        if not found:
            return None
        values = np.where(self.complete, self.values(found[0]), 0.0)
        if not ((np.abs(values) < MOST) & (values == np.round(values))).all():
            raise WorkbenchError(f"{self.name}: the column {found[0].heading!r} must hold whole numbers.")
        return values.astype(int)

    @cached_property
    def repeat(self) -> np.ndarray:
        found = self.numbers("repeat")
        return np.zeros(self.raw.rows, dtype=int) if found is None else found

    @property
    def marks(self) -> str:
        """Heading of the column that marks rows to hold out, "" without one."""
        return next((column.heading for column in self.of_role("holdout")), "")

    def marked(self, name: str) -> np.ndarray:
        """Rows in which a column is not zero (n,)."""
        for place, heading in enumerate(self.raw.headings):
            if name in (heading.written, heading.name):
                values = self.raw.values(place)
                return np.isfinite(values) & (values != 0)
        raise WorkbenchError(f"{self.name}: the hold-out column {name!r} of {FILE} is not in the file.")

    # ---- tables -----------------------------------------------------------------------------------------------------

    def part(self, names: Sequence[str], rows: np.ndarray, held_out: np.ndarray) -> Table:
        """The table of some responses in some rows."""
        scan = self.numbers("scan")
        conditions = {c.name: self._inside(c)[rows] for c in self.of_role("condition", "group")}
        _check_conditions(conditions, self.name)
        return Table(
            self.entry.kind,
            self.name,
            Conditions(conditions, self.name),
            {c.name: self._response(c, rows) for c in self.of_role("response") if c.name in names},
            (self.repeat if scan is None else scan)[rows],
            self.repeat[rows],
            held_out[rows],
            {c.name: self._random(c, rows) for c in self.of_role("condition") if c.random is not None},
            self.entry.bandwidth_Hz,
            {c.name: c.unit for c in self.of_role("condition", "group")},
            np.asarray(self.raw.lines)[rows],
        )

    def _inside(self, column: Column) -> np.ndarray:
        return to_inside(self.values(column), column.name, column.unit or "1", self.name)

    def _response(self, column: Column, rows: np.ndarray) -> Response:
        scale = difference(column.unit, column.name, self.name)
        values, random = self._inside(column)[rows], self._random(column, rows)
        if not (random > FINEST * np.abs(values).max()).all():
            raise WorkbenchError(
                f"{self.name}: the random uncertainty of {column.heading!r} must be positive in every row, and not "
                f"less than {FINEST:g} of the largest reading."
            )
        return Response(column.name, values, random, column.unit, scale, column.bandwidth)

    def _random(self, column: Column, rows: np.ndarray) -> np.ndarray:
        """Declared random uncertainty, inside (n,). y, z and the conditions of a formula are in the units of the file;
        z is the size of a complex response."""
        names = {"y": self.values(column)[rows]}
        for other in self.of_role("condition"):
            names[other.heading] = names[other.name] = self.values(other)[rows]
        parts = [self.values(c)[rows] for c in self.columns if c.name in ("re", "im")]
        if len(parts) == 2:
            names["z"] = np.hypot(*parts)
        value = evaluate(column.random, names, f"{self.name}, u_random of {column.heading!r}")
        if not (value >= 0).all():
            raise WorkbenchError(f"{self.name}: the random uncertainty of {column.heading!r} is negative somewhere.")
        size = np.broadcast_to(value, names["y"].shape)
        return size * difference(column.unit or "1", column.name, self.name)


def _alike(given: Mapping[str, np.ndarray]) -> dict[bytes, tuple[list[str], np.ndarray]]:
    """Responses that have readings in the same rows, together."""
    groups: dict[bytes, tuple[list[str], np.ndarray]] = {}
    for name, mask in given.items():
        groups.setdefault(mask.tobytes(), ([], mask))[0].append(name)
    return groups


_POSITIVE, _NOT_NEGATIVE = ("frequency", "amplitude"), ("shunt",)


def _check_conditions(conditions: Mapping[str, np.ndarray], where: str) -> None:
    for name, values in conditions.items():
        if name in _POSITIVE and not (values > 0).all():
            raise WorkbenchError(f"{where}: {name} must be positive in every row.")
        if name in _NOT_NEGATIVE and not (values >= 0).all():
            raise WorkbenchError(f"{where}: {name} must not be negative in any row.")


def _refuse_twins(tables: Sequence[Table]) -> None:
    """A channel is named by its file and its quantity; no reading takes part twice."""
    seen: dict[tuple[str, str], str] = {}
    for table in tables:
        for name in table.responses:
            key = (Path(table.file).stem, name)
            if key in seen:
                how = "names" if seen[key] == table.file else f"has {seen[key]!r} and"
                raise WorkbenchError(
                    f"{FILE}: {how} {table.file!r} twice for {name}; name every file once, each with a name of its own."
                )
            seen[key] = table.file


def _repeats(declared: int | None, tables: Sequence[Table], complaints: list[str]) -> int:
    found = max(len(np.unique(table.repeat)) for table in tables)
    if declared is not None and declared != found:
        complaints.append(f"{FILE} declares {declared} repeats, the tables have {found}")
    if found < 2:
        complaints.append("one repeat only: the size of the noise is taken as declared and its correlation is unknown")
    return int(found)


def _id(written: str | None, folder: Path) -> str:
    try:
        return folder_name(written or folder.resolve().name)
    except ValueError as error:
        raise WorkbenchError(
            f"{FILE}: [campaign] has no id, and the name of its folder cannot be one: it {error}."
        ) from None


def _checked_inputs(device: Mapping[str, object]) -> Mapping[str, object]:
    for key in device:
        check_input(*split_unit(key), f"{FILE}, [device] {key}")
    return device


def _tolerance(name: str, entry: ToleranceEntry) -> Tolerance:
    quantity, unit = split_unit(name)
    where = f"{FILE}, [tolerance] {name}"
    check_input(quantity, entry.unit or unit, where)
    source = "" if entry.source is None else str(entry.source)
    if entry.sigma_rel is not None:
        return Tolerance(quantity, entry.sigma_rel, True, source)
    return Tolerance(quantity, entry.sigma * factor(entry.unit or unit or "1", where), False, source)


def _systematic(name: str, entry: SystematicEntry) -> Systematic:
    quantity, unit = split_unit(name)
    where = f"{FILE}, [systematic] {name}"
    if entry.kind == "gain":
        return Systematic(quantity, entry.kind, entry.sigma)
    check_reading(quantity, entry.unit or unit, where)
    scale = factor(entry.unit or unit or "1", where)
    return Systematic(quantity, entry.kind, entry.sigma * scale)


def _sha256(path: Path) -> str:
    digest = hashlib.sha256()
    try:
        with path.open("rb") as stream:
            for block in iter(lambda: stream.read(1 << 20), b""):
                digest.update(block)
    except OSError as error:
        raise WorkbenchError(f"{path.name}: cannot be read ({error.strerror}).") from None
    return digest.hexdigest()
