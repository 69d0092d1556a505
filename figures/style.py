"""One look for all figures: sizes, colours, fonts, and how a figure becomes a PNG."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from functools import wraps
from io import BytesIO
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

import pandas as pd
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.typing import RcKeyType

WIDTH = 9.0  # inches; 900 px wide at 100 px an inch, where 10 pt letters are 14 px high
DPI = 150  # of saved pictures: sharp on dense screens when shown 900 px wide
_SQUEEZE = 3  # of deflate's levels 0 to 9: half of the time of 6, which is usual, for files that are a twelfth larger

# Okabe and Ito's palette, told apart with any kind of colour vision.
BLACK, BLUE, ORANGE, GREEN = "#000000", "#0072B2", "#E69F00", "#009E73"
VERMILION, PURPLE, SKY, YELLOW = "#D55E00", "#CC79A7", "#56B4E9", "#F0E442"
GREY, LIGHT_GREY = "#666666", "#D9D9D9"
SERIES = (BLUE, ORANGE, GREEN, PURPLE, VERMILION, SKY, GREY)
MARKERS = ("o", "s", "^", "D", "v", "P", "X")

PHASE_NAMES = ("A", "B", "C")
PHASE_COLOURS = (VERMILION, GREEN, BLUE)  # red, green, blue of phases A, B, C; positive sides
PHASE_LIGHT = ("#F2B48C", "#8FD8BF", "#8FC3E3")  # negative sides

FIELD_MAP = "viridis"  # flux density
DESIGN_MAP = "cividis"  # torque over a design space

Look = dict[str, Any]  # how something is drawn, as matplotlib's functions take it
Key = TypeVar("Key", int, float, str)
Arguments = ParamSpec("Arguments")
Drawn = TypeVar("Drawn")

_STYLE: dict[RcKeyType, Any] = {
    "font.size": 10.0,
    "axes.titlesize": 10.5,
    "axes.labelsize": 10.0,
    "legend.fontsize": 9.0,
    "legend.framealpha": 0.9,
    "axes.grid": False,
    "axes.axisbelow": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "grid.color": "#E3E3E3",
    "grid.linewidth": 0.7,
    "lines.linewidth": 1.6,
    "hatch.linewidth": 0.6,
    "savefig.facecolor": "white",
}


def styled(draw: Callable[Arguments, Drawn]) -> Callable[Arguments, Drawn]:
    """Decorator: the figure is drawn in the style of the project, whatever the caller's settings are."""

    @wraps(draw)
    def wrapper(*arguments: Arguments.args, **named: Arguments.kwargs) -> Drawn:
        with rc_context(_STYLE):
            return draw(*arguments, **named)

    return wrapper


def new_figure(height: float, width: float = WIDTH) -> Figure:
    """Empty figure of this height and width [inch] that makes room for its labels itself."""
    figure = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def series_style(values: Iterable[Key]) -> dict[Key, Look]:
    """Colour and marker for each of the values, in their sorted order: ``style[9]["color"]``."""
    ordered = sorted(set(values), key=_natural)
    looks = ({"color": SERIES[i % len(SERIES)], "marker": MARKERS[i % len(MARKERS)]} for i in range(len(ordered)))
    return dict(zip(ordered, looks, strict=True))


def _natural(value: Key) -> list[object]:
    """What values are sorted by: 9 slots before 12 slots."""
    if not isinstance(value, str):
        return [value]
    return [int(part) if part.isdigit() else part for part in re.split(r"(\d+)", value)]


def combinations(table: pd.DataFrame) -> pd.Series:
    """Slots and poles of each row in words, to tell series apart by; columns slots, poles."""
    return table.slots.astype(str) + " slots, " + table.poles.astype(str) + " poles"


def show_grid(*axes: Axes) -> None:
    """Thin grid behind the data."""
    for axis in axes:
        axis.grid(True, color=_STYLE["grid.color"], linewidth=_STYLE["grid.linewidth"])
        axis.set_axisbelow(True)


def letter(axes: Iterable[Axes]) -> None:
    """(a), (b), ... in front of the titles."""
    for number, axis in enumerate(axes):
        axis.set_title(f"({chr(ord('a') + number)}) {axis.get_title(loc='left')}", loc="left")


def signed(value: float, digits: int) -> str:
    """A number of so many digits with a proper minus."""
    return f"{value:.{digits}g}".replace("-", "\N{MINUS SIGN}")


def degrees(angle: float, digits: int = 2) -> str:
    """An angle in degrees with a proper minus, without idle zeros."""
    return f"{angle:.{digits}f}".rstrip("0").rstrip(".").replace("-", "\N{MINUS SIGN}") + "°"


@styled
def png_bytes(figure: Figure) -> bytes:
    """The figure as a PNG; drawn once, while ``Figure.savefig`` draws a first time for the layout alone."""
    buffer, dpi = BytesIO(), figure.dpi
    canvas: Any = FigureCanvasAgg(figure)  # its functions have no annotations
    figure.dpi = DPI
    try:
        canvas.print_png(buffer, metadata={"Software": None}, pil_kwargs={"compress_level": _SQUEEZE})
    finally:
        figure.dpi = dpi
    return buffer.getvalue()


def save_png(figure: Figure, path: Path) -> None:
    """Write the figure as a PNG file."""
    Path(path).write_bytes(png_bytes(figure))


@styled
def save_pdf(figure: Figure, path: Path) -> None:
    """Write the figure as a PDF file, whose lines stay lines; without the time, so that it is the same every time."""
    figure.savefig(path, format="pdf", metadata={"CreationDate": None})
