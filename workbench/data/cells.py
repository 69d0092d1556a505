"""Cells of a text table as numbers: decimal signs, thousands, gaps, open circuits, dates and times of day."""

from __future__ import annotations

import re
from collections.abc import Sequence
from datetime import date
from typing import Final

import numpy as np

from workbench.errors import WorkbenchError

# What SCPI instruments send for infinity (SCPI-99 7.2.1.4); anything as large is no reading.
NO_READING: Final = 9.9e37
GAPS: Final = frozenset(
    [
        "", "-", "--", "---", "----", "n/a", "na", "#n/a", "#nv", "nan", "null", "none", "#div/0!", "#wert!", "#value!",
        "*",
    ]
)  # fmt: skip
OPEN: Final = frozenset(["inf", "+inf", "infinity", "∞", "open", "offen", "ol", "overload", "ovld"])

_PLAIN = frozenset("0123456789+-.,eE ")
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_GROUPS = re.compile(r"[-+]?\d{1,3}(?:(?P<sign>[., '\u2019])\d{3})(?:(?P=sign)\d{3})*(?:[.,]\d*)?(?:[eE][-+]?\d+)?")
_EDGE, _END = r"(?<![^;\t|\"\s])[-+\u2212]?", r"(?:[eE][-+]?\d+)?(?![^;\t|\"\s])"


def _sure(sign: str, other: str) -> re.Pattern[str]:
    """A number in which ``sign`` can only be the decimal sign: not three digits behind it, or 0 or many before it."""
    s, o = re.escape(sign), re.escape(other)
    parts = (
        rf"\d*{s}(?:\d{{1,2}}|\d{{4,}})", rf"0?{s}\d+", rf"\d{{4,}}{s}\d*", rf"\d{{1,3}}(?:{o}\d{{3}})+{s}\d*"
    )  # fmt: skip
    return re.compile(f"{_EDGE}(?:{'|'.join(parts)}){_END}")


_SURE = {",": _sure(",", "."), ".": _sure(".", ",")}
_EITHER = {s: re.compile(rf"{_EDGE}[1-9]\d{{0,2}}{re.escape(s)}\d{{3}}{_END}") for s in (",", ".")}


class UntoldSign(WorkbenchError):
    """Nothing in a text shows whether 1,234 is one or a thousand."""


def decimal_sign(text: str, where: str) -> str:
    """ "," or ".", whichever the numbers of a text use; its delimiter is not the comma, or numbers are in quotes.

    Raises:
        WorkbenchError: both are used; UntoldSign: either may be.
    """
    comma = _SURE[","].search(text) if "," in text else None
    point = _SURE["."].search(text) if "." in text else None
    if comma and point:
        raise WorkbenchError(
            f"{where}: {comma.group().strip()} has a decimal comma and {point.group().strip()} a decimal point; "
            "write one of them everywhere."
        )
    if not comma and not point and "," in text and (either := _EITHER[","].search(text)):
        raise UntoldSign(
            f'{where}: {either.group()} may be a decimal number or thousands; say decimal = "," or decimal = "." in '
            "its [[table]], or --decimal to airgap import."
        )
    return "," if comma else "."


def may_be_thousands(text: str) -> str:
    """A number whose point nothing in a text shows to be no sign of thousands; empty where there is none."""
    either = None if _SURE["."].search(text) else _EITHER["."].search(text)
    return either.group().strip() if either else ""


def values_of(cells: Sequence[str], decimal: str, where: str, lines: Sequence[int]) -> np.ndarray:
    """Numbers of a column (n,): NaN for a gap or what is no number, infinity for an open circuit, seconds since the
    first one for dates and times."""
    quick = _quick(cells, decimal)
    if quick is not None:
        return quick
    if is_time(cells):
        return seconds(cells, where)
    _refuse_either(cells, decimal, where, lines)
    return readings(np.array([number(cell, decimal, where, line) for cell, line in zip(cells, lines)]))


def _refuse_either(cells: Sequence[str], decimal: str, where: str, lines: Sequence[int]) -> None:
    """A column of 3,192 and 12.786, where no cell shows that the other sign is one of thousands: 1.234,5.

    Raises:
        WorkbenchError: there is such a cell.
    """
    other = _other(decimal)
    own = next((cell for cell in cells if decimal in cell), "")
    told = any(cell.count(other) + (decimal in cell) > 1 for cell in cells if other in cell)
    either = next((k for k, cell in enumerate(cells) if _EITHER[other].fullmatch(cell.strip())), None)
    if own and not told and either is not None:
        raise WorkbenchError(
            f"{where}: line {lines[either]} says {cells[either].strip()}, which may be a decimal number or thousands, "
            f"where its column has {own.strip()}; write the same sign everywhere."
        )


def _quick(cells: Sequence[str], decimal: str) -> np.ndarray | None:
    """Plain numbers without thousands, and gaps; None where a cell is anything else."""
    text = "".join([cell for cell in cells if cell not in GAPS])
    if not set(text) <= _PLAIN or (decimal == "," and "." in text) or (decimal == "." and "," in text):
        return None
    try:
        return readings(np.array([np.nan if c in GAPS else float(c.replace(",", ".")) for c in cells]))
    except ValueError:
        return None


def readings(values: np.ndarray) -> np.ndarray:
    """Values with NaN for what is too large to be a reading; infinities stay, they are open circuits."""
    return np.where(np.isfinite(values) & (np.abs(values) >= NO_READING), np.nan, values)


def number(cell: str, decimal: str, where: str, line: int) -> float:
    """One cell; NaN where it holds no number."""
    text = cell.strip().replace("\u2212", "-").replace("\u00a0", " ").replace("\u202f", " ")
    small = text.lower()
    if small in GAPS:
        return float("nan")
    if small in OPEN:
        return float("inf")
    plain = _plain(text, decimal)
    if plain is None and _SURE[_other(decimal)].fullmatch(text):
        raise WorkbenchError(f"{where}: line {line} says {text}, where the file writes numbers with {decimal!r}.")
    return float(plain) if plain is not None and _NUMBER.fullmatch(plain) else float("nan")


def _other(decimal: str) -> str:
    return "." if decimal == "," else ","


def _plain(text: str, decimal: str) -> str | None:
    """The number without thousands and with a decimal point; None where its signs do not fit."""
    grouped = _GROUPS.fullmatch(text)
    if grouped and grouped["sign"] != decimal:
        text = text.replace(grouped["sign"], "")
    if _other(decimal) in text:
        return None
    return text.replace(decimal, ".")


def looks_like_data(cell: str) -> bool:
    """Whether a cell is a number, a date or a time, in any of the ways that are read."""
    text = cell.strip().replace("\u2212", "-")
    if not text[:1].isdigit() and text[:1] not in ("-", "+", ".", ","):
        return text.lower() in OPEN
    plain = text.replace(",", ".")
    return bool(_NUMBER.fullmatch(plain) or _GROUPS.fullmatch(text) or _TIME.fullmatch(text))


# ---- dates and times of day ----------------------------------------------------------------------------------------

_TIME = re.compile(
    r"(?:(?P<y>\d{4})[-/.](?P<m>\d{1,2})[-/.](?P<d>\d{1,2})|(?P<a>\d{1,2})(?P<sign>[-/.])(?P<b>\d{1,2})[-/.](?P<c>\d{4}))?"
    r"(?:[T ,]*(?P<H>\d{1,2}):(?P<M>\d{2})(?::(?P<S>\d{2})(?:[.,](?P<f>\d{1,12}))?)?\s*(?P<pm>[AaPp][Mm])?)?"
    r"(?P<zone>Z|[+-]\d{2}:?\d{2})?"
)
_DAY = 86400.0


def is_time(cells: Sequence[str]) -> bool:
    """Whether the first cell that is no gap is a date or a time of day."""
    first = next((cell.strip() for cell in cells if cell.strip().lower() not in GAPS), "")
    return bool(_TIME.fullmatch(first)) and not _NUMBER.fullmatch(first) and any(sign in first for sign in ":-/.")


def seconds(cells: Sequence[str], where: str) -> np.ndarray:
    """Seconds since the first row (n,), NaN for gaps; a time of day that falls by half a day has passed midnight."""
    found = [_TIME.fullmatch(cell.strip()) for cell in cells]
    day_first = _day_first([m for m in found if m and m["a"]], where)
    values = np.array([_instant(m, day_first) if m and m.group() else np.nan for m in found])
    known = np.flatnonzero(np.isfinite(values))
    if known.size == 0:
        return values
    if not any(m and (m["y"] or m["a"]) for m in found):
        falls = np.concatenate([[0.0], np.diff(values[known]) < -0.5 * _DAY])
        values[known] += _DAY * np.cumsum(falls)
    return values - values[known[0]]


def _day_first(found: Sequence[re.Match[str]], where: str) -> bool:
    """31.12.2026 has the day first; 12/31/2026 and 31/12/2026 are told by a number above twelve."""
    if not found or found[0]["sign"] == ".":
        return True
    days, months = any(int(m["a"]) > 12 for m in found), any(int(m["b"]) > 12 for m in found)
    alike = len({(m["a"], m["b"]) for m in found}) == 1
    if days == months and not alike:
        raise WorkbenchError(f"{where}: {found[0].group()} may have the day or the month first; write 2026-12-31.")
    return days or not months


def _instant(found: re.Match[str], day_first: bool) -> float:
    year, month, day = (
        (found["y"], found["m"], found["d"])
        if found["y"]
        else (found["c"], found["b"], found["a"]) if day_first else (found["c"], found["a"], found["b"])
    )  # fmt: skip
    try:
        days = date(int(year), int(month), int(day)).toordinal() if year else 0
    except ValueError:
        return float("nan")
    return days * _DAY + _time_of_day(found) - _zone(found["zone"])


def _time_of_day(found: re.Match[str]) -> float:
    if not found["H"]:
        return 0.0
    hour = int(found["H"])
    if found["pm"]:
        hour = hour % 12 + (12 if found["pm"].lower() == "pm" else 0)
    return 3600.0 * hour + 60.0 * int(found["M"]) + float(f"{found['S'] or 0}.{found['f'] or 0}")


def _zone(text: str | None) -> float:
    if not text or text == "Z":
        return 0.0
    return (1 if text[0] == "+" else -1) * (3600.0 * int(text[1:3]) + 60.0 * int(text[-2:]))
