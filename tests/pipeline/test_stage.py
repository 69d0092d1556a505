"""A stage runs when an input changed, says why, and leaves results with their provenance or nothing."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

import pipeline.stage
from pipeline.stage import PROJECT, Stage, StageError, code_hash, command, write_atomically
from study.errors import StudyError


@pytest.fixture
def project(tmp_path, monkeypatch):
    """A project of its own, with one package and one input file."""
    (tmp_path / "physics").mkdir()
    (tmp_path / "physics" / "law.py").write_text("B = 1\n")
    (tmp_path / "physics" / "steel.csv").write_text("0,0\n")
    (tmp_path / "units.py").write_text("MM = 1e-3\n")
    (tmp_path / "map.csv").write_text("1\n")
    monkeypatch.setattr(pipeline.stage, "PROJECT", tmp_path)
    return tmp_path


@pytest.fixture
def stage(project):
    return a_stage(project)


def a_stage(project, **values):
    return Stage(
        "fits",
        project / "results",
        {"machine": {"airgap_mm": 0.5}, **values},
        files=(project / "map.csv",),
        code=("physics", "units"),
        outputs=("fit.csv", "fit.txt"),
    )


def work(run):
    run.write("fit.csv", lambda path: path.write_text("1,2\n"))
    run.write_text("fit.txt", "good")
    run.note(tolerances={"newton": 1e-6}, newton=[1.0, 0.1])


def test_a_stage_runs_once(stage, capsys):
    assert stage.run(work) is True
    assert stage.run(work) is False
    assert capsys.readouterr().out.splitlines()[-1] == "fits: unchanged, not run again"
    assert (stage.folder / "fit.csv").read_text() == "1,2\n"


@pytest.mark.parametrize(
    "change, reason",
    [
        (lambda p: (p / "map.csv").write_text("2\n"), "file map.csv changed"),
        (lambda p: (p / "physics" / "law.py").write_text("B = 2\n"), "code physics changed"),
        (lambda p: (p / "physics" / "steel.csv").write_text("0,1\n"), "code physics changed"),
        (lambda p: (p / "physics" / "new.py").write_text(""), "code physics changed"),
        (lambda p: (p / "units.py").write_text("MM = 1\n"), "code units changed"),
        (lambda p: (p / "results" / "fit.txt").unlink(), "fit.txt is not there"),
        (lambda p: (p / "results" / "fit.txt").write_text(""), "fit.txt is not there"),
        (lambda p: (p / "results" / "fit.csv.provenance.json").write_text("{"), "fit.csv is not there"),
    ],
)
def test_any_change_makes_it_run_again_and_is_named(stage, project, capsys, change, reason):
    stage.run(work)
    change(project)
    capsys.readouterr()
    assert stage.run(work) is True
    assert capsys.readouterr().out.splitlines()[0] == f"fits: {reason}"
    assert stage.run(work) is False


def test_a_changed_value_makes_it_run_again(stage, project):
    stage.run(work)
    assert a_stage(project, machine={"airgap_mm": 0.6}).changes() == ["value machine changed"]
    assert a_stage(project, sweep={}).changes() == ["value sweep changed"]


def test_compiled_and_hidden_files_do_not_count(stage, project):
    stage.run(work)
    (project / "physics" / "__pycache__").mkdir()
    (project / "physics" / "__pycache__" / "law.pyc").write_text("x")
    (project / "physics" / ".law.py.swp").write_text("x")
    assert stage.changes() == []


def test_the_provenance_tells_what_the_result_was_made_from(stage):
    stage.run(work)
    for output in stage.outputs:
        record = json.loads((stage.folder / f"{output}.provenance.json").read_text())
        assert record["output"] == output and record["stage"] == "fits"
        assert set(record["inputs"]) == {"value machine", "file map.csv", "code physics", "code units"}
        assert record["values"] == {"machine": {"airgap_mm": 0.5}}
        assert record["tolerances"] == {"newton": 1e-6} and record["newton"] == [1.0, 0.1]
        assert record["packages"]["pydantic"] and record["python"].startswith("3.")
        assert record["wall_time_s"] >= 0 and "commit" in record and record["created"].endswith("+00:00")
        assert str(stage.folder.parent) not in json.dumps(record)


def test_a_stage_that_fails_on_the_way_does_not_look_current(stage, project):
    stage.run(work)
    (project / "map.csv").write_text("2\n")

    def fails(run):
        run.write_text("fit.txt", "half")
        raise RuntimeError("no")

    with pytest.raises(RuntimeError):
        stage.run(fails)
    (project / "map.csv").write_text("1\n")  # back to what the complete result was made from
    assert stage.changes() == ["fit.csv is not there", "fit.txt is not there"]


def test_outputs_are_those_declared(stage):
    with pytest.raises(StageError, match="without writing fit.csv, fit.txt"):
        stage.run(lambda run: None)
    with pytest.raises(StageError, match="other.csv, which is not among its outputs"):
        stage.run(lambda run: run.write_text("other.csv", ""))


def test_an_input_that_does_not_exist_is_named(stage, project):
    (project / "map.csv").unlink()
    with pytest.raises(StageError, match="fits needs map.csv, which does not exist"):
        stage.run(work)


def test_unknown_code_is_named(project):
    with pytest.raises(StageError, match="no package or module nothing.here"):
        code_hash("nothing.here")


def test_a_module_of_a_package_is_hashed_alone(project):
    before = code_hash("physics.law")
    (project / "physics" / "steel.csv").write_text("0,1\n")
    assert code_hash("physics.law") == before


def test_the_checkpoint_lives_until_the_stage_is_done(stage, project):
    def interrupted(run):
        run.checkpoint().add("point", 1)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        stage.run(interrupted)

    def goes_on(run):
        assert run.checkpoint()["point"] == 1
        work(run)

    stage.run(goes_on)
    assert not list(stage.folder.glob("*.jsonl"))


def test_the_checkpoint_of_changed_inputs_is_empty(stage, project):
    def interrupted(run):
        run.checkpoint().add("point", 1)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        stage.run(interrupted)
    (project / "physics" / "law.py").write_text("B = 2\n")

    def starts_anew(run):
        assert len(run.checkpoint()) == 0
        work(run)

    stage.run(starts_anew)


def test_writing_replaces_the_file_in_one_step_or_leaves_it(tmp_path):
    path = tmp_path / "fit.csv"
    path.write_text("old")

    def fails(temporary: Path):
        assert temporary.suffix == ".csv" and temporary.parent == tmp_path
        temporary.write_text("half")
        raise OSError("disk full")

    with pytest.raises(OSError):
        write_atomically(path, fails)
    assert path.read_text() == "old" and list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize(
    "error, code, text",
    [
        (StudyError("a.toml: machine.airgap_mm = -1 is wrong."), 2, "a.toml: machine.airgap_mm = -1 is wrong.\n"),
        (StageError("fits needs map.csv."), 1, "fits needs map.csv.\n"),
        (KeyboardInterrupt(), 130, "stopped\n"),
        (KeyboardInterrupt("3 of 9 are kept."), 130, "3 of 9 are kept.\n"),
    ],
)
def test_a_command_ends_with_a_sentence_and_a_code(capsys, error, code, text):
    with pytest.raises(SystemExit) as ended, command():
        raise error
    assert ended.value.code == code
    assert capsys.readouterr().err == text


def test_an_error_of_the_program_keeps_its_traceback(capsys):
    with pytest.raises(SystemExit), command():
        raise StageError("sweep: design 3 failed.") from ZeroDivisionError("division by zero")
    assert "ZeroDivisionError: division by zero\nsweep: design 3 failed.\n" in capsys.readouterr().err


def test_the_check_loads_nothing_slow():
    code = "import pipeline.stage, study.read, sys; print([m for m in ('numpy', 'scipy', 'gmsh') if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], cwd=PROJECT, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
