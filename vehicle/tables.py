"""Two-column tables of numbers from CSV files."""

from __future__ import annotations

import csv
from importlib.resources import files
from math import isfinite
from pathlib import Path

from vehicle.errors import VehicleError

DATA = Path(str(files("vehicle") / "data"))  # curves that stand in for what the thesis shows as figures only


def read_columns(path: Path, *names: str) -> tuple[tuple[float, ...], ...]:
    """The named columns of a CSV file with a header line [as in the file]; lines that begin with # are comments.

    Raises VehicleError for a missing file or column, fewer than two rows, or a cell that is not a finite number.
    """
    rows = list(csv.DictReader(_lines(path)))
    missing = [name for name in names if not rows or name not in rows[0]]
    if missing:
        raise VehicleError(f"{path}: expected a header with the columns {', '.join(names)}; {missing[0]} is missing")
    if len(rows) < 2:
        raise VehicleError(f"{path}: a table needs two rows or more, found {len(rows)}; add points")
    return tuple(tuple(_number(path, number, row, name) for number, row in enumerate(rows, 1)) for name in names)


def _lines(path: Path) -> list[str]:
    if not Path(path).is_file():  # a named pipe would be waited for
        raise VehicleError(f"{path}: cannot be read, there is no such file; give the path of a CSV file")
    try:
        text = Path(path).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise VehicleError(f"{path}: cannot be read as a text file ({error}); give the path of a CSV file") from None
    return [line for line in text.splitlines() if line.strip() and not line.startswith("#")]


def _number(path: Path, number: int, row: dict[str, str], name: str) -> float:
    try:
        value = float(row[name])
    except (TypeError, ValueError):
        value = float("nan")
    if not isfinite(value):
        raise VehicleError(f"{path}: row {number}, column {name}: expected a finite number, found '{row[name]}'")
    return value
