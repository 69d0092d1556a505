"""Control laws over their settings: carpets in the planes of comfort, road holding and stroke; LQR over frequency."""

from __future__ import annotations

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator

from figures.style import BLACK, DESIGN_MAP, SERIES, letter, new_figure, show_grid, styled
from units import GRAVITY, MILLIMETRE
from vehicle.spectral import Carpet
from vehicle.strategies import LAWS, Strategies

_SHOWN = 7  # iso-curves of each setting
_MOST = (1.0, 3.0, 300.0)  # g, road holding, mm: beyond it nobody rides


@styled
def carpets(found: Strategies) -> Figure:
    """Every law: curves of one first setting over the second, in two planes (thesis Figs 4.13 to 4.17)."""
    figure = new_figure(2.5 * len(LAWS))
    axes = figure.subplots(len(LAWS), 2, squeeze=False)
    for row, law in zip(axes, LAWS, strict=True):
        _carpet(row, found.carpets[law.name], law.first)
        row[0].set(ylabel=f"{law.name}\nroad holding")
    for axis in axes[-1]:
        axis.set(xlabel="comfort / g")
    show_grid(*axes.flat)
    return figure


def _carpet(row: np.ndarray, one: Carpet, first: str) -> None:
    comfort, colours = one.comfort / GRAVITY, _colours()
    rows = np.linspace(0, len(one.first) - 1, _SHOWN).astype(int)
    others = one.road_holding, one.stroke / MILLIMETRE
    for axis, other, most in zip(row, others, _MOST[1:], strict=True):
        for k, colour in zip(rows, colours, strict=True):
            axis.loglog(comfort[k], other[k], color=colour)
            axis.plot(comfort[k, 0], other[k, 0], color=BLACK, marker=".", markersize=4, linestyle="")
        axis.set(xlim=(None, min(_MOST[0], np.nanmax(comfort))), ylim=(None, min(most, np.nanmax(other))))
        _plain_ticks(axis)
    row[1].set(ylabel="stroke, RMS / mm")
    _name(row[1], rows, one, first, colours)


def _name(axis: Axes, rows: np.ndarray, one: Carpet, first: str, colours: np.ndarray) -> None:
    """Which colour is which first setting."""
    name, unit = first.split(" / ")
    handles = [axis.plot([], [], color=colour)[0] for colour in colours]
    axis.legend(handles, [f"{one.first[k]:.3g}" for k in rows], title=f"{name} / {unit.strip('()')}", fontsize=7,
                title_fontsize=7, loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)  # fmt: skip


def _plain_ticks(axis: Axes) -> None:
    """1, 2, 5 and their tens as plain numbers."""
    for one in (axis.xaxis, axis.yaxis):
        one.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        one.set_major_formatter("{x:g}")
        one.set_minor_formatter("")


def _colours() -> np.ndarray:
    return np.asarray(colormaps[DESIGN_MAP](np.linspace(0.0, 0.9, _SHOWN)))


@styled
def responses(found: Strategies) -> Figure:
    """Weighted acceleration and tyre deflection over the road's height with each LQR setting (thesis Fig. 4.18)."""
    figure = new_figure(3.6)
    left, right = figure.subplots(1, 2)
    for name, colour in zip(found.responses.setting.values, SERIES, strict=False):
        one = found.responses.sel(setting=name)
        left.loglog(one.frequency, one.felt, color=colour, label=str(name))
        right.loglog(one.frequency, one.tyre, color=colour)
    left.set(xlabel="frequency / Hz", ylabel="weighted acceleration / road / (1/s²)", ylim=(1e-2, None))
    right.set(xlabel="frequency / Hz", ylabel="tyre deflection / road", ylim=(1e-4, None))
    figure.legend(*left.get_legend_handles_labels(), loc="outside lower center", ncols=3, frameon=False)
    letter((left, right))
    show_grid(left, right)
    return figure
