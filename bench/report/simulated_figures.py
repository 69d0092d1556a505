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

_OPEN = 1e9  # ohm, and above
_STEADY = 0.5  # s, after which the step to the bias of the chirp has died away


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
    """The impedance: its size and phase shunted, its size controlled (thesis Figs 5.9, 5.10 and B.2)."""
    figure = new_figure(4.4)
    size, phase, controlled = figure.subplots(1, 3)
    data, shunts = found.impedance, [_words(shunt) for shunt in found.impedance.shunt]
    asked = [f"{value / FACTORS['kNs_per_m']:g} kNs/m" for value in data.damping.values]
    _lines(size, data.shunted, shunts)
    _lines(phase, np.degrees(data.phase), shunts)
    _lines(controlled, data.controlled, asked)
    for axis, title in ((size, "shunted"), (phase, "shunted"), (controlled, "controlled, asked for")):
        axis.set(xlabel="frequency / Hz", xscale="log")
        axis.set_title(title, loc="left")
    for axis in (size, controlled):
        axis.set(ylabel="force over velocity / (Ns/m)", yscale="log", ylim=(50.0, 1e5))
    figure.legend(*size.get_legend_handles_labels(), loc="outside lower left", ncols=3, frameon=False)
    figure.legend(*controlled.get_legend_handles_labels(), loc="outside lower right", ncols=3, frameon=False)
    phase.set(ylabel="phase / °")
    letter((size, phase, controlled))
    show_grid(size, phase, controlled)
    return figure


@styled
def chirp(found: BenchTests) -> Figure:
    """Current, its frequency, force and angle of the chirp over time (thesis Fig. 5.12)."""
    figure = new_figure(4.8)
    axes = figure.subplots(2, 2, sharex=True).ravel()
    data = found.chirp.sel(time=slice(_STEADY, None))
    names = {"current": "current / A", "frequency": "frequency / Hz", "force": "force / N", "angle": "angle / rad"}
    for axis, (name, words) in zip(axes, names.items(), strict=True):
        axis.plot(data.time, data[name], color=BLUE, linewidth=0.6)
        axis.set(ylabel=words, xlim=(_STEADY, float(data.time[-1])))
    for axis in axes[2:]:
        axis.set(xlabel="time / s")
    letter(axes)
    show_grid(*axes)
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


# Rows of the test in the loop: label of the axis, its unit, and the lines: name, colour, style, words.
_Line = tuple[str, str, str, str]
_LOOP_ROWS: tuple[tuple[str, float, tuple[_Line, ...]], ...] = (
    ("height / mm", MILLIMETRE, (("road", BLACK, "-", "road"), ("body", BLUE, "-", "body"),
                                 ("wheel", ORANGE, "-", "wheel"))),
    ("stroke / mm", MILLIMETRE, (("stroke", BLUE, "-", "stroke, model"), ("axis", ORANGE, "--", "stroke, bench"))),
    ("force / N", 1.0, (("force", BLUE, "-", "force, measured"), ("wanted", BLACK, ":", "force, wanted"))),
    ("felt / (m/s²)", 1.0, (("felt", BLUE, "-", "felt"),)),
    ("missing tyre load", 1.0, (("holding", BLUE, "-", "missing tyre load"),)),
    ("power / W", 1.0, (("mechanical", ORANGE, "-", "from the suspension"),
                        ("electrical", BLUE, "-", "to the battery"))),
    ("battery / A", 1.0, (("current", BLUE, "-", "current to the battery"),)),
)  # fmt: skip


@styled
def in_the_loop(found: BenchTests) -> Figure:
    """The test in the loop, without and with force loop, one column each (thesis Figs 5.16 and 5.17)."""
    data = found.loops_in_time
    figure = new_figure(11.0)
    axes = figure.subplots(len(_LOOP_ROWS), data.sizes["test"], sharex=True, sharey="row", squeeze=False)
    for column, name in zip(axes.T, data.test.values, strict=True):
        for axis, (_, unit, lines) in zip(column, _LOOP_ROWS, strict=True):
            _in_one(axis, data.sel(test=name), lines, unit)
        column[0].set_title(str(name), loc="left")
        column[-1].set(xlabel="time / s", xlim=(float(data.time[0]), float(data.time[-1])))
    for axis, (words, _, lines) in zip(axes[:, 0], _LOOP_ROWS, strict=True):
        axis.set(ylabel=words)
        if len(lines) > 1:
            axis.legend(fontsize=7, loc="lower right", bbox_to_anchor=(1.0, 0.96), ncols=3, frameon=False)
    show_grid(*axes.flat)
    figure.align_ylabels(axes)
    return figure


def _in_one(axis: Axes, one: xr.Dataset, lines: tuple[_Line, ...], unit: float) -> None:
    for name, colour, style, words in lines:
        axis.plot(one.time, one[name] / unit, color=colour, linestyle=style, label=words, linewidth=1.0)
