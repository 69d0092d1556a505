"""One page of HTML that reads from top to bottom: text, key numbers, tables and pictures, with nothing beside it."""

from __future__ import annotations

import re
from base64 import b64encode
from collections.abc import Iterable
from dataclasses import dataclass, field
from math import floor, inf, isinf, log10
from pathlib import Path
from typing import ClassVar, SupportsFloat

import pandas as pd
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from matplotlib.figure import Figure

from figures.style import png_bytes
from units import split_unit, written

TEMPLATE = "report.html.j2"
SIGNIFICANT_DIGITS = 4  # of numbers in tables


@dataclass(frozen=True)
class Table:
    """A table with its caption.

    headings: column -> heading where the one made from the column's name will not do; marked: row numbers to stress
    """

    kind: ClassVar[str] = "table"
    frame: pd.DataFrame
    caption: str
    headings: dict[str, str] = field(default_factory=dict)
    marked: tuple[int, ...] = ()

    @property
    def columns(self) -> list[tuple[str, str]]:
        """(heading, kind) of every column; kind is "text" or "number" and decides the side it is set to."""
        names = [self.headings.get(name, heading(str(name))) for name in self.frame.columns]
        kinds = ["text" if _holds_text(self.frame[name]) else "number" for name in self.frame.columns]
        return list(zip(names, kinds, strict=True))

    @property
    def rows(self) -> list[tuple[bool, list[tuple[str, str]]]]:
        """(stressed, cells) of every row, a cell being (text, kind)."""
        kinds = [kind for _, kind in self.columns]
        rows = self.frame.itertuples(index=False, name=None)
        return [
            (number in self.marked, [(number_text(value), kind) for value, kind in zip(row, kinds, strict=True)])
            for number, row in enumerate(rows)
        ]


@dataclass(frozen=True)
class MoreThan:
    """What a table shows in the place of a number so large that its digits say nothing; limit: [unit of the number]"""

    limit: float

    def __str__(self) -> str:
        return f"> {self.limit:g}"


def capped(values: Iterable[float], most: float) -> list[float | MoreThan]:
    """Numbers for a table, those from ``most`` on as ``MoreThan``, but for infinite ones; all in one unit."""
    return [MoreThan(most) if most <= value < inf else value for value in values]


@dataclass(frozen=True)
class Picture:
    """A figure, or the PNG of one (bytes, or the path of a file from the report's folder), with its caption."""

    kind: ClassVar[str] = "picture"
    image: Figure | bytes | Path | str
    caption: str

    def source(self, folder: Path) -> str:
        """The PNG as a data address; folder: from which the path of a file counts."""
        return "data:image/png;base64," + b64encode(self._png(folder)).decode("ascii")

    def _png(self, folder: Path) -> bytes:
        if isinstance(self.image, Figure):
            return png_bytes(self.image)
        return self.image if isinstance(self.image, bytes) else (folder / self.image).read_bytes()


@dataclass(frozen=True)
class KeyNumber:
    """A number that stands out: what it is, its value (a number or text), unit and a remark."""

    name: str
    value: object
    unit: str = ""
    remark: str = ""

    @property
    def text(self) -> str:
        return number_text(self.value)


@dataclass(frozen=True)
class KeyNumbers:
    """Several key numbers side by side."""

    kind: ClassVar[str] = "numbers"
    numbers: tuple[KeyNumber, ...]


@dataclass(frozen=True)
class Remark:
    """A paragraph that must not be overlooked, such as a violated requirement."""

    kind: ClassVar[str] = "remark"
    text: str


@dataclass(frozen=True)
class Code:
    """Text to be put into a file, line by line as it stands."""

    kind: ClassVar[str] = "code"
    text: str


Part = str | Table | Picture | KeyNumbers | Remark | Code


@dataclass(frozen=True)
class Section:
    """A heading and what stands under it, in reading order: paragraphs (plain text), tables, pictures, ..."""

    title: str
    content: tuple[Part, ...]

    @property
    def anchor(self) -> str:
        """The heading as the target of a link."""
        return re.sub(r"[^a-z0-9]+", "-", self.title.lower()).strip("-")


def write_report(
    path: Path,
    sections: tuple[Section, ...],
    folder: Path = Path(),
    *,
    title: str,
    subtitle: str = "",
    provenance: dict[str, str] | None = None,
) -> None:
    """Write the page.

    sections: in reading order; folder: from which the paths of pictures count
    provenance: name -> value for the foot of the page, such as versions and input hashes
    """
    html = render_report(sections, folder, title=title, subtitle=subtitle, provenance=provenance)
    Path(path).write_text(html, encoding="utf-8")


def render_report(
    sections: tuple[Section, ...],
    folder: Path = Path(),
    *,
    title: str,
    subtitle: str = "",
    provenance: dict[str, str] | None = None,
) -> str:
    """The page as text; arguments as in ``write_report``."""
    page = {"title": title, "subtitle": subtitle, "provenance": provenance or {}, "folder": folder}
    return template_environment().get_template(TEMPLATE).render(sections=tuple(sections), **page)


def template_environment() -> Environment:
    """Where the page templates are found; everything put into them is escaped."""
    folder = FileSystemLoader(Path(__file__).parent)
    found = Environment(loader=folder, autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    found.filters["typeset"] = typeset
    return found


_SIGN = re.compile(r"(?<![^\s(])-(?=[\d.])")  # a hyphen that begins a number


def typeset(text: str) -> str:
    """A sentence or a cell with minus signs before its numbers, as number_text writes them."""
    return _SIGN.sub("\N{MINUS SIGN}", text)


def heading(column: str) -> str:
    """A column name as a heading: ``back_iron_width_mm`` becomes ``back iron width / mm``, stroke and unit unbroken."""
    quantity, unit = split_unit(column)
    if not unit:
        return column.replace("_", " ")
    text = written(unit)
    return f"{quantity.replace('_', ' ')} /\N{NO-BREAK SPACE}{f'({text})' if _is_compound(text) else text}"


def _is_compound(unit: str) -> bool:
    return "/" in unit or " " in unit


def _holds_text(column: pd.Series) -> bool:
    return any(isinstance(value, str) for value in column)


def number_text(value: object, digits: int = SIGNIFICANT_DIGITS) -> str:
    """A value as a table shows it: significant digits without an exponent where that is readable, a dash for NaN."""
    if isinstance(value, bool) or hasattr(value, "dtype") and value.dtype == bool:
        return "yes" if value else "no"
    if value is None or value != value:
        return "–"
    if not isinstance(value, SupportsFloat):
        return str(value)
    return _digits(float(value), digits).replace("-", "\N{MINUS SIGN}")


def _digits(value: float, digits: int) -> str:
    if isinf(value):
        return "∞" if value > 0 else "-∞"
    if value.is_integer() and abs(value) < 1e7:
        return str(int(value))
    size = floor(log10(abs(value)))
    return f"{value:.{max(digits - 1 - size, 0)}f}" if -5 < size < 7 else f"{value:.{digits - 1}e}"
