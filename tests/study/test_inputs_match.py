"""What the match reads of a study, in SI."""

import pytest

from drivetrain.match import DampingEnforced, DampingReported
from drivetrain.matching import ChosenByHand, FieldOverload, LinearOverload
from geometry.family import Combination
from study.errors import StudyError
from study.inputs_match import match_inputs, part_materials, stated_demands, whole_search_inputs
from study.read import read_study


@pytest.fixture(scope="module")
def motorcycle():
    return read_study("motorcycle")


def test_inputs_of_the_motorcycle(motorcycle):
    found = match_inputs(motorcycle)
    assert found.combinations == (Combination(9, 10), Combination(12, 10))
    assert found.gear_stages == 2 and found.planets == 3
    assert (found.limits.active_length, found.limits.rotor_speed) == pytest.approx((70e-3, 2618.0))
    assert found.scales.stator_radius == pytest.approx(50e-3)
    assert found.by_hand.slots == 12 and found.by_hand.stator_outer_radius == pytest.approx(42.5e-3)
    assert found.gear_laws.contact_strength == pytest.approx(1.5e9)
    assert found.gear_laws.pressure_angle == pytest.approx(0.349066, rel=1e-5)
    assert found.printed.coil_side_area == pytest.approx(98.2e-6) and found.printed.torque_nominal == 50.0
    assert found.resistivity == pytest.approx(1.68e-8)  # at the temperature it is stated for
    assert (found.overload, found.damping) == (FieldOverload(), DampingReported())
    assert whole_search_inputs(motorcycle).loss_grade == "M235-35A"


def test_choices_are_objects():
    changed = read_study(
        "motorcycle",
        [
            "match.overload_torque=linear",
            "match.enforce_damping=true",
            "winding_selection.winding_temperature_degC=120",
        ],
    )
    found = match_inputs(changed)
    assert (found.overload, found.damping) == (LinearOverload(), DampingEnforced())
    assert found.resistivity == pytest.approx(1.68e-8 * (1 + 0.00393 * 100))


def test_a_study_without_a_choice_of_its_own():
    found = match_inputs(read_study("template"))
    assert found.by_hand == ChosenByHand() and found.by_hand.nothing and found.printed is None


def test_densities_have_one_home_each(motorcycle):
    found = part_materials(motorcycle)
    assert (found.lamination_density, found.magnet_density, found.copper_density) == (7650.0, 7500.0, 8890.0)
    assert found.shaft_density == motorcycle.match.steel_density_kg_per_m3 and found.stacking == 0.95


def test_stated_demands_stand_beside_those_of_a_vehicle(motorcycle):
    found = stated_demands(motorcycle)
    assert found.requirements.maximum_damping == pytest.approx(40e3) and found.requirements.force_peak == 2614.0
    assert found.linkage.ratio_max == pytest.approx(0.175) and found.linkage.envelope_radius_max == pytest.approx(0.06)
    assert stated_demands(read_study("automotive")) is None  # it states no requirements
    as_stated = read_study("motorcycle", ["chain.requirements=stated", "chain.linkage=stated"])
    assert stated_demands(as_stated) is None  # they are the ones that are met


@pytest.mark.parametrize("key", ["materials.lamination_density_kg_per_m3", "machine.stacking_factor"])
def test_an_older_study_is_told_what_to_add(tmp_path, key):
    text = open("studies/motorcycle.toml", encoding="utf-8").read()
    path = tmp_path / "older.toml"
    lines = [line for line in text.splitlines() if not line.startswith(key.partition(".")[2])]
    path.write_text("\n".join(lines), encoding="utf-8")
    with pytest.raises(StudyError, match=f"{key} is missing; add it under"):
        read_study(path)
