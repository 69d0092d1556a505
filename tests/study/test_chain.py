"""The design chain of a study: units, answers to a wrong vehicle, linkage or damper, which sections are needed."""

import re

import pytest

from drivetrain.linkage_choice import SmallestRatio
from study.chain import drives, rates_by_density, searches_linkage
from study.errors import StudyError
from study.inputs_linkage import installation_space, linkage_search, stated_linkage
from study.inputs_vehicle import requirements_beside, ride_case, stated_requirements
from study.read import STUDIES, read_study
from study.usable import check_study
from tests.vehicle import thesis
from units import DEGREE

FULL = (STUDIES / "motorcycle.toml").read_text(encoding="utf-8")


RIGHT = re.sub(r"[ ]+#.*", "", FULL)  # comments name keys and sections too


def changed(tmp_path, old, new):
    assert RIGHT.count(old) == 1, f"{old!r} must stand once in the study"
    path = tmp_path / "wrong.toml"
    path.write_text(RIGHT.replace(old, new), encoding="utf-8")
    return path


def refusal(path):
    with pytest.raises(StudyError) as caught:
        check_study(read_study(path))
    text = str(caught.value)
    assert text.count("\n") == 0 and text.endswith(".") and len(text) < 500, text
    return text


def test_the_motorcycle_is_that_of_the_thesis():
    case = ride_case(read_study("motorcycle"))
    assert case.vehicle == thesis.motorcycle() and len(case.overload) == 101
    assert [curve.name for curve in case.damping] == ["maximum", "minimum", "mixed"]
    assert all(curve.largest_damping <= 40e3 * (1 + 1e-9) for curve in case.damping)
    assert case.curves == thesis.motorcycle_damping() and case.maximum_damping == 40e3


def test_the_quarter_car_is_that_of_the_thesis():
    study = read_study("automotive")
    case = ride_case(study)
    assert case.vehicle == thesis.quarter_car() and case.overload == ()
    assert case.curves[:2] == thesis.quarter_car_damping(), "linear dampers, not the tables of the same name"
    assert drives(study) and not searches_linkage(study)


def test_the_stated_requirements_are_those_of_the_thesis():
    study = read_study("motorcycle")
    found = stated_requirements(study)
    assert requirements_beside(study).requirements == found
    for name, printed in thesis.TABLE_3_7.items():
        assert getattr(found, name) == pytest.approx(abs(printed), rel=1e-12), name


def test_a_study_without_requirements_states_none():
    study = read_study("automotive")
    assert requirements_beside(study) is None
    with pytest.raises(StudyError, match=r"section \[requirements\] is missing"):
        stated_requirements(study)


def test_no_regenerative_damping_may_be_asked_for(tmp_path):
    old = "[requirements]\nmaximum_damping_kNs_per_m = 40.0"
    found = stated_requirements(read_study(changed(tmp_path, old, old.replace("40.0", "0.0"))))
    assert found.maximum_damping == 0 and found.force_peak == 2614


def test_the_stated_linkage_has_its_printed_ratio():
    """Table 3.9 with the axle below the pivot: 170 mm/rad."""
    study = read_study("motorcycle")
    search = linkage_search(study)
    assert search.stated.motion([0.0]).transmission_ratio[0] == pytest.approx(0.170, abs=5e-4)
    assert search.problem.travel.lowest == pytest.approx(-0.020)
    assert search.problem.limits.angle_window == pytest.approx(50 * DEGREE)
    assert search.rule == SmallestRatio(1.116) and search.settings.seeds == (1, 2, 3, 4)
    assert installation_space(study).radius_max == pytest.approx(0.060)


def test_ratios_may_be_stated_without_hardpoints():
    found = stated_linkage(read_study("automotive"))
    assert (found.ratio_nominal, found.ratio_max, found.envelope_radius_max) == (0.115, 0.115, None)


WRONG = {
    "negative mass": ("sprung_mass_kg = 227.0", "sprung_mass_kg = -227.0", ["motorcycle.sprung_mass_kg = -227"]),
    "obstacle without amplitude": ("-10, 10, 20", "-10, 0, 20", ["obstacles.amplitudes_mm", "without amplitude"]),
    "two damper curves": ('maximum = "rear_maximum"', 'maximum = "x"\nmaximum_kNs_per_m = 2.0', ["found both"]),
    "no damper curve": ('minimum = "rear_minimum"', "", ["[dampers]", "minimum", "found neither"]),
    "unknown damper table": ('"rear_maximum"', '"rear_maximal"', ["rear_maximal", "cannot be read"]),
    "stops on the wrong side": ("stop_bump_mm = -140.0", "stop_bump_mm = 140.0", ["motorcycle.stop_bump_mm = 140"]),
    "no ride": ("[ride]", "[rides]", ["[rides]"]),
    "box turned over": ("c_max_mm = [50.0, 140.0]", "c_max_mm = [30.0, 140.0]", ["box of hardpoint C"]),
    "rule without its number": ("angles_worst_rad2 = 1.116", "#", ["smallest_ratio", "without angles_worst_rad2"]),
    "hardpoint missing": ("hardpoint_b_min_mm = [0.0, 0.0]", "#", ["linkage.hardpoint_b_min_mm"]),
    "unknown feed": ('requirements = "vehicle"', 'requirements = "car"', ['"vehicle" or "stated"']),
    "unit of a stiffness": ("rear_spring_stiffness_kN_per_m = 170.0", "rear_spring_stiffness_N_per_m = 170000.0",
                            ["write rear_spring_stiffness_kN_per_m = 170"]),
}  # fmt: skip


@pytest.mark.parametrize("old, new, named", WRONG.values(), ids=WRONG.keys())
def test_one_wrong_thing_gives_one_sentence(tmp_path, old, new, named):
    text = refusal(changed(tmp_path, old, new))
    assert all(part in text for part in named), text


def test_a_damper_table_that_is_not_rising_names_the_velocities(tmp_path):
    (tmp_path / "mine.csv").write_text("velocity_m_per_s,force_N\n-1,-500\n0,0\n0.5,200\n0.4,300\n1,500\n")
    text = refusal(changed(tmp_path, '"rear_maximum"', '"mine.csv"'))
    assert "velocities must rise" in text and "0.4 m/s after 0.5 m/s" in text


def test_two_vehicles_and_none(tmp_path):
    car = "[quarter_car]\nsprung_mass_kg = 417.0\nunsprung_mass_kg = 40.0\n"
    car += "spring_stiffness_kN_per_m = 23.0\ntyre_stiffness_kN_per_m = 126.0\n\n[dampers]"
    assert "found [motorcycle] and [quarter_car]" in refusal(changed(tmp_path, "[dampers]", car))
    path = tmp_path / "none.toml"
    start, end = RIGHT.index("\n[motorcycle]"), RIGHT.index("\n[dampers]")
    path.write_text(RIGHT[:start] + RIGHT[end:], encoding="utf-8")
    assert "needs one of [motorcycle] and [quarter_car], found neither" in refusal(path)


def test_stated_requirements_need_their_section(tmp_path):
    start, end = RIGHT.index("\n[requirements]"), RIGHT.index("\n[linkage]")
    path = tmp_path / "none.toml"
    path.write_text(
        (RIGHT[:start] + RIGHT[end:]).replace('requirements = "vehicle"', 'requirements = "stated"'), encoding="utf-8"
    )
    assert "section [requirements] is missing" in refusal(path)


def test_without_a_chain_everything_is_as_stated(tmp_path):
    start, end = RIGHT.index("\n[chain]"), RIGHT.index("\n[motorcycle]")
    path = tmp_path / "plain.toml"
    path.write_text(RIGHT[:start] + RIGHT[end:], encoding="utf-8")
    study = read_study(path)
    assert not drives(study) and not searches_linkage(study)


def test_a_study_may_rate_by_its_current_density(tmp_path):
    path = tmp_path / "dense.toml"
    path.write_text(RIGHT + '\n[thermal]\ncontinuous_length = "density"\n', encoding="utf-8")
    assert rates_by_density(read_study(path)) and not rates_by_density(read_study("motorcycle"))
