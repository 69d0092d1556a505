"""Steel grades by name: the curves shipped in ``materials/steels`` and a user's own csv files.

A curve file has the columns ``H_A_per_m,B_T`` in its first row that is not a comment (``#``), and one point a row.
"""

from __future__ import annotations

import csv
from pathlib import Path

from materials.curve_units import wrong_unit
from materials.errors import MaterialError
from materials.reluctivity import SplineReluctivity

STEELS = Path(__file__).parent / "steels"
ENDING = "_bh.csv"
FIELD_COLUMN, FLUX_COLUMN = "H_A_per_m", "B_T"


def known_steels() -> list[str]:
    """Names of the grades shipped with the package."""
    return sorted(path.name.removesuffix(ENDING) for path in STEELS.glob(f"*{ENDING}"))


def load_steel(name: str, folder: Path | str = ".") -> SplineReluctivity:
    """The reluctivity law of a steel.

    name: a grade of ``known_steels()``, or the path of a curve file ending in ``.csv``
    folder: folder from which a relative path counts, that is the folder of the study file
    Raises MaterialError: unknown grade (lists the known ones), missing file, a curve in other units than its columns
    say, or one that cannot be used (names the file and the line).
    """
    path = steel_file(name, folder)
    lines, H, B = read_curve(path)
    if said := wrong_unit(H, B):
        raise MaterialError(f"{path.name}: {said}")
    try:
        return SplineReluctivity.from_points(Path(name).stem.removesuffix("_bh"), H, B)
    except MaterialError as error:
        where = f"{path.name}" if error.point is None else f"{path.name}, line {lines[error.point]}"
        raise MaterialError(f"{where}: {error}", error.point) from error


def steel_file(name: str, folder: Path | str = ".") -> Path:
    """Path of the curve file that ``load_steel`` reads."""
    own = name.lower().endswith(".csv")
    path = Path(folder) / name if own else STEELS / f"{name}{ENDING}"
    if own and not path.is_file():
        raise MaterialError(f"there is no curve file {path}; its path counts from the folder of the study file")
    if not own and name not in known_steels():
        grades = ", ".join(known_steels())
        raise MaterialError(f"unknown steel '{name}': known are {grades}, or give the path of a csv file with a curve")
    return path


def read_curve(path: Path) -> tuple[list[int], list[float], list[float]]:
    """Line numbers in the file, H [A/m] and B [T] of the points of a curve file."""
    with open(path, encoding="utf-8-sig", newline="") as file:
        rows = [(line, text) for line, text in enumerate(file, start=1) if text.strip() and text.strip()[0] != "#"]
    if not rows:
        raise MaterialError(f"{path.name} holds no data; expected the columns {FIELD_COLUMN},{FLUX_COLUMN}")
    reader = csv.DictReader((text for _, text in rows), skipinitialspace=True)
    columns = [column.strip() for column in reader.fieldnames or ()]
    reader.fieldnames = columns
    _need_columns(path, columns)
    lines = [line for line, _ in rows[1:]]
    points = [_point(path, line, row) for line, row in zip(lines, reader, strict=True)]
    return lines, [point[0] for point in points], [point[1] for point in points]


def _need_columns(path: Path, columns: list[str]) -> None:
    missing = [column for column in (FIELD_COLUMN, FLUX_COLUMN) if column not in columns]
    if missing:
        found = ", ".join(columns)
        raise MaterialError(f"{path.name}: column {' and '.join(missing)} missing; found {found}")


def _point(path: Path, line: int, row: dict[str, str]) -> tuple[float, float]:
    try:
        return float(row[FIELD_COLUMN]), float(row[FLUX_COLUMN])
    except (TypeError, ValueError) as error:
        found = f"{row[FIELD_COLUMN]!r}, {row[FLUX_COLUMN]!r}"
        raise MaterialError(f"{path.name}, line {line}: expected two numbers, found {found}") from error
