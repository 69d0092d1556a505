"""What the temperatures allow over time, and how warm the parts become."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from drivetrain.output import Output, in_unit, labelled
from figures.style import BLACK, BLUE, GREY, LIGHT_GREY, ORANGE, VERMILION, letter, new_figure, show_grid, styled
from thermal.machine import PARTS
from thermal.rating import Overload
from thermal.stage import HeatOutcome

_SHORTEST = 10.0  # s, where the curves begin unless a limit is met before


@styled
def heat_of_machine(found: HeatOutcome, output: Output) -> Figure:
    """Effort over the time for which it is allowed, and the temperatures at the continuous effort."""
    figure = new_figure(4.8)
    axes = figure.subplots(1, 2)
    _draw_overloads(axes[0], found, output)
    _draw_temperatures(axes[1], found, output)
    letter(axes)
    show_grid(*axes)
    return figure


def _draw_overloads(axes: Axes, found: HeatOutcome, output: Output) -> None:
    unit = output.axis_unit
    curves = (
        (found.cold, "from cold", {"color": BLUE}),
        (found.warm, f"from the duty {output.duty}", {"color": ORANGE, "linestyle": "--"}),
    )
    for overload, words, look in curves:
        if len(overload.duration):
            duration, torque = _continued(overload, found.slow.torque)
            axes.semilogx(duration, in_unit(found.effort(torque), unit), label=words, **look)
    lines = ((found.effort(found.slow.torque), "continuous", BLACK), (found.nominal_effort, _nominal(found), GREY))
    for effort, words, colour in lines:
        axes.axhline(in_unit(effort, unit), color=colour, linestyle=":", label=words)
    axes.set(xlabel="duration / s", ylabel=labelled(f"{output.effort}, slowly turning", unit))
    axes.set_ylim(bottom=0.0)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=2, frameon=False)


def _nominal(found: HeatOutcome) -> str:
    return f"at {in_unit(found.nominal_density, 'A_per_mm2'):g} A/mm²"


def _continued(overload: Overload, continuous: float) -> tuple[np.ndarray, np.ndarray]:
    """The curve (n,) with its ends: the largest current for a shorter time, the continuous torque for ever."""
    duration = np.array([10 * overload.duration[0], *overload.duration, min(_SHORTEST, overload.duration[-1])])
    return duration, np.array([continuous, *overload.torque, overload.torque[-1]])


def _draw_temperatures(axes: Axes, found: HeatOutcome, output: Output) -> None:
    state, limits = found.slow.state, found.inputs.limits
    rows = [("hottest copper", state.hottest_copper), *((name, state.temperature[name]) for name in PARTS)]
    names, values = zip(*rows)
    axes.barh(range(len(rows)), values, color=LIGHT_GREY, edgecolor=GREY, linewidth=0.8)
    axes.set_yticks(range(len(rows)), names)
    axes.invert_yaxis()
    for limit, words, look in ((limits.copper, "winding", "-"), (limits.magnets, "magnets", "--")):
        axes.axvline(limit, color=VERMILION, linestyle=look, label=f"limit of the {words}")
    axes.axvline(found.inputs.cooling.ambient, color=BLUE, linewidth=0.8, label="ambient")
    axes.set(
        xlabel=f"temperature at the continuous {output.effort} / °C", xlim=(0.0, 1.12 * max(*values, limits.copper))
    )
    axes.legend(loc="upper center", bbox_to_anchor=(0.4, -0.16), ncols=3, frameon=False)
