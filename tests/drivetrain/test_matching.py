"""The match as a stage: against what the cylinder of steel gave before, choices, refusals and what they advise."""

import re
from contextlib import contextmanager
from dataclasses import replace

import numpy as np
import pytest

from drivetrain.masses import DrawnParts, PartMaterials, SteelCylinder
from drivetrain.match import (
    CostScales,
    CostWeights,
    DampingEnforced,
    DampingReported,
    MatchError,
    MatchLimits,
    linear_overload,
)
from drivetrain.matching import (
    ChosenByHand,
    FieldOverload,
    LinearOverload,
    Matcher,
    MatchInputs,
    PrintedMachine,
    StatedDemands,
    match_stage,
    matched_machine,
    sized_section,
    solved_section,
)
from drivetrain.output import Shaft, Wheel
from drivetrain.planetary import NITRIDED_STEEL
from drivetrain.requirements import Linkage, Requirements
from study.schema import Study
from study.sentences import section_class
from tests.drivetrain.fitted_machines import CASE, NINE, TWELVE, MotorcycleFits
from units import MILLIMETRE

# What runs of the motorcycle and its front gave for these numbers.
REQUIRED = Requirements(
    maximum_damping=40e3, force_rms=313.6556405622691, velocity_rms=0.10120411597026306, power_rms=41.366341241628284,
    velocity_peak=3.575922051575109, force_peak=2698.352878477155, velocity_at_force_peak=1.6363049510371732,
    power_peak=4756.803850655061, force_at_power_peak=1416.0602748786423, velocity_at_power_peak=3.35918176298161,
)  # fmt: skip
LINKAGE = Linkage(161.00992488670434e-3, 167.12635574262262e-3)
STATED = StatedDemands(
    replace(REQUIRED, force_rms=300.0, velocity_rms=0.1, velocity_peak=3.4, force_peak=2614.0), Linkage(0.170, 0.175)
)
INPUTS = MatchInputs(
    combinations=(NINE, TWELVE),
    limits=MatchLimits(70 * MILLIMETRE, 2618.0),
    scales=CostScales(4.0, 15.0, 50 * MILLIMETRE),
    weights=CostWeights(0.5, 0.2),
    gear_stages=2,
    planets=3,
    gear_laws=NITRIDED_STEEL,
    resistivity=1.68e-8,
    overload=FieldOverload(),
    damping=DampingReported(),
    masses=PartMaterials(7650.0, 7500.0, 8890.0, 7800.0, 0.95),
    by_hand=ChosenByHand(12, 42.5 * MILLIMETRE),
    printed=PrintedMachine("thesis", 50.0, 98.2e-6),
)
FREE = replace(INPUTS, by_hand=ChosenByHand())
ONLY_TWELVE = replace(INPUTS, combinations=(TWELVE,))


def stage(inputs=INPUTS, requirements=REQUIRED, stated=None, fits=MotorcycleFits(), output=Wheel()):
    return match_stage(CASE, fits, requirements, LINKAGE, stated, inputs, output)


@contextmanager
def no_field():
    """Torques of the thesis's machine in the place of field solutions, and few radii."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("drivetrain.matching.RADII", 8)
        torques = {CASE.nominal_density: 55.6, CASE.overload_density: 145.6}
        patch.setattr("drivetrain.matching._mean_torque", lambda case, model, density: torques[density])
        yield


@pytest.fixture
def quick():
    with no_field():
        yield


@pytest.fixture(scope="module")
def found():
    with no_field():
        return stage(stated=STATED)


def matcher(inputs=INPUTS, masses=SteelCylinder(7800.0)):
    return Matcher(CASE, MotorcycleFits(), REQUIRED, LINKAGE, inputs, masses)


# ---- numbers --------------------------------------------------------------------------------------------------------


def test_the_cylinder_of_steel_gives_what_it_gave():
    one = matcher()
    found = one.match(one.section(TWELVE, FieldOverload(), 42.5e-3))
    assert found.transmission_ratio == pytest.approx(1.7954143004371468e-3, rel=1e-6)
    assert found.active_length == pytest.approx(37.53522753647196e-3, rel=1e-6)
    assert found.cost.total == pytest.approx(0.6155306885007497, rel=1e-9)
    assert found.cost.mass == pytest.approx(2.1078259115473803, rel=1e-6)
    assert found.cost.equivalent_mass == pytest.approx(5.461573486719814, rel=1e-6)


def test_drawn_parts_are_lighter_and_so_the_machine_longer(found):
    """A third less motor for the same length: the optimum takes a slower and longer machine, and weighs less."""
    chosen = found.chosen
    assert chosen.transmission_ratio == pytest.approx(2.242e-3, rel=2e-3)
    assert chosen.active_length == pytest.approx(46.87e-3, rel=2e-3)
    assert chosen.cost.motor_mass == pytest.approx(found.parts.total, rel=1e-12)
    assert found.parts.total / found.cylinder_mass == pytest.approx(0.678, abs=0.005)
    assert chosen.cost.motor_equivalent_mass == pytest.approx(
        found.parts.rotor_inertia / chosen.transmission_ratio**2, rel=1e-12
    )


def test_the_printed_machine_is_matched_as_a_cylinder_with_the_stated_demands(found):
    """As under the stated demands before: 2.266 mm/rad and 35.54 mm."""
    printed = found.printed.match
    assert printed.transmission_ratio == pytest.approx(2.26606e-3, rel=1e-5)
    assert printed.active_length == pytest.approx(35.5409e-3, rel=1e-5)
    assert printed.section.torque_per_length_overload == pytest.approx(linear_overload(50.0, 6.0, 20.0), rel=1e-12)
    assert found.reference_cylinder.match.active_length == pytest.approx(40.35e-3, rel=1e-3)
    assert found.reference.match.active_length > found.reference_cylinder.match.active_length


def test_the_reference_machine_has_its_torques_from_the_field():
    section = solved_section(CASE, CASE.family.reference)
    assert section.torque_per_length_nominal == pytest.approx(55.6, abs=0.3)
    assert section.torque_per_length_overload == pytest.approx(145.6, abs=0.8)
    assert section.coil_side_area == pytest.approx(100.4e-6, rel=2e-3)


# ---- choice ---------------------------------------------------------------------------------------------------------


def test_the_designer_chooses_and_the_least_cost_is_said(found):
    assert matched_machine(found).machine == found.machine == found.chosen.section.machine
    assert found.machine.stator_outer_radius == pytest.approx(42.5e-3) and found.machine.slots == 12
    assert "chosen in the study file (12 slots, 10 poles, 85 mm" in found.reason
    assert "belongs to 12 slots, 10 poles and 70.0 mm" in found.reason
    assert "add smaller diameters to sweep.stator_diameters_mm" in found.at_edge
    assert found.at_edge in [note.words(Wheel()) for note in found.notes]


def test_without_a_choice_the_least_cost_decides(quick):
    found = stage(FREE)
    costs = [np.nanmin(one.over_radius.cost) for one in found.over_radius if one.overload == FieldOverload()]
    assert (
        found.chosen.cost.total <= min(costs) and found.reason == "least cost over all radii and slot-pole combinations"
    )
    assert found.stated is None


def test_every_slot_count_is_matched_with_both_laws(found):
    assert [(one.combination, one.overload) for one in found.over_radius] == [
        (NINE, FieldOverload()), (NINE, LinearOverload()), (TWELVE, FieldOverload()), (TWELVE, LinearOverload()),
    ]  # fmt: skip
    field, linear = found.over_radius[2:]
    assert (linear.over_radius.active_length < field.over_radius.active_length).all()


def test_the_choice_rests_on_the_overload_law_of_the_study(quick):
    linear, field = (stage(replace(ONLY_TWELVE, overload=law)).chosen for law in (LinearOverload(), FieldOverload()))
    assert linear.active_length < 0.9 * field.active_length


def test_the_stated_demands_stand_beside(found):
    assert found.stated.match.section == found.chosen.section
    assert found.stated.match.active_length != pytest.approx(found.chosen.active_length, rel=1e-3)


def test_the_curves_pass_through_the_optimum_and_stop_before_the_planets_vanish(found):
    curves, chosen = found.curves, found.chosen
    assert np.interp(chosen.transmission_ratio, curves.ratio, curves.cost) == pytest.approx(chosen.cost.total, rel=1e-3)
    one = replace(FREE, combinations=(TWELVE,), gear_stages=6, printed=None)  # vanish at 161 / 64 = 2.5 mm/rad
    few = Matcher(CASE, MotorcycleFits(), REQUIRED, LINKAGE, one, DrawnParts(INPUTS.masses, 0.3))
    match = few.match(few.section(TWELVE, FieldOverload(), 42.5e-3))
    assert few.curves(match).ratio.max() < LINKAGE.ratio_nominal / 2**6


# ---- end turns ------------------------------------------------------------------------------------------------------


def test_a_distributed_winding_has_its_own_end_turns():
    """12 slots and 4 poles: a pitch of three slots, about 72 mm of end turn where a tooth coil has 16."""
    machine = CASE.family.reference
    tooth = sized_section(CASE, machine, 100e-6, 50.0, 150.0)
    distributed = sized_section(CASE, replace(machine, pole_pairs=2), 100e-6, 50.0, 150.0)
    assert (tooth.coil_pitch, distributed.coil_pitch) == (1, 3)
    assert tooth.end_turn_length == pytest.approx(16.3e-3, abs=0.1e-3)
    assert distributed.end_turn_length == pytest.approx(71.3e-3, abs=0.1e-3)
    drawn = DrawnParts(INPUTS.masses, 0.3)
    assert drawn.parts(distributed, 36e-3).copper > 2 * drawn.parts(tooth, 36e-3).copper


# ---- refusals -------------------------------------------------------------------------------------------------------


def refusal(inputs=FREE, requirements=REQUIRED, **changes):
    with no_field(), pytest.raises(MatchError) as caught:
        stage(inputs, requirements, **changes)
    said = str(caught.value)
    for section, key in re.findall(r"\b([a-z_]+)\.([a-z]\w+)", said):
        assert section in Study.model_fields and key in section_class(section).model_fields, f"{section}.{key}"
    return said


def test_a_force_that_no_machine_has():
    said = refusal(requirements=replace(REQUIRED, force_peak=99_999.0))
    assert (
        "no slot-pole combination of sweep.slots and sweep.poles has a match: 9 slots, 10 poles: " in said
        and "overload force needs" in said
    )
    assert "match.length_max_mm" in said and "match.speed_max_rad_per_s" in said


def test_a_torque_that_no_machine_has_is_refused_in_the_words_of_a_shaft():
    said = refusal(requirements=replace(REQUIRED, force_peak=99_999.0), output=Shaft())
    assert "overload torque needs" in said and "of 1:" in said and "mm/rad" not in said


def test_a_machine_chosen_by_hand_that_has_no_match():
    """3900 N is about what 12 slots reach at 115 mm, but not at 70 mm."""
    by_hand = replace(
        ONLY_TWELVE, by_hand=ChosenByHand(12, 35 * MILLIMETRE), limits=MatchLimits(40 * MILLIMETRE, 2618.0)
    )
    said = refusal(by_hand, replace(REQUIRED, force_peak=6000.0))
    assert "the machine chosen in the study file (12 slots, 10 poles, 70 mm) has no match: overload force needs" in said


def test_one_stage_that_cannot_be():
    said = refusal(replace(FREE, gear_stages=1))
    assert "set by the planet clearance" in said and "more match.gearbox_stages" in said


def test_more_stages_than_the_ratio_has_room_for():
    said = refusal(replace(FREE, gear_stages=6, limits=replace(FREE.limits, rotor_speed=1000.0)))
    assert "planets vanish" in said and "fewer gear stages (match.gearbox_stages)" in said


def test_a_choice_outside_the_sweep():
    said = refusal(replace(FREE, by_hand=ChosenByHand(15)))
    assert "match.chosen_slots = 15 is not among sweep.slots [9, 12]" in said
    said = refusal(replace(ONLY_TWELVE, by_hand=ChosenByHand(None, 30e-3)))
    assert "match.chosen_stator_diameter_mm = 60 lies outside the 70 to 115 mm of sweep.stator_diameters_mm" in said


def test_a_slot_count_without_usable_fits_leaves_the_others(quick):
    found = stage(FREE, fits=MotorcycleFits(refused=(NINE,)))
    assert found.machine.slots == 12 and "9 slots, 10 poles is refused" in found.over_radius[0].refusal.words(Wheel())
    assert "9 slots, 10 poles is refused" in refusal(fits=MotorcycleFits(refused=(NINE, TWELVE)))


def test_stated_demands_that_have_no_match_are_said(quick):
    hard = replace(STATED, requirements=replace(STATED.requirements, force_peak=50_000.0))
    found = stage(ONLY_TWELVE, stated=hard)
    assert found.stated.match is None and "overload force needs" in found.stated.refusal.words(Wheel())
    assert found.reference.match is None and found.chosen is not None


@pytest.mark.parametrize("damping", [DampingReported(), DampingEnforced()])
def test_no_damping_is_asked_for(quick, damping):
    found = stage(replace(ONLY_TWELVE, damping=damping), replace(REQUIRED, maximum_damping=0.0))
    assert found.chosen.binding.name(Wheel()) == "overload force" and found.chosen.notes == ()
    assert "regenerative damping" not in [one.name(Wheel()) for one in found.curves.lengths]


def test_planets_of_the_study_bound_the_ratio():
    """Eight planets clear each other below 3.24: two stages give 10.5, that is 15 mm/rad, too much for the length."""
    assert "planet clearance" in refusal(replace(FREE, planets=8))
