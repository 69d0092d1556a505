"""``airgap solve``: the contract of its JSON, the reference machine, and wrong input."""

import json
import subprocess
import sys

import pytest

from pipeline.modules import PROJECT
from tests.command_line import airgap


def solved(*arguments):
    done = airgap("solve", "motorcycle", *arguments, "--json", "-")
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@pytest.mark.parametrize(
    "arguments, torque",  # independently computed reference values [Nm/m], +-0.05 %
    (
        (("--angle-deg", -21, "--j-amplitude", 6), 39.49),
        (("--angle-deg", -21, "--j-rms", 6), 55.53),
        (("--angle-deg", -24, "--j-rms", 6, "--current-angle-deg", 15), 54.56),
        (("--angle-deg", -18, "--j-amplitude", 6, "--current-angle-deg", -15), 38.03),
        (("--angle-deg", -21, "--j-rms", 6, "--set", "machine.magnetisation=radial"), 52.25),
    ),
)
def test_torque_of_the_reference_machine(arguments, torque):
    found = solved(*arguments)["torque_per_length_Nm_per_m"]
    assert found["arkkio"] == pytest.approx(torque, rel=2e-3)
    assert found["maxwell"] == pytest.approx(found["arkkio"], rel=1e-3)


def test_everything_promised_is_in_the_json(tmp_path):
    found = solved("--angle-deg", -21, "--j-rms", 6, "--vtu", tmp_path / "field.vtu", "--png", tmp_path / "field.png")
    assert set(found["flux_linkage_Wb_per_turn_per_m"]) == {"a", "b", "c"}
    assert sum(found["flux_linkage_Wb_per_turn_per_m"].values()) == pytest.approx(0.0, abs=1e-3)
    assert len([name for name in found["probes_T"] if name.startswith("tooth")]) == 6
    assert found["unknowns"] > 5000 and found["newton"]["residuals"][-1] < 1e-4 and found["cpu_seconds"] > 0
    assert (tmp_path / "field.png").read_bytes()[:4] == b"\x89PNG"
    assert (tmp_path / "field.vtu").stat().st_size > 1e5


def test_the_template_study_can_be_solved_by_a_process_of_its_own():
    command = [sys.executable, "-m", "pipeline.cli", "solve", "template", "--angle-deg", "0"]
    assert subprocess.run(command, cwd=PROJECT, capture_output=True).returncode == 0


@pytest.mark.parametrize(
    "arguments, words",
    (
        (("--j-rms", "nan"), "must be a finite number"),
        (("--j-rms", "-3"), "zero or more"),
        (("--angle-deg", "inf"), "--angle-deg must be a finite number"),
        (("--angle-deg", "1e300"), "at most 360000 either way, found 1e+300"),
        (("--j-amplitude", "1e9"), "at most 1000 A/mm2 (amplitude), found 1e+09"),
        (("--set", "mesh.elements_across_tooth=40"), "reduce mesh.elements_across_tooth"),
        (("--set", "machine.airgap_mm=-0.5"), "outside the allowed range"),
        (("--set", "machine.slots=10"), "cannot carry this winding"),
        (("--set", "materials.steel=unobtainium"), "unknown steel"),
        (("--set", "machine.back_iron_width_mm=6.3"), "wider than the slot pitch"),
        (("--json", "no/such/folder/x.json"), "does not exist"),
    ),
)
def test_wrong_input_is_one_sentence_and_exit_code_2(arguments, words):
    done = airgap("solve", "motorcycle", *arguments)
    assert done.returncode == 2
    assert words in done.stderr and "Traceback" not in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
