"""Stages around the machine on a study that nothing satisfies: one sentence each and exit code 1."""

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

PROJECT = Path(__file__).resolve().parents[2]
FOLDER = PROJECT / "results" / "small-test-chain"
RIGHT = (PROJECT / "studies" / "motorcycle.toml").read_text(encoding="utf-8")


@pytest.fixture
def folder():
    shutil.rmtree(FOLDER, ignore_errors=True)
    FOLDER.mkdir(parents=True)
    yield FOLDER
    shutil.rmtree(FOLDER, ignore_errors=True)


def refusal(tmp_path, stage, changes, code=1):
    """The one sentence with which a stage refuses the motorcycle with some things changed."""
    text = RIGHT.replace('id = "motorcycle"', 'id = "small-test-chain"')
    for old, new in changes.items():
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    path = tmp_path / "wrong.toml"
    path.write_text(text, encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "-m", f"pipeline.{stage}", str(path)], cwd=PROJECT, capture_output=True, text=True
    )
    said = [line for line in done.stderr.splitlines() if line and "it/s" not in line and "?it" not in line]
    assert done.returncode == code and len(said) == 1 and "Traceback" not in done.stderr, done.stderr
    return said[0]


STATED = {'requirements = "vehicle"': 'requirements = "stated"', 'linkage = "optimised"': 'linkage = "stated"'}


@pytest.fixture
def matched(folder):
    found = {"transmission_ratio_mm_per_rad": 2.26, "stator_outer_radius_mm": 42.5}
    (folder / "match.json").write_text(json.dumps(found))
    return folder


SEVEN = {"planets = 3  ": "planets = 7  "}


def test_no_feasible_tooth_set(matched, tmp_path):
    said = refusal(tmp_path, "gearbox", {**STATED, "ratio_tolerance = 0.03": "ratio_tolerance = 0.0002", **SEVEN})
    assert said.startswith("no gearbox: ") and "relax" in said


def test_teeth_that_are_too_weak(matched, tmp_path):
    said = refusal(tmp_path, "gearbox", {**STATED, "force_peak_N = 2614.0": "force_peak_N = 26140.0"})
    assert "too weak" in said and "static_root" in said and "relax that factor" in said


def test_a_force_that_no_machine_reaches(folder, tmp_path):
    shutil.copy(PROJECT / "results" / "reference" / "optima.csv", folder / "optima.csv")
    path = tmp_path / "fits.toml"
    path.write_text(RIGHT.replace('id = "motorcycle"', 'id = "small-test-chain"'), encoding="utf-8")
    subprocess.run([sys.executable, "-m", "pipeline.fits", str(path)], cwd=PROJECT, check=True, capture_output=True)
    said = refusal(tmp_path, "match", {**STATED, "force_peak_N = 2614.0": "force_peak_N = 261400.0"})
    assert said.startswith("no match: ") and "overload force needs" in said and "relax one of the two" in said


def test_a_match_without_its_feeds(folder, tmp_path):
    assert "requirements.json of the study small-test-chain does not exist" in refusal(tmp_path, "match", {})
