"""Gearbox and motor matched: over the transmission ratio (thesis Fig. 3.25) and over the stator radius (Fig. 3.26).

The functions take the results of ``drivetrain.match`` by their attributes and import nothing of it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from drivetrain.output import Output, in_unit, labelled
from figures.style import (
    BLACK,
    GREY,
    LIGHT_GREY,
    SERIES,
    VERMILION,
    combinations,
    letter,
    new_figure,
    series_style,
    show_grid,
    styled,
)
from geometry.family import Combination
from units import MILLIMETRE, written

_TERMS = (("mass_term", "mass"), ("inertia_term", "equivalent inertia"), ("radius_term", "stator radius"))
Look = dict[str, Any]
_OVERLOADS = (("field", "-"), ("linear", "--"))  # where the overload torque comes from, and its line
_MOST_MARKERS = 10  # on one line
_WORST_COST_SHOWN = 1.6  # times the least one; the cost has a pole towards small ratios


class LengthCurve(Protocol):
    """``drivetrain.match.LengthCurve``."""

    @property
    def length(self) -> np.ndarray:
        """[m]"""

    def name(self, output: Output) -> str:
        """Of the constraint."""


class Curves(Protocol):
    """``drivetrain.match.MatchCurves``, arrays over the transmission ratio (n,)."""

    @property
    def ratio(self) -> np.ndarray:
        """[m/rad]"""

    @property
    def lengths(self) -> Sequence[LengthCurve]:
        """Asked for by each constraint."""

    @property
    def active_length(self) -> np.ndarray:
        """[m]"""

    @property
    def feasible(self) -> np.ndarray:
        """Bool."""

    @property
    def cost(self) -> np.ndarray:
        """Dimensionless."""


class Optimum(Protocol):
    """What is drawn of ``drivetrain.match.Match``."""

    @property
    def transmission_ratio(self) -> float:
        """[m/rad]"""

    @property
    def active_length(self) -> float:
        """[m]"""

    @property
    def ratio_bounds(self) -> tuple[float, float]:
        """[m/rad]"""

    @property
    def total_cost(self) -> float:
        """Dimensionless."""


class OverRadius(Protocol):
    """``drivetrain.match.RadiusMatches``, arrays over the stator radius (n,), NaN where there is no match."""

    @property
    def radii(self) -> np.ndarray:
        """[m]"""

    @property
    def transmission_ratio(self) -> np.ndarray:
        """[m/rad]"""

    @property
    def active_length(self) -> np.ndarray:
        """[m]"""

    @property
    def cost(self) -> np.ndarray:
        """Dimensionless."""


@styled
def match_curves(curves: Curves, match: Optimum, *, output: Output, title: str, length_limit: float) -> Figure:
    """Active length that each constraint asks for, and the cost with its parts, over the transmission ratio.

    curves, match: in SI, see the protocols; output: words and units; title: which machine; length_limit [m]
    """
    figure = new_figure(5.4)
    axes = figure.subplots(1, 2)
    _draw_lengths(axes[0], curves, match, length_limit, output)
    _draw_cost(axes[1], curves, match, output)
    for axis in axes:
        axis.set_xlabel(labelled("transmission ratio", output.ratio_unit))
        axis.set_xlim(*(in_unit(end, output.ratio_unit) for end in (curves.ratio.min(), curves.ratio.max())))
    letter(axes)
    show_grid(*axes)
    figure.suptitle(title)
    legends = [axis.get_legend_handles_labels() for axis in axes]
    handles, names = ([one for legend in legends for one in legend[part]] for part in range(2))
    figure.legend(handles, names, loc="outside lower center", ncols=4, frameon=False)
    return figure


@styled
def match_over_radius(table: pd.DataFrame, output: Output, *, best: pd.DataFrame | None = None) -> Figure:
    """Transmission ratio, active length and cost of the match over the stator radius, for each slot-pole combination.

    table: columns slots, poles, overload ("field" or "linear", drawn solid and dashed), stator_outer_radius_mm,
        transmission_ratio in the unit of the output, active_length_mm, cost; NaN where there is no match. See
        ``radius_table``
    best: rows of the same columns to mark with a star, usually the chosen machine
    """
    panels = (
        (output.column("transmission_ratio", output.ratio_unit), labelled("transmission ratio", output.ratio_unit)),
        ("active_length_mm", "active length / mm"),
        ("cost", "cost (dimensionless)"),
    )
    figure = new_figure(4.8)
    axes = figure.subplots(1, 3)
    table = table.assign(combination=combinations(table))
    style = series_style(table.combination)
    for axis, (column, label) in zip(axes, panels, strict=True):
        _draw_over_radius(axis, table, column, style)
        _draw_best(axis, best, column)
        axis.set(xlabel="stator outer radius / mm", ylabel=label)
        axis.set_title(label.split(" /")[0].split(" (")[0], loc="left")
    letter(axes)
    show_grid(*axes)
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=2, frameon=False)
    return figure


def radius_table(combination: Combination, overload: str, result: OverRadius, output: Output) -> pd.DataFrame:
    """Rows for ``match_over_radius`` in drawing units.

    overload: where the overload torque of these matches comes from, "field" or "linear"
    """
    unit = output.ratio_unit
    return pd.DataFrame(
        {
            "slots": combination.slots,
            "poles": combination.poles,
            "overload": overload,
            "stator_outer_radius_mm": result.radii / MILLIMETRE,
            output.column("transmission_ratio", unit): in_unit(result.transmission_ratio, unit),
            "active_length_mm": result.active_length / MILLIMETRE,
            "cost": result.cost,
        }
    )


def best_row(combination: Combination, overload: str, radius: float, match: Optimum, output: Output) -> pd.DataFrame:
    """One match at a stator outer radius [m] as a row of the same columns."""
    row = {
        "slots": combination.slots,
        "poles": combination.poles,
        "overload": overload,
        "stator_outer_radius_mm": radius / MILLIMETRE,
        output.column("transmission_ratio", output.ratio_unit): in_unit(match.transmission_ratio, output.ratio_unit),
        "active_length_mm": match.active_length / MILLIMETRE,
        "cost": match.total_cost,
    }
    return pd.DataFrame([row])


# ---- over the transmission ratio ------------------------------------------------------------------------------------


def _draw_lengths(axes: Axes, curves: Curves, match: Optimum, length_limit: float, output: Output) -> None:
    unit = output.ratio_unit
    ratio, optimum = in_unit(curves.ratio, unit), in_unit(match.transmission_ratio, unit)
    look: Look
    for number, (name, length) in enumerate((one.name(output), one.length) for one in curves.lengths):
        enforced = np.all(length <= curves.active_length * (1 + 1e-9))
        look = {"linestyle": "-", "label": name} if enforced else {"linestyle": ":", "label": f"{name} (not enforced)"}
        axes.plot(ratio, length / MILLIMETRE, color=SERIES[number % len(SERIES)], **look)
    active = np.where(curves.feasible, curves.active_length, np.nan) / MILLIMETRE
    axes.plot(ratio, active, color=BLACK, linewidth=4.5, alpha=0.35, label="possible solutions")
    bound: Look = {"color": GREY, "linewidth": 1.2}
    axes.axvline(in_unit(match.ratio_bounds[0], unit), linestyle="--", label="smallest allowed ratio", **bound)
    axes.axhline(length_limit / MILLIMETRE, linestyle="-.", label="active length limit", **bound)
    axes.plot(optimum, match.active_length / MILLIMETRE, label="optimum", **_cross())
    axes.set_ylim(0.0, 1.2 * length_limit / MILLIMETRE)
    axes.set_ylabel("active length / mm")
    place = f"{optimum:.2f}{' ' * bool(unit)}{written(unit)}, {match.active_length / MILLIMETRE:.1f} mm"
    axes.set_title(f"active length, optimum {place}", loc="left")


def _draw_cost(axes: Axes, curves: Curves, match: Optimum, output: Output) -> None:
    unit = output.ratio_unit
    ratio = in_unit(curves.ratio, unit)
    axes.plot(ratio, curves.cost, color=LIGHT_GREY, linewidth=2.4)
    axes.plot(ratio, np.where(curves.feasible, curves.cost, np.nan), color=SERIES[0], linewidth=2.4, label="cost")
    for number, (term, name) in enumerate(_TERMS, start=1):
        axes.plot(ratio, getattr(curves, term), color=SERIES[number], linestyle="--", label=f"cost of the {name}")
    axes.axvline(in_unit(match.ratio_bounds[0], unit), color=GREY, linestyle="--", linewidth=1.2)
    axes.axvline(in_unit(match.ratio_bounds[1], unit), color=GREY, linestyle="-.", linewidth=1.2)
    axes.plot(in_unit(match.transmission_ratio, unit), match.total_cost, **_cross())
    axes.set_ylim(0.0, _WORST_COST_SHOWN * match.total_cost)
    axes.set_ylabel("cost (dimensionless)")
    axes.set_title(f"cost and its parts, optimum {match.total_cost:.3f}", loc="left")


def _cross() -> Look:
    look: Look = {"marker": "X", "markersize": 11, "color": VERMILION, "markeredgecolor": "white", "linestyle": ""}
    return look | {"zorder": 5}


# ---- over the stator radius -----------------------------------------------------------------------------------------


def _draw_over_radius(axes: Axes, table: pd.DataFrame, column: str, style: dict[str, Look]) -> None:
    for combination, look in style.items():
        for overload, line in _OVERLOADS:
            own = table[(table.combination == combination) & (table.overload == overload)]
            rows = own.sort_values("stator_outer_radius_mm")
            if rows.empty:
                continue
            label = f"{combination}, overload torque {'by field' if overload == 'field' else 'scaled linearly'}"
            shape = {**look, "markersize": 4, "linestyle": line, "label": label}
            shape["markevery"] = max(1, len(rows) // _MOST_MARKERS)
            axes.plot(rows.stator_outer_radius_mm, rows[column], **shape)


def _draw_best(axes: Axes, best: pd.DataFrame | None, column: str) -> None:
    if best is None or best.empty:
        return
    look: Look = {"marker": "*", "markersize": 14, "markerfacecolor": "white", "markeredgecolor": BLACK}
    look |= {"linestyle": ""}
    axes.plot(best.stator_outer_radius_mm, best[column], label="chosen", zorder=5, **look)
