"""What each tolerance does to torque, losses and cogging, and the cogging of machines whose magnets differ."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import isfinite

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from drivetrain.output import amount
from figures.style import BLACK, BLUE, GREEN, LIGHT_GREY, ORANGE, VERMILION, letter, new_figure, show_grid, styled
from uncertainty.scatter import peak_to_peak
from uncertainty.tolerance_stage import Sensitivity, ToleranceOutcome

SHOWN = {
    "peak_torque": "peak torque",
    "copper_loss": "copper loss",
    "iron_loss": "iron loss",
    "cogging": "cogging",
}
_PERCENT = 100.0
_ORDERS = 6  # of each kind that are drawn


@styled
def tolerance_bars(found: ToleranceOutcome, rows: Sequence[Sensitivity]) -> Figure:
    """One bar a tolerance and quantity: the most that it does, and its standard uncertainty; in the order given."""
    shown = {name: words for name, words in SHOWN.items() if isfinite(getattr(found.values, name))}
    figure = new_figure(1.2 + 0.3 * len(rows))
    axes = figure.subplots(1, len(shown), sharey=True)
    labels = [f"{one.deviation.name} ± {amount(one.deviation.half_width, one.deviation.unit)}" for one in rows]
    for axis, (name, words) in zip(axes, shown.items()):
        axis.barh(labels, [_PERCENT * one.worst(name) for one in rows], color=LIGHT_GREY, label="at the end of it")
        standard = [_PERCENT * abs(one.standard(name)) for one in rows]
        axis.barh(labels, standard, height=0.45, color=BLUE, label="standard uncertainty")
        axis.set(title=words, xlabel="change / %")
        axis.xaxis.set_major_locator(MaxNLocator(4))
    axes[0].invert_yaxis()
    show_grid(*axes)
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=2, frameon=False)
    return figure


@styled
def cogging_of_many(found: ToleranceOutcome) -> Figure:
    """Cogging of machines drawn by lot, and the new orders that magnets and eccentricity add."""
    scatter, figure = found.scatter, new_figure(3.6)
    histogram, orders = figure.subplots(1, 2, width_ratios=(1.0, 1.4))
    machines, drawn = scatter.machines(found.tolerances.scatter), float(peak_to_peak(scatter.drawn))
    histogram.hist(machines, bins=40, color=BLUE)
    histogram.axvline(drawn, color=BLACK, linestyle="--", label="as drawn")
    histogram.axvline(np.percentile(machines, 95), color=VERMILION, label="19 of 20 below")
    histogram.set(xlabel="cogging, peak to peak / (Nm/m)", ylabel="machines", title="magnets that differ")
    histogram.legend()
    _orders(
        orders,
        {
            "magnets that differ, RMS": scatter.orders_of_magnets(found.tolerances.scatter),
            "stator off centre": scatter.orders_of_static,
            "rotor off centre": scatter.orders_of_dynamic,
        },
    )
    letter((histogram, orders))
    show_grid(histogram, orders)
    return figure


def _orders(axes: Axes, kinds: Mapping[str, Mapping[int, float]]) -> None:
    """Amplitude of the largest new orders of each kind, side by side."""
    largest = {name: dict(list(sizes.items())[:_ORDERS]) for name, sizes in kinds.items()}
    shown = sorted({order for sizes in largest.values() for order in sizes})
    for place, (colour, (name, sizes)) in enumerate(zip((BLUE, ORANGE, GREEN), largest.items())):
        heights = [sizes.get(order, 0.0) for order in shown]
        axes.bar(np.arange(len(shown)) + 0.27 * (place - 1), heights, width=0.27, color=colour, label=name)
    axes.set_xticks(np.arange(len(shown)), [str(order) for order in shown])
    axes.set(xlabel="order, periods per turn of the rotor", ylabel="amplitude / (Nm/m)", title="new orders")
    axes.legend()
