"""Torque and probes over one electrical period of the rotor (thesis Fig. 3.19)."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from figures.style import (
    BLACK,
    BLUE,
    GREY,
    ORANGE,
    SERIES,
    VERMILION,
    Look,
    degrees,
    letter,
    new_figure,
    show_grid,
    styled,
)

TORQUES: tuple[tuple[str, str, Look], ...] = (
    ("torque_arkkio_Nm_per_m", "ring average (Arkkio)", {"color": BLUE, "linestyle": "-"}),
    ("torque_maxwell_Nm_per_m", "Maxwell stress at mid gap", {"color": ORANGE, "linestyle": "--"}),
)
NO_CURRENT = "torque_no_current_Nm_per_m"
_HEADROOM = 0.35  # of the height, above the curves for the legend


@styled
def rotation(
    table: pd.DataFrame,
    *,
    null_angle_deg: float | None = None,
    q_axis_angle_deg: float | None = None,
    current: str = "nominal",
) -> Figure:
    """Torque per length by both routes, without current where magnets make one, and the probes in teeth, back iron and
    narrow rotor iron.

    table: columns ``angle_mech_deg``, ``torque_arkkio_Nm_per_m``, ``torque_maxwell_Nm_per_m``,
        ``torque_no_current_Nm_per_m``, ``tooth_<k>_T``, ``back_iron_<k>_T``,
        those of the rotor ``<name>_<k>_T``
    null_angle_deg: rotor angle at which a magnet stands on a tooth; q_axis_angle_deg: angle of the marked field
    current: which one, in a word
    """
    table = table.sort_values("angle_mech_deg")
    cogging, probes = bool(table[NO_CURRENT].any()), probe_groups(table)
    panels = (1.5, *((1.0,) if cogging else ()), *(1.2 for _ in probes))
    figure = new_figure(9.6 / 4.9 * sum(panels))
    axes = figure.subplots(len(panels), 1, sharex=True, height_ratios=panels)
    _draw_torque(axes[0], table, current)
    if cogging:
        _draw_no_current(axes[1], table)
    for axis, (where, columns) in zip(axes[-len(probes) :], probes.items(), strict=True):
        _draw_probes(axis, table, columns, where)
    for axis in axes:
        _mark_angles(axis, null_angle_deg, q_axis_angle_deg)
        axis.margins(x=0.01)
    axes[0].legend(loc="upper left", ncols=2)
    axes[-1].set_xlabel("mechanical rotor angle / °")
    letter(axes)
    show_grid(*axes)
    return figure


def probe_groups(table: pd.DataFrame) -> dict[str, dict[str, str]]:
    """Columns of the probes by their names, of each part of the iron that has any."""
    rotor = {name[:-2].replace("_", " "): name for name in rotor_probe_columns(table)}
    stator = {"teeth": _numbered(table, "tooth_"), "back iron": _numbered(table, "back_iron_")}
    return stator | ({"narrow iron of the rotor": rotor} if rotor else {})


def probe_columns(table: pd.DataFrame, prefix: str) -> list[str]:
    """Columns ``<prefix><k>_T`` by rising number k."""
    found = [name for name in table.columns if name.startswith(prefix) and name[len(prefix) : -2].isdigit()]
    return sorted(found, key=lambda name: int(name[len(prefix) : -2]))


def rotor_probe_columns(table: pd.DataFrame) -> list[str]:
    """Columns of flux densities that are neither of teeth nor of the back iron, in their order."""
    stator = {*probe_columns(table, "tooth_"), *probe_columns(table, "back_iron_")}
    return [name for name in table.columns if name.endswith("_T") and name not in stator]


def _numbered(table: pd.DataFrame, prefix: str) -> dict[str, str]:
    """Columns of the probes that begin so, by their number."""
    return {column[len(prefix) : -2]: column for column in probe_columns(table, prefix)}


def mean_over_period(angle: np.ndarray, values: np.ndarray) -> float:
    """Mean of a periodic quantity; a last sample that repeats the first one counts once."""
    span = angle - angle[0]
    repeats = len(values) > 2 and np.isclose(values[0], values[-1], rtol=1e-4) and _is_even(span)
    return float(np.mean(values[:-1] if repeats else values))


def _is_even(span: np.ndarray) -> bool:
    return bool(np.allclose(np.diff(span), span[1], rtol=1e-6))


def _draw_torque(axes: Axes, table: pd.DataFrame, current: str) -> None:
    for column, name, look in TORQUES:
        if column not in table:
            continue
        mean = mean_over_period(table.angle_mech_deg.to_numpy(), table[column].to_numpy())
        axes.plot(table.angle_mech_deg, table[column], label=f"{name}, mean {mean:#.5g} Nm/m", **look)
        axes.axhline(mean, linewidth=0.9, **{**look, "linestyle": ":"})
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + _HEADROOM * (high - low))
    axes.set_ylabel("torque per length\n/ (Nm/m)")
    axes.set_title(f"torque per length at the {current} current", loc="left")


def _draw_no_current(axes: Axes, table: pd.DataFrame) -> None:
    axes.axhline(0.0, color=GREY, linewidth=0.8)
    axes.plot(table.angle_mech_deg, table[NO_CURRENT], color=BLACK)
    axes.set_ylabel("torque per length\n/ (Nm/m)")
    axes.set_title("torque per length without current (cogging)", loc="left")


def _draw_probes(axes: Axes, table: pd.DataFrame, probes: Mapping[str, str], where: str) -> None:
    columns = list(probes.values())
    for number, (name, column) in enumerate(probes.items()):
        look: Look = {"color": SERIES[number % len(SERIES)], "linestyle": "-" if number < len(SERIES) else "--"}
        axes.plot(table.angle_mech_deg, table[column], linewidth=1.2, label=name, **look)
    if columns:
        worst = table[columns].to_numpy().max()
        axes.axhline(worst, color=VERMILION, linewidth=0.9, linestyle=":")
        axes.set_title(f"flux density in the {where}, worst {worst:.3f} T", loc="left")
        axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), title="probe", frameon=False, labelspacing=0.25)
    axes.set_ylabel("|B| / T")
    axes.set_ylim(bottom=0.0)


def _mark_angles(axes: Axes, null_angle: float | None, q_axis_angle: float | None) -> None:
    for angle, name, style in ((null_angle, "null angle", "--"), (q_axis_angle, "q-axis angle", "-.")):
        if angle is not None:
            axes.axvline(angle, color=BLACK, linestyle=style, linewidth=1.0, label=f"{name} {degrees(angle)}")
