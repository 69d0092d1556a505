"""All stages on a small study by the command: files, a second run without work, the report, a wrong study.

The run is one of a user, in a process with workers of its own; what only looks at it afterwards needs none.
"""

import re
import shutil
import subprocess
import sys
import zipfile

import pandas as pd
import pytest
from small_studies import MOTORCYCLE, small

from actuator.text import actuator_of
from pipeline.modules import PROJECT
from pipeline.results import Results
from pipeline.stages import graph_of
from study.read import read_study
from tests.command_line import airgap

FOLDER = PROJECT / "results" / "small-test-study"


def in_a_process_of_its_own(*arguments):
    command = [sys.executable, "-m", "pipeline.cli", *map(str, arguments)]
    return subprocess.run(command, cwd=PROJECT, capture_output=True, text=True)


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    path = small("motorcycle", tmp_path_factory.mktemp("study"), **MOTORCYCLE).path
    shutil.rmtree(FOLDER, ignore_errors=True)
    done = in_a_process_of_its_own("run", path)
    assert done.returncode == 0, f"{done.stdout}\n{done.stderr}"
    yield path
    shutil.rmtree(FOLDER, ignore_errors=True)


@pytest.fixture(scope="module")
def results(study):
    return Results(FOLDER)


def test_every_stage_is_there_with_its_provenance(study, results):
    for stage in graph_of(read_study(study)).usual:
        record = results.record(stage.name)
        assert record["inputs"]["code"] and record["inputs"]["package numpy"] and record["wall_time_s"] >= 0
    for file in ("optima.csv", "windings.csv", "reference_nominal.vtu", "figures/fits.png", "figures/losses.png",
                 "linkage_front.csv", "figures/axial_section.png", "flux_map_export.mat", "report.html"):  # fmt: skip
        assert (FOLDER / file).is_file(), file
    assert not (FOLDER / "checkpoints").exists() or not list((FOLDER / "checkpoints").iterdir())


def test_every_optimum_holds_the_limit(results):
    optima = pd.read_csv(FOLDER / "optima.csv")
    assert len(optima) == 4
    assert optima.limited_T.to_numpy() == pytest.approx(1.2, rel=1e-3)
    assert (optima.torque_overload_linear_Nm_per_m > 1.2 * optima.torque_overload_Nm_per_m).all()


def test_a_second_run_does_no_work_and_an_edited_byte_is_noticed(study, results):
    done = airgap("run", study)
    assert done.returncode == 0 and "done in" not in done.stdout and "report: unchanged" in done.stdout
    table = FOLDER / "match.csv"
    good = table.read_bytes()
    table.write_bytes(good.replace(b"1", b"2", 1))
    done = airgap("run", study, "--to", "match")
    assert "match.files: not there" in done.stdout and "match: unchanged" in done.stdout
    assert table.read_bytes() == good


def test_the_report_reads_from_the_vehicle_to_the_vehicle(study):
    html = (FOLDER / "report.html").read_text(encoding="utf-8")
    titles = [re.sub(r"^\d+\. ", "", title) for title in re.findall(r"<h2[^>]*>(.*?)</h2>", html, flags=re.S)]
    assert titles[:4] == ["Data sheet", "Outcome", "Requirements from the vehicle", "Linkage"]
    assert titles.index("Planetary gearbox") < titles.index("Winding")  # whole teeth decide about the length
    assert titles[-2:] == ["The vehicle with the designed actuator", "Energy on the road"]
    pictures = {path.stem for path in (FOLDER / "figures").glob("*.png")}
    assert html.count("data:image/png;base64") == len(pictures) + 1, "the efficiency map is on the data sheet too"


def test_the_peak_torque_is_one_number(results):
    """In the winding, the outcome, the tables and the text of the report."""
    winding, outcome = results.load("winding"), results.load("outcome")
    torque = winding.peak_torque
    assert outcome.features.machine_torque == pytest.approx(torque, rel=1e-6)
    assert winding.chosen.peak_torque == pytest.approx(torque, rel=1e-6)
    envelope = pd.read_csv(FOLDER / "flux_map_envelope.csv")
    assert envelope.torque_field_Nm[0] == pytest.approx(torque, rel=1e-4)
    html = (FOLDER / "report.html").read_text(encoding="utf-8")
    assert html.count(f"{torque:.3f} ± {winding.peak_torque_error:.3f} Nm") >= 1


def test_the_computed_requirements_feed_the_match_and_the_stated_ones_stand_beside_it(results):
    required, linkage, match = (results.load(name) for name in ("requirements", "linkage", "match"))
    force = abs(required.demands.force_peak.value)
    assert force != 2614.0 and linkage.built.ratio_nominal < 0.170
    chosen = match.chosen
    needed = force * chosen.transmission_ratio / chosen.section.torque_per_length_overload  # the overload binds (3.66)
    assert chosen.active_length == pytest.approx(needed, rel=1e-3)
    assert match.stated.match.active_length != pytest.approx(chosen.active_length, rel=1e-3)


def test_what_was_designed_goes_back_into_the_vehicle(results):
    outcome, ride = results.load("outcome"), results.load("ride")
    features = outcome.features
    assert features.transmission_ratio == pytest.approx(features.linkage_ratio / features.gear_ratio)
    assert len(ride.road_ideal) == len(ride.road_designed) == 3
    assert ride.designed.force_peak <= ride.ideal.force_peak * 1.001
    energy = results.load("energy")
    assert {case.actuator for case in energy.cases} >= {"quasi-ideal", "real"}
    assert all(abs(one.closure) < 0.01 for case in energy.cases if not case.swings for one in case.energies)
    assert all(one.copper[0] < one.copper[-1] < 155 for one in energy.temperatures) and energy.temperatures
    assert energy.own.actuator.equivalent_mass == outcome.limits.equivalent_mass


def test_the_actuator_is_exported_and_answers_as_the_study_says(study, results, tmp_path):
    path = tmp_path / "actuator.fmu"
    done = airgap("export-fmu", study, "--out", path)
    assert done.returncode == 0 and f"wrote {path}" in done.stdout, done.stderr
    with zipfile.ZipFile(path) as unit:
        actuator, terminals = actuator_of(unit.read("resources/actuator.json").decode())
    own, winding = results.load("energy").own.actuator, results.load("winding")
    assert (actuator.ratio, actuator.mount, actuator.drive.limit) == (own.ratio, own.mount, own.drive.limit)
    assert terminals.torque_of(winding.limits.current_peak) == pytest.approx(winding.peak_torque, rel=0.02)
    assert terminals.bus_voltage == pytest.approx(90.0)
    again = airgap("export-fmu", study, "--out", path)
    assert again.returncode == 2 and "exists already" in again.stderr + again.stdout


def test_the_length_makes_up_for_whole_turns_and_teeth(results):
    """Where the linkage ratio is largest the peak force at rest is what is asked, by the flux map, to its rounding."""
    winding, linkage, required = (results.load(name) for name in ("winding", "linkage", "requirements"))
    outcome = results.load("outcome")
    at_largest = outcome.features.effort_peak * linkage.built.ratio_nominal / linkage.built.ratio_range[1]
    assert 1.0 < at_largest / abs(required.demands.force_peak.value) < 1.02
    assert winding.length.set_by.name == "the peak torque"


def test_one_radius_keeps_its_unit_from_the_study_to_the_outcome(study, results):
    """In metres wherever a stage reads it; in millimetres only in the file and in what people read."""
    match, winding = results.load("match"), results.load("winding")
    radius = match.machine.stator_outer_radius
    assert radius == pytest.approx(read_study(study).match.chosen_stator_diameter_mm / 2e3)
    assert winding.wound.machine.stator_outer_radius == radius == match.chosen.section.machine.stator_outer_radius
    assert f"{1e3 * radius:.2f}" in (FOLDER / "report.html").read_text(encoding="utf-8")


def test_an_unknown_stage_is_named_with_those_there_are(study):
    done = airgap("run", study, "--to", "fit")
    assert done.returncode == 2
    assert "give one of requirements, linkage" in done.stderr and "Traceback" not in done.stderr


def test_a_wrong_study_stops_the_run_with_one_sentence(tmp_path):
    text = (PROJECT / "studies" / "motorcycle.toml").read_text(encoding="utf-8")
    (tmp_path / "wrong.toml").write_text(text.replace("airgap_mm = 0.5", "airgap_mm = -0.5"), encoding="utf-8")
    done = airgap("run", tmp_path / "wrong.toml")
    assert done.returncode == 2
    assert len(done.stderr.strip().splitlines()) == 1 and "machine.airgap_mm = -0.5" in done.stderr


def test_make_knows_the_stages_of_the_graph():
    lines = (PROJECT / "Makefile").read_text(encoding="utf-8").splitlines()
    named = next(line for line in lines if line.startswith("STAGES :=")).split(":=")[1].split()
    stages = [stage.name for stage in graph_of(read_study("motorcycle")).stages]
    assert sorted(named) == sorted(name for name in stages if name != "optimise")


@pytest.mark.parametrize(("name", "counted"), (("motorcycle", True), ("template", False)))
def test_heat_waits_for_losses_only_where_the_steel_has_data(name, counted):
    graph = graph_of(read_study(name))
    before = [stage.name for stage in graph.before(graph.stage("heat"))]
    assert ("losses" in before) == counted and {"winding", "flux_map"} <= set(before)


def test_readme_shows_the_graph_as_it_is():
    from pipeline.graph import drawing

    text = (PROJECT / "README.md").read_text(encoding="utf-8")
    shown = re.search(r"<!-- graph -->\n```mermaid\n(.*?)\n```\n<!-- /graph -->", text, flags=re.S)
    assert shown is not None and shown.group(1) == drawing(graph_of(read_study("motorcycle")))
