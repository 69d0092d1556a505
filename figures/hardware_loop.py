"""The picture of the loop in real time: forces with and without force loop, and how well the clock was kept."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from figures.style import BLACK, SERIES, letter, new_figure, show_grid, styled
from units import FACTORS
from vehicle.hardware_loop import LoopRun

SHOWN = (1.0, 1.6)  # s; of a shorter run its second half
MILLISECOND = FACTORS["ms"]
_CLOCK = 1e-5  # ms; less is the reading of the clock itself


@styled
def loop_runs(runs: Mapping[tuple[str, float], LoopRun]) -> Figure:
    """Forces over time, and the clock where a run was paced; runs: by low-level control and damping [Ns/m]."""
    dampings = sorted({damping for _, damping in runs})
    paced = [run for run in runs.values() if run.timing is not None]
    rows = len(dampings) + bool(paced)
    figure = new_figure(2.2 * rows)
    axes = figure.subplots(rows, 1, squeeze=False)[:, 0]
    for axis, damping in zip(axes, dampings, strict=False):
        _forces(axis, {kind: run for (kind, one), run in runs.items() if one == damping}, damping)
    if paced:
        _clock(axes[-1], paced)
    letter(axes)
    show_grid(*axes)
    return figure


def _forces(axis: Axes, runs: Mapping[str, LoopRun], damping: float) -> None:
    end = min(SHOWN[1], max(run.time[-1] for run in runs.values()))
    begin = min(SHOWN[0], end / 2)
    for color, (kind, run) in zip(SERIES, runs.items()):
        here = (run.time >= begin) & (run.time <= end)
        axis.plot(run.time[here], run.force[here], color=color, label=kind, linewidth=1.1)
    axis.plot(run.time[here], run.wanted[here], ":", color=BLACK, label=f"wanted with the {kind}", linewidth=1.1)
    axis.set(xlabel="time / s", ylabel="force / N", xlim=(begin, end))
    axis.set_title(f"{damping:g} Ns/m wanted", loc="left")
    axis.legend(loc="upper left", bbox_to_anchor=(1, 1), frameon=False)


def _clock(axis: Axes, runs: list[LoopRun]) -> None:
    timings = [run.timing for run in runs if run.timing is not None]
    spent, late = [one.spent for one in timings], [one.late for one in timings]
    for color, (name, values) in zip(SERIES, {"step time": spent, "jitter of the release": late}.items()):
        ordered = np.sort(np.concatenate(values)) / MILLISECOND
        axis.plot(ordered, 1 - np.arange(ordered.size) / ordered.size, color=color, label=name)
    axis.axvline(timings[0].step / MILLISECOND, color=BLACK, linestyle="--", label="sample time")
    axis.set(xscale="log", yscale="log", xlabel="time / ms", ylabel="share of steps above", xlim=(_CLOCK, None))
    axis.set_title("All steps of all runs against the clock", loc="left")
    axis.legend(loc="upper left", bbox_to_anchor=(1, 1), frameon=False)
