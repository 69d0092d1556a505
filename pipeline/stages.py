"""The declared graph: what a study is made of, from what is asked to the report.

Each stage is a function of the room that it speaks of; what it reads and writes stands in its signature. Variants of a
study are other nodes: requirements that a vehicle gives, that are stated, or those of a drive; a linkage that is
searched or stated; gears or a direct drive.
"""

from __future__ import annotations

from actuator.errors import ActuatorError
from bench.chapters import chapters_stage
from bench.errors import RecordError
from bench.report import simulated
from bench.simulated import bench_stage
from control.errors import ControlError
from drivetrain.four_bar import LinkageError
from drivetrain.gear_views import braking_demand, direct_drive, gear_demand, stated_loads, transmission
from drivetrain.heat_views import (
    built_machine,
    length_by_density,
    length_by_temperature,
    mapped_loss,
    stated_duty,
)
from drivetrain.learned import NOTHING_LEARNED, Learned, demand_as_learned
from drivetrain.linkage_stage import chosen_linkage, linkage_stage
from drivetrain.match import MatchError
from drivetrain.matching import match_stage, matched_machine
from drivetrain.outcome import actuator_limits, outcome_stage
from drivetrain.planetary import GearboxError
from drivetrain.rotor_duty import rotor_duty
from drivetrain.second_design import FirstDesign, lesson_costs_stage
from drivetrain.whole_search import optimise_stage
from electrical.braking_stage import braking_stage
from electrical.drive_stage import drive_stage
from electrical.driven_machine import driven_machine
from electrical.flux_map_machine import FluxMapMachineError
from electrical.magnets_stage import magnets_stage
from electrical.winding_selection import WindingError
from electrical.winding_stage import winding_stage
from export.stage import package_stage
from export.step import StepError
from gearbox.errors import GearError
from gearbox.stage import gearbox_stage
from geometry.errors import GeometryError
from losses.stage import LossError, current_losses_stage, loss_law, losses_stage
from magnetostatics.case import field_case, stated_machine
from magnetostatics.fields_stage import fields_stage
from magnetostatics.flux_map import FluxMapError
from magnetostatics.flux_map_stage import flux_map_stage
from magnetostatics.gap_stress_stage import gap_stress_stage
from magnetostatics.newton import FieldSolutionError
from materials.errors import MaterialError
from mechanics.stage import mechanics_stage
from optimisation.constrained_optimum import NoOptimumError
from optimisation.fits import fits_stage
from optimisation.limits import limits_stage
from optimisation.optima import optima_stage
from optimisation.polynomial_fits import FitRefused
from optimisation.sweep import sweep_stage
from pipeline import chapters_page
from pipeline.graph import Function, Graph, Node, Source, Stage, View
from report import (
    braking,
    datasheet,
    drive,
    energy,
    fields,
    fits,
    flux_map,
    gap_stress,
    gearbox,
    heat,
    judged,
    linkage,
    losses,
    magnets,
    match,
    mechanics,
    optimise,
    outcome,
    package,
    quarter_car,
    requirements,
    ride,
    strategies,
    sweep,
    tolerances,
    uncertainty,
    winding,
)
from report import learned as learned_report
from study.chain import drives, judges_by_road, rates_by_density, searches_linkage
from study.inputs_actuator import actuator_inputs
from study.inputs_drive import output
from study.inputs_electrical import copper_heat, flux_map_grid, loss_inputs
from study.inputs_field import saturation_limit, sweep_grid
from study.inputs_gearbox import gear_inputs
from study.inputs_heat import heat_inputs, no_loss_data
from study.inputs_learned import (
    field_case_as_learned,
    loss_inputs_as_learned,
    magnet_inputs_as_learned,
    outcome_inputs_as_learned,
    study_itself,
    winding_inputs_as_learned,
)
from study.inputs_linkage import installation_space, linkage_search, stated_linkage
from study.inputs_match import match_inputs, requirement_aims, stated_demands, whole_search_inputs
from study.inputs_mechanics import mechanics_inputs
from study.inputs_package import part_prices
from study.inputs_tolerances import tolerances as stated_tolerances
from study.inputs_variables import freedom
from study.inputs_vehicle import requirements_beside, ride_case, stated_requirements
from study.schema import Study
from thermal.errors import ThermalError
from thermal.stage import heat_stage
from uncertainty.stage import uncertainty_stage
from uncertainty.tolerance_stage import tolerances_stage
from vehicle.demands import required, requirements_stage
from vehicle.designed import bench_machine, designed_actuator
from vehicle.energy_stage import energy_stage
from vehicle.errors import VehicleError
from vehicle.gear_loads import road_loads
from vehicle.heat_duty import road_duty
from vehicle.judged_designs import judged_stage
from vehicle.quarter_car_stage import quarter_car_stage
from vehicle.ride_again import ride_again_stage
from vehicle.ride_heat import thermal_machine
from vehicle.road_aims import road_aims, road_response_stage
from vehicle.strategies import strategies_stage

REFUSALS = (
    ActuatorError, ControlError, FieldSolutionError, FitRefused, FluxMapError, FluxMapMachineError,
    GearboxError, GearError, GeometryError, LinkageError, LossError, MatchError, MaterialError,
    NoOptimumError, RecordError, StepError, ThermalError, VehicleError, WindingError,
)  # fmt: skip

_SOURCES = (
    study_itself, sweep_grid, freedom, saturation_limit, match_inputs, stated_demands, whole_search_inputs,
    flux_map_grid, gear_inputs, output, copper_heat, heat_inputs, mechanics_inputs, part_prices,
)  # fmt: skip
_AS_LEARNED = (
    field_case_as_learned, field_case, stated_machine, winding_inputs_as_learned, loss_inputs_as_learned,
    outcome_inputs_as_learned,
    demand_as_learned,
)  # fmt: skip
_VEHICLE: tuple[Node, ...] = (
    Source(ride_case),
    Source(requirements_beside),
    Stage("requirements", requirements_stage, "the vehicle asks", requirements.files, remarks=requirements.remarks),
    View(required),
    View(road_loads),
    View(road_duty),
    Stage("ride", ride_again_stage, "the vehicle with what was designed", ride.files),
    View(actuator_limits),
)
_ENERGY: tuple[Node, ...] = (
    Source(actuator_inputs),
    View(designed_actuator),
    View(thermal_machine),
    Stage("energy", energy_stage, "power and duty on the road", energy.files, remarks=energy.remarks),
    Stage("judged", judged_stage, "all designs on the road", judged.files, on_request=True, remarks=judged.remarks),
    Stage("strategies", strategies_stage, "control laws over their settings", strategies.files, on_request=True),
    Stage("quarter_car", quarter_car_stage, "in the thesis's quarter car", quarter_car.files, on_request=True),
    View(bench_machine),
    Stage("bench", bench_stage, "what benches would read", simulated.files, on_request=True),
    Stage("chapters", chapters_stage, "beside chapters 4 and 5", chapters_page.files, on_request=True),
)
_BY_ROAD: tuple[Node, ...] = (
    Stage("road_response", road_response_stage, "what the road makes of an equivalent mass", on_request=True),
    View(road_aims),
)
_STATED: tuple[Node, ...] = (Source(stated_requirements), View(stated_loads), View(stated_duty))
_SEARCHED: tuple[Node, ...] = (
    Source(linkage_search),
    Source(installation_space),
    Stage("linkage", linkage_stage, "Pareto front of four-bars", linkage.files, remarks=linkage.remarks),
    View(chosen_linkage),
)
_GEARS: tuple[Node, ...] = (
    View(gear_demand),
    Stage("gearbox", gearbox_stage, "all tooth sets, rated", gearbox.files, remarks=gearbox.remarks),
)
_MAGNETS: tuple[Node, ...] = (
    View(magnet_inputs_as_learned),
    Stage("magnets", magnets_stage, "what they stand", magnets.files, remarks=magnets.remarks),
)
_LOSSES: tuple[Node, ...] = (
    Stage("current_losses", current_losses_stage, "per metre, over the currents"),
    Stage("losses", losses_stage, "loss and efficiency map", losses.files),
    View(mapped_loss),
)
_NO_LOSSES: tuple[Node, ...] = (
    Stage("current_losses", current_losses_stage, "per metre, over the currents", on_request=True),
    Stage("losses", losses_stage, "loss and efficiency map", losses.files, on_request=True),
    Source(no_loss_data),
)
_MACHINE: tuple[Node, ...] = (
    Stage("sweep", sweep_stage, "designs solved over slots and radii"),
    Stage("optima", optima_stage, "the best under the limit", sweep.optima_files, remarks=sweep.remarks),
    Stage("limits", limits_stage, "what the limit costs", sweep.limits_files),
    Stage("fits", fits_stage, "polynomials over the radius", fits.files, remarks=fits.remarks),
    Stage("match", match_stage, "ratio, length and radius", match.files, remarks=match.remarks),
    View(matched_machine),
    Stage("flux_map", flux_map_stage, "per turn and metre", flux_map.files),
    View(transmission),
    Stage("winding", winding_stage, "wires, turns, connection, length", winding.files, remarks=winding.remarks),
    View(driven_machine),
    Stage("drive", drive_stage, "over speed, current and voltage", drive.files),
    View(braking_demand),
    Stage("braking", braking_stage, "shorted and controlled, over speed", braking.files, remarks=braking.remarks),
    Stage("gap_stress", gap_stress_stage, "waves, cogging, ripple, magnetic pull", gap_stress.files),
    View(rotor_duty),
    Stage("mechanics", mechanics_stage, "magnets, rotor, shafts, bearings", mechanics.files, remarks=mechanics.remarks),
    View(built_machine),
    Stage("heat", heat_stage, "what the temperatures allow", heat.files, remarks=heat.remarks),
    Stage("fields", fields_stage, "in the null position", fields.files),
    Stage("outcome", outcome_stage, "what holds, what would help", outcome.files, remarks=outcome.remarks),
    View(stated_tolerances),
    Stage("tolerances", tolerances_stage, "which one to buy", tolerances.files, remarks=tolerances.remarks),
    Stage("uncertainty", uncertainty_stage, "of the headline numbers", uncertainty.files),
    Stage("optimise", optimise_stage, "all stages at once", optimise.files, on_request=True, remarks=optimise.remarks),
)


def graph_of(study: Study, learned: Learned = NOTHING_LEARNED) -> Graph:
    """The graph of a study; learned: what a bench has taught about its machines."""
    return Graph(_nodes(study, learned), _sections(study), REFUSALS)


def graph_of_second_design(study: Study, learned: Learned, first: FirstDesign) -> Graph:
    """The graph of a study that is designed again, with what each lesson costs the first design."""

    def given(study: Study) -> FirstDesign:
        return first

    costs = Stage("lessons", lesson_costs_stage, "what each lesson costs", learned_report.files)
    nodes = (*_nodes(study, learned), Source(given), costs)
    return Graph(nodes, (learned_report.section, *_sections(study)), REFUSALS)


def _nodes(study: Study, learned: Learned) -> tuple[Node, ...]:
    driven, searched = drives(study), searches_linkage(study)

    def given(study: Study) -> Learned:
        return learned

    return (
        Source(given),
        *(Source(function) for function in _SOURCES),
        *(View(function) for function in _AS_LEARNED),
        *(_VEHICLE if driven else _STATED),
        *(_SEARCHED if searched else (Source(stated_linkage),)),
        *_MACHINE,
        *(_MAGNETS if _has_grade(study) else ()),
        *(_LOSSES if _has_loss_data(study) else _NO_LOSSES),
        *(_ENERGY if driven and _has_loss_data(study) else ()),
        *(_BY_ROAD if _searches_on_road(study) else (Source(requirement_aims),)),
        Stage("package", package_stage, "what parts are ordered by", package.files),
        View(datasheet.data_sheet),
        View(length_by_density if rates_by_density(study) else length_by_temperature),
        *(_GEARS if study.match.gearbox_stages else (View(direct_drive),)),
    )


def _has_loss_data(study: Study) -> bool:
    """Whether the steel has loss data of its own or a stand-in; without them losses are refused when asked for."""
    try:
        loss_law(loss_inputs(study))
    except LossError:
        return False
    return True


def _searches_on_road(study: Study) -> bool:
    """Without loss data there is no ride with losses; the search refuses to begin then, whatever it is for."""
    return judges_by_road(study) and _has_loss_data(study)


def _has_grade(study: Study) -> bool:
    """Whether the study says whose knee its magnets have; without it they are not held against demagnetisation."""
    return study.materials.magnet_grade is not None


def _sections(study: Study) -> tuple[Function, ...]:
    """Of the report, in reading order."""
    driven = drives(study)
    return (
        datasheet.section,
        outcome.section,
        requirements.section if driven else requirements.stated_section,
        *_linkage_sections(study),
        fields.machine,
        sweep.section,
        fits.section,
        match.section,
        fields.matched,
        flux_map.section,
        gap_stress.section,
        gearbox.section,
        winding.section,
        drive.section,
        braking.section,
        *((magnets.section,) if _has_grade(study) else ()),
        mechanics.section,
        losses.section,
        heat.section,
        tolerances.section,
        uncertainty.section,
        package.section,
        *((ride.section,) if driven else ()),
        *((energy.section,) if driven and _has_loss_data(study) else ()),
    )


def _linkage_sections(study: Study) -> tuple[Function, ...]:
    """None for a load on the shaft."""
    if study.linkage is None:
        return ()
    return (linkage.section if searches_linkage(study) else linkage.stated_section,)
