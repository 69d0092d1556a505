"""The vehicle on its road: histories, working points, obstacles, requirements (thesis Figs 3.9-3.12, 3.28).

Of what they are given the functions read attributes only.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from figures.style import BLACK, GREY, LIGHT_GREY, MARKERS, SERIES, letter, new_figure, show_grid, styled
from units import MILLIMETRE
from vehicle.ride import RideHistory
from vehicle.traces import Trace

_KILONEWTON = 1e3
_MOST_POINTS = 6000  # of a history that are drawn
_FLAT = 1e-9  # m, a road lower than this is not drawn


@styled
def time_histories(histories: Mapping[str, Trace | RideHistory], *, span: tuple[float, float] | None = None) -> Figure:
    """Road, stroke, actuator force and velocity, and load of the actuated tyre over time.

    histories: ``RideHistory`` by label, of one scenario; span: first and last time shown [s], all of it when None
    """
    panels: tuple[tuple[str, Callable[[Trace | RideHistory], np.ndarray]], ...] = (
        ("road / mm", lambda h: h.road.T / MILLIMETRE),
        ("stroke / mm", lambda h: h.stroke / MILLIMETRE),
        ("force / N", lambda h: h.actuator_force),
        ("velocity / (m/s)", lambda h: h.velocity),
        ("tyre load / kN", lambda h: h.tyre_loads[-1] / _KILONEWTON),
    )
    any_history = next(iter(histories.values()))
    span = span or (0.0, any_history.time[-1])
    shown_panels = panels[1:] if np.abs(any_history.road).max() < _FLAT else panels
    figure = new_figure(1.7 * len(shown_panels))
    axes = figure.subplots(len(shown_panels), 1, sharex=True)
    for axis, (label, values) in zip(axes, shown_panels, strict=True):
        axis.set(ylabel=label)
        if label.startswith("road"):
            _draw_road(axis, any_history, span)
        else:
            for number, (name, history) in enumerate(histories.items()):
                shown = _shown(history.time, span)
                axis.plot(history.time[shown], values(history)[shown], color=SERIES[number], label=name, linewidth=1.1)
    axes[-1].set(xlabel="time / s", xlim=span)
    show_grid(*axes)
    figure.align_ylabels(axes)
    handles, names = axes[-1].get_legend_handles_labels()
    figure.legend(handles, names, loc="outside lower center", ncols=4, frameon=False)
    return figure


def _draw_road(axis: Axes, history: Trace | RideHistory, span: tuple[float, float]) -> None:
    names = ("under the wheel",) if len(history.road) == 1 else ("under the front wheel", "under the rear wheel")
    shown = _shown(history.time, span)
    for heights, name, look in zip(history.road, names, ("-", "--")[: len(names)], strict=True):
        axis.plot(history.time[shown], heights[shown] / MILLIMETRE, look, color=GREY, linewidth=1.1, label=name)
    axis.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=2, frameon=False, borderaxespad=0.1)


def _shown(time: np.ndarray, span: tuple[float, float]) -> slice:
    first, last = np.searchsorted(time, span)
    return slice(first, last + 1, max(1, (last - first) // _MOST_POINTS))


def _thinned(time: np.ndarray) -> slice:
    return slice(None, None, max(1, len(time) // _MOST_POINTS))


@styled
def force_velocity_cloud(
    histories: Mapping[str, Trace | RideHistory],
    *,
    limit: Callable[[np.ndarray], np.ndarray] | None = None,
    required: Sequence[tuple[str, float, float]] = (),
) -> Figure:
    """Working points of the actuator in the force-velocity plane.

    histories: ``RideHistory`` by label; limit: largest force [N] over speed [m/s], drawn in all quadrants, or None;
    required: name, force [N] and velocity [m/s] of points to mark
    """
    figure = new_figure(4.8)
    axis = figure.subplots()
    for number, (name, history) in enumerate(histories.items()):
        thin = _thinned(history.time)
        width = 2.4 if number == 0 else 0.9  # the first is seen beside those that cover it
        look: dict[str, Any] = {"color": SERIES[number], "linewidth": width, "marker": ".", "markersize": 2 + width}
        axis.plot(history.velocity[thin], history.actuator_force[thin] / _KILONEWTON, label=name, **look)
    if limit is not None:
        _draw_limit(axis, limit, max(np.abs(history.velocity).max() for history in histories.values()))
    for number, (name, force, velocity) in enumerate(required):
        hollow: dict[str, Any] = {"markerfacecolor": "none", "markeredgecolor": BLACK, "markersize": 10}
        axis.plot(velocity, force / _KILONEWTON, marker=MARKERS[number], label=name, zorder=5, linestyle="", **hollow)
    axis.axhline(0, color=LIGHT_GREY, linewidth=0.8)
    axis.axvline(0, color=LIGHT_GREY, linewidth=0.8)
    axis.set(xlabel="actuator velocity / (m/s), rebound positive", ylabel="actuator force / kN")
    show_grid(axis)
    figure.legend(loc="outside lower center", ncols=4, frameon=False, markerscale=1.2)
    return figure


def _draw_limit(axis: Axes, limit: Callable[[np.ndarray], np.ndarray], fastest: float) -> None:
    speed = np.linspace(0, max(fastest, 1e-3), 400)
    force = limit(speed) / _KILONEWTON
    for number, (sign_v, sign_f) in enumerate(((1, 1), (1, -1), (-1, 1), (-1, -1))):
        label = None if number else "limit of the actuator"
        axis.plot(sign_v * speed, sign_f * force, "--", color=GREY, linewidth=1.2, label=label)


@styled
def obstacle_peaks(speeds: Sequence[float], peaks: Mapping[float, Sequence[tuple[float, float]]]) -> Figure:
    """Peak actuator force and the velocity at it over the speed, one line an amplitude (thesis Fig. 3.10).

    speeds [m/s], (n,); peaks: by amplitude [m], bumps positive: force [N] and velocity [m/s] for each speed, (n, 2)
    """
    figure = new_figure(4.2)
    axes = figure.subplots(1, 2)
    kmh = 3.6 * np.asarray(speeds)
    for number, (amplitude, points) in enumerate(sorted(peaks.items())):
        force, velocity = np.transpose(points)
        look = {"color": SERIES[number % len(SERIES)], "marker": MARKERS[number % len(MARKERS)], "markersize": 4}
        look["linestyle"] = "-" if amplitude > 0 else "--"
        name = f"{'bump' if amplitude > 0 else 'pothole'} {abs(amplitude) / MILLIMETRE:.4g} mm"
        axes[0].plot(kmh, force / _KILONEWTON, label=name, **look)
        axes[1].plot(kmh, velocity, **look)
    for axis, label in zip(axes, ("peak force / kN", "velocity at the peak force / (m/s)"), strict=True):
        axis.set(xlabel="speed / (km/h)", ylabel=label)
        axis.set_title(label.split(" /")[0], loc="left")
    letter(axes)
    show_grid(*axes)
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=4, frameon=False)
    return figure


@styled
def requirement_bars(rows: Sequence[tuple[str, float, float | None, str]], *, reference: str = "thesis") -> Figure:
    """Requirements as bars, each scaled by its reference value, with the number and the scenario that set it.

    rows: label with its unit, value, reference value or None, scenario; magnitudes count
    reference: who gives the reference values
    """
    figure = new_figure(0.8 + 0.48 * len(rows))
    axis = figure.subplots()
    places = np.arange(len(rows))[::-1]
    shares = [abs(value / given) if given else 1.0 for _, value, given, _ in rows]
    axis.barh(places, shares, height=0.62, color=SERIES[0], label="here")
    if any(given is not None for _, _, given, _ in rows):
        axis.axvline(1.0, color=BLACK, linewidth=1.2, label=reference)
    for place, share, (_, value, given, scenario) in zip(places, shares, rows, strict=True):
        beside = f" ({_number(given)})" if given is not None else ""
        axis.text(max(share, 1.0) + 0.03, place, f"{_number(value)}{beside}   {scenario}", va="center", fontsize=9)
    axis.set_yticks(places, [label for label, *_ in rows])
    axis.set_xticks([0, 0.5, 1.0])
    axis.set(xlim=(0, 2.6 * max(1.0, *shares)), xlabel=f"value over the one of the {reference} (dimensionless)")
    axis.spines["left"].set_visible(False)
    axis.tick_params(axis="y", length=0)
    figure.legend(loc="outside lower center", ncols=2, frameon=False)
    return figure


def _number(value: float) -> str:
    """Three digits or all those before the point, with a proper minus."""
    text = f"{value:.0f}" if abs(value) >= 1000 else f"{value:.3g}"
    return text.replace("-", "\N{MINUS SIGN}")
