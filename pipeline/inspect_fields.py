"""``airgap inspect STUDY``: look into the solved fields of a study.

Opens a window where there is a display. Without one it writes a PNG of every field and ``scene.html``, a page with all
fields to zoom into that needs nothing but a browser.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from figures.export import FieldFileError, read_vtu
from figures.field_map import FLUX_LINES, colour_limit, field_map, outlines
from figures.scene import write_scene
from figures.style import FIELD_MAP, Look, save_png
from figures.whole_field import WholeField
from pipeline.results import ResultsError, results_of
from pipeline.sentences import sentences
from study.read import read_study
from units import MILLIMETRE

if TYPE_CHECKING:
    import pyvista
    from pyvista.plotting._typing import ScalarBarArgs

SYSTEM_LIBRARIES = "libglu1-mesa libgl1 libxft2 libxcursor1 libxinerama1 libgomp1 libegl1"
Fields = dict[str, WholeField]  # by the name of their file
_WINDOW_PROBE = """
import pyvista
plotter = pyvista.Plotter(window_size=(80, 80))
plotter.add_mesh(pyvista.Plane())
plotter.show(auto_close=False, interactive=False)
kind = type(plotter.render_window).__name__
plotter.close()
raise SystemExit(0 if any(system in kind for system in ("XOpenGL", "Win32", "Cocoa")) else 3)
"""


def add_inspect(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``airgap inspect``."""
    parser.add_argument("study", help="path of a study file, or the name of one in studies/")
    parser.add_argument("--out", type=Path, help="folder for the pictures (default: results/<study>/inspect)")
    parser.add_argument("--no-window", action="store_true", help="write the files even where there is a display")
    parser.set_defaults(run=inspect)


def inspect(chosen: argparse.Namespace) -> None:
    """See the module's text."""
    study = read_study(chosen.study)
    with sentences():
        folder = results_of(study).folder
        fields = read_fields(folder)
        if not chosen.no_window and wants_window():
            show(fields)
        else:
            write_files(fields, chosen.out or folder / "inspect", study.study.title)


def read_fields(folder: Path) -> Fields:
    """Name -> field of every .vtu file in the folder; ResultsError when there is none or one cannot be read."""
    paths = sorted(path for path in folder.glob("*.vtu") if not path.name.startswith("."))
    if not paths:
        raise ResultsError("there are no fields to look at yet; run `make pipeline`, or `make fields`, first.")
    try:
        return {path.stem: read_vtu(path) for path in paths}
    except FieldFileError as error:
        raise ResultsError(f"{error}; delete it and run `make fields`.") from None


def wants_window() -> bool:
    """Whether there is a display and a window opens on it; says what is missing where it does not open."""
    if not has_display():
        return False
    if window_opens():
        return True
    print(
        "There is a display, but no window could be opened on it: the graphics libraries of the system are missing or "
        f"too old. On Debian and Ubuntu: sudo apt-get install {SYSTEM_LIBRARIES}\nWriting files instead."
    )
    return False


def has_display() -> bool:
    """Whether this process may open windows at all."""
    if os.environ.get("PYVISTA_OFF_SCREEN", "").lower() in ("true", "1"):
        return False
    return sys.platform in ("win32", "darwin") or bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


@cache
def window_opens() -> bool:
    """Open a small window in another process: without its system libraries vtk does not raise, it ends the process."""
    try:
        probe = subprocess.run([sys.executable, "-c", _WINDOW_PROBE], capture_output=True, timeout=60)
    except subprocess.TimeoutExpired:
        return False
    return probe.returncode == 0


def write_files(fields: Fields, folder: Path, title: str) -> list[Path]:
    """A PNG of every field and one page with all of them; returns what was written."""
    folder.mkdir(parents=True, exist_ok=True)
    paths = [folder / f"{name}.png" for name in fields] + [folder / "scene.html"]
    for path, field in zip(paths, fields.values()):
        save_png(field_map(field), path)
    write_scene(paths[-1], fields, title)
    print("No window here, so there are files to look at; open scene.html in a browser:")
    print("\n".join(f"  {path}" for path in paths))
    return paths


def show(fields: Fields) -> None:
    """A window with |B| and flux lines; a slider chooses the field."""
    import pyvista  # noqa: PLC0415

    plotter = pyvista.Plotter(title="flux density and flux lines", window_size=[1000, 1000])
    add_field(plotter, next(iter(fields.values())))
    if len(fields) > 1:
        place = {"pointa": (0.62, 0.94), "pointb": (0.97, 0.94)}
        chosen = partial(_add_named, plotter, fields)
        plotter.add_text_slider_widget(chosen, list(fields), value=0, **place)
    plotter.view_xy()
    plotter.show()


def _add_named(plotter: pyvista.Plotter, fields: Fields, name: str) -> None:
    add_field(plotter, fields[name])


def add_field(plotter: pyvista.Plotter, field: WholeField) -> None:
    """Put a field into the window, in place of the one before."""
    surface = surface_of(field)
    colours: Look = {"cmap": FIELD_MAP, "clim": (0.0, colour_limit(field)), "copy_mesh": True}
    plotter.add_mesh(surface, scalars="B", name="surface", lighting=False, scalar_bar_args=_bar(), **colours)
    lines = surface.contour(FLUX_LINES, scalars="A")
    plotter.add_mesh(lines, color="black", line_width=1, name="flux lines", show_scalar_bar=False)
    plotter.add_mesh(pieces_of(outlines(field.points, field.cells, field.region)), color="white", name="outlines")
    plotter.add_text(field.description.replace("²", "^2"), font_size=10, name="description")


def _bar() -> ScalarBarArgs:
    return {"title": "flux density / T", "vertical": True, "position_x": 0.88, "position_y": 0.25, "height": 0.5}


def surface_of(field: WholeField) -> pyvista.PolyData:
    """The field as triangles [mm] with |B| [T] and A [Wb/m] at their corners."""
    import pyvista  # noqa: PLC0415 - a second of start-up that only this command needs

    smooth = field.smooth
    points = np.column_stack([*(smooth.points / MILLIMETRE), np.zeros(smooth.points.shape[1])])
    surface = pyvista.PolyData.from_regular_faces(points, smooth.triangles.T)
    surface["B"], surface["A"] = smooth.b, smooth.a
    return surface


def pieces_of(pieces: np.ndarray) -> pyvista.PolyData:
    """Straight pieces (k, 2, 2) as lines in the plane."""
    import pyvista  # noqa: PLC0415

    ends = np.concatenate([pieces.reshape(-1, 2), np.zeros((2 * len(pieces), 1))], axis=1)
    return pyvista.line_segments_from_points(ends)
