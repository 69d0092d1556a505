"""Flux density and flux lines of the whole machine (thesis Fig. 3.20)."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import Collection, LineCollection
from matplotlib.figure import Figure
from matplotlib.tri import Triangulation

from figures.style import FIELD_MAP, Look, new_figure, styled
from figures.whole_field import Region, SmoothField, WholeField
from units import MILLIMETRE

FLUX_LINES = 24  # contours of A between its extremes
_SHARE_SHOWN = 0.998  # of the area lies inside the colour scale; corners of the iron are hotter
_AIR = ("gap", "opening", "between", "bore", "hole", "outside")


@styled
def field_map(field: WholeField, *, largest_b: float | None = None, title: str | None = None) -> Figure:
    """|B| as colours and the contours of A as flux lines.

    field: see ``whole_field``
    largest_b: end of the colour scale [T]; None takes what 99.8 % of the area stays below
    title: None writes the operating point
    """
    figure = new_figure(7.8)
    axes = figure.subplots()
    largest_b = largest_b or colour_limit(field)
    colours = _draw_flux_density(axes, field.smooth, largest_b)
    _draw_flux_lines(axes, field.smooth)
    draw_outlines(axes, field)
    bar = figure.colorbar(colours, ax=axes, shrink=0.85, pad=0.02, extend="max")
    bar.set_label("flux density |B| / T")
    _finish(axes, field, title or field.description)
    return figure


def colour_limit(field: WholeField) -> float:
    """Flux density that all but 0.2 % of the area stays below, rounded up to 0.1 T."""
    b = np.hypot(*field.cell_flux_density)
    order = np.argsort(b)
    share = np.cumsum(field.areas[order]) / field.areas.sum()
    return float(np.ceil(b[order][np.searchsorted(share, _SHARE_SHOWN)] * 10) / 10)


def draw_outlines(axes: Axes, field: WholeField, colour: str = "#EFEFEF", width: float = 0.6) -> None:
    """Borders between the regions, and the outside."""
    pieces = outlines(field.points, field.cells, field.region)
    axes.add_collection(LineCollection(list(pieces), colors=colour, linewidths=width, capstyle="round", snap=False))


def outlines(points: np.ndarray, cells: np.ndarray, region: Region) -> np.ndarray:
    """Straight pieces (k, 2, 2) [mm] along the borders of the regions; parts of the air count as one region.

    points (2, n) [m], cells (3 or more, E): the first three rows are the corners
    """
    starts, ends = cells[[0, 1, 2]].ravel().astype(np.int64), cells[[1, 2, 0]].ravel()  # their product is large
    sides = np.sort(np.stack([starts, ends]), axis=0)
    distinct, side = np.unique(sides[0] * points.shape[1] + sides[1], return_inverse=True)
    kind = np.tile(_kinds(region)[region.index], 3)
    low, high = np.full(len(distinct), len(region.names)), np.full(len(distinct), -2)
    np.minimum.at(low, side, kind)
    np.maximum.at(high, side, kind)
    border = (low != high) | (np.bincount(side) == 1)
    pair = np.stack(np.divmod(distinct[border], points.shape[1]), axis=1)
    return points[:, pair].transpose(1, 2, 0) / MILLIMETRE


def _kinds(region: Region) -> np.ndarray:
    """Number of every region, -1 for air."""
    return np.array([-1 if name.startswith(_AIR) else i for i, name in enumerate(region.names)])


def _draw_flux_density(axes: Axes, smooth: SmoothField, largest_b: float) -> Collection:
    x, y = smooth.points / MILLIMETRE
    triangulation = Triangulation(x, y, smooth.triangles.T)
    return axes.tripcolor(triangulation, smooth.b, shading="gouraud", cmap=FIELD_MAP, vmin=0.0, vmax=largest_b)


def _draw_flux_lines(axes: Axes, smooth: SmoothField) -> None:
    x, y = smooth.points / MILLIMETRE
    triangulation = Triangulation(x, y, smooth.triangles.T)
    levels = np.linspace(smooth.a.min(), smooth.a.max(), FLUX_LINES + 2)[1:-1]
    look: Look = {"colors": "black", "linewidths": 0.6, "alpha": 0.8, "linestyles": "solid"}
    axes.tricontour(triangulation, smooth.a, levels=levels, **look)


def _finish(axes: Axes, field: WholeField, title: str) -> None:
    reach = 1.02 * _reach(field) / MILLIMETRE
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach), xlabel="x / mm", ylabel="y / mm")
    axes.set_aspect("equal")
    axes.set_title(title, loc="left")


def _reach(field: WholeField) -> float:
    """Of everything but air from the axis [m]: the air around a cup is drawn as far as its corners let it."""
    solid = _kinds(field.region)[field.region.index] >= 0
    return float(np.hypot(*field.points[:, field.cells[:, solid]]).max())
