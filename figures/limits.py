"""What the flux-density limit costs: the optimum against the limit for each way to read it."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from figures.style import GREY, MARKERS, SERIES, Look, letter, new_figure, show_grid, styled

_PANELS = (
    ("torque_nominal_Nm_per_m", "torque per length", "torque per length / (Nm/m)"),
    ("back_iron_width_mm", "back-iron width", "back-iron width / mm"),
    ("rotor_outer_radius_mm", "rotor outer radius", "rotor outer radius / mm"),
)


@styled
def limits(table: pd.DataFrame, *, chosen_reading: str | None = None, chosen_limit_T: float | None = None) -> Figure:
    """Torque, back iron and rotor of the optimum over the flux-density limit, one line for each reading.

    table: columns reading, limit_T, torque_nominal_Nm_per_m, back_iron_width_mm, rotor_outer_radius_mm; NaN where no
        machine keeps the limit, drawn as a cross at the lower edge
    chosen_reading, chosen_limit_T: the study's own choice, ringed
    """
    figure = new_figure(4.6)
    axes = figure.subplots(1, 3)
    for axis, (column, title, label) in zip(axes, _PANELS, strict=True):
        for number, (_, rows) in enumerate(table.groupby("reading", sort=False)):
            _draw_reading(axis, rows, column, number)
        _draw_infeasible(axis, table, column)
        _ring(axis, table, column, chosen_reading, chosen_limit_T)
        axis.set(xlabel="flux-density limit / T", ylabel=label)
        axis.set_title(title, loc="left")
        axis.margins(y=0.12)
    letter(axes)
    show_grid(*axes)
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=2, frameon=False)
    return figure


def _draw_reading(axes: Axes, rows: pd.DataFrame, column: str, number: int) -> None:
    rows = rows.sort_values("limit_T")
    look: Look = {"color": SERIES[number % len(SERIES)], "marker": MARKERS[number % len(MARKERS)], "markersize": 5}
    axes.plot(rows.limit_T, rows[column], label=_in_words(rows), **look)


def _draw_infeasible(axes: Axes, table: pd.DataFrame, column: str) -> None:
    """Crosses on the lower edge, one row for each reading that some limits leave without a machine."""
    row = 0
    for number, (_, rows) in enumerate(table.groupby("reading", sort=False)):
        none = rows.limit_T[~np.isfinite(rows[column])]
        if len(none):
            look: Look = {"color": SERIES[number % len(SERIES)], "marker": "x", "markeredgewidth": 2, "linestyle": ""}
            label = f"{_in_words(rows)}: no machine keeps the limit"
            height = np.full(len(none), 0.04 * row)
            axes.plot(none, height, transform=axes.get_xaxis_transform(), clip_on=False, label=label, **look)
            row += 1


def _in_words(rows: pd.DataFrame) -> str:
    return rows.reading.iloc[0].replace("_", " ")


def _ring(axes: Axes, table: pd.DataFrame, column: str, reading: str | None, limit: float | None) -> None:
    if reading is None or limit is None:
        return
    rows = table[(table.reading == reading) & np.isclose(table.limit_T, limit)]
    look: Look = {"marker": "o", "markersize": 14, "markerfacecolor": "none", "linestyle": ""}
    look |= {"markeredgecolor": GREY, "markeredgewidth": 1.6}
    axes.plot(rows.limit_T, rows[column], label="choice of the study", **look)
