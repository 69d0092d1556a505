"""A stage runs when something that it reads changed, says why, leaves whole results or none; every end has a report."""

import json
import os
import stat
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from toy_graph import (
    GRAPH,
    SQUARES,
    SUMMARY,
    Extra,
    Inputs,
    Largest,
    NoFit,
    Squares,
    StudyOfToys,
    Summary,
    file_of_a_process,
    file_of_a_survivor,
    file_of_nobody,
    inputs,
    largest,
)

import pipeline.closure
import pipeline.modules
import pipeline.run
from figures.files import text_file
from pipeline.graph import Graph, Source, Stage, View
from pipeline.results import Results, ResultsError
from pipeline.run import Run
from processes import Processes, ThisProcess


def go(folder, study=StudyOfToys(), graph=GRAPH, drawing=ThisProcess()):
    run = Run(graph, study, Results(folder), ThisProcess(), drawing)
    with run.results.held():
        run.all(graph.stages)
        run.write_report(page)
    return run


def page(study, sections, failures):
    lines = [f"FAILED {one.stage}: {one.reason}" for one in failures] + [one.title for one in sections]
    return text_file("report.html", "\n".join(lines))


def said(capsys):
    return [line for line in capsys.readouterr().out.splitlines() if "done in" not in line]


def test_a_second_run_does_nothing(tmp_path, capsys):
    go(tmp_path)
    assert (tmp_path / "summary.txt").read_text() == "the largest is 4\n"
    capsys.readouterr()
    go(tmp_path)
    assert said(capsys) == [
        "squares: unchanged, not run again",
        "summary: unchanged, not run again",
        "report: unchanged, not written again",
    ]


@pytest.mark.parametrize("name", ["squares.json", "squares.nc", "summary.json", "summary.txt", "report.html"])
@pytest.mark.parametrize("spoil", [lambda p: p.write_bytes(p.read_bytes()[:-1] + b"~"), Path.unlink])
def test_an_edited_byte_or_an_absent_file_is_noticed(tmp_path, capsys, name, spoil):
    go(tmp_path)
    before = (tmp_path / name).read_bytes()
    spoil(tmp_path / name)
    capsys.readouterr()
    go(tmp_path)
    assert any("not there" in line for line in said(capsys))
    assert (tmp_path / name).read_bytes() == before


@pytest.mark.parametrize(
    "content", ["", "{", "[]", "7", '{"outputs": 3}', '{"outputs": {"a": 1}, "inputs": {}}', "\0", "[" * 100000]
)
def test_malformed_provenance_counts_as_absent(tmp_path, content):
    go(tmp_path)
    (tmp_path / "provenance" / "squares.json").write_text(content)
    assert Results(tmp_path).record("squares") is None
    go(tmp_path)
    assert Results(tmp_path).record("squares") is not None


def test_a_changed_input_is_named_and_only_what_reads_it_runs(tmp_path, capsys):
    go(tmp_path)
    capsys.readouterr()
    go(tmp_path, StudyOfToys(count=4))
    assert said(capsys)[:3] == ["squares: Inputs changed", "summary: Largest changed, Inputs changed",
                                "summary.files: Summary changed"]  # fmt: skip


def test_what_a_stage_has_to_say_is_said_when_it_ran(tmp_path, capsys):
    def remarks(summary: Summary, inputs: Inputs):
        yield f"{summary.text}, of {inputs.count}"

    nodes = tuple(replace(n, remarks=remarks) if n is SUMMARY else n for n in GRAPH.nodes)
    graph = replace(GRAPH, nodes=nodes)
    go(tmp_path, graph=graph)
    assert "summary: the largest is 4, of 3" in said(capsys)
    go(tmp_path, graph=graph)
    assert not any("the largest" in line for line in said(capsys))


@pytest.fixture(scope="module")
def elsewhere():
    pool = Processes(1)
    yield pool
    pool.end()


def with_files(function):
    return replace(GRAPH, nodes=tuple(replace(n, files=function) if n is SUMMARY else n for n in GRAPH.nodes))


def test_files_are_drawn_in_a_process_of_their_own(tmp_path, elsewhere, capsys):
    run = go(tmp_path, graph=with_files(file_of_a_process), drawing=elsewhere)
    assert int((tmp_path / "summary.txt").read_text()) != os.getpid()
    assert list(run.results.record("summary.files")["outputs"]) == ["summary.txt"]
    capsys.readouterr()
    go(tmp_path, graph=with_files(file_of_a_process), drawing=elsewhere)
    assert not any("summary.files" in line for line in said(capsys))


def test_files_are_drawn_here_where_that_process_dies(tmp_path, elsewhere):
    run = go(tmp_path, graph=with_files(file_of_a_survivor), drawing=elsewhere)
    assert int((tmp_path / "summary.txt").read_text()) == os.getpid() and not run.failures


def test_files_that_cannot_be_drawn_are_said_and_the_report_is_there(tmp_path, elsewhere, capsys):
    (failure,) = go(tmp_path, graph=with_files(file_of_nobody), drawing=elsewhere).failures
    assert failure.stage == "summary.files"
    assert failure.reason == "a fault of the program: ZeroDivisionError: nothing to divide by"
    assert "file_of_nobody" in capsys.readouterr().err  # where it was
    assert (tmp_path / "report.html").read_text().startswith("FAILED summary.files: ")


def test_an_equal_value_of_a_view_stops_the_change(tmp_path, capsys):
    def constant(squares: Squares) -> Largest:
        return Largest(1)

    nodes = tuple(View(constant) if isinstance(n, View) and n.function is largest else n for n in GRAPH.nodes)
    graph = replace(GRAPH, nodes=nodes)
    go(tmp_path, graph=graph)
    capsys.readouterr()
    go(tmp_path, StudyOfToys(count=4), graph)
    assert "summary: Inputs changed" in said(capsys)


def test_a_changed_package_version_is_noticed(tmp_path, capsys, monkeypatch):
    go(tmp_path)
    capsys.readouterr()
    versions = pipeline.run.packages_of
    monkeypatch.setattr(pipeline.run, "packages_of", lambda *f: versions(*f) | {"numpy": "0.1"})
    go(tmp_path)
    assert said(capsys)[0] == "squares: package numpy changed"


def test_changed_code_anywhere_behind_a_stage_is_noticed(tmp_path, capsys, monkeypatch):
    go(tmp_path)
    capsys.readouterr()
    hashed = pipeline.closure._file_hash
    changed = pipeline.modules.PROJECT / "figures" / "style.py"  # which figures.files imports
    monkeypatch.setattr(pipeline.closure, "_file_hash", lambda p: "other" if p == changed else hashed(p))
    go(tmp_path)
    assert said(capsys)[0] == "squares: code changed"


def test_what_compilers_leave_beside_the_code_is_not_code():
    """It appears while a first run goes on, which is no reason to do everything again."""
    folder = pipeline.modules.PROJECT / "actuator" / "__pycache__"
    folder.mkdir(exist_ok=True)
    left = folder / "left.nbi"
    left.write_bytes(b"compiled")
    try:
        assert left not in pipeline.closure._data_of.__wrapped__(pipeline.modules.PROJECT / "actuator")
    finally:
        left.unlink()


def test_the_closure_finds_what_no_list_names():
    found = pipeline.closure.files_of("magnetostatics.case")
    names = {path.relative_to(pipeline.modules.PROJECT).as_posix() for path in found}
    assert {"magnetostatics/assembly.py", "geometry/plane_mesh.py", "units.py"} <= names
    assert "materials/steels/35PN270_bh.csv" in names
    assert not any(name.startswith(("workbench", "vehicle", "tests")) for name in names)


def test_the_provenance_tells_what_a_result_was_made_from(tmp_path):
    go(tmp_path)
    record = json.loads((tmp_path / "provenance" / "summary.json").read_text())
    assert {"Largest", "Inputs", "Extra", "code", "package numpy", "package python"} <= record["inputs"].keys()
    assert record["inputs"]["Extra"] == "absent" and record["outputs"].keys() == {"summary.json"}
    assert str(tmp_path) not in json.dumps(record)


# ---- ends -----------------------------------------------------------------------------------------------------------


def test_a_refusal_ends_with_a_report_of_what_was_found(tmp_path):
    run = go(tmp_path, StudyOfToys(refuse=True))
    told = [(one.stage, one.reason) for one in run.failures]
    assert told == [("summary", "no summary: refuse is set; set it to false")]
    assert (tmp_path / "report.html").read_text() == (
        "FAILED summary: no summary: refuse is set; set it to false\nSquares"
    )


def test_stale_results_of_a_stage_that_now_fails_are_not_in_the_report(tmp_path):
    go(tmp_path)
    go(tmp_path, StudyOfToys(refuse=True))
    assert "Summary" not in (tmp_path / "report.html").read_text()


def test_a_fault_of_the_program_ends_with_its_traceback_and_a_report(tmp_path, capsys):
    run = go(tmp_path, StudyOfToys(count=0))  # the largest of nothing
    assert run.failures[0].reason.startswith("a fault of the program: ValueError")
    assert "Traceback" in capsys.readouterr().err and "Squares" in (tmp_path / "report.html").read_text()


def test_what_needs_a_failed_stage_is_left_out(tmp_path):
    def after(summary: Summary) -> Extra:
        raise AssertionError("must not be called")

    graph = Graph(
        (
            Source(inputs),
            View(largest),
            SQUARES,
            replace(SUMMARY, function=_refusing, files=None),
            Stage("after", after, ""),
        ),
        refusals=GRAPH.refusals,
    )
    run = go(tmp_path, graph=graph)
    assert [one.stage for one in run.failures] == ["summary", "after"]
    assert "needs the result of summary" in run.failures[1].reason


def _refusing(largest: Largest) -> Summary:
    raise NoFit("no")


# ---- faults of the machine ------------------------------------------------------------------------------------------


def test_a_second_run_on_one_folder_ends_in_a_sentence(tmp_path):
    with Results(tmp_path).held():
        imports = "from pathlib import Path; from pipeline.results import Results"
        code = f"{imports}\nwith Results(Path({str(tmp_path)!r})).held(): pass"
        command, project = [sys.executable, "-c", code], pipeline.modules.PROJECT
        done = subprocess.run(command, capture_output=True, text=True, cwd=project)
    assert done.returncode == 1 and "another run is at work in" in done.stderr.splitlines()[-1]


def test_a_full_disk_is_said_in_a_sentence_and_nothing_half_written_is_left(tmp_path):
    def full(path):
        path.write_text("half")
        raise OSError(28, "No space left on device")

    with pytest.raises(ResultsError, match="map.nc cannot be written .No space left on device.; free space"):
        Results(tmp_path).write("map.nc", full)
    assert list(tmp_path.iterdir()) == []


def test_a_disk_that_is_really_full(tmp_path):
    if os.geteuid() != 0 or subprocess.run(["mount", "-t", "tmpfs", "-o", "size=64k", "none", tmp_path]).returncode:
        pytest.skip("needs the right to mount a small disk")
    try:
        with pytest.raises(ResultsError, match="No space left on device"):
            Results(tmp_path).write("map.nc", lambda path: path.write_bytes(b"x" * 10**6))
    finally:
        subprocess.run(["umount", tmp_path], check=True)


def test_a_folder_that_cannot_be_made_is_said_in_a_sentence(tmp_path):
    (tmp_path / "results").write_text("a file where the folder should be")
    with pytest.raises(ResultsError, match="cannot be written"), Results(tmp_path / "results" / "motorcycle").held():
        pass


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_a_read_only_folder_is_said_in_a_sentence(tmp_path):
    tmp_path.chmod(stat.S_IRUSR | stat.S_IXUSR)
    with pytest.raises(ResultsError, match="Permission denied"), Results(tmp_path).held():
        pass


def test_temporary_files_of_a_killed_run_go_away(tmp_path):
    (tmp_path / "figures").mkdir()
    for name in (".map.partab12.nc", "figures/.fits.partxy.png"):
        (tmp_path / name).write_text("half")
    with Results(tmp_path).held():
        pass
    assert [path.name for path in tmp_path.rglob("*") if path.is_file()] == [".lock"]


def test_a_file_is_on_the_disk_before_it_takes_its_place(tmp_path, monkeypatch):
    calls = []
    monkeypatch.setattr(os, "fsync", lambda handle: calls.append("fsync"))
    monkeypatch.setattr(os, "replace", lambda a, b: calls.append("replace"))
    Results(tmp_path).write("a.txt", lambda path: path.write_text("whole"))
    assert calls == ["fsync", "replace"]
