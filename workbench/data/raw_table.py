"""A data file as it is: headings, cells and the line that each row stands in. Nothing is converted before it is asked
for, so that columns which nobody declares may hold anything."""

from __future__ import annotations

import csv
import re
import warnings
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from labelled import pd
from workbench.data.cells import (
    GAPS,
    decimal_sign,
    is_time,
    looks_like_data,
    may_be_thousands,
    readings,
    values_of,
)
from workbench.data.headings import heading_parts, known_unit
from workbench.errors import WorkbenchError

PARQUET = (".parquet", ".pq")
DELIMITERS = (";", "\t", "|", ",")  # the comma last: it may be a decimal sign
COMMENTS = ("#", "%", "//")
LOOKED_AT = 200  # lines from which the delimiter is guessed
ALIKE = 0.8  # share of them that a delimiter must cut into the same number of cells


@dataclass(frozen=True)
class Layout:
    """How a text table is written; None is found out.

    delimiter: between cells;  decimal: "," or ".";  encoding: as Python names it
    """

    delimiter: str | None = None
    decimal: str | None = None
    encoding: str | None = None


@dataclass(frozen=True)
class Heading:
    """A column's heading: as written, and its name and unit ("" where it has none)."""

    written: str
    name: str
    unit: str


@dataclass(frozen=True, eq=False)
class RawTable:
    """headings, columns: of the file, columns with n cells each;  lines: where each row stands, from 1 (n,)

    remarks: what was left out or read in an unusual way
    """

    where: str
    headings: tuple[Heading, ...]
    columns: tuple[Sequence, ...]
    lines: Sequence[int]
    decimal: str = "."
    delimiter: str = ","
    remarks: tuple[str, ...] = ()
    _known: dict[int, np.ndarray] = field(default_factory=dict)

    @property
    def rows(self) -> int:
        return len(self.lines)

    def values(self, column: int) -> np.ndarray:
        """Numbers of a column (n,): NaN where there is none, infinity for an open circuit, seconds for times."""
        if column not in self._known:
            cells = self.columns[column]
            numbers = cells if isinstance(cells, np.ndarray) else self._of_text(cells)
            self._known[column] = numbers
        return self._known[column].copy()

    def _of_text(self, cells: Sequence[str]) -> np.ndarray:
        return values_of(cells, self.decimal, self.where, self.lines)

    def labels(self, column: int) -> np.ndarray:
        """Numbers 0, 1, ... for the different texts of a column, in the order of their first row (n,)."""
        texts = [str(cell).strip() for cell in self.columns[column]]
        number = {text: k for k, text in enumerate(dict.fromkeys(texts))}
        return np.array([number[text] for text in texts], dtype=float)

    def holds_times(self, column: int) -> bool:
        return not isinstance(self.columns[column], np.ndarray) and is_time(self.columns[column])

    def holds_numbers(self, column: int) -> bool:
        return not np.isnan(self.values(column)).all()

    def is_empty(self, column: int) -> bool:
        cells = self.columns[column]
        if isinstance(cells, np.ndarray):
            return bool(np.isnan(cells).all())
        return all(cell.strip().lower() in GAPS for cell in cells)


def used_twice(where: str, count: int, heading: str) -> WorkbenchError:
    """Of a heading that several columns have."""
    return WorkbenchError(f"{where}: {count} columns are called {heading!r}; rename all but one of them.")


def read_raw(path: Path, layout: Layout = Layout()) -> RawTable:
    """The table of a CSV, text or Parquet file.

    Raises:
        WorkbenchError: one sentence, why there is no table.
    """
    if path.suffix.lower() in PARQUET:
        return _of_parquet(path)
    try:
        data = path.read_bytes()
    except OSError as error:
        raise WorkbenchError(f"{path.name}: cannot be read ({error.strerror}).") from None
    return table_of_text(decoded(data, path.name, layout.encoding), path.name, layout)


# ---- bytes to text -------------------------------------------------------------------------------------------------

_MARKS = (
    (b"\xef\xbb\xbf", "utf-8-sig"), (b"\xff\xfe\x00\x00", "utf-32"), (b"\x00\x00\xfe\xff", "utf-32"),
    (b"\xff\xfe", "utf-16"), (b"\xfe\xff", "utf-16"),
)  # fmt: skip
_ARCHIVE = b"PK\x03\x04"  # how the files of spreadsheets begin
_CONTROL = re.compile(r"[\x00-\x08\x0e-\x1f\x7f]")


def decoded(data: bytes, where: str, encoding: str | None = None) -> str:
    """The text of a file: UTF-8 or UTF-16 with or without a byte-order mark, else Windows-1252, else Latin-1.

    Raises:
        WorkbenchError: the bytes are no text.
    """
    if data.startswith(_ARCHIVE):
        raise WorkbenchError(f"{where}: is no text but an archive, as spreadsheets are; save it as CSV from there.")
    for name in [encoding] if encoding else _likely_encodings(data):
        try:
            text = data.decode(name)
        except (UnicodeError, LookupError):
            continue
        return _clean(text, where)
    raise WorkbenchError(f"{where}: is no text in {encoding}; leave encoding out, or say another.")


def _likely_encodings(data: bytes) -> list[str]:
    marked = [name for mark, name in _MARKS if data.startswith(mark)]
    zeros = data[:2000].count(0)
    if not marked and zeros > 0.2 * len(data[:2000]):
        marked = ["utf-16-le" if data[1:2000:2].count(0) > data[0:2000:2].count(0) else "utf-16-be"]
    return [*marked, "utf-8", "cp1252", "latin-1"]


def _clean(text: str, where: str) -> str:
    text = text.removeprefix("\ufeff").rstrip("\x1a\x00").replace("\r\n", "\n").replace("\r", "\n")
    if wrong := _CONTROL.search(text):
        line = text.count("\n", 0, wrong.start()) + 1
        raise WorkbenchError(f"{where}: is no text table (line {line} holds a control character); export it as CSV.")
    return text


# ---- text to rows of cells -----------------------------------------------------------------------------------------


def table_of_text(text: str, where: str, layout: Layout = Layout()) -> RawTable:
    """The table in a text, see ``read_raw``."""
    lines = text.split("\n")
    if lines[0].lower().startswith("sep=") and len(lines[0]) == 5:
        layout, lines[0] = replace(layout, delimiter=layout.delimiter or lines[0][4]), ""
    content = _without_comments(lines)
    delimiter = layout.delimiter or _delimiter(content)
    first, names, units = _head(lines, content, delimiter, where)
    headings, body = tuple(map(_heading, names, units)), content[first - 1 :]
    decimal = layout.decimal or _decimal(body, delimiter, where)
    doubts = _doubts(body, where) if delimiter == ";" and decimal == "." and not layout.decimal else []
    plain = _all_numbers(body, delimiter, decimal, len(names))
    if plain is not None:
        lines_of = range(first, first + len(body))
        return RawTable(where, headings, tuple(plain.T), lines_of, decimal, delimiter, tuple(doubts))
    rows, remarks = _same_width(len(names), _rows(content, first, delimiter, where), delimiter, where)
    columns = tuple(zip(*(cells for _, cells in rows)))
    return RawTable(where, headings, columns, [line for line, _ in rows], decimal, delimiter, tuple(doubts + remarks))


def _doubts(body: Sequence[str], where: str) -> list[str]:
    """Between semicolons a point may be the sign of thousands, as where the comma is that of decimals."""
    said = may_be_thousands("\n".join(body))
    words = f'{where}: {said} is read as a decimal number; where it is thousands, say decimal = "," in its [[table]]'
    return [words] if said else []


def _without_comments(lines: Sequence[str]) -> list[str]:
    """The lines with comments blank, without blank ones at the end."""
    text = "".join(lines)
    if any(sign in text for sign in COMMENTS):
        lines = ["" if line.lstrip().startswith(COMMENTS) else line for line in lines]
    end = len(lines)
    while end and not lines[end - 1].strip():
        end -= 1
    return list(lines[:end])


def _no_rows(where: str) -> WorkbenchError:
    return WorkbenchError(f"{where}: has no rows; at least one measured row is needed.")


def _head(lines: Sequence[str], content: Sequence[str], delimiter: str, where: str) -> tuple[int, list[str], list[str]]:
    """Line of the first row of data, names and units of the columns."""
    rows = _rows(content[:LOOKED_AT], 1, delimiter, where)
    if not rows:
        raise _no_rows(where)
    start = _first_data(rows)
    if start == len(rows):
        _refuse_open_quotes(rows, where)
        raise _no_rows(where)
    _refuse_open_quotes(rows[start : start + 1], where)
    first = rows[start][0]
    names, units = _heading_rows(rows[:start], lines[: first - 1], delimiter, where)
    return first, names, (units + [""] * len(names))[: len(names)]


_PLAIN = frozenset("0123456789+-.eE ")


def _all_numbers(lines: Sequence[str], delimiter: str, decimal: str, width: int) -> np.ndarray | None:
    """The quick way for the usual file: every line has the same number of cells and every cell is a plain number
    (n, width); None for any other."""
    if delimiter == " " or {line.count(delimiter) for line in lines} != {width - 1}:
        return None
    text = delimiter.join(lines)
    if decimal == ",":
        if "." in text or delimiter == ",":
            return None
        text = text.replace(",", ".")
    if not set(text) <= _PLAIN | {delimiter}:
        return None
    with warnings.catch_warnings():
        warnings.simplefilter("error", DeprecationWarning)  # numpy's word for a cell that is no number
        try:
            values = np.fromstring(text, sep=delimiter)
        except (DeprecationWarning, ValueError):
            return None
    return readings(values).reshape(len(lines), width) if len(values) == len(lines) * width else None


def _decimal(body: Sequence[str], delimiter: str, where: str) -> str:
    """Where the comma is the delimiter a decimal comma can only stand within quotes."""
    text = "\n".join(body)
    if delimiter == ",":
        text = "\n".join(re.findall(r'"([^"\n]*)"', text)) if '"' in text else ""
    return decimal_sign(text, where)


def _delimiter(content: Sequence[str]) -> str:
    """The sign that cuts most lines into equally many cells, two at least; blanks where no sign does."""
    sample = [line for line in content if line.strip()][:LOOKED_AT]
    sample = sample[len(sample) // 2 :]  # titles stand above
    for sign in (*DELIMITERS, " "):
        counts = Counter(len(_cells(line, sign)) for line in sample)
        most, times = max(counts.items(), key=lambda item: item[1], default=(1, 0))
        if most > 1 and times >= ALIKE * len(sample):
            return sign
    return ","


def _cells(line: str, sign: str) -> list[str]:
    if sign == " ":
        return line.split()
    try:
        return next(csv.reader([line], delimiter=sign), [])
    except csv.Error:
        return []


Row = tuple[int, list[str]]  # line of the file, cells


def _rows(content: Sequence[str], first: int, delimiter: str, where: str) -> list[Row]:
    """Rows that hold something, from a line on."""
    lines = content[first - 1 :]
    if delimiter == " ":
        return [(number, line.split()) for number, line in enumerate(lines, first) if line.strip()]
    reader = csv.reader((line + "\n" for line in lines), delimiter=delimiter, skipinitialspace=True)
    try:
        return [(reader.line_num + first - 1, cells) for cells in reader if any(cells)]
    except csv.Error as error:
        line = reader.line_num + first - 1
        raise WorkbenchError(f"{where}: line {line} cannot be cut into cells: {error}.") from None


def _first_data(rows: Sequence[Row]) -> int:
    """The first row, not far narrower than most, that says numbers for the better part; the second where none is.

    Half a row of numbers will do where the next row is alike: a title such as ``date; 2026-01-31`` stands alone.
    """
    usual = Counter(len(cells) for _, cells in rows).most_common(1)[0][0]
    shares = [_share_of_numbers(cells) if 2 * len(cells) > usual else 0.0 for _, cells in rows]
    for number, (share, after) in enumerate(zip(shares, [*shares[1:], 0.0])):
        if share > 0.5 or (share == 0.5 and after >= 0.5):
            return number
    return min(1, len(rows))


def _share_of_numbers(cells: Sequence[str]) -> float:
    """Numbers, times and gaps among what the cells say; none without a number."""
    said = [cell.strip() for cell in cells if cell.strip()]
    numbers = sum(looks_like_data(cell) for cell in said)
    return (numbers + sum(cell.lower() in GAPS for cell in said)) / len(said) if numbers else 0.0


def _heading_rows(
    above: Sequence[Row], lines: Sequence[str], delimiter: str, where: str
) -> tuple[list[str], list[str]]:
    """Names and units of the columns: of the last line above the data, or of the last two where that one holds units.

    lines: above the data; names in a comment count where there are no others
    """
    if not above:
        return _commented_names(lines, delimiter, where), []
    last = [_one_line(cell) for cell in above[-1][1]]
    if len(above) > 1 and _are_units(last) and _said(above[-2][1]) >= _said(last):
        return [_one_line(cell) for cell in above[-2][1]], last
    return last, []


def _commented_names(lines: Sequence[str], delimiter: str, where: str) -> list[str]:
    comments = [line.strip().lstrip("#%/ ") for line in lines if line.lstrip().startswith(COMMENTS)]
    if not comments:
        raise WorkbenchError(f"{where}: has no line of headings above its numbers; add one that names the columns.")
    return [_one_line(cell) for cell in _cells(comments[-1], delimiter)]


def _one_line(cell: str) -> str:
    return " ".join(cell.split())


def _said(cells: Sequence[str]) -> int:
    return sum(bool(cell.strip()) for cell in cells)


def _are_units(cells: Sequence[str]) -> bool:
    """Whether most of what the cells say are units, bare or in brackets."""
    said = [cell for cell in cells if cell]
    return 2 * sum(_bare_unit(cell) is not None for cell in said) > len(said)


def _bare_unit(cell: str) -> str | None:
    text = cell.strip()
    return known_unit(text[1:-1] if text[:1] + text[-1:] in ("[]", "()", "<>", "{}") else text)


def _same_width(width: int, rows: list[Row], delimiter: str, where: str) -> tuple[list[Row], list[str]]:
    """Rows of as many cells as there are headings. A cell more that is empty is dropped, a cell less is a gap; both are
    said.

    Raises:
        WorkbenchError: a row has something in a cell that no heading stands above, or a quote is not closed.
    """
    _refuse_open_quotes(rows, where)
    longer, shorter = ([row for row in rows if len(row[1]) > width], [row for row in rows if len(row[1]) < width])
    _refuse_more_cells(longer, width, delimiter, where)
    remarks = []
    if longer:
        remarks.append(f"{where}: {_of(longer, rows)} with an empty cell more than the headings; it is dropped")
    if shorter:
        remarks.append(
            f"{where}: {_of(shorter, rows)} with fewer cells than headings (first line {shorter[0][0]}); what is "
            "missing counts as gaps"
        )
    if longer or shorter:
        rows = [(line, (cells + [""] * width)[:width]) for line, cells in rows]
    return rows, remarks


def _refuse_open_quotes(rows: Sequence[Row], where: str) -> None:
    for line, cells in rows:
        if any("\n" in cell for cell in cells):
            raise WorkbenchError(f"{where}: a quote is opened and not closed above line {line}; correct that place.")


def _refuse_more_cells(longer: Sequence[Row], width: int, delimiter: str, where: str) -> None:
    for line, cells in longer:
        if any(cell.strip() for cell in cells[width:]):
            hint = "; decimal commas need another delimiter" if delimiter == "," else ""
            raise WorkbenchError(
                f"{where}: line {line} has {len(cells)} cells, its headings are {width}: correct that line{hint}."
            )


def _of(some: Sequence[Row], rows: Sequence[Row]) -> str:
    return "all rows" if len(some) == len(rows) else f"{len(some)} of {len(rows)} rows"


def _heading(written: str, unit: str = "") -> Heading:
    """The unit of the heading itself, else that of the line below it."""
    name, own = heading_parts(written)
    return Heading(written, name, own or (_bare_unit(unit) or "" if unit else ""))


# ---- Parquet -------------------------------------------------------------------------------------------------------


def _of_parquet(path: Path) -> RawTable:
    try:
        frame = pd.read_parquet(path)
    except Exception as error:  # pyarrow raises many kinds for a broken file
        words = str(error).strip().splitlines() or [type(error).__name__]
        raise WorkbenchError(f"{path.name}: cannot be read as Parquet: {words[0].rstrip('.')}.") from None
    if any(name is not None for name in frame.index.names):
        frame = frame.reset_index()
    if frame.empty:
        raise WorkbenchError(f"{path.name}: has no rows; at least one measured row is needed.")
    headings = tuple(_heading(_one_line(str(name))) for name in frame.columns)
    columns = tuple(_parquet_column(frame.iloc[:, k]) for k in range(frame.shape[1]))
    return RawTable(path.name, headings, columns, range(1, len(frame) + 1))


def _parquet_column(column: pd.Series) -> np.ndarray | list[str]:
    if not column.notna().any():
        return np.full(len(column), np.nan)
    if pd.api.types.is_datetime64_any_dtype(column):
        return (column - column.dropna().iloc[0]).dt.total_seconds().to_numpy(dtype=float)
    if pd.api.types.is_numeric_dtype(column) and not pd.api.types.is_complex_dtype(column):
        return column.to_numpy(dtype=float, na_value=np.nan)
    return ["" if cell is None else str(cell) for cell in column]
