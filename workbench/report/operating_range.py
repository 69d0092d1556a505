"""Where in the operating range a model fails: the regime map."""

from __future__ import annotations

import numpy as np
from matplotlib.colors import TwoSlopeNorm
from matplotlib.figure import Figure

from figures.style import BLACK, BLUE, GREY, new_figure, show_grid, styled
from workbench.findings import RegimeMap
from workbench.report.channels import ALARM
from workbench.report.sentences import ALARMING_P
from workbench.report.words import axis_label, number

_COLOURS = "RdBu_r"  # red: the measurement is above the model
_HEIGHT = 2.9  # inch, a map
_MOST_WORDS = 80  # cells that still have room for numbers


@styled
def regime_maps(maps: tuple[RegimeMap, ...]) -> Figure:
    """Mean residual in u of the cells of every channel's operating range; a frame marks cells that are not chance."""
    columns = min(2, len(maps))
    rows = -(-len(maps) // columns)
    figure = new_figure(0.4 + _HEIGHT * rows)
    axes = figure.subplots(rows, columns, squeeze=False).ravel()
    for axis, regime in zip(axes, maps):
        (_bars if regime.y is None else _map)(figure, axis, regime)
        axis.set_title(regime.channel, loc="left")
        axis.set_xlabel(axis_label(regime.x))
    for axis in axes[len(maps) :]:
        axis.set_axis_off()
    return figure


def _map(figure: Figure, axes, regime: RegimeMap) -> None:
    reach = max(3.0, float(np.nanmax(np.abs(regime.mean))))
    nx, ny = len(regime.x_edges) - 1, len(regime.y_edges) - 1
    shown = axes.pcolormesh(
        np.arange(nx + 1), np.arange(ny + 1), regime.mean, cmap=_COLOURS, norm=TwoSlopeNorm(0.0, -reach, reach)
    )
    _edges(axes.set_xticks, regime.x_edges)
    _edges(axes.set_yticks, regime.y_edges)
    axes.set_ylabel(axis_label(regime.y))
    for row, column in np.argwhere(regime.count > 0):
        _cell(axes, regime, row, column, reach, words=nx * ny <= _MOST_WORDS)
    figure.colorbar(shown, ax=axes, pad=0.02).set_label("mean residual / u")


def _edges(set_ticks, edges: np.ndarray) -> None:
    """Edges of the cells at equal distances, at most seven of them named."""
    every = max(1, -(-len(edges) // 7))
    places = np.arange(0, len(edges), every)
    set_ticks(places, [number(edges[k]) for k in places])


def _cell(axes, regime: RegimeMap, row: int, column: int, reach: float, words: bool) -> None:
    mean = regime.mean[row, column]
    if words:
        colour = "white" if abs(mean) > 0.6 * reach else BLACK
        axes.text(column + 0.5, row + 0.5, _cell_text(mean), ha="center", va="center", fontsize=8, color=colour)
    if _stands_out(regime)[row, column]:
        axes.plot(
            column + np.array([0.04, 0.96, 0.96, 0.04, 0.04]),
            row + np.array([0.05, 0.05, 0.95, 0.95, 0.05]),
            color=BLACK,
            linewidth=1.4,
        )


def _stands_out(regime: RegimeMap) -> np.ndarray:
    """Cells that are not chance, as many as there are (ny, nx)."""
    return np.count_nonzero(regime.count) * regime.p_value < ALARMING_P


def _cell_text(mean: float) -> str:
    return f"{mean:+.0f}" if abs(mean) >= 100 else f"{mean:+.1f}"


def _bars(figure: Figure, axes, regime: RegimeMap) -> None:
    """One condition only: a bar a cell."""
    place = np.arange(len(regime.x_edges) - 1)
    chance = ~_stands_out(regime)[0]
    axes.bar(place + 0.5, regime.mean[0], width=0.85, color=np.where(chance, BLUE, ALARM))
    axes.axhline(0.0, color=GREY, linewidth=0.8)
    _edges(axes.set_xticks, regime.x_edges)
    axes.set_ylabel("mean residual / u")
    show_grid(axes)
