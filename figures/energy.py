"""Energy of the ride: powers over time, working points, where the power goes, and the force loop."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from actuator.linear import tangent_plant
from control.transfer import FREQUENCIES
from figures.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    LIGHT_GREY,
    ORANGE,
    SERIES,
    VERMILION,
    letter,
    new_figure,
    show_grid,
    styled,
)
from vehicle.energy import Scatter, scatter
from vehicle.energy_stage import REAL, EnergyOutcome

_SEEN = (1.0, 1e3)  # Hz
_PARTS = (("battery.active", "to the battery", BLUE), ("machine_loss", "lost in machine and drive", VERMILION),
          ("mechanical_loss", "lost in mount, gears, friction", ORANGE))  # fmt: skip


@styled
def powers_over_time(found: EnergyOutcome, actuator: str = REAL) -> Figure:
    """Force, wanted and given, and power of the first road with an actuator, one row a command; actuator: its name."""
    data = found.traces.sel(actuator=actuator)
    figure = new_figure(0.6 + 1.7 * data.sizes["command"])
    axes = figure.subplots(data.sizes["command"], 2, sharex=True, squeeze=False)
    for row, name in zip(axes, data.command.values, strict=True):
        one, time = data.sel(command=name), data.time.values
        row[0].plot(time, one.force, color=BLUE, label="at the suspension", linewidth=1.0)
        row[0].plot(time, one.wanted, color=BLACK, label="wanted", linestyle=":", linewidth=1.0)
        row[1].plot(time, one.shaft, color=ORANGE, label="from the suspension", linewidth=1.0)
        row[1].plot(time, one.electrical, color=BLUE, label="to the battery", linewidth=1.0)
        row[1].plot(time, one.lost, color=VERMILION, label="lost in machine and drive", linewidth=1.0)
        row[0].set(ylabel=f"{name}\nforce / N")
        row[1].set(ylabel="power / W")
    for axis in axes[-1]:
        axis.set(xlabel="time / s", xlim=(time[0], time[-1]))
    _legends(figure, axes[0])
    show_grid(*axes.flat)
    figure.align_ylabels(axes)
    return figure


def _legends(figure: Figure, axes: Iterable[Axes]) -> None:
    pairs = [pair for axis in axes for pair in zip(*axis.get_legend_handles_labels(), strict=True)]
    handles, names = zip(*pairs, strict=True)
    figure.legend(handles, names, loc="outside lower center", ncols=5, frameon=False, markerscale=6)


@styled
def working_points(found: EnergyOutcome, actuator: str = REAL) -> Figure:
    """Force over velocity at the suspension and torque over speed at the rotor, with the torque limit; actuator: its
    name."""
    figure = new_figure(4.6)
    left, right = figure.subplots(1, 2)
    data, limit = found.traces.sel(actuator=actuator), found.own.actuator.drive.limit
    for number, name in enumerate(data.command.values):
        one, look = data.sel(command=name), {"color": SERIES[number], "linestyle": "", "marker": ".", "markersize": 1.5}
        left.plot(one.velocity, one.force, label=name, **look)
        right.plot(one.rotor_speed, one.torque, **look)
    fastest = 1.1 * float(np.abs(data.rotor_speed).max())
    speed = np.linspace(0.0, fastest, 300)
    for turn in (1, -1):
        right.plot(turn * speed, turn * limit.braking_at(speed), color=GREY, linestyle="--", linewidth=1.2)
        right.plot(turn * speed, -turn * limit.driving_at(speed), color=GREY, linestyle="--", linewidth=1.2)
    right.plot([], [], color=GREY, linestyle="--", linewidth=1.2, label="limit of current and voltage")
    left.set(xlabel="velocity of the suspension / (m/s)", ylabel="force at the suspension / N")
    right.set(xlabel="speed of the rotor / (rad/s)", ylabel="torque, positive against rebound / Nm")
    right.set_xlim(-fastest, fastest)
    _legends(figure, (left, right))
    for axis in (left, right):
        axis.axhline(0, color=LIGHT_GREY, linewidth=0.8)
        axis.axvline(0, color=LIGHT_GREY, linewidth=0.8)
    letter((left, right))
    show_grid(left, right)
    return figure


@styled
def where_the_power_goes(found: EnergyOutcome) -> Figure:
    """Mean powers with their scatter over the roads; what swings by itself, by some hundred times more, is left out."""
    cases = [case for case in found.cases if not case.swings]
    figure = new_figure(0.9 + 0.36 * len(cases))
    axis = figure.subplots()
    names = [f"{case.command}, {case.actuator}" for case in cases]
    for place, case in enumerate(cases):
        _bar(axis, place, scatter(case.energies))
    for _, words, colour in _PARTS:
        axis.barh([0], [0], color=colour, label=words)
    axis.plot([], [], color=BLACK, marker="|", markersize=9, linestyle="", label="from the suspension")
    axis.set_yticks(range(len(names)), names)
    axis.invert_yaxis()
    axis.axvline(0, color=BLACK, linewidth=0.8)
    axis.set(xlabel="mean power / W")
    show_grid(axis)
    figure.legend(loc="outside lower center", ncols=4, frameon=False)
    return figure


def _bar(axis: Axes, place: int, values: dict[str, Scatter]) -> None:
    ends = {True: 0.0, False: 0.0}  # of the positive and the negative parts
    for name, _, colour in _PARTS:
        mean = values[name].mean
        axis.barh(place, mean, left=ends[mean >= 0], color=colour, height=0.7)
        ends[mean >= 0] += mean
    axis.plot(values["shaft.active"].mean, place, color=BLACK, marker="|", markersize=14, linestyle="")
    deviation = values["battery.active"].deviation
    axis.errorbar(values["battery.active"].mean, place, xerr=deviation, color=BLACK, capsize=3, linewidth=1.0)


@styled
def temperatures_under_the_ride(found: EnergyOutcome) -> Figure:
    """Copper and magnets over time under the mean losses of the first road, one colour a command."""
    figure = new_figure(3.8)
    axis = figure.subplots()
    for one, colour in zip(found.temperatures, SERIES, strict=False):
        minutes = one.time / 60.0
        axis.plot(minutes, one.copper, color=colour, label=f"{one.command}, copper")
        axis.plot(minutes, one.magnets, color=colour, linestyle="--", label=f"{one.command}, magnets")
    axis.set(xlabel="time / min", ylabel="mean temperature / °C", xlim=(0.0, None))
    show_grid(axis)
    figure.legend(loc="outside lower center", ncols=3, frameon=False)
    return figure


@styled
def force_loop(found: EnergyOutcome) -> Figure:
    """Bode plot of the open force loop about the working forces; the force wanted over that of the suspension."""
    figure = new_figure(4.4)
    left, right = figure.subplots(1, 2)
    frequency = FREQUENCIES[(FREQUENCIES >= _SEEN[0]) & (FREQUENCIES <= _SEEN[1])]
    for point, colour in zip(found.loop, (BLUE, ORANGE, GREEN), strict=True):
        loop = tangent_plant(found.own.actuator, point.force).times(found.own.loop.transfer)
        response, closed = loop.at(frequency), loop.closed.at(frequency)
        left.loglog(frequency, np.abs(response), color=colour, label=f"about {point.force:g} N")
        left.loglog(frequency, np.abs(closed), color=colour, linestyle="--", linewidth=1.0)
        right.semilogx(frequency, np.degrees(np.unwrap(np.angle(response))), color=colour)
    left.plot([], [], color=GREY, linestyle="--", label="closed loop")
    left.axhline(1.0, color=GREY, linewidth=0.8)
    right.axhline(-180.0, color=GREY, linewidth=0.8)
    left.set(xlabel="frequency / Hz", ylabel="gain of the loop", xlim=_SEEN)
    right.set(xlabel="frequency / Hz", ylabel="phase of the open loop / °", xlim=_SEEN)
    figure.legend(*left.get_legend_handles_labels(), loc="outside lower center", ncols=4, frameon=False)
    letter((left, right))
    show_grid(left, right)
    return figure
