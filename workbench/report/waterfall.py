"""The falling error, effect after effect."""

from __future__ import annotations

from textwrap import fill

import numpy as np
from matplotlib.figure import Figure

from figures.style import BLUE, GREY, ORANGE, new_figure, show_grid, styled
from workbench.findings import Ledger, LedgerStep
from workbench.report.channels import ALARM, below, noise_lines, plain_log
from workbench.report.words import chi2_text, plain

_WIDTH = 0.38
_LETTERS = 14  # in a line of a step's name
_LOG_FROM = 8.0  # largest over smallest error above which the axis is logarithmic
_ROOM = 1.6  # above the tallest bar on a logarithmic axis, for the words


@styled
def waterfall(ledger: Ledger) -> Figure:
    """chi2/n of fitted rows and of conditions left out of the fit after each step; refused ones are hatched."""
    figure = new_figure(4.6)
    axes = figure.subplots()
    fit = np.array([step.chi2_per_n for step in ledger.steps])
    held = np.array([np.nan if s.held_out_chi2_per_n is None else s.held_out_chi2_per_n for s in ledger.steps])
    place = np.arange(len(fit))
    refused = np.array([step.decision == "refused" for step in ledger.steps])
    for shift, values, colour, name in (
        (-_WIDTH / 2, fit, BLUE, "fitted rows"),
        (_WIDTH / 2, held, ORANGE, "conditions left out of the fit"),
    ):
        if np.isfinite(values).any():
            _bars(axes, place + shift, values, colour, name, refused)
    _levels(axes, place, np.where(np.isnan(held), fit, held), refused)
    noise_lines(axes.axhline, ledger.goal)
    axes.set_xticks(place, [_step_name(step) for step in ledger.steps])
    for tick, no in zip(axes.get_xticklabels(), refused):
        tick.set_color(ALARM if no else "black")
    axes.set_ylabel("chi²/n")
    _scale(axes, np.concatenate([fit, held]))
    axes.set_xlim(-0.7, max(len(fit) - 0.3, 2.0))
    show_grid(axes)
    axes.xaxis.grid(False)
    below(figure, axes)
    return figure


def _bars(axes, place, values, colour, name, refused) -> None:
    bars = axes.bar(place, values, width=_WIDTH, color=colour, label=name)
    for bar, no in zip(bars, refused):
        if no:
            bar.set(facecolor="white", edgecolor=colour, hatch="////")
    for x, value in zip(place, values):
        if np.isfinite(value):
            look = {"ha": "center", "fontsize": 9, "bbox": {"facecolor": "white", "edgecolor": "none", "pad": 0.6}}
            axes.annotate(chi2_text(value), (x, value), (0, 3), textcoords="offset points", **look)


def _levels(axes, place, judged, refused) -> None:
    """Thin line at the level reached so far, from each accepted step to the next."""
    kept = [k for k in place if not refused[k]]
    for here, there in zip(kept, [*kept[1:], place[-1]]):
        if there > here:
            axes.plot(
                [here + _WIDTH, there - (0 if refused[there] else _WIDTH)],
                [judged[here]] * 2,
                color=GREY,
                linewidth=0.9,
                linestyle="--",
            )


def _step_name(step: LedgerStep) -> str:
    if step.decision == "start":
        return "start"
    name = fill(f"+\N{NO-BREAK SPACE}{plain(step.effect)}", _LETTERS)
    return f"{name}\nrefused" if step.decision == "refused" else name


def _scale(axes, values: np.ndarray) -> None:
    largest, smallest = np.nanmax(values), max(np.nanmin(values), 1e-3)
    if largest / smallest > _LOG_FROM:
        axes.set_yscale("log")
        axes.set_ylim(min(0.5, smallest / 2), _ROOM * largest)
        plain_log(axes.yaxis)
    else:
        axes.set_ylim(0, 1.2 * max(largest, 1.2))
