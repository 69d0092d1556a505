"""What the match and the search over everything read of a study, in SI."""

from __future__ import annotations

from drivetrain.masses import PartMaterials
from drivetrain.match import CostScales, CostWeights, DampingEnforced, DampingReading, DampingReported, MatchLimits
from drivetrain.matching import (
    ChosenByHand,
    FieldOverload,
    LinearOverload,
    MatchInputs,
    OverloadLaw,
    PrintedMachine,
    StatedDemands,
)
from drivetrain.planetary import NITRIDED_STEEL, PLANETS, GearLaws, PrintedDynamicFactor
from drivetrain.requirements import Linkage, Requirements
from drivetrain.whole_design import Aims, RequirementAims
from drivetrain.whole_search import WholeSearchInputs
from study.chain import drives, searches_linkage
from study.inputs_drive import largest_equivalent_mass
from study.inputs_electrical import winding_resistivity
from study.inputs_machine import combinations
from study.magnet_choice import magnet_density
from study.needed import needed
from study.schema import MatchSection, Study

_OVERLOADS: dict[str, OverloadLaw] = {law.name: law for law in (FieldOverload(), LinearOverload())}
_DAMPING: dict[bool, DampingReading] = {True: DampingEnforced(), False: DampingReported()}


def match_inputs(study: Study) -> MatchInputs:
    """Limits, scales, gears, materials and choices of [match] and of the sections it rests on."""
    section = study.match.si
    return MatchInputs(
        combinations=combinations(study),
        limits=MatchLimits(section.length_max, section.speed_max),
        scales=CostScales(section.mass_max, largest_equivalent_mass(study), section.radius_limit),
        weights=CostWeights(section.weight_inertia, section.weight_radius),
        gear_stages=section.gearbox_stages,
        planets=PLANETS if study.gearbox is None else study.gearbox.planets,
        gear_laws=gear_laws(study.match),
        resistivity=winding_resistivity(study),
        overload=_OVERLOADS[section.overload_torque],
        damping=_DAMPING[section.enforce_damping],
        masses=part_materials(study),
        by_hand=_by_hand(study.match),
        printed=_printed(study),
    )


def part_materials(study: Study) -> PartMaterials:
    """Densities of the active parts and the stacking of the laminations; the shaft is of the gears' steel."""
    materials = study.materials.si
    return PartMaterials(
        lamination_density=materials.lamination_density,
        magnet_density=magnet_density(study),
        copper_density=materials.copper_density,
        shaft_density=study.match.si.steel_density,
        stacking=study.machine.stacking_factor,
    )


def gear_laws(section: MatchSection) -> GearLaws:
    """Gears by their scaling laws, with the dynamic factor as the thesis prints it (eq. 3.118); those of the thesis for
    a direct drive, which has no gears to size."""
    found = section.si
    if section.gearbox_stages == 0:
        return NITRIDED_STEEL
    return GearLaws(
        density=found.steel_density,
        youngs_modulus=found.gear_youngs_modulus,
        poisson_ratio=found.gear_poisson_ratio,
        contact_strength=found.gear_contact_stress,
        pressure_angle=found.gear_pressure_angle,
        overload_factor=found.gear_overload_factor,
        contact_ratio_factor=found.gear_contact_ratio_factor,
        ring_fraction=found.gear_ring_diameter_fraction,
        dynamic_factor=PrintedDynamicFactor(),
    )


def stated_demands(study: Study) -> StatedDemands | None:
    """Requirements and linkage as stated; None where they are the ones that are met, or no requirement is stated."""
    required = study.requirements
    if required is None or not (drives(study) or searches_linkage(study)):
        return None
    linkage = needed(study.linkage, "linkage").si
    return StatedDemands(
        Requirements(**vars(required.si)),
        Linkage(linkage.ratio_nominal, linkage.ratio_max, linkage.envelope_radius_max),
    )


def whole_search_inputs(study: Study) -> WholeSearchInputs:
    """What the search over everything needs beside the match."""
    return WholeSearchInputs(loss_grade=study.materials.loss_grade)


def requirement_aims(study: Study) -> Aims:
    """The aims of a search that asks for what the requirements ask for."""
    return RequirementAims()


def _by_hand(section: MatchSection) -> ChosenByHand:
    diameter = section.si.chosen_stator_diameter
    return ChosenByHand(
        slots=section.chosen_slots,
        stator_outer_radius=None if diameter is None else diameter / 2,
        poles=section.chosen_poles,
        gear_ratio=section.chosen_gear_ratio,
        active_length=section.si.chosen_active_length,
    )


def _printed(study: Study) -> PrintedMachine | None:
    if study.printed_machine is None:
        return None
    found = study.printed_machine.si
    return PrintedMachine(found.source, found.torque_nominal, found.half_slot_area)
