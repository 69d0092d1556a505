"""Picture of the comparison: CPU time and differences, code by code."""

from __future__ import annotations

from matplotlib.figure import Figure

from benchmarks.comparison import Agreement, Timing
from figures.style import MARKERS, SERIES, letter, new_figure, show_grid, styled

_HEIGHT = 4.2  # inches
_ACCEPTED = 2e-4  # relative difference
_APART = 0.2  # of two peers in a column


@styled
def draw_comparison(agreements: list[Agreement], timings: list[Timing]) -> Figure:
    """CPU time of every code (left) and its difference from this project's solution (right), both logarithmic."""
    figure = new_figure(_HEIGHT)
    times, differences = figure.subplots(1, 2)
    _draw_times(times, timings)
    _draw_differences(differences, agreements)
    letter((times, differences))
    return figure


def _draw_times(axis, timings: list[Timing]) -> None:
    cases = list(dict.fromkeys((t.extent, t.order, t.unknowns) for t in timings))
    codes = list(dict.fromkeys(t.code for t in timings))
    width = 0.8 / len(codes)
    for k, code in enumerate(codes):
        heights = [t.cpu_median for t in timings if t.code == code]
        places = [i + (k - (len(codes) - 1) / 2) * width for i in range(len(cases))]
        axis.bar(places, heights, width, color=SERIES[k], label=code)
    axis.set_xticks(range(len(cases)), [f"{extent} {order}\n{unknowns}" for extent, order, unknowns in cases])
    axis.set_yscale("log")
    axis.set_ylabel("CPU time / s, one solution")
    axis.set_xlabel("part of the machine, order, unknowns")
    axis.set_title("Cost, median", loc="left")
    axis.legend(loc="upper left")
    axis.set_ylim(top=axis.get_ylim()[1] * 20)
    show_grid(axis)


def _draw_differences(axis, agreements: list[Agreement]) -> None:
    columns = {
        "torque": "torque_difference",
        "flux linkage": "flux_difference",
        "potential": "potential_difference",
        "torque,\n7 points": "fine_torque_difference",
    }
    codes = list(dict.fromkeys(a.code for a in agreements))
    for k, code in enumerate(codes):
        for i, field in enumerate(columns.values()):
            values = [getattr(a, field) for a in agreements if a.code == code]
            places = [i + _APART * (k - (len(codes) - 1) / 2)] * len(values)
            axis.plot(places, values, MARKERS[k], color=SERIES[k], label=None if i else code)
    axis.axhline(_ACCEPTED, color=SERIES[4], linestyle="--", label="0.02 %")
    axis.set_xticks(range(len(columns)), columns)
    axis.set_yscale("log")
    axis.set_ylabel("relative difference")
    axis.set_title("Agreement on identical meshes, all states", loc="left")
    axis.legend()
    show_grid(axis)
