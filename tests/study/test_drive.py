"""Studies of a load on a shaft: units, a direct drive, which sections go together."""

import re
from math import inf, pi

import pytest

from drivetrain.output import Shaft, Wheel
from study.errors import StudyError
from study.inputs_drive import friction_at, largest_equivalent_mass, output
from study.inputs_gearbox import gear_inputs
from study.inputs_linkage import stated_linkage
from study.inputs_outcome import outcome_inputs
from study.inputs_vehicle import stated_requirements
from study.read import STUDIES, read_study

RPM = pi / 30


def right(name):
    """A study without its comments, which name keys and sections too."""
    return re.sub(r"[ ]+#.*", "", (STUDIES / f"{name}.toml").read_text(encoding="utf-8"))


def refusal(tmp_path, text):
    path = tmp_path / "wrong.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(StudyError) as caught:
        read_study(path)
    said = str(caught.value)
    assert said.count("\n") == 0 and said.endswith("."), said
    return said


def test_torque_and_speed_stand_where_force_and_velocity_do():
    required = stated_requirements(read_study("robot_joint"))
    assert required.force_peak == 80 and required.force_rms == 30 and required.maximum_damping == 0
    assert required.velocity_peak == pytest.approx(30 * RPM)
    assert required.power_peak == pytest.approx(60 * 25 * RPM)


def test_the_linkage_of_a_shaft_is_one():
    joint, pump = (stated_linkage(read_study(name)) for name in ("robot_joint", "pump"))
    assert joint.ratio_nominal == joint.ratio_max == pump.ratio_max == 1.0
    assert joint.envelope_radius_max == pytest.approx(0.05) and pump.envelope_radius_max is None


def test_words_inertia_and_friction_follow_the_output():
    joint, bike = read_study("robot_joint"), read_study("motorcycle")
    assert (output(joint), output(bike)) == (Shaft(), Wheel())
    assert (largest_equivalent_mass(joint), largest_equivalent_mass(bike)) == (0.08, 15.0)
    assert (friction_at(joint).viscous, friction_at(bike).viscous) == (2.0, 250.0)
    assert gear_inputs(joint).cost.equivalent_mass == 0.08
    assert (outcome_inputs(joint).load_inertia, outcome_inputs(bike).load_inertia) == (0.8, None)


def test_what_turns_on_swings_without_end(tmp_path):
    path = tmp_path / "on.toml"
    path.write_text(right("robot_joint").replace("swing_deg = 90.0\n", ""), encoding="utf-8")
    assert gear_inputs(read_study(path)).swing == inf


def test_a_direct_drive_states_no_gears():
    pump = read_study("pump")
    assert pump.gearbox is None and pump.match.gearbox_stages == 0 and pump.match.gear_poisson_ratio is None


@pytest.mark.parametrize(
    ("study", "old", "new", "words"),
    [
        ("pump", "gearbox_stages = 0", "gearbox_stages = 1", "match.gearbox_stages = 1 needs the section [gearbox]"),
        ("robot_joint", "gear_poisson_ratio = 0.3\n", "", "needs match.gear_poisson_ratio"),
        ("pump", "[flux_map]", "[linkage]\nratio_nominal_mm_per_rad = 100.0\nratio_max_mm_per_rad = 100.0\n[flux_map]",
         "[drive] stands in the place of [linkage]"),
        ("automotive", "[linkage]\nratio_nominal_mm_per_rad = 115.0\nratio_max_mm_per_rad = 115.0\n", "",
         "or state a load on a shaft in [drive]"),
        ("automotive", "equivalent_mass_max_kg = 15.0\n", "", "match.equivalent_mass_max_kg is missing"),
        ("automotive", "coulomb_friction_N = 0.0\n", "", "assembly.coulomb_friction_N is missing"),
        ("pump", "inertia_max_kg_m2 = 1e-4\n", "", "drive.inertia_max_kg_m2 is missing"),
    ],
)  # fmt: skip
def test_what_does_not_go_together_is_one_sentence(tmp_path, study, old, new, words):
    text = right(study)
    assert text.count(old) == 1
    assert words in refusal(tmp_path, text.replace(old, new))
