"""Figures of the bench tools."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.tri import Triangulation

from bench.constant_speed import SteadyPoint, StraightLine
from bench.force_loops import LoopMatch
from bench.frequency_response import FrequencyResponse
from bench.identification import Identification
from bench.impedance import ImpedancePoint
from bench.quadrants import Pass
from bench.shunt_damping import JudgedLaw
from bench.sound import SoundLevels
from figures.report import heading
from figures.style import (
    BLACK,
    BLUE,
    DESIGN_MAP,
    GREY,
    LIGHT_GREY,
    ORANGE,
    SKY,
    VERMILION,
    Look,
    letter,
    new_figure,
    series_style,
    show_grid,
    styled,
)  # fmt: skip
from units import MILLIMETRE, MILLIOHM
from vehicle.impedance import LumpedActuator
from workbench.data.table import OPEN_CIRCUIT

_LARGEST_SHOWN_ERROR = 75.0  # percent, of a law; beyond it a mark stands at the edge
_MOST_LOOPS = 6  # shown
_CURVE = 60  # points of a line
_AROUND = 1.1  # of the outermost point, to the edge of a map


def shunt_words(shunt: float) -> str:
    """A shunt [ohm] in words."""
    if shunt >= OPEN_CIRCUIT:
        return "open circuit"
    return f"{shunt / MILLIOHM:g} mΩ" if shunt > 0 else "short circuit"


@styled
def law_errors(laws: Sequence[JudgedLaw]) -> Figure:
    """Error of every law at every shunt; hollow where the law was fitted to the point."""
    figure = new_figure(0.9 + 0.42 * len(laws))
    axes = figure.subplots()
    shunts = laws[0].points.shunt
    for shunt, look in series_style(shunts.tolist()).items():
        place = int(np.flatnonzero(shunts == shunt)[0])
        error = np.clip([100 * law.error[place] for law in laws], -_LARGEST_SHOWN_ERROR, _LARGEST_SHOWN_ERROR)
        axes.plot(error, range(len(laws)), linestyle="none", label=shunt_words(shunt), **look)
    axes.axvspan(-5, 5, color=LIGHT_GREY, alpha=0.6, linewidth=0)
    axes.axvline(0, color=BLACK, linewidth=0.8)
    axes.set_yticks(range(len(laws)), [law.name for law in laws])
    axes.invert_yaxis()
    axes.set(xlabel="predicted over measured damping less one / %  (grey: 5 %)")
    axes.set_xlim(-_LARGEST_SHOWN_ERROR - 3, _LARGEST_SHOWN_ERROR + 3)
    show_grid(axes)
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=len(shunts), frameon=False)
    return figure


@styled
def steady_points(points: Sequence[SteadyPoint], lines: Sequence[StraightLine]) -> Figure:
    """Force and efficiency over velocity for every shunt, with the straight lines."""
    figure = new_figure(4.4)
    force, efficiency = figure.subplots(1, 2)
    by_shunt = {line.shunt: line for line in lines}
    for shunt, look in series_style(point.shunt for point in points).items():
        mine = sorted((p for p in points if p.shunt == shunt), key=lambda p: p.velocity)
        velocity = np.array([p.velocity for p in mine])
        force.errorbar(velocity, [p.force for p in mine], [p.force_error for p in mine], linestyle="none",
                       label=shunt_words(shunt), **look)  # fmt: skip
        if shunt in by_shunt:
            line = by_shunt[shunt]
            reach = np.array([0.0, velocity.max()])
            force.plot(reach, line.damping * reach + line.intercept, color=look["color"])
        if any(p.power for p in mine):
            efficiency.plot(velocity, [100 * p.efficiency for p in mine], **look)
    force.set(xlabel="velocity / (m/s)", ylabel="force / N", title="")
    efficiency.set(xlabel="velocity / (m/s)", ylabel="conversion efficiency / %")
    letter([force, efficiency])
    show_grid(force, efficiency)
    figure.legend(*force.get_legend_handles_labels(), loc="outside lower center", ncols=5, frameon=False)
    return figure


@styled
def quadrant_maps(found: Sequence[Pass]) -> Figure:
    """Electrical power and efficiency over velocity and force, between the points that were measured."""
    figure = new_figure(4.6)
    axes = figure.subplots(1, 2)
    power = np.array([one.electrical for one in found])
    _map(figure, axes[0], found, power, "electrical power, to the battery / W")
    _map(figure, axes[1], found, 100 * np.array([one.efficiency for one in found]), "efficiency, out over in / %")
    letter(axes)
    return figure


def _map(figure: Figure, axes: Axes, found: Sequence[Pass], values: np.ndarray, label: str) -> None:
    velocity, force = (np.array([getattr(one, name) for one in found]) for name in ("velocity", "force"))
    known = np.isfinite(values)
    for horizontal in (-1, 1):
        for vertical in (-1, 1):
            mine = known & (velocity * horizontal > 0) & (force * vertical > 0)
            if _spans_an_area(velocity[mine], force[mine]):
                levels = np.linspace(np.nanmin(values), np.nanmax(values), 13)
                axes.tricontourf(
                    Triangulation(velocity[mine], force[mine]), values[mine], levels, cmap=DESIGN_MAP, alpha=0.6
                )
    dots = axes.scatter(velocity[known], force[known], c=values[known], cmap=DESIGN_MAP, edgecolor=BLACK, linewidth=0.5)
    axes.plot(velocity[~known], force[~known], "x", color=GREY, markersize=5)
    axes.axhline(0, color=GREY, linewidth=0.7)
    axes.axvline(0, color=GREY, linewidth=0.7)
    axes.set(xlabel="velocity / (m/s)", ylabel="force / N")
    axes.set_xlim(*_AROUND * np.max(np.abs(velocity)) * np.array([-1, 1]))
    axes.set_ylim(*_AROUND * np.max(np.abs(force)) * np.array([-1, 1]))
    figure.colorbar(dots, ax=axes, pad=0.02).set_label(label)


def _spans_an_area(x: np.ndarray, y: np.ndarray) -> bool:
    return len(x) > 2 and np.linalg.matrix_rank(np.column_stack([x - x.mean(), y - y.mean()]), 1e-6) == 2


@styled
def impedance_points(points: Sequence[ImpedancePoint]) -> Figure:
    """Size and phase of the impedance over frequency, a colour a shunt, with two standard deviations."""
    figure, (size, phase) = _size_and_phase()
    for shunt, look in series_style(point.shunt for point in points).items():
        _draw_points(size, phase, points, shunt, look)
    figure.legend(*size.get_legend_handles_labels(), loc="outside lower center", ncols=5, frameon=False)
    return figure


@styled
def lumped_model(points: Sequence[ImpedancePoint], device: LumpedActuator) -> Figure:
    """The impedance of the points (marks) beside that of a lumped model (lines), strokes in between interpolated."""
    figure, (size, phase) = _size_and_phase()
    for shunt, look in series_style(point.shunt for point in points).items():
        mine = _draw_points(size, phase, points, shunt, {**look, "linestyle": "none"})
        frequency = np.geomspace(mine[0].frequency, mine[-1].frequency, _CURVE)
        stroke = np.interp(frequency, [p.frequency for p in mine], [p.amplitude for p in mine])
        z = device.impedance(frequency, min(shunt, OPEN_CIRCUIT), 2 * np.pi * frequency * stroke)
        size.plot(frequency, np.abs(z), color=look["color"])
        phase.plot(frequency, np.angle(z, deg=True), color=look["color"])
    figure.legend(*size.get_legend_handles_labels(), loc="outside lower center", ncols=5, frameon=False)
    return figure


def _size_and_phase() -> tuple[Figure, tuple[Axes, Axes]]:
    figure = new_figure(5.6)
    size, phase = figure.subplots(2, 1, sharex=True)
    size.set(xscale="log", yscale="log", ylabel="force over velocity / (Ns/m)")
    phase.set(xscale="log", xlabel="frequency / Hz", ylabel="phase / °", yticks=(-90, -45, 0, 45, 90))
    letter([size, phase])
    show_grid(size, phase)
    return figure, (size, phase)


def _draw_points(
    size: Axes, phase: Axes, points: Sequence[ImpedancePoint], shunt: float, look: Look
) -> list[ImpedancePoint]:
    """Draws the points of a shunt; returns them in the order of frequency."""
    mine = sorted((p for p in points if p.shunt == shunt), key=lambda p: p.frequency)
    frequency, z = np.array([p.frequency for p in mine]), np.array([p.impedance for p in mine])
    error = 2 * np.array([p.error for p in mine])
    size.errorbar(frequency, np.abs(z), error, label=shunt_words(shunt), **look)
    phase.errorbar(frequency, np.angle(z, deg=True), np.degrees(error / np.abs(z)), **look)
    return mine


@styled
def response(found: FrequencyResponse, label: str) -> Figure:
    """H_1 with its 95 % band, H_2, phase and coherence over frequency; label: of the size, with its unit."""
    figure = new_figure(7.0)
    size, phase, coherence = figure.subplots(3, 1, sharex=True, height_ratios=(2, 1.3, 1))
    gain, sure = np.abs(found.h1), found.is_sure
    low, high = np.maximum(gain - found.radius, 1e-3 * gain), gain + found.radius
    size.fill_between(found.frequency, low, high, color=LIGHT_GREY, linewidth=0, label="95 % band")
    size.plot(found.frequency, gain, color=BLUE, label="H₁")
    size.plot(found.frequency, np.abs(found.h2), color=ORANGE, linestyle="--", label="H₂")
    size.set(xscale="log", yscale="log", ylabel=label)
    if sure.any():
        size.set_ylim(0.3 * gain[sure].min(), 3 * gain[sure].max())
        phase.plot(found.frequency[sure], np.degrees(np.unwrap(np.angle(found.h1[sure]))), color=BLUE)
    phase.set(ylabel="phase of H₁ / °")
    coherence.plot(found.frequency, found.coherence, color=BLUE)
    coherence.set(xlabel="frequency / Hz", ylabel="coherence", ylim=(0, 1.05))
    letter([size, phase, coherence])
    show_grid(size, phase, coherence)
    figure.legend(*size.get_legend_handles_labels(), loc="outside lower center", ncols=3, frameon=False)
    return figure


@styled
def levels(found: Sequence[SoundLevels]) -> Figure:
    """A-weighted level over time of every record, and its equivalent level."""
    figure = new_figure(4.0)
    axes = figure.subplots()
    for name, look in series_style(one.record for one in found).items():
        one = next(one for one in found if one.record == name)
        axes.plot(one.time, one.fast, color=look["color"], label=name)
        axes.axhline(one.equivalent, color=look["color"], linestyle=":", linewidth=1.0)
    top = max(one.loudest for one in found)
    axes.set(
        xlabel="time / s",
        ylabel="A-weighted level / dB",
        ylim=(top - 40, top + 3),
    )
    show_grid(axes)
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=3, frameon=False)
    return figure


@styled
def loops(matches: Sequence[LoopMatch]) -> Figure:
    """Measured and identified force over the stroke and, below, over time."""
    shown = matches[:_MOST_LOOPS]
    columns = min(len(shown), 3)
    rows = -(-len(shown) // columns)
    figure = new_figure(0.6 + 5.0 * rows)
    grid = figure.subplots(2 * rows, columns, squeeze=False)
    over_stroke, over_time = grid[::2].ravel(), grid[1::2].ravel()
    for loop, time, match in zip(over_stroke, over_time, shown):
        _match(loop, match.loop.stroke[match.loop.compared] / MILLIMETRE, match)
        _match(time, match.loop.time[match.loop.compared], match)
        loop.set(xlabel="stroke / mm", ylabel="force / N")
        begin, end = match.loop.time[match.loop.compared][[0, -1]]
        time.set(xlabel="time / s", ylabel="force / N", xlim=(end - (end - begin) / 4, end))
        loop.set_title(match.loop.name, loc="left")
    for axes in (*over_stroke[len(shown) :], *over_time[len(shown) :]):
        axes.set_visible(False)
    letter(over_stroke[: len(shown)])
    show_grid(*grid.flat)
    figure.legend(*over_stroke[0].get_legend_handles_labels(), loc="outside lower center", ncols=2, frameon=False)
    return figure


def _match(axes: Axes, over: np.ndarray, match: LoopMatch) -> None:
    axes.plot(over, match.loop.measured, color=SKY, linewidth=4.0, label="measured")
    axes.plot(over, match.answer, color=BLACK, linewidth=0.9, label="identified model")


@styled
def identifiability(found: Identification) -> Figure:
    """Relative 90 % interval of every parameter, and the correlation of their logarithms."""
    figure = new_figure(4.4)
    sizes, correlation = figure.subplots(1, 2, width_ratios=(1, 1.1))
    names = [heading(one.unknown.name).split(" /")[0] for one in found.found]
    half = [100 * (one.interval[1] / one.value - 1) for one in found.found]
    colours = [BLUE if one.is_identified else VERMILION for one in found.found]
    sizes.barh(range(len(names)), half, color=colours)
    sizes.set(xscale="log", xlabel="half of the 90 % interval / %", xlim=(0.5 * min(half), 2 * max(half)))
    sizes.set_yticks(range(len(names)), names)
    sizes.invert_yaxis()
    shown = correlation.imshow(found.correlation, vmin=-1, vmax=1, cmap="RdBu_r")
    correlation.set_xticks(range(len(names)), names, rotation=60, ha="right")
    correlation.set_yticks(range(len(names)), [""] * len(names))
    figure.colorbar(shown, ax=correlation, pad=0.02).set_label("correlation")
    letter([sizes, correlation])
    return figure
