"""Every end is an end with a report: what was found, the reason, and a key of the study that would help."""

import argparse
import html
import re

import pytest
from small_studies import fitted, small

import pipeline.run_command
import pipeline.running
from figures.report import Picture, Section
from pipeline.results import Results
from pipeline.run import Failure
from pipeline.run_command import page_of, run_command
from processes import ThisProcess
from study.schema import Study
from study.sentences import section_class

HEAVY = (
    "flux_map", "gap_stress", "fields", "winding", "drive", "braking", "magnets", "mechanics", "losses", "heat",
    "outcome", "tolerances", "uncertainty", "package", "optimise",
)  # fmt: skip
STATED = {"chain__requirements": '"stated"', "chain__linkage": '"stated"'}


@pytest.fixture
def ended(tmp_path, monkeypatch):
    """Run a small study as the command does; returns its report as text, and what is said of the failed stage."""

    def run(name, stage, **changes):
        study = small(name, tmp_path, **changes)
        graph = fitted(study, without=HEAVY)
        monkeypatch.setattr("drivetrain.matching.RADII", 4)
        monkeypatch.setattr(pipeline.run_command, "graph_of", lambda study: graph)
        monkeypatch.setattr(pipeline.run_command, "results_of", lambda study: Results(tmp_path / "results"))
        monkeypatch.setattr(pipeline.running, "Processes", lambda jobs, modules: ThisProcess())
        options = argparse.Namespace(
            study=str(study.path), to=None, jobs=1, executor="processes", scheduler=None, model=None, out=None
        )
        with pytest.raises(SystemExit) as end:
            run_command(options)
        assert end.value.code == 1
        text = (tmp_path / "results" / "report.html").read_text(encoding="utf-8")
        text = " ".join(html.unescape(re.sub(r"<[^>]*>", " ", text.split("</style>")[-1])).split())
        (said,) = re.findall(rf"\b{stage}: (.*?) (?:gearbox: left out|2\. )", text)
        return text, said

    return run


def keys(said):
    """The keys of the study that a sentence names; each must exist."""
    found = [(section, key) for section, key in re.findall(r"\b([a-z_]+)\.([a-z]\w+)", said)]
    for section, key in found:
        assert section in Study.model_fields and key in section_class(section).model_fields, f"{section}.{key}"
    return {f"{section}.{key}" for section, key in found}


def test_a_force_that_no_machine_has(ended, capsys):
    text, said = ended("motorcycle", "match", **STATED, requirements__force_peak_N="99999.0")
    assert (
        "no slot-pole combination of sweep.slots and sweep.poles has a match" in said and "overload force needs" in said
    )
    assert {"match.length_max_mm", "match.speed_max_rad_per_s", "sweep.stator_diameters_mm"} <= keys(said)
    assert "This run could not go on" in text and "force peak / N 99,999" in text.replace("99999", "99,999")
    assert f"match: {said}" in " ".join(capsys.readouterr().err.split())


def test_a_torque_that_no_machine_has(ended):
    text, said = ended("robot_joint", "match", drive__torque_peak_Nm="99999.0")
    assert "overload torque needs" in said and "match.length_max_mm" in keys(said)
    assert "force" not in text and "mm/rad" not in text


def test_one_stage_of_gears_that_cannot_be(ended):
    text, said = ended("motorcycle", "match", **STATED, match__gearbox_stages="1")
    assert "set by the planet clearance" in said and "more match.gearbox_stages" in said
    assert "match.gearbox_stages" in keys(said) and "Linkage" in text


def test_a_machine_that_must_be_too_short(ended):
    _, said = ended("motorcycle", "match", **STATED, match__length_max_mm="12.0")
    assert "the limit is 12.0 mm" in said and "match.length_max_mm" in keys(said)


def test_no_gears_are_found(ended):
    """What the match found is in the report; the gears are refused behind it."""
    text, said = ended("robot_joint", "gearbox", gearbox__ratio_tolerance="0.0005")
    assert keys(said) and "gear" in said
    assert "Gearbox and motor matched" in text and "The chosen machine beside the machine of the study file" in text


def test_a_picture_that_could_not_be_drawn_does_not_cost_the_report(tmp_path):
    study = small("pump", tmp_path)
    sections = [Section("Found", ("Text.", Picture("figures/absent.png", "what it would have shown")))]
    page = page_of(study, sections, [Failure("some.files", "a fault of the program")])
    page.write(tmp_path / page.name)
    text = (tmp_path / page.name).read_text(encoding="utf-8")
    assert "Not drawn: what it would have shown" in text and "some.files: a fault of the program" in text
