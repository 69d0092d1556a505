"""The machine as a brake."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from drivetrain.output import Output, in_unit, labelled
from electrical.braking import Braking
from electrical.braking_stage import BrakingOutcome
from figures.style import BLACK, BLUE, GREY, ORANGE, VERMILION, letter, new_figure, show_grid


def braking_over_speed(found: BrakingOutcome, output: Output) -> Figure:
    """Damping, effort and phase current of the brake over the speed of the output, with what is asked for."""
    figure = new_figure(4.6)
    axes = figure.subplots(1, 3)
    speed, ratio = in_unit(found.speed, output.speed_unit), found.demand.ratio
    for words, one, look in _curves(found):
        axes[0].loglog(speed, in_unit(found.damping(one), output.damping_unit), label=words, **look)
        axes[1].semilogx(speed, in_unit(one.torque / ratio, output.axis_unit), **look)
        axes[2].semilogx(speed, one.current_peak, **look)
    if found.demand.damping:
        _draw_demand(axes, found, output)
    for axis, label in zip(axes, _labels(output), strict=True):
        axis.set(xlabel=labelled(output.speed, output.speed_unit), ylabel=label)
        axis.set_xlim(speed[0], speed[-1])
    axes[1].set_ylim(bottom=0.0)
    axes[2].set_ylim(bottom=0.0)
    letter(axes)
    show_grid(*axes)
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=4, frameon=False)
    return figure


def _curves(found: BrakingOutcome) -> Iterator[tuple[str, Braking, dict[str, Any]]]:
    heat = found.heat
    yield f"shorted, {heat.cold:g} °C", found.cold, {"color": BLUE}
    yield f"shorted, {heat.hot:g} °C", found.hot, {"color": ORANGE, "linestyle": "--"}
    yield f"controlled, {heat.hot:g} °C", found.controlled, {"color": VERMILION, "linewidth": 2.0}


def _draw_demand(axes: Sequence[Axes], found: BrakingOutcome, output: Output) -> None:
    demand = found.demand
    speed = in_unit(demand.speed_rms, output.speed_unit)
    axes[0].axhline(in_unit(demand.damping, output.damping_unit), color=BLACK, linestyle=":", label="asked for")
    shown = np.minimum(demand.damping * found.speed, 1.05 * np.nanmax(found.controlled.torque) / demand.ratio)
    axes[1].plot(in_unit(found.speed, output.speed_unit), in_unit(shown, output.axis_unit), color=BLACK, linestyle=":")
    for axis in axes:
        axis.axvline(speed, color=GREY, linewidth=0.8)


def _labels(output: Output) -> tuple[str, str, str]:
    return (
        labelled("damping", output.damping_unit),
        labelled(f"braking {output.effort}", output.axis_unit),
        "phase current, peak / A",
    )
