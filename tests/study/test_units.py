"""The one table of units holds together, and every key of a study is read by it."""

from collections import Counter

import pytest

from study.schema import Study
from study.sentences import section_class
from units import FACTORS, QUANTITIES, converted, drawn, same_quantity, split_unit, to_si, written

# Keys without a unit that have been looked at: numbers of things, ratios, weights and exponents. A key that is missing
# here either lacks its unit or has one that the table does not know.
PURE_NUMBERS = set(
    """
    machine.slots machine.poles machine.shoe_depth_fraction machine.shoe_aspect_ratio machine.magnet_arc_fraction
    machine.stacking_factor mechanics.notch_factor mechanics.fatigue_safety mechanics.peak_load_cycles
    thermal.emissivity tolerances.recoil_permeability
    materials.recoil_permeability winding.layers winding.packing_factor winding.coil_pitch
    mesh.gap_edges_per_revolution mesh.gap_layers mesh.elements_across_tooth
    variables.magnet_arc_fraction
    sweep.slots sweep.poles sweep.back_iron_fraction_min sweep.back_iron_fraction_max sweep.back_iron_steps
    sweep.rotor_radius_fraction_min sweep.rotor_radius_fraction_max sweep.rotor_radius_steps
    motorcycle.front_weight_fraction motorcycle.rear_motion_ratio ride.road_seeds
    linkage_search.ratio_weight linkage_search.seeds linkage_search.population linkage_search.generations
    match.weight_inertia match.weight_radius match.chosen_slots match.chosen_poles match.chosen_gear_ratio
    match.gearbox_stages
    match.gear_ring_diameter_fraction
    match.gear_overload_factor match.gear_contact_ratio_factor match.gear_poisson_ratio
    prices.lamination prices.magnet prices.copper prices.shaft
    winding_selection.packing_tolerance winding_selection.enamel_grade winding_selection.parallel_paths
    winding_selection.insulated_fill_max winding_selection.delta_circulating_loss_max flux_map.angles flux_map.currents
    gearbox.ratio_tolerance gearbox.planets gearbox.accuracy_grade gearbox.application_factor
    gearbox.friction_coefficient gearbox.safety_flank gearbox.safety_root gearbox.safety_static_flank
    gearbox.safety_static_root gearbox.planet_bore_fraction gearbox.flange_fraction gearbox.printed_teeth
    gearbox.printed_shifts printed_actuator.gearbox_ratio
    mechanics.overspeed_factor mechanics.glue_safety mechanics.sleeve_safety mechanics.yield_safety
    mechanics.critical_speed_factor mechanics.eccentricity_fraction
    actuator.loop_proportional
    """.split()
)


def numbers():
    """Every key that takes a number, as ``section.key``."""
    for name in Study.model_fields:
        for key in section_class(name).model_fields:
            if section_class(name).quantity(key) is not None:
                yield f"{name}.{key}"


def test_no_unit_stands_in_two_rows():
    seen = Counter(unit for row in QUANTITIES for unit in row)
    assert [unit for unit, times in seen.items() if times > 1] == []


def test_every_row_has_the_unit_used_inside():
    assert [row for row in QUANTITIES if 1.0 not in row.values() and set(row) != {"percent"}] == []


@pytest.mark.parametrize("unit", FACTORS)
def test_to_si_and_back_is_the_same_number(unit):
    quantity, value = to_si(f"of_something_{unit}", 3.0)
    assert quantity == "of_something" and value == pytest.approx(3.0 * FACTORS[unit])
    assert drawn({quantity: value}, [f"of_something_{unit}"]) == {f"of_something_{unit}": pytest.approx(3.0)}


@pytest.mark.parametrize("row", QUANTITIES, ids=lambda row: next(iter(row)))
def test_units_of_one_quantity_convert_back(row):
    for unit in row:
        for other in row:
            assert same_quantity(unit, other)
            if row[unit] is None or row[other] is None:
                assert converted(3.0, unit, other) is None
            else:
                assert converted(converted(3.0, unit, other), other, unit) == pytest.approx(3.0)


@pytest.mark.parametrize("key", list(numbers()))
def test_every_key_has_a_unit_of_the_table_or_is_a_pure_number(key):
    unit = split_unit(key.partition(".")[2])[1]
    assert (unit in FACTORS) != (key in PURE_NUMBERS), f"{key} has the unit {unit!r}"


def test_no_pure_number_is_listed_that_no_study_has():
    assert PURE_NUMBERS <= set(numbers()) | {"winding.layers"}


def test_a_section_turns_itself_into_si():
    section = section_class("linkage").model_validate(
        {"ratio_nominal_mm_per_rad": 170.0, "ratio_max_mm_per_rad": 175.0, "hardpoint_a_mm": [218.0, 0.9]}
    )
    assert section.si.ratio_nominal == pytest.approx(0.170)
    assert section.si.hardpoint_a == pytest.approx((0.218, 0.9e-3)) and section.si.hardpoint_c is None


def test_texts_and_switches_stay_as_they_are():
    assert to_si("material", "steel") == ("material", "steel")
    assert to_si("airgap_mm", None) == ("airgap", None) and to_si("is_long_mm", True) == ("is_long", True)


def test_the_unit_is_the_longest_that_fits():
    assert split_unit("airgap_mm") == ("airgap", "mm")
    assert split_unit("ratio_max_mm_per_rad") == ("ratio_max", "mm_per_rad")
    assert split_unit("packing_factor") == ("packing_factor", "")
    assert not same_quantity("mm", "kg") and converted(1.0, "degC", "K") is None


def test_units_as_people_write_them():
    units = "mm_per_rad", "A_per_mm2", "per_K", "percent_per_K", "kg_m2", "nOhm_m", ""
    assert [written(unit) for unit in units] == ["mm/rad", "A/mm²", "1/K", "%/K", "kg m²", "nΩ m", ""]
