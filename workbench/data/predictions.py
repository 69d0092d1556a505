"""What a campaign predicts for a device that is not measured yet, stored before anything is compared."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from dataclasses import fields
from math import isfinite
from pathlib import Path

from workbench.errors import WorkbenchError
from workbench.findings import Prediction

_NUMBERS = ("value", "low", "high")
COLUMNS = tuple(one.name for one in fields(Prediction))


def read_predictions(path: Path) -> tuple[Prediction, ...]:
    """Of a CSV file with the columns of, quantity, unit, value, low, high and given.

    Raises:
        WorkbenchError: a column is missing, a value is no number or lies outside its interval.
    """
    with open(path, encoding="utf-8", newline="") as file:
        reader = csv.DictReader(file)
        missing = [name for name in COLUMNS if name not in (reader.fieldnames or ())]
        if missing:
            raise WorkbenchError(f"{path.name}: predictions lack the column {missing[0]}; add it.")
        return tuple(_prediction(row, f"{path.name}, line {reader.line_num}") for row in reader)


def _prediction(row: Mapping[str, str], where: str) -> Prediction:
    value, low, high = (_number(row[name], name, where) for name in _NUMBERS)
    if not low <= value <= high:
        raise WorkbenchError(f"{where}: value {value:g} lies outside of low {low:g} and high {high:g}; correct them.")
    return Prediction(row["of"], row["quantity"], row["unit"], value, low, high, row["given"])


def _number(cell: str, name: str, where: str) -> float:
    try:
        number = float(cell)
    except (TypeError, ValueError):
        number = float("nan")
    if not isfinite(number):
        raise WorkbenchError(f"{where}: {name} is {cell!r} where a number is expected; correct it.")
    return number
