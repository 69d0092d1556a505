"""Safety factors of rotor, shafts and bearings against what is wanted of them."""

from __future__ import annotations

from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullLocator, StrMethodFormatter

from drivetrain.output import amount
from figures.style import BLACK, BLUE, VERMILION, new_figure, show_grid, styled
from mechanics.stage import MechanicsOutcome

_SHOWN = 100.0  # times the wanted factor; more is as good


@styled
def safety_margins(found: MechanicsOutcome) -> Figure:
    """Reached over wanted factor of every check; what falls short of 1 fails."""
    figure = new_figure(0.9 + 0.42 * len(found.checks))
    axes = figure.subplots()
    over = [min(max(one.reached / one.wanted, 1 / _SHOWN), _SHOWN) for one in found.checks]
    bars = axes.barh(
        [one.part for one in found.checks],
        [value - 1 for value in over],
        left=1.0,
        color=[BLUE if one.holds else VERMILION for one in found.checks],
    )
    factors = [f" {_factor(one.reached)} of {amount(one.wanted, '')} " for one in found.checks]
    axes.bar_label(bars, factors, fontsize=9)
    axes.axvline(1.0, color=BLACK, linewidth=1.0)
    axes.set_xscale("log")
    axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axes.xaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_xlim(min(0.5, *over) / 3, max(2.0, *over) * 3)  # room for what is written beside the bars
    axes.invert_yaxis()
    axes.set_xlabel("factor reached over factor wanted")
    show_grid(axes)
    return figure


def _factor(reached: float) -> str:
    return amount(reached, "") if reached < _SHOWN else f"> {_SHOWN:g}"
