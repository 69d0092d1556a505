"""The gearbox of a study: its sections in SI, as the gearbox stage reads them."""

from __future__ import annotations

from math import inf

from gearbox.bodies import Construction
from gearbox.flank import Lubrication
from gearbox.load_factors import Quality
from gearbox.material import MATERIALS
from gearbox.planetary_set import planetary_set
from gearbox.rating import Rules
from gearbox.search import Safety
from gearbox.stage import GearCost, GearInputs, StatedGears
from study.inputs_drive import largest_equivalent_mass
from study.needed import needed
from study.schema import GearboxSection, Study


def gear_inputs(study: Study) -> GearInputs:
    """Strength, construction and cost of the gears that are searched."""
    section, match = needed(study.gearbox, "gearbox"), study.match
    si = section.si
    return GearInputs(
        rules=gear_rules(section),
        safety=Safety(si.safety_flank, si.safety_root, si.safety_static_flank, si.safety_static_root),
        construction=construction(section),
        cost=GearCost(match.si.mass_max, largest_equivalent_mass(study), match.si.weight_inertia),
        stage_count=match.gearbox_stages,
        ratio_tolerance=si.ratio_tolerance,
        planets=si.planets,
        friction=si.friction_coefficient,
        torque_class_width=si.torque_class,
        life=si.life,
        swing=inf if si.swing is None else si.swing,
        stated=stated_gears(section),
    )


def gear_rules(section: GearboxSection) -> Rules:
    """Steel, manufacture and oil that the teeth are rated by."""
    si = section.si
    oil = Lubrication(si.oil_viscosity, si.flank_roughness, si.root_roughness)
    return Rules(MATERIALS[section.material], Quality(si.accuracy_grade, si.application_factor), oil)


def construction(section: GearboxSection) -> Construction:
    """How a stage is built around its teeth."""
    si = section.si
    return Construction(
        bore_fraction=si.planet_bore_fraction,
        flange_fraction=si.flange_fraction,
        least_flange=si.flange_thickness_min,
        axial_gap=si.axial_gap,
    )


def stated_gears(section: GearboxSection) -> StatedGears | None:
    """The gear set that the study states, None where it does not."""
    si = section.si
    if None in (si.printed_teeth, si.printed_module, si.printed_shifts, si.printed_face_widths):
        return None
    sun, planet, ring = si.printed_teeth
    gears = planetary_set((sun, planet, -ring), si.printed_shifts, si.printed_module, planets=si.planets)
    return StatedGears(gears.plain, si.printed_face_widths)
