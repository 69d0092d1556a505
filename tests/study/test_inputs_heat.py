"""What a study says about its temperatures, and what counts where it says nothing."""

import pytest

from materials.magnet_grade import load_grade
from study.inputs_heat import heat_inputs, warming_magnet
from study.read import STUDIES, read_study
from thermal.air import GivenFilm, StillAir
from thermal.cooling import Cooling, HeatLimits


def test_a_study_that_says_nothing_has_the_defaults_of_the_room():
    found = heat_inputs(read_study("motorcycle"))
    assert found.cooling == Cooling()
    assert found.limits == HeatLimits(155.0, 120.0)
    assert found.winding_temperature == 20.0 and found.conductor.temperature_coefficient == 0.00393


def test_what_a_study_states_counts_in_si():
    said = {"ambient_temperature_degC": "60.0", "slot_liner_mm": "0.4",
            "slot_liner_conductivity_W_per_mK": "0.2", "slot_filler_conductivity_W_per_mK": "0.6",
            "casing_gap_mm": "0.01", "magnet_temperature_max_degC": "150.0", "mount_conductance_W_per_K": "2.5",
            "remanence_temperature_coefficient_per_K": "-0.0012", "emissivity": "0.3"}  # fmt: skip
    winding = 'winding_selection.insulation_class="H"'
    study = read_study("pump", [*(f"thermal.{key}={value}" for key, value in said.items()), winding])
    found = heat_inputs(study)
    cooling = found.cooling
    assert (cooling.ambient, cooling.mount, cooling.filler_conductivity) == (60.0, 2.5, 0.6)
    assert (cooling.liner.thickness, cooling.liner.conductivity) == pytest.approx((0.4e-3, 0.2))
    assert cooling.casing_gap == pytest.approx(1e-5) and cooling.film == StillAir(0.3)
    assert found.limits == HeatLimits(180.0, 150.0)
    assert warming_magnet(study).remanence_share(120.0) == pytest.approx(0.88)
    assert found.winding_temperature == 100.0


def test_magnets_warm_up_as_their_grade_does(tmp_path):
    """Also where what the field has is the remanence of the grade at another temperature."""
    grade, text = load_grade("N42UH"), (STUDIES / "pump.toml").read_text(encoding="utf-8")
    magnet = warming_magnet(read_study("pump"))
    assert (magnet.temperature_coefficient, magnet.reference_temperature) == (grade.remanence_coefficient, 20.0)
    (tmp_path / "warm.toml").write_text(text.replace("remanence_T = 1.3", "magnet_temperature_degC = 80.0"))
    warm = read_study(tmp_path / "warm.toml")
    kept = warming_magnet(warm).remanence_share(120.0)
    assert kept == pytest.approx(grade.remanence_at(120.0) / grade.remanence_at(80.0))


def test_magnets_may_become_as_warm_as_they_are_held_against_demagnetisation():
    assert heat_inputs(read_study("pump", ["magnets.hot_temperature_degC=100.0"])).limits.magnets == 100.0


def test_a_stated_film_takes_the_place_of_still_air():
    assert heat_inputs(read_study("pump", ["thermal.film_W_per_m2K=80.0"])).cooling.film == GivenFilm(80.0)
