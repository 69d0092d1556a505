"""What a study says about the strength of its rotor, in SI, and what counts where it says nothing."""

from __future__ import annotations

from materials.strength import (
    CARBON_SLEEVE,
    GEAR_STEEL,
    GEAR_TENSILE,
    MPA,
    SHAFT_STEEL,
    SHAFT_TENSILE,
    STEEL_SLEEVE,
    StrengthBySection,
)
from mechanics.bearings import Bearing
from mechanics.retention import Glue, Retention, Sleeve
from mechanics.stage import FatigueInputs, MechanicsInputs
from study.schema import MechanicsSection, Study
from units import FACTORS

OVERSPEED = 1.2  # over the largest speed: IEC 60034-1, machines without an overspeed of their own
# Estimate: two thirds of the least of the 15 to 30 MPa (EN 1465, cold) in data sheets of epoxies and acrylics.
GLUE_STRENGTH = 10 * MPA  # Pa, in tension and in shear
GLUE_SAFETY = 3.0  # estimate, for peel at the edges, voids and age
SLEEVE_SAFETY = 1.2  # estimate
LAMINATION_YIELD = 300 * MPA  # Pa, least of makers' typical values for non-oriented sheet of 0.35 mm, 300 to 460 MPa
LAMINATION_TENSILE = 400 * MPA  # Pa, estimate: least of makers' typical values of the same sheet, 400 to 560 MPa
NOTCH = 2.0  # estimate between a shoulder, 1.5, and a press fit or keyway, 2.5; a punched edge is of that kind
FATIGUE_SAFETY = 1.5  # FKM guideline: grave consequences, no inspection
LIFE = 20000 * FACTORS["h"]  # s, usual for industrial drives; where the study states none
PEAKS = 1e5  # estimate: five an hour over that life
YIELD_SAFETY = 1.5  # usual for known loads that act once
CRITICAL_SPEED_FACTOR = 1.25  # usual: the largest speed stays below four fifths of the first critical one
ECCENTRICITY = 0.2  # of the air gap: run-out, clearance of the bearings and seats of a small machine, an estimate
SLEEVES = {"carbon": CARBON_SLEEVE, "steel": STEEL_SLEEVE}


def mechanics_inputs(study: Study) -> MechanicsInputs:
    """Strengths, safety factors, retention of the magnets and bearings."""
    section = study.mechanics
    si = section.si
    return MechanicsInputs(
        overspeed=_stated(si.overspeed_factor, OVERSPEED),
        retention=retention(section),
        lamination_yield=_stated(si.lamination_yield, LAMINATION_YIELD),
        shaft_steel=_steel(si.shaft_yield, SHAFT_STEEL),
        sun_steel=_steel(si.sun_yield, GEAR_STEEL),
        yield_safety=_stated(si.yield_safety, YIELD_SAFETY),
        critical_speed_factor=_stated(si.critical_speed_factor, CRITICAL_SPEED_FACTOR),
        eccentricity=_stated(si.eccentricity_fraction, ECCENTRICITY),
        bearing=None if si.bearing_capacity is None else Bearing(si.bearing_capacity, si.bearing_life),
        fatigue=fatigue(study),
    )


def fatigue(study: Study) -> FatigueInputs:
    """Tensile strengths and life; a yield strength that is stated alone counts as the tensile strength too."""
    si, gearbox = study.mechanics.si, study.gearbox
    return FatigueInputs(
        shaft=_steel(_first(si.shaft_tensile, si.shaft_yield), SHAFT_TENSILE),
        sun=_steel(_first(si.sun_tensile, si.sun_yield), GEAR_TENSILE),
        lamination=_stated(_first(si.lamination_tensile, si.lamination_yield), LAMINATION_TENSILE),
        notch=_stated(si.notch_factor, NOTCH),
        safety=_stated(si.fatigue_safety, FATIGUE_SAFETY),
        life=LIFE if gearbox is None else gearbox.si.life,
        peaks=_stated(si.peak_load_cycles, PEAKS),
    )


def retention(section: MechanicsSection) -> Retention:
    """A sleeve where one is stated, glue otherwise."""
    si = section.si
    if section.sleeve_material is not None:
        safety = _stated(si.sleeve_safety, SLEEVE_SAFETY)
        return Sleeve(SLEEVES[section.sleeve_material], si.sleeve_thickness, si.sleeve_prestress, safety)
    tension, shear = (_stated(one, GLUE_STRENGTH) for one in (si.glue_tensile_strength, si.glue_shear_strength))
    return Glue(tension, shear, _stated(si.glue_safety, GLUE_SAFETY))


def _first(*stated: float | None) -> float | None:
    """The first that is stated."""
    return next((one for one in stated if one is not None), None)


def _stated(stated: float | None, usual: float) -> float:
    return usual if stated is None else stated


def _steel(stated: float | None, usual: StrengthBySection) -> StrengthBySection:
    return usual if stated is None else StrengthBySection.stated(stated)
