"""What a study says of the strength of its rotor, and what counts where it says nothing."""

import pytest

from materials.strength import GEAR_STEEL, MPA, SHAFT_STEEL, STEEL_SLEEVE
from mechanics.retention import Glue, Sleeve
from study.errors import StudyError
from study.inputs_mechanics import mechanics_inputs
from study.read import STUDIES, read_study

SLEEVE = tuple(f"mechanics.sleeve_{text}" for text in ("material=steel", "thickness_mm=0.3", "prestress_MPa=400.0"))


@pytest.mark.parametrize("name", sorted(file.stem for file in STUDIES.glob("*.toml")))
def test_no_shipped_study_needs_to_say_more_than_its_bearing(name):
    inputs = mechanics_inputs(read_study(name))
    assert inputs.retention == Glue(10 * MPA, 10 * MPA, 3.0)
    assert inputs.bearing.dynamic_capacity == 4550.0 and inputs.bearing.life == inputs.fatigue.life
    assert (inputs.shaft_steel, inputs.sun_steel) == (SHAFT_STEEL, GEAR_STEEL)
    assert (inputs.overspeed, inputs.critical_speed_factor, inputs.eccentricity) == (1.2, 1.25, 0.2)


def test_everything_can_be_stated():
    stated = ("overspeed_factor=1.5", "shaft_yield_MPa=400.0", "lamination_yield_MPa=450.0", "glue_safety=5.0",
              "bearing_capacity_kN=2.2", "bearing_life_h=100.0")  # fmt: skip
    inputs = mechanics_inputs(read_study("pump", [f"mechanics.{text}" for text in stated]))
    assert inputs.overspeed == 1.5 and inputs.shaft_steel.at(1.0) == 400 * MPA
    assert inputs.lamination_yield == 450 * MPA
    assert inputs.bearing.dynamic_capacity == 2200.0 and inputs.bearing.life == 360e3
    assert inputs.retention.safety == 5.0


def test_fatigue_has_the_life_of_the_gears_and_strengths_that_were_stated():
    assert mechanics_inputs(read_study("motorcycle")).fatigue.life == 750 * 3600
    texts = ["mechanics.shaft_yield_MPa=400.0", "mechanics.sun_tensile_MPa=900.0", "mechanics.notch_factor=3.0"]
    plain, stated = (mechanics_inputs(read_study("pump", some)).fatigue for some in ([], texts))
    assert plain.life == 20000 * 3600 and plain.shaft.at(10e-3) == 1100 * MPA and plain.notch == 2.0
    assert (stated.shaft.at(10e-3), stated.sun.at(10e-3), stated.notch) == (400 * MPA, 900 * MPA, 3.0)


def test_a_sleeve_takes_the_place_of_the_glue():
    inputs = mechanics_inputs(read_study("motorcycle", SLEEVE))
    assert inputs.retention == Sleeve(STEEL_SLEEVE, 0.3e-3, 400 * MPA, 1.2)


@pytest.mark.parametrize("missing", range(3))
def test_a_sleeve_is_described_whole(missing):
    with pytest.raises(StudyError, match=SLEEVE[missing].partition("=")[0].partition(".")[2]):
        read_study("motorcycle", [text for k, text in enumerate(SLEEVE) if k != missing])


def test_a_sleeve_fits_the_air_gap():
    with pytest.raises(StudyError, match="sleeve_thickness_mm = 0.5 fills machine.airgap_mm = 0.5"):
        read_study("motorcycle", (SLEEVE[0], "mechanics.sleeve_thickness_mm=0.5", SLEEVE[2]))


def test_a_life_needs_the_capacity_of_the_bearing(tmp_path):
    lines = (STUDIES / "pump.toml").read_text(encoding="utf-8").splitlines(keepends=True)
    path = tmp_path / "pump.toml"
    path.write_text("".join(line for line in lines if "bearing_capacity" not in line), encoding="utf-8")
    with pytest.raises(StudyError, match="bearing_life_h without bearing_capacity_kN"):
        read_study(path)
