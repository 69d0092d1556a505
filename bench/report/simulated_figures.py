"""Figures of the simulated benches, as thesis chapters 4 and 5 show those of its prototype."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bench.report.pictures import shunt_words
from bench.simulated import BenchTests
from figures.style import BLACK, BLUE, DESIGN_MAP, ORANGE, SERIES, letter, new_figure, show_grid, styled
from units import FACTORS, MILLIMETRE
from vehicle.comfort import weighted_acceleration

_OPEN = 1e9  # ohm, and above


def _words(shunt: xr.DataArray) -> str:
    return shunt_words(min(float(shunt), _OPEN))


def _lines(axis: Axes, table: xr.DataArray, words: Sequence[str]) -> None:
    """A line for each row of a table over its second axis; words: of the rows."""
    for values, name, colour in zip(table.values, words, SERIES, strict=False):
        axis.plot(table[table.dims[1]], values, color=colour, label=name)


@styled
def static_shunts(found: BenchTests) -> Figure:
    """Force and conversion efficiency over velocity at every shunt (thesis Figs 5.3 and 5.4)."""
    figure = new_figure(3.6)
    force, efficiency = figure.subplots(1, 2)
    data, words = found.shunted, [_words(shunt) for shunt in found.shunted.shunt]
    loaded = (data.shunt > 0) & np.isfinite(data.shunt)
    _lines(force, data.force, words)
    _lines(efficiency, 100 * data.efficiency.where(loaded), words)
    force.set(xlabel="velocity / (m/s)", ylabel="force / N", xlim=(0, None), ylim=(0, None))
    efficiency.set(xlabel="velocity / (m/s)", ylabel="shunt over mechanical power / %", xlim=(0, None), ylim=(0, 100))
    figure.legend(*force.get_legend_handles_labels(), loc="outside lower center", ncols=5, frameon=False)
    letter((force, efficiency))
    show_grid(force, efficiency)
    return figure


@styled
def quadrant_maps(found: BenchTests) -> Figure:
    """Electrical power and efficiency of the controlled machine over force and velocity (thesis Figs 5.6 and 5.8)."""
    figure = new_figure(4.2)
    axes = figure.subplots(1, 2)
    data = found.quadrants
    force = np.where(np.isnan(data.force), 0.0, data.force)
    velocity = np.broadcast_to(data.velocity.values, force.shape)
    panels = (("to the battery / W", data.electrical), ("efficiency / %", 100 * data.efficiency))
    for axis, (words, values) in zip(axes, panels, strict=True):
        shown = axis.contourf(velocity, force, np.ma.masked_invalid(values), 12, cmap=DESIGN_MAP)
        figure.colorbar(shown, ax=axis, location="bottom", shrink=0.9)
        axis.axhline(0.0, color=BLACK, linewidth=0.8)
        axis.set(xlabel="velocity / (m/s), rebound", ylabel="force / N")
        axis.set_title(words, loc="left")
    letter(axes)
    return figure


@styled
def impedance(found: BenchTests) -> Figure:
    """Size of the impedance, shunted and controlled (thesis Figs 5.9, 5.10 and B.2)."""
    figure = new_figure(4.4)
    left, right = figure.subplots(1, 2, sharey=True)
    data = found.impedance
    asked = [f"{value / FACTORS['kNs_per_m']:g} kNs/m asked for" for value in data.damping.values]
    _lines(left, data.shunted, [_words(shunt) for shunt in data.shunt])
    _lines(right, data.controlled, asked)
    for axis, title in ((left, "shunted"), (right, "controlled, no force loop")):
        axis.set(xlabel="frequency / Hz", xscale="log", yscale="log")
        axis.set_title(title, loc="left")
        axis.legend(fontsize=8, loc="upper center", bbox_to_anchor=(0.5, -0.18), ncols=2, frameon=False)
    left.set(ylabel="force over velocity / (Ns/m)", ylim=(50.0, 1e5))
    letter((left, right))
    show_grid(left, right)
    return figure


@styled
def active_mode(found: BenchTests) -> Figure:
    """Force over current and angle over force with the output held, with the coherence (thesis Fig. 5.13)."""
    figure = new_figure(3.6)
    axes = figure.subplots(1, 3)
    data, peak = found.active, float(found.active.frequency[int(np.argmax(found.active.force.values))])
    axes[0].loglog(data.frequency, data.force, color=BLUE)
    axes[0].axvline(peak, color=BLACK, linestyle=":", linewidth=1.0)
    axes[1].loglog(data.frequency, data.angle, color=BLUE)
    axes[2].semilogx(data.frequency, data.coherence, color=BLUE)
    for axis, words in zip(
        axes, ("force over current / (N/A)", "angle over force / (rad/N)", "coherence"), strict=True
    ):
        axis.set(xlabel="frequency / Hz", ylabel=words)
    axes[2].set(ylim=(0, 1.05))
    letter(axes)
    show_grid(*axes)
    return figure


@styled
def in_the_loop(found: BenchTests) -> Figure:
    """Stroke, force and felt acceleration of the test in the loop, without and with force loop (thesis Fig. 5.16)."""
    data = found.loops_in_time
    step = float(data.time[1] - data.time[0])
    figure = new_figure(5.4)
    axes = figure.subplots(3, data.sizes["test"], sharex=True, sharey="row", squeeze=False)
    for column, name in zip(axes.T, data.test.values, strict=True):
        _test_in_the_loop(column, data.sel(test=name), step)
        column[0].set_title(str(name), loc="left")
        column[-1].set(xlabel="time / s", xlim=(float(data.time[0]), float(data.time[-1])))
    for axis, words in zip(axes[:, 0], ("stroke / mm", "force / N", "felt / (m/s²)"), strict=True):
        axis.set(ylabel=words)
    pairs = [pair for axis in axes[:2, 0] for pair in zip(*axis.get_legend_handles_labels(), strict=True)]
    figure.legend(*zip(*pairs, strict=True), loc="outside lower center", ncols=4, frameon=False)
    show_grid(*axes.flat)
    return figure


def _test_in_the_loop(column: np.ndarray, one: xr.Dataset, step: float) -> None:
    stroke, force, felt = column
    _two(stroke, one, (("stroke", BLUE, "-", "stroke, model"), ("axis", ORANGE, "--", "stroke, bench")), MILLIMETRE)
    _two(force, one, (("force", BLUE, "-", "force, measured"), ("wanted", BLACK, ":", "force, wanted")), 1.0)
    felt.plot(one.time, weighted_acceleration(one.acceleration.values, step), color=BLUE, linewidth=1.0)


def _two(axis: Axes, one: xr.Dataset, lines: tuple[tuple[str, str, str, str], ...], unit: float) -> None:
    for name, colour, style, words in lines:
        axis.plot(one.time, one[name] / unit, color=colour, linestyle=style, label=words, linewidth=1.0)
