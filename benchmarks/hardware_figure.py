"""The picture of the loop in real time: forces with and without force loop, and how well the clock was kept."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from figures.style import BLACK, SERIES, letter, new_figure, save_png, show_grid, styled
from units import FACTORS
from vehicle.hardware_loop import LoopRun

SHOWN = (1.0, 1.6)  # s
MILLISECOND = FACTORS["ms"]


def draw(runs: Mapping[tuple[str, float], LoopRun], path: Path) -> None:
    """Write the picture; runs: by low-level control and damping [Ns/m]."""
    save_png(_figure(runs), path)


@styled
def _figure(runs: Mapping[tuple[str, float], LoopRun]) -> Figure:
    dampings = sorted({damping for _, damping in runs})
    figure = new_figure(2.2 * (len(dampings) + 1))
    axes = figure.subplots(len(dampings) + 1, 1)
    for axis, damping in zip(axes, dampings, strict=False):
        _forces(axis, {kind: run for (kind, one), run in runs.items() if one == damping}, damping)
    _clock(axes[-1], list(runs.values()))
    letter(axes)
    show_grid(*axes)
    return figure


def _forces(axis: Axes, runs: Mapping[str, LoopRun], damping: float) -> None:
    for color, (kind, run) in zip(SERIES, runs.items()):
        here = (run.time >= SHOWN[0]) & (run.time <= SHOWN[1])
        axis.plot(run.time[here], run.force[here], color=color, label=kind, linewidth=1.1)
    axis.plot(run.time[here], run.wanted[here], ":", color=BLACK, label=f"wanted with the {kind}", linewidth=1.1)
    axis.set(xlabel="time / s", ylabel="force / N", xlim=SHOWN)
    axis.set_title(f"{damping:g} Ns/m wanted", loc="left")
    axis.legend(loc="upper left", bbox_to_anchor=(1, 1), frameon=False)


def _clock(axis: Axes, runs: list[LoopRun]) -> None:
    timings = [run.timing for run in runs if run.timing is not None]
    spent, late = [one.spent for one in timings], [one.late for one in timings]
    for color, (name, values) in zip(SERIES, {"step time": spent, "jitter of the release": late}.items()):
        ordered = np.sort(np.concatenate(values)) / MILLISECOND
        axis.plot(ordered, 1 - np.arange(ordered.size) / ordered.size, color=color, label=name)
    axis.axvline(timings[0].step / MILLISECOND, color=BLACK, linestyle="--", label="sample time")
    axis.set(xscale="log", yscale="log", xlabel="time / ms", ylabel="share of steps above")
    axis.set_title("All steps of all runs against the clock", loc="left")
    axis.legend(loc="upper left", bbox_to_anchor=(1, 1), frameon=False)
