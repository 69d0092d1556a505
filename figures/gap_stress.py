"""Radial stress around the air gap over the rotor angle, its largest moving waves, and the torque over the angle."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from figures.style import BLACK, BLUE, DESIGN_MAP, GREY, ORANGE, VERMILION, letter, new_figure, show_grid, styled
from magnetostatics.gap_stress import amplitude_of, moving
from magnetostatics.gap_stress_stage import GapStress
from magnetostatics.rotation import STATES, Rotation
from units import DEGREE, FACTORS

_PLACES = 361  # around the gap
_WAVES = 10
_HEADROOM = 0.15  # of the height, for a legend
_COLOURS = dict(zip(STATES, (BLACK, BLUE, VERMILION), strict=True))
_MPA = FACTORS["MPa"]


@styled
def gap_stress(found: GapStress) -> Figure:
    """Map at the overload current, waves that move in all states, torque with current and without."""
    figure = new_figure(7.6)
    axes = figure.subplots(2, 2, width_ratios=(1.15, 1.0)).ravel()
    _map(figure, axes[0], found.rotation)
    _waves(axes[1], found.rotation)
    _cogging(axes[2], found)
    _ripple(axes[3], found.rotation)
    letter(axes)
    show_grid(*axes[1:])
    return figure


def _map(figure: Figure, axes: Axes, found: Rotation) -> None:
    places = np.linspace(0.0, 2 * np.pi, _PLACES)
    angles = found.data.angle.values
    drawn = axes.pcolormesh(
        places / DEGREE,
        (angles - angles[0]) / DEGREE,
        found.stress_map("overload", places) / _MPA,
        cmap=DESIGN_MAP,
        shading="gouraud",
    )
    axes.set(xlabel="place around the gap / °", ylabel="rotor angle / °", xticks=range(0, 361, 60))
    axes.set_title("radial stress, overload", loc="left")
    figure.colorbar(drawn, ax=axes, pad=0.02).set_label("radial stress / MPa")


def _waves(axes: Axes, found: Rotation) -> None:
    shown = moving(found.waves("overload"))[:_WAVES]
    height = 0.8 / len(STATES)
    for number, state in enumerate(STATES):
        waves = found.waves(state)
        sizes = [amplitude_of(waves, wave) / _MPA for wave in shown]
        places = np.arange(len(shown)) + (number - 1) * height
        axes.barh(places, sizes, height, color=_COLOURS[state], label=state.replace("_", " "))
    orders = [f"{wave.spatial_order}, {wave.temporal_order}".replace("-", "\N{MINUS SIGN}") for wave in shown]
    axes.set_yticks(range(len(shown)), orders)
    axes.invert_yaxis()
    axes.set(xlabel="amplitude / MPa", ylabel="spatial, temporal order")
    axes.set_title("largest moving waves of the stress", loc="left")
    axes.legend(loc="lower right")


def _cogging(axes: Axes, found: GapStress) -> None:
    angles = found.rotation.cogging_angles - found.rotation.null_angle
    usual = found.rotation.torque("no_current")[: len(angles)]
    axes.plot(angles / DEGREE, usual, color=ORANGE, marker="o", label="usual mesh")
    axes.plot(angles / DEGREE, found.cogging_torque, color=BLACK, marker="x", label="triangles of half the size")
    axes.axhline(0.0, color=GREY, linewidth=0.8)
    axes.set(xlabel="rotor angle / °", ylabel="torque per length / (Nm/m)")
    axes.set_title("cogging over its period", loc="left")
    _legend_above(axes)


def _ripple(axes: Axes, found: Rotation) -> None:
    angles = found.data.angle.values
    for state in ("nominal", "overload"):
        relative = found.torque(state) / found.mean_torque_per_length(state)
        axes.plot((angles - angles[0]) / DEGREE, relative, color=_COLOURS[state], label=state)
    axes.axhline(1.0, color=GREY, linewidth=0.8)
    axes.set(xlabel="rotor angle / °", ylabel="torque over its mean")
    axes.set_title("torque ripple", loc="left")
    _legend_above(axes)


def _legend_above(axes: Axes) -> None:
    """In room of its own above the curves."""
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + _HEADROOM * (high - low))
    axes.legend(loc="upper center", ncols=2, columnspacing=1.0)
