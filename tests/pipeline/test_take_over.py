"""``airgap take-over``: a design of the search as a study, whose match gives the design's numbers again."""

from dataclasses import replace

import numpy as np
import pytest

import pipeline.take_over_command as command
from drivetrain.match import MatchError
from drivetrain.matching import match_stage
from drivetrain.output import Wheel
from drivetrain.whole_design import WholeDesign
from drivetrain.whole_search import SearchRange
from pipeline.results import Results
from report.optimise import bound_hits, remarks
from study.errors import StudyError
from study.inputs_match import match_inputs
from study.read import STUDIES, read_study
from tests.drivetrain.fitted_machines import CASE, TWELVE, MotorcycleFits
from tests.drivetrain.test_matching import LINKAGE, REQUIRED, no_field
from tests.drivetrain.test_whole_search import search
from units import MILLIMETRE

NUMBER = 6  # least mass with the damping as required, all else free


@pytest.fixture(autouse=True)
def few_radii(monkeypatch):
    monkeypatch.setattr("drivetrain.matching.RADII", 5)


@pytest.fixture(scope="module")
def found():
    """With the linkage that is stated, so that the search and the match have the same."""
    return search(linkages=None)


@pytest.fixture
def study(tmp_path):
    path = tmp_path / "motorcycle.toml"
    path.write_bytes((STUDIES / "motorcycle.toml").read_bytes())
    return read_study(path)


@pytest.fixture
def taken(study, found, monkeypatch):
    front = type("Front", (), {"objectives": np.array([[1.0, 0.9], [1.1, 0.8], [1.3, 0.7]])})
    front.nominal_ratios = np.array([0.1610, 0.1700, 0.1900])
    built = type("Built", (), {"ratio_nominal": LINKAGE.ratio_nominal})
    linkages = type("Linkages", (), {"front": front, "nominal_ratios": front.nominal_ratios, "built": built})
    monkeypatch.setattr(command, "artefact", lambda *_: linkages)
    return command.taken_design(study, Results(study.path.parent), found, NUMBER)


def test_the_match_of_the_new_study_gives_the_design(taken, found, tmp_path):
    """Ratio, length, mass and inertia to 1e-7: what nine digits in the file leave."""
    path = tmp_path / "motorcycle_6.toml"
    command.write_study(path, taken)
    inputs = match_inputs(read_study(path))
    with no_field():
        match = match_stage(CASE, MotorcycleFits(), REQUIRED, LINKAGE, None, inputs, Wheel())
    design, values = found.solved[NUMBER - 1].model.design, found.solved[NUMBER - 1].model.values
    chosen = match.chosen
    assert match.machine.stator_outer_radius == pytest.approx(design.stator_outer_radius, rel=1e-8)
    assert (chosen.transmission_ratio, chosen.active_length) == pytest.approx(
        (design.transmission_ratio, design.active_length), rel=1e-8
    )
    assert (chosen.cost.mass, chosen.cost.equivalent_mass) == pytest.approx(values.objectives[:2], rel=1e-7)


def test_what_is_not_the_designs_stays_as_it_was_written(taken, study):
    old, new = study.path.read_text(encoding="utf-8").splitlines(), taken.text.splitlines()
    gone = [line for line in old if line not in new]
    assert [line.split(" =")[0] for line in gone] == [
        "id", "title", "enforce_damping", "chosen_slots", "chosen_stator_diameter_mm",
    ]  # fmt: skip
    assert new[0].startswith("# Design 6 (mass, ") and "airgap take-over motorcycle --design 6" in new[1]
    assert len([line for line in new if line.endswith("# design 6")]) == 8


def test_the_linkage_is_the_one_with_the_best_angles_up_to_that_of_the_design(taken, found):
    """Of single points: 170 mm/rad where the design has 180."""
    design = replace(found.solved[NUMBER - 1].model.design, linkage_ratio=0.180)
    solved = found.solved[NUMBER - 1]
    other = replace(solved, model=replace(solved.model, design=design))
    every = replace(found, solved=(*found.solved[: NUMBER - 1], other, *found.solved[NUMBER:]))
    again = command.taken_design(taken.study, Results(taken.study.path.parent), every, NUMBER)
    assert again.settings["linkage_search"]["choice"] == "best_angles"
    assert again.linkage_limit == pytest.approx(0.180, rel=1e-5)
    assert again.gear_ratio * design.transmission_ratio == pytest.approx(0.170)


def test_a_file_that_exists_and_a_number_that_is_not_there_are_refused(taken, study, found):
    with pytest.raises(StudyError, match="is not overwritten"):
        command.write_study(study.path, taken)
    with pytest.raises(StudyError, match="--design 99 is not there: optimise.csv has the designs 1 to"):
        command.taken_design(study, Results(study.path.parent), found, 99)


def test_a_length_alone_is_refused(tmp_path):
    inputs = match_inputs(read_study("motorcycle", ["match.chosen_active_length_mm=40"]))
    with no_field(), pytest.raises(MatchError, match="needs match.chosen_gear_ratio"):
        match_stage(CASE, MotorcycleFits(), REQUIRED, LINKAGE, None, inputs, Wheel())


def test_a_ratio_that_the_rotor_speed_forbids_is_refused():
    inputs = match_inputs(read_study("motorcycle", ["match.chosen_gear_ratio=150"]))
    with no_field(), pytest.raises(MatchError, match="match.chosen_gear_ratio asks for a transmission ratio of"):
        match_stage(CASE, MotorcycleFits(), REQUIRED, LINKAGE, None, inputs, Wheel())


# ---- bounds ---------------------------------------------------------------------------------------------------------


CHOICES = SearchRange(((TWELVE, (35e-3, 57.5e-3)),), (7e-3, 70e-3), (1.4e-3, 40e-3), (0.161, 0.161))


def test_a_design_on_an_end_says_what_to_widen():
    inside = WholeDesign(TWELVE, 42.5e-3, 40e-3, 2e-3, 0.161)
    assert CHOICES.hits(inside) == ()
    (said,) = CHOICES.hits(replace(inside, stator_outer_radius=35e-3))
    assert said == "the smallest diameter: add smaller ones to sweep.stator_diameters_mm"
    assert CHOICES.hits(replace(inside, active_length=70 * MILLIMETRE)) == (
        "the longest machine: raise match.length_max_mm",
    )


def test_the_run_says_which_designs_lie_on_an_end(found):
    smallest = replace(found.solved[2].model.design, stator_outer_radius=35e-3)
    solved = [replace(one, model=replace(one.model, design=smallest)) for one in found.solved[:2]]
    said = list(bound_hits(replace(found, solved=tuple(solved)), Wheel()))
    assert any(one.startswith("designs 1, 2 lie on the smallest diameter") for one in said)
    assert "airgap take-over STUDY --design NUMBER" in list(remarks(found, Wheel()))[-1]
