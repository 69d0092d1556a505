"""Torque and flux density over back-iron width and rotor radius, with the feasible domain (thesis Fig. 3.22)."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.contour import ContourSet
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from figures.style import BLACK, DESIGN_MAP, FIELD_MAP, VERMILION, Look, letter, new_figure, styled

# Which maps a reading of the saturation limit looks at (see the study file); the largest of them is limited.
CONSTRAINED = {
    "aligned_tooth": ("tooth_aligned_T",),
    "every_tooth": ("tooth_worst_T",),
    "every_tooth_and_back_iron_over_period": ("tooth_worst_T", "back_iron_worst_T"),
}
_PROBE_MAPS = (
    ("tooth_aligned_T", "tooth that faces a magnet"),
    ("tooth_worst_T", "worst tooth"),
    ("back_iron_worst_T", "worst back iron"),
)
_COLUMNS = 4  # panels side by side in the overview
_UNBUILDABLE = "#BDBDBD"
_STAR: Look = {"marker": "*", "markerfacecolor": "white", "markeredgecolor": BLACK, "linestyle": ""}


@dataclass(frozen=True)
class Design:
    """One panel: axes x (n,), y (m,), torque and limited flux density (m, n), the limit [T], the optimum (x, y)."""

    x: np.ndarray
    y: np.ndarray
    torque: np.ndarray
    constrained: np.ndarray
    limit: float
    optimum: tuple[float, float] | None

    @property
    def feasible(self) -> np.ndarray:
        """Whether each grid point can be built and keeps the limit (m, n)."""
        return np.isfinite(self.torque) & (self.constrained <= self.limit)


@styled
def design_map(
    maps: xr.Dataset, optima: pd.DataFrame, name: str, stator_diameter_mm: float, reading: str, limit_T: float
) -> Figure:
    """Torque per length with the feasible domain, and the probes beside it, for one diameter.

    maps: of one family; dimensions stator_diameter_mm, back_iron, rotor_radius; variables ``back_iron_width_mm``,
        ``rotor_outer_radius_mm``, ``torque_Nm_per_m``, ``tooth_aligned_T``, ``tooth_worst_T``, ``back_iron_worst_T``;
        NaN where the machine cannot be built
    optima: of the same; columns stator_diameter_mm, reading, limit_T, back_iron_width_mm, rotor_outer_radius_mm,
        torque_nominal_Nm_per_m; reading and limit_T select among them
    name: of the family, such as its slots and poles
    """
    one = maps.sel(stator_diameter_mm=stator_diameter_mm)
    optimum = select_optimum(optima, stator_diameter_mm, reading, limit_T)
    design = in_millimetres(one, reading, limit_T, optimum)
    figure = new_figure(8.4)
    axes = figure.subplots(2, 2, sharex=True, sharey=True).ravel()
    _torque_panel(figure, axes[0], design, optimum)
    for axis, (probe, words) in zip(axes[1:], _PROBE_MAPS, strict=True):
        _probe_panel(figure, axis, design, one[probe].transpose("rotor_radius", "back_iron").values, words)
    _label(axes)
    figure.suptitle(f"{name}, Ø {stator_diameter_mm:g} mm, limit {limit_T:g} T ({_in_words(reading)})")
    figure.legend(handles=_legend(), loc="outside lower center", ncols=5, frameon=False)
    return figure


@styled
def design_maps(maps: xr.Dataset, optima: pd.DataFrame, name: str, reading: str, limit_T: float) -> Figure:
    """One small torque map for each stator diameter; the axes are shares of the stator radius, the colours shares of
    the torque at the optimum (of the largest feasible torque on the grid where there is no optimum).

    Arguments as in ``design_map``.
    """
    diameters = [float(value) for value in maps.stator_diameter_mm.values]
    optimum = {diameter: select_optimum(optima, diameter, reading, limit_T) for diameter in diameters}
    panels = {
        diameter: _as_shares(maps.sel(stator_diameter_mm=diameter), reading, limit_T, optimum[diameter])
        for diameter in diameters
    }
    rows = -(-(len(diameters) + 1) // _COLUMNS)
    figure = new_figure(0.9 + 2.3 * rows)
    axes = figure.subplots(rows, _COLUMNS, sharex=True, sharey=True, squeeze=False)
    levels = _share_levels(panels.values())
    for axis, (diameter, design) in zip(axes.flat, panels.items()):
        colours = _small_panel(axis, design, levels)
        axis.set_title(_small_title(diameter, optimum[diameter]), loc="left", fontsize=9)
    _finish_overview(figure, axes, len(diameters), colours)
    figure.suptitle(f"{name}, limit {limit_T:g} T ({_in_words(reading)})")
    return figure


def select_optimum(optima: pd.DataFrame, stator_diameter_mm: float, reading: str, limit_T: float) -> pd.Series | None:
    """The row of the optimum, or None where no feasible machine was found."""
    same = np.isclose(optima.stator_diameter_mm, stator_diameter_mm)
    rows = optima[same & (optima.reading == reading) & np.isclose(optima.limit_T, limit_T)]
    rows = rows[np.isfinite(rows.torque_nominal_Nm_per_m)]
    return None if rows.empty else rows.iloc[0]


def constrained_flux_density(one: xr.Dataset, reading: str) -> xr.DataArray:
    """The flux density that a reading limits [T]: ``limited_T`` where the maps were made for this reading (their
    attribute ``reading`` says so), else the largest of the maps that the reading looks at.

    Raises ValueError for an unknown reading.
    """
    if "limited_T" in one and one.attrs.get("reading") == reading:
        return one.limited_T
    if reading not in CONSTRAINED:
        raise ValueError(f"a reading of the saturation limit is one of {', '.join(CONSTRAINED)}; found {reading!r}")
    return one[list(CONSTRAINED[reading])].to_array().max("variable", skipna=False)


def in_millimetres(one: xr.Dataset, reading: str, limit_T: float, optimum: pd.Series | None = None) -> Design:
    """One diameter as a panel with axes in mm."""
    place = None if optimum is None else (optimum.back_iron_width_mm, optimum.rotor_outer_radius_mm)
    return _design(one, one.back_iron_width_mm.values, one.rotor_outer_radius_mm.values, reading, limit_T, place)


def _as_shares(one: xr.Dataset, reading: str, limit_T: float, optimum: pd.Series | None) -> Design:
    """Axes as shares of the stator radius, torque as a share of that at the optimum."""
    radius = float(one.stator_diameter_mm) / 2
    place = None if optimum is None else (optimum.back_iron_width_mm / radius, optimum.rotor_outer_radius_mm / radius)
    design = _design(one, one.back_iron_fraction.values, one.rotor_radius_fraction.values, reading, limit_T, place)
    return replace(design, torque=design.torque / _reference_torque(design, optimum))


def _design(
    one: xr.Dataset, x: np.ndarray, y: np.ndarray, reading: str, limit_T: float, place: tuple[float, float] | None
) -> Design:
    order = ("rotor_radius", "back_iron")
    torque = one.torque_Nm_per_m.transpose(*order).values
    return Design(x, y, torque, constrained_flux_density(one, reading).transpose(*order).values, limit_T, place)


# ---- panels ---------------------------------------------------------------------------------------------------------


def _torque_panel(figure: Figure, axes: Axes, design: Design, optimum: pd.Series | None) -> None:
    axes.set_facecolor(_UNBUILDABLE)
    colours = axes.contourf(design.x, design.y, design.torque, levels=14, cmap=DESIGN_MAP)
    _draw_domain(axes, design)
    figure.colorbar(colours, ax=axes, pad=0.02).set_label("torque per length / (Nm/m)")
    found = "no feasible machine" if optimum is None else f"optimum {optimum.torque_nominal_Nm_per_m:.1f} Nm/m"
    axes.set_title(f"torque per length, {found}", loc="left")


def _probe_panel(figure: Figure, axes: Axes, design: Design, values: np.ndarray, words: str) -> None:
    axes.set_facecolor(_UNBUILDABLE)
    colours = axes.contourf(design.x, design.y, values, levels=14, cmap=FIELD_MAP)
    _draw_domain(axes, design)
    if np.nanmin(values) <= design.limit <= np.nanmax(values):
        axes.contour(design.x, design.y, values, levels=[design.limit], colors=BLACK, linestyles="--", linewidths=1.4)
    figure.colorbar(colours, ax=axes, pad=0.02).set_label("mean |B| / T")
    axes.set_title(words, loc="left")


def _small_panel(axes: Axes, design: Design, levels: np.ndarray) -> ContourSet:
    axes.set_facecolor(_UNBUILDABLE)
    colours = axes.contourf(design.x, design.y, design.torque, levels=levels, cmap=DESIGN_MAP, extend="both")
    _draw_domain(axes, design)
    return colours


def _small_title(diameter: float, optimum: pd.Series | None) -> str:
    found = "none feasible" if optimum is None else f"{optimum.torque_nominal_Nm_per_m:.1f} Nm/m"
    return f"Ø {diameter:g} mm: {found}"


def _share_levels(designs: Iterable[Design]) -> np.ndarray:
    """Steps of 0.05 over the middle 96 % of all values, so that a few odd designs do not take the colours."""
    values = np.concatenate([design.torque[np.isfinite(design.torque)] for design in designs])
    low, high = np.floor(np.quantile(values, 0.02) * 20) / 20, np.ceil(np.quantile(values, 0.98) * 20) / 20
    return np.arange(low, high + 0.051, 0.05)


def _reference_torque(design: Design, optimum: pd.Series | None) -> float:
    if optimum is not None:
        return optimum.torque_nominal_Nm_per_m
    within = design.torque[design.feasible] if design.feasible.any() else design.torque
    return np.nanmax(within)


def _draw_domain(axes: Axes, design: Design) -> None:
    """Limit line, hatching beyond it, grid points and the optimum."""
    known = design.constrained[np.isfinite(design.constrained)]
    if known.size and known.max() > design.limit:
        above = [design.limit, max(known.max(), design.limit) + 1.0]
        hatched = axes.contourf(design.x, design.y, design.constrained, levels=above, colors="white", alpha=0.45)
        hatched.set_hatch("///")
        hatched.set_edgecolor("#404040")
        hatched.set_linewidth(0.0)
    if known.size and known.min() <= design.limit <= known.max():
        axes.contour(design.x, design.y, design.constrained, levels=[design.limit], colors=VERMILION, linewidths=2.0)
    if design.optimum is not None:
        axes.plot(*design.optimum, markersize=15, clip_on=False, zorder=5, **_STAR)


def _legend() -> list[Artist]:
    return [
        Line2D([], [], color=VERMILION, linewidth=2.0, label="limit of the reading"),
        Line2D([], [], color=BLACK, linestyle="--", linewidth=1.4, label="this probe at the limit"),
        Patch(facecolor="white", edgecolor="#404040", hatch="///", label="above the limit"),
        Patch(color=_UNBUILDABLE, label="cannot be built"),
        Line2D([], [], markersize=12, label="optimum", **_STAR),
    ]


def _label(axes: np.ndarray) -> None:
    for axis in axes[2:]:
        axis.set_xlabel("back-iron width / mm")
    for axis in axes[::2]:
        axis.set_ylabel("rotor outer radius / mm")
    letter(axes)


def _finish_overview(figure: Figure, axes: np.ndarray, used: int, colours: ContourSet) -> None:
    for axis in axes.flat[used:]:
        axis.axis("off")
    for axis in axes.flat[max(used - _COLUMNS, 0) : used]:  # nothing stands below these
        axis.tick_params(labelbottom=True)
    last = axes.flat[used]
    last.legend(handles=_legend()[:1] + _legend()[2:], loc="center", frameon=False)
    figure.supxlabel("back-iron width / stator outer radius")
    figure.supylabel("rotor outer radius / stator outer radius")
    figure.colorbar(colours, ax=axes, pad=0.02, shrink=0.8).set_label("torque / torque at the optimum")


def _in_words(reading: str) -> str:
    return reading.replace("_", " ")
