"""What a winding makes of the machine: torque and power over speed, voltage and current over force (Fig. 3.27)."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from drivetrain.output import Output, in_unit, labelled
from electrical.dq import DriveLimits, Envelope, OperatingMap
from figures.flux_map import power_unit
from figures.style import BLACK, FIELD_MAP, GREY, SERIES, VERMILION, letter, new_figure, show_grid, styled
from units import FACTORS, RPM

_LINES = ("-", "--", "-.", ":")


@dataclass(frozen=True)
class RequiredPoint:
    """A demand at the rotor shaft: speed [rad/s], torque [Nm] and its name."""

    name: str
    speed: float
    torque: float


@dataclass(frozen=True)
class WheelPoint:
    """A demand at the output: velocity [m/s or rad/s], force [N or Nm] and its name."""

    name: str
    velocity: float
    force: float


@styled
def torque_speed(envelopes: dict[str, Envelope], chosen: str, required: tuple[RequiredPoint, ...] = ()) -> Figure:
    """Largest torque and power over the rotor speed for some windings, with the demands.

    envelopes: by the name of the winding; chosen: one of the names
    """
    figure = new_figure(4.4)
    axes = figure.subplots(1, 2)
    unit = power_unit(envelopes.values())
    for number, (name, envelope) in enumerate(envelopes.items()):
        look: dict[str, Any] = {"color": SERIES[number % len(SERIES)]}
        look["linestyle"] = _LINES[number // len(SERIES) % len(_LINES)]
        look |= {"linewidth": 3.0 if name == chosen else 1.3, "label": name + (" (chosen)" if name == chosen else "")}
        axes[0].plot(envelope.speed / RPM, envelope.torque, **look)
        axes[1].plot(envelope.speed / RPM, envelope.power / FACTORS[unit], **look)
    for point in required:
        _mark(axes, point, unit)
    for axis, (title, label) in zip(axes, (("torque", "torque / Nm"), ("power", f"power / {unit}")), strict=True):
        axis.set(xlabel="rotor speed / rpm", ylabel=label)
        axis.set_title(f"largest {title}", loc="left")
        axis.set_xlim(left=0.0)
        axis.set_ylim(bottom=0.0)
    letter(axes)
    show_grid(*axes)
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=2, frameon=False)
    return figure


_HEADROOM = 1.05  # above the largest force, for the marker there


@styled
def force_velocity(
    operating: OperatingMap,
    transmission_ratio: float,
    *,
    output: Output,
    title: str,
    required: tuple[WheelPoint, ...] = (),
    limits: DriveLimits | None = None,
) -> Figure:
    """Peak phase voltage and current over speed and effort at the output; white where the machine cannot go.

    operating: over torque (first index) and speed, NaN out of reach; transmission_ratio: tau_t [m/rad or 1]
    output: words and units of the axes; limits: written into the titles
    """
    force = operating.torque / transmission_ratio / FACTORS[output.axis_unit]
    velocity = operating.speed * transmission_ratio / FACTORS[output.speed_unit]
    figure = new_figure(4.6)
    axes = figure.subplots(1, 2, sharex=True, sharey=True)
    for axis, values, name, unit, limit in (
        (axes[0], operating.voltage_peak, "phase voltage", "V", getattr(limits, "voltage_peak", None)),
        (axes[1], operating.current_peak, "phase current", "A", getattr(limits, "current_peak", None)),
    ):
        _map(figure, axis, velocity, force, values, f"peak {name} / {unit}")
        _mark_demands(axis, required, output)
        axis.set_title(f"peak {name}" + (f", limit {limit:.3g} {unit}" if limit is not None else ""), loc="left")
        axis.set_xlabel(labelled(f"{output.speed} {output.place}", output.speed_unit))
    highest = max([force.max(), *(in_unit(point.force, output.axis_unit) for point in required)])
    axes[0].set(ylabel=labelled(f"{output.effort} {output.place}", output.axis_unit), ylim=(0, _HEADROOM * highest))
    letter(axes)
    figure.suptitle(f"{title}. {output.overall_ratio(transmission_ratio)}")
    if required:
        figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3, frameon=False)
    return figure


def _mark(axes: Iterable[Axes], point: RequiredPoint, unit: str) -> None:
    look: dict[str, Any] = {"marker": "X", "markersize": 10, "linestyle": "", "color": VERMILION}
    look["markeredgecolor"] = "white"
    for axis, value in zip(axes, (point.torque, point.torque * point.speed / FACTORS[unit]), strict=True):
        axis.plot(point.speed / RPM, value, label=point.name, zorder=5, **look)


def _map(figure: Figure, axes: Axes, velocity: np.ndarray, force: np.ndarray, values: np.ndarray, label: str) -> None:
    colours = axes.contourf(velocity, force, values, levels=12, cmap=FIELD_MAP)
    levels = np.asarray(colours.levels)[1:-1:3]
    lines = axes.contour(velocity, force, values, levels=levels, colors="white", linewidths=0.6)
    axes.clabel(lines, fontsize=8, fmt="%g")
    reached = np.isfinite(values).astype(float)
    if reached.min() < 0.5 < reached.max():
        axes.contour(velocity, force, reached, levels=[0.5], colors=BLACK, linewidths=1.2)
    axes.axhline(0.0, color=GREY, linewidth=0.7)
    axes.axvline(0.0, color=GREY, linewidth=0.7)
    figure.colorbar(colours, ax=axes, pad=0.02).set_label(label)


def _mark_demands(axes: Axes, required: tuple[WheelPoint, ...], output: Output) -> None:
    for number, point in enumerate(required):
        look: dict[str, Any] = {"marker": "Xo^Ds"[number % 5], "markersize": 9, "linestyle": "", "color": VERMILION}
        place = in_unit(point.velocity, output.speed_unit), in_unit(point.force, output.axis_unit)
        axes.plot(*place, markeredgecolor="white", label=point.name, zorder=5, **look)
