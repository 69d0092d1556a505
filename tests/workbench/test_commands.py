"""The commands on the damper, from the outside: what they write, what they say, what they refuse."""

import json
import shutil
import subprocess
import sys

import numpy as np
import pytest

from pipeline.cli import main
from pipeline.modules import PROJECT
from workbench.data.campaign import read_campaign
from workbench.models.bases import nominal_model

TOML = """
[campaign]
id = "bench"
repeats = 2
holdout = { rule = "last repeat of every table" }
[device]
force_constant_N_per_A = 60.0
internal_resistance_ohm = 1.2
moving_mass_kg = 2.0
viscous_damping_Ns_per_m = 20.0
[tolerance]
force_constant_N_per_A = { sigma_rel = 0.01 }
viscous_damping_Ns_per_m = { sigma_rel = 0.15 }
[systematic]
force_gain = { sigma = 0.003, kind = "gain" }
[[table]]
file = "force_velocity.csv"
kind = "damping_velocity"
u_random = { force_N = "0.3 + 0.008*abs(y)" }
"""


@pytest.fixture(scope="module")
def bench(tmp_path_factory):
    """Friction of 5 N that the model does not know, worked out by hand: F = K^2 v / (R + R_s) + c v + 5 sign(v)."""
    folder, random, rows = tmp_path_factory.mktemp("bench"), np.random.default_rng(5), []
    for repeat in range(2):
        for shunt in (0.5, 3.0, 10.0):
            for velocity in (*np.linspace(0.02, 0.4, 12), *-np.linspace(0.02, 0.4, 12)):
                force = 60**2 * velocity / (1.2 + shunt) + 20 * velocity + 5 * np.sign(velocity)
                force += random.standard_normal() * (0.3 + 0.008 * abs(force))
                rows.append(f"{repeat},{shunt},{velocity:.5f},{force:.4f}")
    (folder / "force_velocity.csv").write_text("repeat,shunt_ohm,velocity_m_per_s,force_N\n" + "\n".join(rows) + "\n")
    (folder / "campaign.toml").write_text(TOML, encoding="utf-8")
    return folder


def run(capsys, *arguments):
    main([str(a) for a in arguments])
    return capsys.readouterr().out


def test_the_walk_from_failing_to_nothing_missing(bench, tmp_path, capsys):
    out = tmp_path / "out"
    said = run(capsys, "compare", bench, "--out", out)
    assert "force_velocity.force" in said and "campaign.toml" not in said, "nothing is wrong with its conventions"
    assert json.loads((out / "comparison.json").read_text())["failing"] == "force_velocity.force"
    assert "friction" in run(capsys, "diagnose", bench, "--out", out)
    said = json.loads((out / "diagnosis.json").read_text())
    assert said["verdict"] in ("effect", "group") and "coulomb_friction" in said["names"]
    assert "accepted" in run(capsys, "add", "coulomb_friction", bench, "--out", out)
    said = json.loads((out / "diagnosis.json").read_text())
    assert said["verdict"] == "nothing_missing" and said["effects"] == ["coulomb_friction"]
    assert json.loads((out / "comparison.json").read_text())["model"]["effects"] == ["coulomb_friction"]
    assert len((out / "ledger.csv").read_text().splitlines()) == 3
    for name in ("comparison.html", "diagnosis.html", "ledger.html"):
        assert (out / name).stat().st_size > 10_000


def test_ledger_walks_by_itself(bench, tmp_path, capsys):
    said = run(capsys, "ledger", bench, "--out", tmp_path)
    assert [line.split()[1:3] for line in said.splitlines() if line[:5].strip().isdigit()] == [
        ["-", "start"],
        ["coulomb_friction", "accepted"],
    ]
    assert "accepted" in said and (tmp_path / "ledger.html").exists()
    again = run(capsys, "ledger", bench, "--out", tmp_path)  # the model has it now: nothing to add
    assert len((tmp_path / "ledger.csv").read_text().splitlines()) == 3 and "nothing" in again.lower()


def test_no_step_is_taken_while_conventions_are_not_settled(bench, tmp_path, capsys):
    wrong = tmp_path / "wrong"
    shutil.copytree(bench, wrong)
    text = (wrong / "campaign.toml").read_text().replace("force_N", "force_kN")
    (wrong / "campaign.toml").write_text(text)
    table = (wrong / "force_velocity.csv").read_text().replace("force_N", "force_kN")
    (wrong / "force_velocity.csv").write_text(table)
    out = tmp_path / "out"
    said = run(capsys, "ledger", wrong, "--out", out)
    assert "1000 times too large" in said and "factor" in said
    assert {path.name for path in out.iterdir()} == {"diagnosis.json", "diagnosis.html"}
    first = run(capsys, "compare", wrong, "--out", out)
    assert "1000 times too large" in first and "[conventions]" in first


def test_effects_lists_every_effect_with_its_equation(capsys):
    lines = run(capsys, "effects").splitlines()
    assert len(lines) >= 30 and any(line.startswith("coulomb_friction") and " = " in line for line in lines)
    shown = run(capsys, "effects", "coulomb_friction")
    assert "level [N]" in shown and "tanh" in shown


def test_a_new_effect_is_a_file_that_works_at_once(bench, tmp_path, capsys):
    own = tmp_path / "stick_slip.py"
    run(capsys, "new-effect", own, bench, "--out", tmp_path / "out")
    text = own.read_text()
    assert "force" in text and 'kind != "damping_velocity"' in text
    main(["diagnose", str(bench), "--out", str(tmp_path / "out"), "--effects-from", str(own)])
    captured = capsys.readouterr()
    assert "this runs the file" in captured.err
    assert "stick_slip" in [r["name"] for r in json.loads((tmp_path / "out" / "diagnosis.json").read_text())["ranking"]]
    with pytest.raises(SystemExit):
        main(["new-effect", str(own), str(bench)])
    assert "exists already" in capsys.readouterr().err


def test_import_writes_a_campaign_file_beside_a_plain_csv(bench, tmp_path, capsys):
    plain = tmp_path / "plain.csv"
    plain.write_bytes((bench / "force_velocity.csv").read_bytes())
    run(capsys, "import", plain)
    text = (tmp_path / "campaign.toml").read_text()
    assert 'kind = "damping_velocity"' in text and '"force_N" = { unit = "N", role = "response", u_random = ' in text
    keys = dict(line.split(" = ") for line in TOML.split("[device]")[1].split("[tol")[0].strip().splitlines())
    filled = text
    for key, value in keys.items():
        filled = filled.replace(f'{key} = "?"', f"{key} = {value}")
    (tmp_path / "campaign.toml").write_text(filled)
    assert nominal_model(read_campaign(tmp_path)).base.name == "damper"
    assert plain.read_bytes() == (bench / "force_velocity.csv").read_bytes()


@pytest.mark.parametrize(
    "arguments, says",
    [
        (["compare", "nowhere"], "there is no campaign.toml"),
        (["add", "magic", "BENCH"], "there is no effect 'magic'"),
        (["effects", "magic"], "there is no effect 'magic'"),
        (["diagnose", "BENCH", "--effects-from", "nowhere.py"], "there is no such file"),
        (["compare", "BENCH", "--model", "nowhere.toml"], "cannot be read as a model file"),
        (["new-effect", "Not-A-Name.txt"], "ends in .py"),
        (["import", "nowhere.csv"], "cannot be read as CSV"),
        (["import", "."], "is a folder"),
        (["import", "sheet.xlsx"], "save it as CSV"),
        (["compare", "BENCH", "--out", "sheet.xlsx"], "cannot be a folder of results"),
        (["validate", "nowhere.toml", "BENCH"], "cannot be read as a model file (No such file or directory)"),
    ],
)
def test_wrong_input_is_one_sentence_and_exit_code_2(bench, tmp_path, capsys, monkeypatch, arguments, says):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "sheet.xlsx").write_bytes(b"PK\x03\x04 and so on")
    with pytest.raises(SystemExit) as caught:
        main([str(bench) if a == "BENCH" else a for a in arguments])
    error = capsys.readouterr().err
    assert caught.value.code == 2 and says in error and len(error.strip().splitlines()) == 1


def test_whoever_reads_the_output_may_stop_before_its_end():
    command = [sys.executable, "-m", "pipeline.cli", "effects"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=PROJECT) as process:
        process.stdout.close()
        assert process.stderr.read() == b"" and process.wait() == 141


def test_a_device_that_no_model_knows(bench, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "force_velocity.csv").write_bytes((bench / "force_velocity.csv").read_bytes())
    (tmp_path / "campaign.toml").write_text(
        TOML.replace("force_constant_N_per_A = 60.0", "").replace("internal_resistance_ohm = 1.2", "")
    )
    with pytest.raises(SystemExit):
        main(["compare", "."])
    assert "no model knows" in capsys.readouterr().err
