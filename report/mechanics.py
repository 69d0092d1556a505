"""Strength of rotor, shafts and bearings for people."""

from __future__ import annotations

from collections.abc import Iterator

import pandas as pd

from drivetrain.output import amount, in_unit
from figures.files import File, figure_file, picture_name, table_file
from figures.mechanics import safety_margins
from figures.report import Picture, Remark, Section, Table, capped
from gearbox.stage import GearboxOutcome
from mechanics.checks import LoadCheck
from mechanics.stage import MechanicsOutcome
from units import FACTORS, MILLIMETRE, RPM, written

TABLE, FIGURE = "mechanics.csv", "mechanics"
LARGEST_FACTOR, LARGEST_MARGIN = 100.0, 1000.0  # safety factor, percent; what is more is as good
_ACTS = "What acts and what may act, of glue the share of its strength, and the factor between them."


def files(found: MechanicsOutcome) -> Iterator[File]:
    """Every check, and the figure of their margins."""
    yield table_file(TABLE, checks_table(found))
    yield figure_file(FIGURE, safety_margins(found))


def section(found: MechanicsOutcome, gears: GearboxOutcome) -> Section:
    """Whether the rotor bears its speed, torque and pull."""
    return Section(
        "Strength of rotor and shafts",
        (
            _text(found),
            *(Remark(line) for line in remarks(found)),
            Table(_shown(checks_table(found)), _ACTS),
            Picture(picture_name(FIGURE), "Safety factors over those wanted; orange falls short."),
            Table(numbers_table(found), "Rotor and shaft."),
            _bearings(found, gears),
        ),
    )


def checks_table(found: MechanicsOutcome) -> pd.DataFrame:
    """One check a row, in drawing units."""
    return pd.DataFrame([_row(one) for one in found.checks])


def _shown(checks: pd.DataFrame) -> pd.DataFrame:
    """Without the digits of what is beyond all doubt."""
    return checks.assign(
        factor=capped(checks.factor, LARGEST_FACTOR), margin_percent=capped(checks.margin_percent, LARGEST_MARGIN)
    )


def _row(one: LoadCheck) -> dict[str, object]:
    return {
        "part": one.part,
        "acts": in_unit(one.load, one.unit),
        "may act": in_unit(one.limit, one.unit),
        "unit": written(one.unit),
        "factor": one.reached,
        "wanted": one.wanted,
        "margin_percent": 100 * one.margin,
        "holds": "yes" if one.holds else "NO",
    }


def numbers_table(found: MechanicsOutcome) -> pd.DataFrame:
    """What the checks are made of, in one row of drawing units."""
    shaft, per_mm = found.shaft, FACTORS["N_per_mm"]
    row: dict[str, object] = {
        "overspeed_rpm": found.overspeed / RPM,
        "centrifugal_load_of_a_magnet_N": found.magnet_pull,
        "bearing_span_mm": shaft.span / MILLIMETRE,
        "shaft_stiffness_N_per_mm": shaft.stiffness / per_mm,
        "magnetic_stiffness_N_per_mm": -shaft.magnetic_stiffness / per_mm,
        "first_critical_speed_rpm": shaft.critical_speed / RPM,
        "deflection_um": found.deflection / FACTORS["um"],
        "bearing_load_N": found.bearing_load,
    }
    if found.bearing_life is not None:
        row["bearing_life_h"] = found.bearing_life / FACTORS["h"]
    return pd.DataFrame([row])


def remarks(found: MechanicsOutcome) -> Iterator[str]:
    """What the run says at once: every check that fails."""
    for one in found.checks:
        if not one.holds:
            yield (
                f"{one.part} does not hold: {amount(one.load, one.unit)} where {amount(one.limit, one.unit)} is the "
                f"limit, a factor of {one.reached:.3g}, {one.wanted:.3g} wanted; what would help: {one.helps}."
            )


def _text(found: MechanicsOutcome) -> str:
    held = sum(one.holds for one in found.checks)
    return (
        f"{held} of {len(found.checks)} checks hold. Magnets and laminations turn at {amount(found.overspeed, 'rpm')}, "
        f"shafts carry the peak torque of the machine, once. {_fatigue(found)} The rotor sits in the middle of its "
        f"shaft between two rigid bearings, {amount(found.eccentricity, 'um')} off centre, bent by its weight and by "
        "the pull of the field solution. Heat and shrink fits are not in these numbers, and notches only in those of "
        "fatigue; the safety factors stand for them."
    )


def _fatigue(found: MechanicsOutcome) -> str:
    """By which cycles fatigue is rated."""
    hours = found.life / FACTORS["h"]
    cycles = (
        f"the cycles of the road's history, counted by rainflow and repeated for {hours:g} h"
        if found.recorded
        else f"{found.peaks:.3g} peak torques there and back, and as many times from rest to the largest speed, for no "
        f"history is known; the shaft bends with every turn in {hours:g} h"
    )
    return (
        f"Fatigue is that of {cycles}: Goodman's mean stress and Miner's sum give the reversed amplitude that does as "
        "much at 10⁶ cycles as all of them, notch factor in, against what the steel endures there. Teeth are rated "
        "with the gears."
    )


def _bearings(found: MechanicsOutcome, gears: GearboxOutcome) -> str:
    side = (
        "Planets at equal distances push sun and carrier from all sides alike and add nothing across the rotor shaft."
        if gears.train.stages
        else "What the load on the shaft adds across it is not known here and not counted."
    )
    if found.bearing_life is not None:
        return f"Their life is that of ISO 281 at the RMS speed. {side}"
    return f"The life of the bearings is not rated: mechanics.bearing_capacity_kN is not stated. {side}"
