"""Fields as .vtu files for ParaView and pyvista, and back again."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from figures.whole_field import Region, WholeField, whole_field
from magnetostatics.model import FieldSolution

if TYPE_CHECKING:
    import pyvista

POTENTIAL, FLUX_DENSITY, FLUX_DENSITY_NORM, REGION = "A_Wb_per_m", "B_T", "B_norm_T", "region"
_REGION_NAMES, _DESCRIPTION = "region_names", "description"
_IN_ASCII = (("°", " deg"), ("²", "^2"), ("\N{MINUS SIGN}", "-"))  # VTK keeps plain letters only


class FieldFileError(ValueError):
    """A .vtu file that this project did not write; the message says what is missing."""


def write_vtu(path: Path, solution: FieldSolution) -> None:
    """Write the whole machine of a solution, rotor turned to its angle.

    Cells are quadratic triangles, in metres. Point data ``A_Wb_per_m``; cell data ``B_T`` (vector, mean of the cell),
    ``B_norm_T`` (mean of |B| at the corners) and ``region``, an index into the field data ``region_names``; the field
    data ``description`` is the operating point in words.
    """
    write_field(path, whole_field(solution))


def write_field(path: Path, field: WholeField) -> None:
    """Write a field that is at hand already; see ``write_vtu``."""
    to_grid(field).save(Path(path))


def to_grid(field: WholeField) -> pyvista.UnstructuredGrid:
    """The field as a pyvista UnstructuredGrid with the data of ``write_vtu``."""
    import pyvista

    count = field.cells.shape[1]
    cells = np.vstack([np.full(count, 6), field.cells]).T.ravel()
    points = np.vstack([field.points, np.zeros(field.points.shape[1])]).T
    grid = pyvista.UnstructuredGrid(cells, np.full(count, pyvista.CellType.QUADRATIC_TRIANGLE), points)
    grid.point_data[POTENTIAL] = field.a
    grid.cell_data[FLUX_DENSITY] = np.vstack([field.cell_flux_density, np.zeros(count)]).T
    grid.cell_data[FLUX_DENSITY_NORM] = np.hypot(*field.flux_density[:, :3]).mean(axis=0)
    grid.cell_data[REGION] = field.region.index.astype(np.int32)
    grid.field_data[_REGION_NAMES] = list(field.region.names)
    grid.field_data[_DESCRIPTION] = [_to_ascii(field.description)]
    return grid


def read_vtu(path: Path) -> WholeField:
    """The field of a file that ``write_vtu`` wrote.

    Raises FieldFileError for another kind of file.
    """
    import pyvista

    _check_kind(Path(path))
    grid = pyvista.read(Path(path))
    if not isinstance(grid, pyvista.UnstructuredGrid):
        raise FieldFileError(_not_ours(path))
    _check_contents(grid, Path(path))
    cells = np.asarray(grid.cells_dict[np.uint8(pyvista.CellType.QUADRATIC_TRIANGLE)]).T
    region = Region(np.asarray(grid.cell_data[REGION]), tuple(str(name) for name in grid.field_data[_REGION_NAMES]))
    points = np.asarray(grid.points)[:, :2].T.astype(float)
    description = _from_ascii(str(grid.field_data[_DESCRIPTION][0]))
    return WholeField(points, cells, np.asarray(grid.point_data[POTENTIAL]), region, description)


def _to_ascii(text: str) -> str:
    for sign, plain in _IN_ASCII:
        text = text.replace(sign, plain)
    return text


def _from_ascii(text: str) -> str:
    for sign, plain in _IN_ASCII:
        text = text.replace(plain, sign)
    return text


def _check_kind(path: Path) -> None:
    """Before VTK opens the file: of a wrong one it prints a page of its own errors."""
    with path.open("rb") as file:
        if b'type="UnstructuredGrid"' not in file.read(500):
            raise FieldFileError(_not_ours(path))


def _not_ours(path: Path) -> str:
    return f"{path.name} is not a .vtu file: it was not written by this project"


def _check_contents(grid: pyvista.UnstructuredGrid, path: Path) -> None:
    there = {*grid.point_data.keys(), *grid.cell_data.keys(), *grid.field_data.keys()}
    absent = [name for name in (POTENTIAL, REGION, _REGION_NAMES, _DESCRIPTION) if name not in there]
    if absent:
        raise FieldFileError(f"{path.name} holds no {', '.join(absent)}: it was not written by this project")
