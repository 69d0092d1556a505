"""Optima over the stator radius and the polynomials through them (thesis Fig. 3.23)."""

from __future__ import annotations

from typing import Protocol

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from figures.style import Look, combinations, letter, new_figure, series_style, show_grid, styled

QUANTITIES = (
    ("torque_nominal_Nm_per_m", "nominal torque per length", "Nm/m"),
    ("torque_overload_Nm_per_m", "overload torque per length, field solution", "Nm/m"),
    ("torque_overload_linear_Nm_per_m", "overload torque per length, scaled linearly", "Nm/m"),
    ("back_iron_width_mm", "back-iron width", "mm"),
    ("rotor_outer_radius_mm", "rotor outer radius", "mm"),
    ("half_slot_area_mm2", "half-slot area", "mm²"),
)
_ROOM_FOR_TEXT = 0.16  # of the height, for each line on the quality of a fit


@styled
def fits(optima: pd.DataFrame, polynomials: pd.DataFrame, further: tuple[tuple[str, str, str], ...] = ()) -> Figure:
    """Each quantity at the optimum over the stator outer radius, with its fit, R^2 and residual, for every
    slot-pole combination.

    optima: columns slots, poles, stator_diameter_mm and the names of ``QUANTITIES``; one reading and limit
    polynomials: columns slots, poles, quantity, p2, p1, p0, r_squared, rms_residual, refused; p2 R^2 + p1 R + p0 with
        the stator outer radius R in mm. ``refused`` holds the reason, or nothing (empty, False, NaN) when the fit holds
    further: (column, title, unit) of quantities beside ``QUANTITIES``
    """
    panels = (*QUANTITIES, *further)
    rows = -(-len(panels) // 2)
    figure = new_figure(3.0 * rows)
    axes = figure.subplots(rows, 2, sharex=True).ravel()
    for axis in axes[len(panels) :]:
        axis.axis("off")
    axes = axes[: len(panels)]
    optima, polynomials = (table.assign(combination=combinations(table)) for table in (optima, polynomials))
    style = series_style(optima.combination)
    for axis, (quantity, title, unit) in zip(axes, panels, strict=True):
        _panel(axis, optima, polynomials[polynomials.quantity == quantity], quantity, unit, style)
        axis.set_title(title, loc="left")
        axis.set_ylabel(f"{_noun(title)} / {f'({unit})' if '/' in unit else unit}")
    for axis in axes[-2:]:
        axis.tick_params(labelbottom=True)
        axis.set_xlabel("stator outer radius / mm")
    letter(axes)
    show_grid(*axes)
    handles = axes[0].get_legend_handles_labels()
    figure.legend(*handles, loc="outside lower center", ncols=min(2 * len(style), 4), frameon=False)
    return figure


class Fit(Protocol):
    """A row of the table of polynomials."""

    p2: float
    p1: float
    p0: float
    r_squared: float
    rms_residual: float
    refused: object


def is_refused(refused: object) -> bool:
    """Whether a fit was refused: a reason or True; empty, False, None and NaN mean that it holds."""
    return not (refused is None or refused is False or refused != refused or str(refused).strip() in ("", "False"))


def _panel(
    axes: Axes, optima: pd.DataFrame, polynomials: pd.DataFrame, quantity: str, unit: str, style: dict[str, Look]
) -> None:
    lines = []
    for combination, look in style.items():
        rows = optima[optima.combination == combination].sort_values("stator_diameter_mm")
        radius = rows.stator_diameter_mm.to_numpy() / 2
        axes.plot(radius, rows[quantity], linestyle="", markersize=5, label=f"{combination}, optima", **look)
        for fit in polynomials[polynomials.combination == combination].itertuples():
            _draw_fit(axes, fit, radius, combination, look)
            lines.append(_quality(fit, combination, unit))
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + _ROOM_FOR_TEXT * len(lines) * (high - low))
    axes.text(0.02, 0.97, "\n".join(lines), transform=axes.transAxes, va="top", fontsize=8.5)


def _draw_fit(axes: Axes, fit: Fit, radius: np.ndarray, combination: str, look: Look) -> None:
    fine = np.linspace(radius.min(), radius.max(), 100)
    refused = is_refused(fit.refused)
    label = f"{combination}, fit" + (" (refused)" if refused else "")
    value = np.polyval([fit.p2, fit.p1, fit.p0], fine)
    axes.plot(fine, value, color=look["color"], linestyle=":" if refused else "-", label=label)


def _quality(fit: Fit, combination: str, unit: str) -> str:
    verdict = ", refused" if is_refused(fit.refused) else ""
    return f"{combination}: $R^2$ = {fit.r_squared:.5f}, rms residual {fit.rms_residual:.3g} {unit}{verdict}"


def _noun(title: str) -> str:
    return title.split(",")[0].replace("nominal ", "").replace("overload ", "")
