"""Electrical losses and efficiency over torque and speed (thesis Fig. 4.5), and what the losses are made of."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from figures.style import BLACK, DESIGN_MAP, FIELD_MAP, MARKERS, SERIES, letter, new_figure, show_grid, styled

_PARTS = (
    ("copper_W", "copper"),
    ("stator_iron_W", "stator iron"),
    ("rotor_iron_W", "rotor iron"),
    ("magnet_W", "magnets"),
)
_EFFICIENCIES = (0.5, 0.6, 0.7, 0.75, 0.8, 0.84, 0.86, 0.88, 0.9, 0.91, 0.92, 0.93, 0.94, 0.95, 0.96, 0.98, 1.0)
_LOWEST_LEVEL = 0.015  # of the largest loss
_SHOWN_TORQUE = 0.25  # of the largest, for the parts over speed


@styled
def loss_maps(data: xr.Dataset, title: str) -> Figure:
    """Total electrical loss, efficiency, and the parts of the loss over speed at a quarter of the largest torque.

    data: dimensions torque_Nm, speed_rpm; copper_W, stator_iron_W, rotor_iron_W, magnet_W, total_W, efficiency; NaN out
        of reach, left white behind the black line of the largest torque
    """
    figure = new_figure(7.6)
    layout = figure.subplot_mosaic([["total", "efficiency"], ["parts", "parts"]])
    axes = [layout[name] for name in ("total", "efficiency", "parts")]
    levels = _levels(data.total_W)
    _map(figure, axes[0], data, data.total_W, levels, FIELD_MAP, "electrical loss / W")
    axes[0].set_title("copper, iron and magnets together", loc="left")
    top = next(level for level in _EFFICIENCIES if level >= float(data.efficiency.max()))
    levels = [level for level in _EFFICIENCIES if level <= top]
    _map(figure, axes[1], data, data.efficiency, levels, DESIGN_MAP, "efficiency without friction")
    axes[1].set_title("efficiency as a motor", loc="left")
    _parts(axes[2], data)
    letter(axes)
    figure.suptitle(title)
    return figure


def _levels(values: xr.DataArray) -> list[float]:
    """Round levels 1, 1.5, 2, 3, 5, 7 per decade: losses span decades between no load and the corner."""
    top = float(values.max())
    rising = [step * 10.0**decade for decade in range(-6, 9) for step in (1.0, 1.5, 2.0, 3.0, 5.0, 7.0)]
    beyond = next(level for level in rising if level >= top)
    return [level for level in rising if _LOWEST_LEVEL * top <= level <= beyond]


def _map(figure, axes, data: xr.Dataset, values: xr.DataArray, levels, colours: str, label: str) -> None:
    speed, torque = data.speed_rpm.to_numpy(), data.torque_Nm.to_numpy()
    shown = values.transpose("torque_Nm", "speed_rpm")
    filled = axes.contourf(speed, torque, shown, levels=levels, cmap=colours, extend="min")
    lines = axes.contour(speed, torque, shown, levels=levels[:-1:2], colors="white", linewidths=0.6)
    axes.clabel(lines, fontsize=8, fmt=lambda value: f"{value:.3g}")
    speeds, limit = _largest_torque(data)
    axes.plot(speeds, limit, color=BLACK, label="largest torque")
    axes.set(xlabel="rotor speed / rpm", ylabel="torque / Nm", ylim=(0, None))
    bar = figure.colorbar(filled, ax=axes, pad=0.02, ticks=levels[::2], format=lambda value, _: f"{value:.3g}")
    bar.set_label(label)


def _largest_torque(data: xr.Dataset) -> tuple[np.ndarray, np.ndarray]:
    """Speeds that can be reached, and the largest torque of the grid there."""
    reached = np.isfinite(data.total_W.transpose("torque_Nm", "speed_rpm").to_numpy())
    some = reached.any(axis=0)
    last = len(reached) - 1 - reached[::-1].argmax(axis=0)
    return data.speed_rpm.to_numpy()[some], data.torque_Nm.to_numpy()[last[some]]


def _parts(axes, data: xr.Dataset) -> None:
    row = data.sel(torque_Nm=_SHOWN_TORQUE * float(data.torque_Nm[-1]), method="nearest")
    for number, (name, label) in enumerate(_PARTS):
        look = {"color": SERIES[number], "marker": MARKERS[number], "markevery": 8, "markersize": 5}
        axes.plot(row.speed_rpm, row[name].where(row[name] > 0), label=label, **look)
    axes.set_title(f"parts of the loss at {float(row.torque_Nm):.3g} Nm", loc="left")
    axes.set(xlabel="rotor speed / rpm", ylabel="loss / W", xlim=(0, None), yscale="log")
    axes.set_ylim(bottom=1e-4 * float(row.total_W.max()))
    show_grid(axes)
    axes.legend(ncols=2)
