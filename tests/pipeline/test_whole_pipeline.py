"""All stages on a small study: files, a second run without work, the report's sections, and a wrong study."""

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pandas as pd
import pytest
import xarray as xr

PROJECT = Path(__file__).resolve().parents[2]
STAGES = "requirements linkage sweep optima limits fits match gearbox winding flux_map drive".split()
STAGES += "fields figures outcome report".split()
SMALL = {
    'id = "motorcycle"': 'id = "small-test-study"',
    "slots = [9, 12]": "slots = [12]",
    "[70, 75, 80, 85, 90, 95, 100, 105, 110, 115]": "[75, 80, 85, 90]",
    "back_iron_steps = 7": "back_iron_steps = 4",
    "rotor_radius_steps = 6": "rotor_radius_steps = 4",
    "road_seeds = [0, 1, 2, 3, 4, 5]": "road_seeds = [0]",
    "road_duration_s = 30.0": "road_duration_s = 5.0",
    "amplitudes_mm = [-50, -40, -30, -20, -10, 10, 20, 30, 40, 50]": "amplitudes_mm = [-50, 50]",
    "speeds_km_per_h = [10, 20, 30, 40, 50, 60, 70, 80, 90, 100]": "speeds_km_per_h = [50]",
    "\nseeds = [1, 2, 3, 4]": "\nseeds = [1]",
    "population = 100": "population = 24",
    "generations = 150": "generations = 20",
    "[flux_map]": "[flux_map]\nangles = 2\ncurrents = 5",
    "ratio_tolerance = 0.03": "ratio_tolerance = 0.015",
    "dc_bus_voltage_V = 48.0": "dc_bus_voltage_V = 90.0",
}
FOLDER = PROJECT / "results" / "small-test-study"


def run(stage, study):
    return subprocess.run(
        [sys.executable, "-m", f"pipeline.{stage}", str(study)], cwd=PROJECT, capture_output=True, text=True
    )


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    text = (PROJECT / "studies" / "motorcycle.toml").read_text(encoding="utf-8")
    for old, new in SMALL.items():
        assert old in text
        text = text.replace(old, new)
    path = tmp_path_factory.mktemp("study") / "small.toml"
    path.write_text(text, encoding="utf-8")
    shutil.rmtree(FOLDER, ignore_errors=True)
    for stage in STAGES:
        done = run(stage, path)
        assert done.returncode == 0, f"{stage}: {done.stdout}\n{done.stderr}"
    yield path
    shutil.rmtree(FOLDER, ignore_errors=True)


def test_results_are_labelled_and_have_their_provenance(study):
    with xr.open_dataset(FOLDER / "design_map.nc") as data:
        assert data.torque_Nm_per_m.dims == ("slots", "stator_diameter_mm", "back_iron", "rotor_radius")
        assert int(data.torque_Nm_per_m.notnull().sum()) > 40
    for file in (
        "design_map.nc",
        "optima.csv",
        "winding.json",
        "reference_nominal.vtu",
        "figures/fits.png",
        "requirements.json",
        "linkage_front.csv",
        "gearbox.json",
        "outcome.json",
        "figures/axial_section.png",
        "report.html",
    ):
        provenance = json.loads((FOLDER / f"{file}.provenance.json").read_text())
        assert provenance["inputs"] and provenance["packages"] and provenance["wall_time_s"] >= 0


def test_every_optimum_holds_the_limit(study):
    optima = pd.read_csv(FOLDER / "optima.csv")
    assert len(optima) == 4
    assert optima.limited_T.to_numpy() == pytest.approx(1.2, rel=1e-3)
    assert (optima.torque_overload_linear_Nm_per_m > 1.2 * optima.torque_overload_Nm_per_m).all()


def test_a_second_run_does_no_work(study):
    for stage in STAGES:
        assert "unchanged" in run(stage, study).stdout


def test_the_report_reads_from_the_vehicle_to_the_vehicle(study):
    html = (FOLDER / "report.html").read_text(encoding="utf-8")
    titles = [re.sub(r"^\d+\. ", "", title) for title in re.findall(r"<h2[^>]*>(.*?)</h2>", html, flags=re.S)]
    assert titles[:3] == ["Outcome", "Requirements from the vehicle", "Linkage"]
    assert titles[-4:-2] == ["Planetary gearbox", "Winding"]  # whole teeth first: they decide about the length
    assert titles[-1] == "The vehicle with the designed actuator"
    assert html.count("data:image/png;base64") == 15 + 5 + 3 + 3 + 3 + 3
    assert re.search(r"At full current the flux map gives [\d.]+ ± 0\.\d+ Nm", html)
    assert "regenerative damping 27.7 kNs/m is 12.3 kNs/m below the requirement" in html


def test_the_computed_requirements_feed_the_match_and_the_stated_ones_stand_beside_it(study):
    required = json.loads((FOLDER / "requirements.json").read_text())
    linkage = json.loads((FOLDER / "linkage.json").read_text())
    match = json.loads((FOLDER / "match.json").read_text())
    inputs = json.loads((FOLDER / "match.json.provenance.json").read_text())["values"]
    assert inputs["requirements"]["force_peak_N"] == required["values"]["force_peak_N"] != 2614.0
    assert inputs["linkage"]["ratio_nominal_mm_per_rad"] == linkage["section"]["ratio_nominal_mm_per_rad"] < 170
    torque = required["values"]["force_peak_N"] * match["transmission_ratio_mm_per_rad"]  # Nm/1000
    needed = torque / match["torque_overload_Nm_per_m"]  # the overload force binds (3.66)
    assert match["active_length_mm"] == pytest.approx(needed, rel=1e-3)
    assert match["stated_feed"]["active_length_mm"] != pytest.approx(match["active_length_mm"], rel=1e-3)


def test_what_was_designed_goes_back_into_the_vehicle(study):
    outcome = json.loads((FOLDER / "outcome.json").read_text())
    features = {row["feature"]: row["ours"] for row in outcome["features"]}
    overall = features["linkage, nominal / (mm/rad)"] / features["gearbox, fast over slow speed"]
    assert features["overall transmission ratio / (mm/rad)"] == pytest.approx(overall)
    assert {row["actuator"] for row in outcome["worst"]} == {"ideal", "designed"} and len(outcome["ride"]) == 6
    failing = {row["requirement"] for row in outcome["requirements"] if not row["holds"]}
    assert {row["requirement"] for row in outcome["remedies"]} == {one for one in failing if "gears" not in one}


def test_the_length_makes_up_for_whole_turns_and_teeth(study):
    """Where the linkage ratio is largest the peak force at rest is what is asked, by the flux map, to its rounding."""
    outcome = json.loads((FOLDER / "outcome.json").read_text())
    linkage = json.loads((FOLDER / "match.json.provenance.json").read_text())["values"]["linkage"]
    (row,) = [row for row in outcome["requirements"] if row["requirement"] == "peak force at rest"]
    at_largest = row["reached"] * linkage["ratio_nominal_mm_per_rad"] / linkage["ratio_max_mm_per_rad"]
    assert 1.0 < at_largest / row["needed"] < 1.02
    length = json.loads((FOLDER / "winding.json").read_text())["length"]
    assert "set by the peak force" in length["reason"] and length["final_mm"] != pytest.approx(length["matched_mm"])


def test_a_stage_without_its_input_says_what_to_run(study, tmp_path):
    other = tmp_path / "other.toml"
    other.write_text(
        study.read_text(encoding="utf-8").replace("small-test-study", "small-test-never-run"), encoding="utf-8"
    )
    done = run("fits", other)
    assert done.returncode == 1
    assert "which does not exist; run the stage that writes it" in done.stderr and "Traceback" not in done.stderr


def test_a_wrong_study_stops_the_pipeline_with_one_sentence(tmp_path):
    path = tmp_path / "wrong.toml"
    text = (PROJECT / "studies" / "motorcycle.toml").read_text(encoding="utf-8")
    path.write_text(text.replace("airgap_mm = 0.5", "airgap_mm = -0.5"), encoding="utf-8")
    done = run("sweep", path)
    assert done.returncode == 2
    assert len(done.stderr.strip().splitlines()) == 1 and "machine.airgap_mm = -0.5" in done.stderr
