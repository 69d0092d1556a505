"""Electrical losses and efficiency over torque and speed (thesis Fig. 4.5), and what the losses are made of."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from figures.style import BLACK, DESIGN_MAP, FIELD_MAP, GREY, MARKERS, SERIES, letter, new_figure, show_grid, styled
from losses.map import PowerLosses
from units import RPM

_EFFICIENCIES = (0.5, 0.6, 0.7, 0.75, 0.8, 0.84, 0.86, 0.88, 0.9, 0.91, 0.92, 0.93, 0.94, 0.95, 0.96, 0.98, 1.0)
_LOWEST_LEVEL = 0.015  # of the largest loss
_SHOWN_TORQUE = 0.25  # of the largest, for the parts over speed
_CROWDED = 0.08  # of the largest torque, below which the lines of all efficiencies run into each other


@styled
def loss_maps(losses: PowerLosses, title: str) -> Figure:
    """Total electrical loss, efficiency, and the parts of the loss over speed at a quarter of the largest torque.

    losses: torque along the first index, negative where the machine brakes, speed along the second; NaN out of reach,
        left white behind the black line of the largest torque
    """
    figure = new_figure(7.6)
    layout = figure.subplot_mosaic([["total", "efficiency"], ["parts", "parts"]])
    axes = [layout[name] for name in ("total", "efficiency", "parts")]
    total = losses.total
    _map(figure, axes[0], losses, total, _levels(total), FIELD_MAP, "electrical loss / W", total)
    axes[0].set_title(_counted(losses), loc="left")
    best = float(np.nanmax(losses.efficiency))
    top = next(level for level in _EFFICIENCIES if level >= best)
    levels = [level for level in _EFFICIENCIES if level <= top]
    _map(
        figure, axes[1], losses, losses.efficiency, levels, DESIGN_MAP, "efficiency without friction", _apart(losses)
    )
    axes[1].set_title("power out over power in", loc="left")
    _parts(axes[2], losses)
    letter(axes)
    figure.suptitle(title)
    return figure


def _counted(losses: PowerLosses) -> str:
    """What is lost, in words."""
    return "copper, iron and magnets together" if np.nanmax(losses.magnet) > 0 else "copper and iron together"


def _apart(losses: PowerLosses) -> np.ndarray:
    """Efficiency where its lines can be told apart, NaN near no torque."""
    crowded = np.abs(losses.torque) < _CROWDED * np.abs(losses.torque).max()
    return np.where(crowded, np.nan, losses.efficiency)


def _levels(values: np.ndarray) -> list[float]:
    """Round levels 1, 1.5, 2, 3, 5, 7 per decade: losses span decades between no load and the corner."""
    top = float(np.nanmax(values))
    rising = [step * 10.0**decade for decade in range(-6, 9) for step in (1.0, 1.5, 2.0, 3.0, 5.0, 7.0)]
    beyond = next(level for level in rising if level >= top)
    return [level for level in rising if _LOWEST_LEVEL * top <= level <= beyond]


def _map(
    figure: Figure, axes: Axes, losses: PowerLosses, values: np.ndarray, levels: Sequence[float], colours: str,
    label: str, lined: np.ndarray,
) -> None:  # fmt: skip
    """Values in colours, with lines of ``lined``, the same values or NaN where no line is to run."""
    speed_rpm, torque = losses.speed[0] / RPM, losses.torque[:, 0]
    filled = axes.contourf(speed_rpm, torque, values, levels=levels, cmap=colours, extend="min")
    lines = axes.contour(speed_rpm, torque, lined, levels=levels[:-1:2], colors="white", linewidths=0.6)
    axes.clabel(lines, fontsize=8, fmt=_written)
    reached = np.isfinite(losses.total)
    axes.plot(speed_rpm, _outermost(torque, reached), color=BLACK, label="largest torque")
    if torque[0] < 0:
        axes.plot(speed_rpm, _outermost(torque[::-1], reached[::-1]), color=BLACK)
        axes.axhline(0.0, color=GREY, linewidth=0.7)
    axes.set(xlabel="rotor speed / rpm", ylabel="torque / Nm")
    bar = figure.colorbar(filled, ax=axes, pad=0.02, ticks=levels[::2], format=lambda value, _: _written(value))
    bar.set_label(label)


def _outermost(torque: np.ndarray, reached: np.ndarray) -> np.ndarray:
    """The last torque (speeds,) that is reached at each speed, NaN where none is."""
    last = len(reached) - 1 - reached[::-1].argmax(axis=0)
    return np.where(reached.any(axis=0), torque[last], np.nan)


def _parts(axes: Axes, losses: PowerLosses) -> None:
    torque = losses.torque[:, 0]
    row = int(np.abs(torque - _SHOWN_TORQUE * torque[-1]).argmin())
    parts = {
        "copper": losses.copper,
        "stator iron": losses.stator_iron,
        "rotor iron": losses.rotor_iron,
        "magnets": losses.magnet,
        "round the delta": losses.circulating,
    }
    shown = {label: values for label, values in parts.items() if np.nanmax(values[row]) > 0}
    for number, (label, values) in enumerate(shown.items()):
        look: dict[str, Any] = {"color": SERIES[number], "marker": MARKERS[number], "markevery": 8, "markersize": 5}
        axes.plot(losses.speed[row] / RPM, np.where(values[row] > 0, values[row], np.nan), label=label, **look)
    axes.set_title(f"parts of the loss at {torque[row]:.3g} Nm", loc="left")
    axes.set(xlabel="rotor speed / rpm", ylabel="loss / W", xlim=(0, None), yscale="log")
    axes.set_ylim(bottom=1e-4 * float(np.nanmax(losses.total[row])))
    show_grid(axes)
    axes.legend(ncols=2)


def _written(value: float) -> str:
    """Three digits, a thousand without an exponent."""
    return f"{value:.0f}" if abs(value) >= 100 else f"{value:.3g}"
