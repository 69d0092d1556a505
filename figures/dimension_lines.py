"""Dimension lines of drawings: an arrow with two heads and its text."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from figures.style import BLACK, Look

Place = tuple[float, float]  # in the drawing [mm]
TO_THE_POINT: Look = {"color": BLACK, "lw": 1.0, "shrinkA": 0, "shrinkB": 0}  # arrows that end where they are told to


def measure(axes: Axes, start: Place, end: Place, name: str, offset: Place) -> None:
    """A dimension line between two places [mm], its text beside the middle by an offset [mm]."""
    style: Look = {"arrowstyle": "<|-|>,head_width=0.15,head_length=0.3", **TO_THE_POINT}
    axes.annotate("", end, start, arrowprops=style)
    middle = (np.array(start) + np.array(end)) / 2 + np.array(offset)
    axes.text(*place_of(middle), name, ha="center", va="center", fontsize=11)


def place_of(vector: np.ndarray) -> Place:
    """A vector (2,) [mm] as a place."""
    x, y = vector
    return float(x), float(y)
