"""How the cost grows with unknowns, designs and processes."""

from __future__ import annotations

import pandas as pd
from matplotlib.ticker import NullFormatter

from figures.style import new_figure, show_grid, styled
from units import percent

_EFFICIENCY = 0.85  # wanted of two processes


@styled
def draw(solves: pd.DataFrame, designs: pd.DataFrame, walls: dict[int, float], processor: str):
    """Three panels.

    solves: unknowns, cold_solve_s, factorisation_s, arithmetic_floor_s, memory_floor_s
    designs: designs, cpu_s; walls: wall time [s] by the number of processes
    """
    figure = new_figure(4.6, width=12.0)
    panels = figure.subplots(1, 3)
    _draw_unknowns(panels[0], solves)
    _draw_designs(panels[1], designs)
    _draw_processes(panels[2], walls)
    for axes in panels:
        axes.legend()
        show_grid(axes)
    figure.suptitle(processor)
    return figure


def _draw_unknowns(axes, solves: pd.DataFrame) -> None:
    axes.loglog(solves.unknowns, solves.cold_solve_s, "o-", label="cold solve")
    axes.loglog(solves.unknowns, solves.factorisation_s, "s-", label="one factorisation")
    axes.loglog(solves.unknowns, solves.arithmetic_floor_s, "--", label="its arithmetic at full rate")
    axes.loglog(solves.unknowns, solves.memory_floor_s, ":", label="its factor written once")
    axes.set(xlabel="free unknowns", ylabel="CPU time / s", ylim=(None, 20 * solves.cold_solve_s.max()))
    axes.xaxis.set_minor_formatter(NullFormatter())


def _draw_designs(axes, designs: pd.DataFrame) -> None:
    per_design = designs.cpu_s.iloc[-1] / designs.designs.iloc[-1]
    axes.plot(designs.designs, designs.cpu_s, "o-", label="measured")
    last = designs.iloc[-1]
    axes.plot([0, last.designs], [0, last.cpu_s], "--", label=f"{1e3 * per_design:.1f} ms a design")
    axes.set(xlabel="designs of the sweep, meshes included", ylabel="CPU time / s", xlim=(0, None), ylim=(0, None))


def _draw_processes(axes, walls: dict[int, float]) -> None:
    counts, one = list(walls), walls[1]
    axes.plot(counts, [one / walls[count] for count in counts], "o-", label="measured")
    axes.plot(counts, counts, "--", label="ideal")
    axes.plot([2], [2 * _EFFICIENCY], "v", label=f"target, {percent(_EFFICIENCY)} efficiency")
    axes.set(xlabel="processes", ylabel="speed-up of the wall time", xticks=counts)
