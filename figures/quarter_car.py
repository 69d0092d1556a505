"""Rides of thesis chapter 4 with an actuator of one's own: vehicle and reactive powers over time, beside the thesis."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from figures.style import BLACK, BLUE, GREY, ORANGE, VERMILION, Look, letter, new_figure, show_grid, styled
from units import GRAVITY, MILLIMETRE
from vehicle.damping import DamperCurve
from vehicle.energy import scatter
from vehicle.energy_stage import QUASI_IDEAL, REAL, EnergyOutcome
from vehicle.printed_energy import PrintedEnergy
from vehicle.quarter_car_stage import QuarterCarRides
from vehicle.ride import Scenario

_KINDS = ((QUASI_IDEAL, BLUE, -0.2), (REAL, ORANGE, 0.2))
Number = Callable[[dict[str, float]], float]
Printed = Callable[[PrintedEnergy], float | None]


@styled
def vehicle_over_time(found: EnergyOutcome) -> Figure:
    """Tyre load, weighted acceleration and reactive power of every command (thesis Figs 4.24 to 4.50)."""
    data = found.traces
    figure = new_figure(0.6 + 1.6 * data.sizes["command"])
    axes = figure.subplots(data.sizes["command"], 3, sharex=True, squeeze=False)
    for row, name in zip(axes, data.command.values, strict=True):
        _vehicle(row, data.sel(command=name))
        row[0].set(ylabel=f"{name}\ntyre load / N")
    for axis in axes[-1]:
        axis.set(xlabel="time / s", xlim=(float(data.time[0]), float(data.time[-1])))
    pairs = [pair for axis in axes[0] for pair in zip(*axis.get_legend_handles_labels(), strict=True)]
    figure.legend(*zip(*pairs, strict=True), loc="outside lower center", ncols=4, frameon=False)
    show_grid(*axes.flat)
    figure.align_ylabels(axes)
    return figure


def _vehicle(row: Sequence[Axes], one: xr.Dataset) -> None:
    for kind, colour, _ in _KINDS:
        look: Look = {"color": colour, "linewidth": 1.0, "linestyle": "-" if kind == QUASI_IDEAL else "--"}
        row[0].plot(one.time, one.tyre_load.sel(actuator=kind), label=kind, **look)
        row[1].plot(one.time, one.felt.sel(actuator=kind) / GRAVITY, **look)
    _lent(row[2], one.sel(actuator=REAL))
    row[1].set(ylabel="felt / g")
    row[2].set(ylabel="reactive / W")


@styled
def lent_powers(found: EnergyOutcome) -> Figure:
    """Power that spring of the mount and equivalent mass take and give back, one panel a command (thesis Fig. 4.39)."""
    data = found.traces.sel(actuator=REAL)
    figure = new_figure(3.2)
    axes = figure.subplots(1, data.sizes["command"], sharey=True, squeeze=False)[0]
    for axis, name in zip(axes, data.command.values, strict=True):
        _lent(axis, data.sel(command=name))
        axis.set(xlabel="time / s", xlim=(float(data.time[0]), float(data.time[-1])))
        axis.set_title(str(name), loc="left")
    axes[0].set(ylabel="reactive / W")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=2, frameon=False)
    show_grid(*axes)
    return figure


def _lent(axis: Axes, one: xr.Dataset) -> None:
    for name, colour, words in (("inertial", VERMILION, "equivalent mass"), ("elastic", BLACK, "spring of the mount")):
        axis.plot(one.time, one[name], color=colour, linewidth=0.8, label=words)


@styled
def car_inputs(dampers: Sequence[DamperCurve], road: Scenario) -> Figure:
    """Damper curves and the height of the road over time (thesis Figs 4.21 and 4.22)."""
    figure = new_figure(3.2)
    left, right = figure.subplots(1, 2)
    for curve, colour in zip(dampers, (BLUE, ORANGE), strict=True):
        velocity = np.linspace(-_SHOWN_VELOCITY, _SHOWN_VELOCITY, 3)
        left.plot(velocity, np.interp(velocity, curve.velocity, curve.force), color=colour, label=curve.name)
    time = np.arange(0.0, road.duration, road.time_step)
    right.plot(time, road.road.heights(time, road.speed) / MILLIMETRE, color=BLUE, linewidth=1.0)
    left.set(xlabel="velocity / (m/s)", ylabel="force / N")
    right.set(xlabel="time / s", ylabel="height of the road / mm", xlim=(0.0, road.duration))
    left.legend(frameon=False)
    letter((left, right))
    show_grid(left, right)
    return figure


_SHOWN_VELOCITY = 0.3  # m/s, beyond what the rides reach


@styled
def comfort_setting(found: QuarterCarRides) -> Figure:
    """The comfort setting of the LQR in the non-linear car, where the wheel may lift (thesis Fig. 4.28)."""
    figure = new_figure(3.2)
    axes = figure.subplots(1, 3)
    time = found.comfort.time
    axes[0].plot(time, found.comfort.felt / GRAVITY, color=BLUE, linewidth=1.0)
    axes[1].plot(time, found.comfort.tyre_load, color=BLUE, linewidth=1.0)
    axes[2].plot(time, found.comfort.force, color=BLUE, linewidth=1.0)
    for axis, words in zip(axes, ("felt / g", "tyre load / N", "force / N"), strict=True):
        axis.set(xlabel="time / s", ylabel=words)
    letter(axes)
    show_grid(*axes)
    return figure


@styled
def beside_the_thesis(found: EnergyOutcome, printed: Sequence[PrintedEnergy]) -> Figure:
    """Comfort, road holding and energy of both actuators, the printed values as marks (thesis Figs 4.54, 4.55)."""
    figure = new_figure(6.4)
    axes = figure.subplots(2, 3).flatten()
    panels: tuple[tuple[str, Number, Printed], ...] = (
        ("comfort / g", lambda one: one["comfort"] / GRAVITY, lambda one: one.comfort / GRAVITY),
        ("road holding", lambda one: one["road_holding"], lambda one: one.road_holding),
        ("from suspension / W", lambda one: one["shaft.active"], lambda one: one.mechanical),
        ("power factor, suspension", lambda one: one["shaft.factor"], lambda one: one.shaft_power_factor),
        ("to battery / W", lambda one: one["battery.active"], lambda one: one.electrical),
        ("efficiency / %", _efficiency, lambda one: 100 * one.electrical / one.mechanical),
    )
    for axis, (words, number, of_printed) in zip(axes, panels, strict=True):
        _bars(axis, found, printed, number, of_printed)
        axis.set_title(words, loc="left")
    axes[-1].set_ylim(bottom=-100.0)
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3, frameon=False)
    letter(axes)
    show_grid(*axes)
    return figure


def _efficiency(one: dict[str, float]) -> float:
    return 100 * one["battery.active"] / one["shaft.active"]


def _bars(
    axis: Axes, found: EnergyOutcome, printed: Sequence[PrintedEnergy], number: Number, of_printed: Printed
) -> None:
    commands = [str(name) for name in found.traces.command.values]
    for kind, colour, shift in _KINDS:
        cases = {case.command: case for case in found.cases if case.actuator == kind}
        means = [{name: one.mean for name, one in scatter(cases[name].energies).items()} for name in commands]
        places = np.arange(len(commands)) + shift
        axis.bar(places, [number(one) for one in means], width=0.38, color=colour, label=f"{kind}, here")
        stated = {one.command: of_printed(one) for one in printed if one.actuator == kind}
        marks = [(place, stated[name]) for place, name in zip(places, commands, strict=True) if name in stated]
        known = [(place, value) for place, value in marks if value is not None]
        axis.plot(*zip(*known, strict=True), color=BLACK, marker="_", markersize=16, linestyle="") if known else None
    axis.plot([], [], color=BLACK, marker="_", markersize=14, linestyle="", label="thesis, its prototype")
    axis.axhline(0.0, color=GREY, linewidth=0.8)
    axis.set_xticks(range(len(commands)), [name.replace(" ", "\n", 1) for name in commands], fontsize=8)
