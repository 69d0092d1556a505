"""Rows of a comparison, printed and written as they come."""

from __future__ import annotations

import csv
from collections.abc import Iterable
from dataclasses import asdict
from pathlib import Path
from typing import Any


def write_table(path: Path, rows: Iterable[Any]) -> None:
    """Write dataclasses of one kind as CSV, a column a field; small numbers with three digits."""
    found = []
    for row in rows:
        found.append({name: _digits(value) for name, value in asdict(row).items()})
        print(*found[-1].values(), flush=True)
    with open(path, "w", newline="", encoding="utf-8") as file:
        table = csv.DictWriter(file, found[0], lineterminator="\n")
        table.writeheader()
        table.writerows(found)


def _digits(value: object) -> object:
    return f"{value:.3g}" if isinstance(value, float) and abs(value) < 1e-3 else value
