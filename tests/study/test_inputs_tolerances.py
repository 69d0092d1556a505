"""What a study says of its tolerances, and what counts where it says nothing."""

import pytest

from geometry.family import MatchedMachine
from study.errors import StudyError
from study.inputs_field import field_case
from study.inputs_mechanics import mechanics_inputs
from study.inputs_tolerances import tolerances
from study.read import STUDIES, read_study
from units import MILLIMETRE


def of(name, *stated):
    study = read_study(name, [f"tolerances.{text}" for text in stated])
    case = field_case(study)
    return tolerances(study, MatchedMachine(case.family.reference), case, mechanics_inputs(study))


@pytest.mark.parametrize("name", sorted(file.stem for file in STUDIES.glob("*.toml")))
def test_no_shipped_study_needs_to_say_anything(name):
    found = of(name)
    assert len({one.name for one in found.deviations}) == 15 and all(one.half_width > 0 for one in found.deviations)
    assert found.eccentricity == 0.2


def test_diameters_are_halved_and_shares_are_of_the_magnet():
    found = {one.name: one.half_width for one in of("motorcycle").deviations}
    assert found["bore radius"] == pytest.approx(39e-6 / 4, rel=0.01)  # IT8 of 32.4 mm, ISO 286-1 Table 1
    assert found["remanence"] == pytest.approx(0.03 * 1.3) and found["magnet length"] == 0.05 * MILLIMETRE


def test_everything_can_be_stated():
    stated = of("motorcycle", "bore_diameter_mm=0.02", "magnet_width_mm=0.1", "shoe_depth_mm=0.03",
                "remanence_percent=1.0", "wire_diameter_percent=2.0", "magnet_scatter_percent=0.5",
                "magnet_position_mm=0.05")  # fmt: skip
    found = {one.name: one.half_width for one in stated.deviations}
    assert found["bore radius"] == pytest.approx(0.01 * MILLIMETRE)
    assert found["magnet arc"] == pytest.approx(0.1 * MILLIMETRE)
    assert found["shoe depth d1"] == found["shoe depth d2"] == pytest.approx(0.03 * MILLIMETRE)
    assert found["remanence"] == pytest.approx(0.013) and found["wire diameter"] == pytest.approx(0.02)
    assert stated.scatter.remanence == pytest.approx(0.0065)
    assert stated.scatter.position == pytest.approx(0.05 / 13.2)  # rad, on the core of the rotor


def test_no_tolerance_is_nought():
    with pytest.raises(StudyError, match="tooth_width_mm = 0.0 is outside the allowed range"):
        of("motorcycle", "tooth_width_mm=0.0")
