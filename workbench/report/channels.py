"""Pictures of channels: the scoreboard, and a channel against its natural axis with its residual below."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from figures.style import (
    BLACK,
    BLUE,
    GREY,
    LIGHT_GREY,
    MARKERS,
    ORANGE,
    SERIES,
    VERMILION,
    new_figure,
    show_grid,
    styled,
)
from workbench.findings import ChannelFit, ChannelScore
from workbench.report.sentences import GOAL
from workbench.report.words import axis_label, label, plain, quantity_of

MOST_POINTS = 1500  # drawn of a channel; more only make the file larger
_MOST_IN_A_LINE = 5  # entries of a legend
_LETTERS_IN_A_LINE, _LETTERS_OF_A_HANDLE = 130, 7
MOST_SERIES = 7  # told apart by colour and named
_WIDE = 500.0  # end over start of a logarithmic axis above which only powers of ten are named
_BAND = 2.0  # u; some 95 of 100 residuals of pure noise lie inside
_ROW = 0.42  # inch, a row of horizontal bars
_LEAST_HEIGHT = 1.8  # inch


def bar_rows(count: int, height: float = 1.0) -> tuple[Figure, Axes, np.ndarray]:
    """A figure of horizontal bars and the places of its rows from the top; height: of a row, in rows of one bar."""
    figure = new_figure(max(_LEAST_HEIGHT, 1.1 + _ROW * height * count))
    return figure, figure.subplots(), np.arange(count)[::-1]


def panels(count: int, height: float, rest: float, columns: int = 1, **grid) -> tuple[Figure, np.ndarray]:
    """A figure of rows of axes one below the other (count, columns); height of one and of the rest [inch]."""
    figure = new_figure(rest + height * count)
    return figure, figure.subplots(count, columns, squeeze=False, **grid)


@styled
def scoreboard(scores: tuple[ChannelScore, ...]) -> Figure:
    """chi2/n of every channel: nominal inputs, fitted inputs, sealed rows; the line is pure noise."""
    figure, axes, place = bar_rows(len(scores), 1.6)
    parts = (
        ("nominal inputs", LIGHT_GREY, [s.chi2_per_n_nominal for s in scores]),
        ("tolerances fitted", BLUE, [s.chi2_per_n for s in scores]),
        ("sealed rows", ORANGE, [np.nan if s.held_out_chi2_per_n is None else s.held_out_chi2_per_n for s in scores]),
    )
    for shift, (name, colour, values) in zip((0.27, 0.0, -0.27), parts):
        if np.isfinite(values).any():
            axes.barh(place + shift, values, height=0.25, color=colour, label=name)
    noise_lines(axes.axvline)
    axes.set_yticks(place, [s.channel for s in scores])
    axes.set(xlabel="chi²/n (1: pure noise)", xscale="log")
    every = np.concatenate([values for *_, values in parts]).astype(float)
    axes.set_xlim(min(0.5, np.nanmin(every) / 1.5), 2 * max(2.0, np.nanmax(every)))
    plain_log(axes.xaxis)
    show_grid(axes)
    below(figure, axes)
    return figure


def plain_log(axis) -> None:
    """1, 10, 100 rather than powers of ten."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    low, high = axis.get_view_interval()
    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if high / low < _WIDE else (1.0,)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def noise_lines(line, goal: float = GOAL) -> None:
    """Lines of pure noise and of the goal; line: ``axes.axvline`` or ``axes.axhline``."""
    line(1.0, color=BLACK, linewidth=1.2, label="pure noise")
    line(goal, color=BLACK, linewidth=1.0, linestyle=":", label=f"goal {goal:g}")


def below(figure: Figure, axes) -> None:
    """The legend in a line under the picture."""
    handles, names = axes.get_legend_handles_labels()
    columns = max(1, min(_MOST_IN_A_LINE, _LETTERS_IN_A_LINE // (max(map(len, names)) + _LETTERS_OF_A_HANDLE)))
    figure.legend(handles, names, loc="outside lower center", ncols=columns, frameon=False)


@styled
def channel_fit(fit: ChannelFit) -> Figure:
    """Reading and model above, residual in u below."""
    figure = new_figure(5.6)
    top, bottom = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
    _readings(top, fit)
    _residuals(bottom, fit, _reach(fit))
    bottom.set_xlabel(axis_label(fit.axis))
    below(figure, top)
    return figure


@styled
def before_and_after(before: ChannelFit, after: ChannelFit, effect: str) -> Figure:
    """The same channel without and with an effect, on the same axes."""
    figure = new_figure(5.8)
    axes = figure.subplots(2, 2, sharex=True, sharey="row", height_ratios=(3, 2))
    reach = max(_reach(before), _reach(after))
    for column, fit, title in zip(axes.T, (before, after), ("without", "with")):
        _readings(column[0], fit)
        _residuals(column[1], fit, reach)
        column[0].set_title(f"{title} {plain(effect)}", loc="left")
        column[1].set_xlabel(axis_label(fit.axis))
    for axis in axes[:, 1]:
        axis.set_ylabel("")
    below(figure, axes[0, 0])
    return figure


def _readings(axes, fit: ChannelFit) -> None:
    rows_of = _rows_of_series(fit)
    for number, (name, rows) in enumerate(rows_of.items()):
        _points(axes, fit, fit.measured, rows, number)
        _model_lines(axes, fit, rows, number)
        if name and len(rows_of) <= MOST_SERIES:
            axes.plot([], [], color=_colour(number), marker=_marker(number), markersize=4, label=name)
    axes.plot([], [], color=GREY, marker="o", linestyle="", markersize=4, label=_measured(fit))
    axes.plot([], [], color=GREY, linestyle="-", label="model, fitted inputs")
    axes.plot([], [], color=GREY, linestyle=":", label="model, nominal inputs")
    axes.set_ylabel(label(quantity_of(fit.channel), fit.unit))
    show_grid(axes)


def _measured(fit: ChannelFit) -> str:
    return "measured (hollow: sealed)" if fit.held_out.any() else "measured"


def _rows_of_series(fit: ChannelFit) -> dict[str, np.ndarray]:
    """Row numbers of every series, in the order in which the series appear."""
    labels = np.array(fit.series)
    return {name: np.flatnonzero(labels == name) for name in dict.fromkeys(fit.series)}


def _points(axes, fit: ChannelFit, values: np.ndarray, rows: np.ndarray, number: int) -> None:
    """Markers of a series, hollow where sealed; evenly thinned where there are very many."""
    step = -(-len(fit.x) // MOST_POINTS)
    look = {"color": _colour(number), "marker": _marker(number), "linestyle": "", "markersize": 4}
    for chosen, fill in ((rows[~fit.held_out[rows]], _colour(number)), (rows[fit.held_out[rows]], "white")):
        axes.plot(fit.x[chosen][::step], values[chosen][::step], markerfacecolor=fill, **look)


def _model_lines(axes, fit: ChannelFit, rows: np.ndarray, number: int) -> None:
    _, first = np.unique(fit.x[rows], return_index=True)
    line = rows[first]
    look = {"color": _colour(number), "marker": "_" if len(line) == 1 else "", "markersize": 24}  # one reading: no line
    axes.plot(fit.x[line], fit.fitted[line], **look)
    axes.plot(fit.x[line], fit.nominal[line], linestyle=":", linewidth=1.2, **look)


def _residuals(axes, fit: ChannelFit, reach: float) -> None:
    axes.axhspan(-_BAND, _BAND, color=LIGHT_GREY, alpha=0.6, linewidth=0)
    axes.axhline(0.0, color=BLACK, linewidth=0.8)
    for number, rows in enumerate(_rows_of_series(fit).values()):
        _points(axes, fit, _in_u(fit), rows, number)
    axes.set(ylabel="residual / u", ylim=(-reach, reach))
    show_grid(axes)


def _in_u(fit: ChannelFit) -> np.ndarray:
    return (fit.measured - fit.fitted) / fit.u


def _reach(fit: ChannelFit) -> float:
    """End of the residual's axis; a few wild readings may lie beyond it."""
    return 1.15 * max(3.0, float(np.percentile(np.abs(_in_u(fit)), 99.5)))


def _colour(number: int) -> str:
    return SERIES[number % len(SERIES)]


def _marker(number: int) -> str:
    return MARKERS[number % len(MARKERS)]


ALARM = VERMILION  # what a reader should look at first
