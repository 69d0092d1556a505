"""Sweep, optima and limits for people: tables, design maps, and the section of the report."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict, astuple

import numpy as np
import pandas as pd
import xarray as xr

from figures.design_map import design_map, design_maps
from figures.files import File, figure_file, picture_name, table_file
from figures.limits import limits as limits_figure
from figures.report import Picture, Remark, Section, Table
from geometry.family import Combination
from magnetostatics.case import FamilyCase
from optimisation.limits import LimitComparison
from optimisation.optima import Optima, Optimum
from optimisation.sweep import DesignMaps
from units import AMPERE_PER_SQUARE_MILLIMETRE, MILLIMETRE, drawn

_COLUMNS = (
    "slots", "poles", "stator_diameter_mm", "stator_outer_radius_mm", "back_iron_width_mm", "rotor_outer_radius_mm",
    "tooth_width_mm", "half_slot_area_mm2", "torque_nominal_Nm_per_m", "torque_nominal_error_Nm_per_m",
    "torque_nominal_arkkio_Nm_per_m", "torque_overload_Nm_per_m", "torque_overload_error_Nm_per_m",
    "torque_overload_linear_Nm_per_m", "torque_null_Nm_per_m", "limited_T", "limit_T", "limit_binds", "tooth_worst_T",
    "back_iron_worst_T", "reading", "field_solutions", "newton_iterations",
)  # fmt: skip
_SHOWN = (
    "slots", "poles", "stator_diameter_mm", "back_iron_width_mm", "rotor_outer_radius_mm", "half_slot_area_mm2",
    "torque_nominal_Nm_per_m", "torque_nominal_error_Nm_per_m", "torque_overload_Nm_per_m",
    "torque_overload_error_Nm_per_m", "torque_overload_linear_Nm_per_m", "limited_T", "tooth_worst_T",
)  # fmt: skip
_MAPS = ("torque", "torque_null", "tooth_aligned", "tooth_worst", "back_iron_worst", "limited")
_LARGE = "Torque and probe flux densities over back-iron width and rotor radius."
_TORQUES = ("torque", "torque_null")


def optima_files(optima: Optima, maps: DesignMaps, case: FamilyCase) -> Iterator[File]:
    """Table of the optima and the design maps; the large one is that closest to the machine of the study."""
    table = optima_table(optima)
    yield table_file("optima.csv", table)
    combination, diameter = _closest(maps, case)
    shown, own = drawn_maps(maps, combination), _of(table, combination)
    chosen = maps.limit.reading.name, maps.limit.limit
    yield figure_file("design_map", design_map(shown, own, combination.words, diameter, *chosen))
    yield figure_file("design_maps", design_maps(shown, own, combination.words, *chosen))


def limits_files(limits: LimitComparison) -> Iterator[File]:
    """Table and figure of the optimum over the limit; nothing where no limits are compared."""
    if not limits.points:
        return
    table = limits_table(limits)
    yield table_file("limits.csv", table)
    chosen = limits.chosen
    drawn = limits_figure(table, chosen_reading=chosen.reading.name, chosen_limit_T=chosen.limit)
    yield figure_file("limits", drawn)


def remarks(optima: Optima) -> Iterator[str]:
    """What the run says at once: where the sweep holds no optimum, or has it at its edge."""
    yield from (one.reason for one in optima.without)
    yield from (edge.sentence for edge in optima.edges)


def section(case: FamilyCase, maps: DesignMaps, optima: Optima, limits: LimitComparison | None) -> Section:
    """Sweep, feasible domain, refined optima and what the limit costs."""
    caption = (
        "Refined optima. Torque per metre of active length, mean over one electrical period; flux densities are means "
        "over the probes."
    )
    return Section(
        "Optimum cross-sections",
        (
            _what(maps),
            Picture(picture_name("design_map"), _LARGE),
            Picture(picture_name("design_maps"), "The same for every stator diameter, as shares of the stator radius."),
            *(Remark(f"{edge.sentence}.") for edge in optima.edges),
            *(Remark(f"{one.reason}.") for one in optima.without),
            *_freed(optima),
            Table(optima_table(optima)[[*_SHOWN, *_freed_columns(optima)]], caption),
            _overload(case, optima),
            *_readings(limits),
        ),
    )


def optima_table(optima: Optima) -> pd.DataFrame:
    """The optima in drawing units, one row each."""
    rows = [_row(optimum, optima) for optimum in optima.found]
    return pd.DataFrame(rows, columns=[*_COLUMNS, *_freed_columns(optima)])


def limits_table(limits: LimitComparison) -> pd.DataFrame:
    """The compared limits in drawing units; empty where no design holds the limit."""
    return pd.DataFrame(
        [
            {
                "reading": point.reading,
                "limit_T": point.limit,
                "torque_nominal_Nm_per_m": point.torque,
                "back_iron_width_mm": point.back_iron_width / MILLIMETRE,
                "rotor_outer_radius_mm": point.rotor_outer_radius / MILLIMETRE,
            }
            for point in limits.points
        ]
    )


def drawn_maps(maps: DesignMaps, combination: Combination) -> xr.Dataset:
    """The maps of one combination in drawing units, as ``figures.design_map`` takes them."""
    data = maps.one(combination)
    named = {f"{name}_{'Nm_per_m' if name in _TORQUES else 'T'}": data[name] for name in _MAPS}
    lengths = {f"{name}_mm": data[name] / MILLIMETRE for name in ("back_iron_width", "rotor_outer_radius")}
    shown = xr.Dataset(named | lengths, attrs={"reading": maps.limit.reading.name})
    shown = shown.rename(stator_outer_radius="stator_diameter_mm")
    diameters = np.round(2 * shown.stator_diameter_mm / MILLIMETRE, 9)
    return shown.assign_coords(stator_diameter_mm=diameters)


def _row(optimum: Optimum, optima: Optima) -> dict[str, object]:
    values = (
        asdict(optimum)
        | asdict(optimum.combination)
        | {
            "stator_diameter": 2 * optimum.stator_outer_radius,
            "torque_nominal_arkkio": optimum.torque_nominal_ring,
            "limit": optima.limit.limit,
            "reading": optima.limit.reading.name,
        }
    )
    further = zip(optima.freedom.further, optimum.further, strict=True)
    return drawn(values, _COLUMNS) | {variable.key: variable.drawn(value) for variable, value in further}


def _freed_columns(optima: Optima) -> list[str]:
    """Columns of what was freed, without those that stand in the table anyway."""
    return [variable.key for variable in optima.freedom.further if variable.key not in _COLUMNS]


def _of(table: pd.DataFrame, combination: Combination) -> pd.DataFrame:
    """The rows of one combination."""
    return table[(table.slots == combination.slots) & (table.poles == combination.poles)]


def _closest(maps: DesignMaps, case: FamilyCase) -> tuple[Combination, float]:
    """Slot-pole combination and stator diameter [mm] of the sweep that are closest to the machine of the study."""
    own = case.family

    def distance(one: tuple[Combination, float]) -> tuple[int, int, float]:
        (slots, poles), outer = astuple(one[0]), one[1]
        return abs(slots - own.slots), abs(poles - own.combination.poles), abs(outer - own.stator_outer_radius)

    combination, outer = min(maps.grid.sections, key=distance)
    return combination, round(2 * outer / MILLIMETRE, 9)


def _what(maps: DesignMaps) -> str:
    return (
        "Largest torque per metre, mean over one electrical period with the current on the q axis, with a flux "
        f"density of at most {maps.limit.words}: {maps.grid.back_iron_steps} × {maps.grid.rotor_radius_steps} designs "
        f"for every slot-pole combination and diameter ({maps.designs} in all, {maps.unbuildable} cannot be built), "
        "then refined with further field solutions until the limit is met to 0.02 %."
    )


def _freed(optima: Optima) -> tuple[str, ...]:
    """What the optima could choose beside back iron and rotor radius."""
    if not optima.freedom.further:
        return ()
    said = "; ".join(
        f"{one.words} {one.drawn(one.low):.4g} to {one.amount(one.high)}" for one in optima.freedom.further
    )
    return (
        f"From the optimum over the grid on, the search by gradients was free in more dimensions: {said}. The magnets "
        "must stand the overload current in the magnetic circuit, and the wire must pass the slot opening.",
    )


def _overload(case: FamilyCase, optima: Optima) -> str:
    over = [(one.torque_overload_linear / one.torque_overload - 1) * 100 for one in optima.found]
    amplitudes = case.nominal_density, case.overload_density
    nominal, overload = (amplitude / np.sqrt(2) / AMPERE_PER_SQUARE_MILLIMETRE for amplitude in amplitudes)
    return (
        f"At the overload of {overload:g} A/mm² RMS the field gives less than linear scaling from {nominal:g} A/mm² "
        f"promises: the assumption is too high by {min(over):.0f} to {max(over):.0f} %."
    )


def _readings(limits: LimitComparison | None) -> tuple[str | Picture, ...]:
    if limits is None or not limits.points:
        return ()
    text = (
        "What the limit means decides about the optimum. The readings differ in which probes and which rotor angles "
        "count; the torque is the same mean over the period in all of them. Points of this figure are read off a map "
        "by interpolation."
    )
    return text, Picture(picture_name("limits"), "Optimum against the flux-density limit, for each reading of it.")
