"""Parallel tasks: finished ones are kept whatever happens to the others, to a worker or to the whole run."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from pipeline.checkpoint import Checkpoint
from pipeline.parallel import run_parallel
from pipeline.stage import PROJECT, StageError

HERE = Path(__file__).parent


@pytest.fixture(autouse=True)
def importable_tasks(monkeypatch):
    monkeypatch.syspath_prepend(HERE)


@pytest.fixture
def checkpoint(tmp_path):
    return Checkpoint(tmp_path / "run.jsonl", "inputs")


def test_results_come_in_the_order_of_the_tasks(checkpoint, capsys):
    from worker_tasks import square

    tasks = {f"design {number}": number for number in (3, 1, 2)}
    assert run_parallel(square, tasks, 2, checkpoint, "designs") == {"design 3": 9, "design 1": 1, "design 2": 4}
    assert "designs: 100%" in capsys.readouterr().err


def test_finished_tasks_are_not_run_again(checkpoint):
    from worker_tasks import square, square_of_positive

    run_parallel(square, {"a": -1, "b": 2}, 2, checkpoint, "first")
    again = Checkpoint(checkpoint.path, "inputs")
    assert run_parallel(square_of_positive, {"a": -1, "b": 2, "c": 3}, 2, again, "second") == {"a": 1, "b": 4, "c": 9}


def test_a_task_with_another_argument_is_another_task(checkpoint):
    from worker_tasks import square

    run_parallel(square, {"a": 1}, 1, checkpoint, "first")
    assert run_parallel(square, {"a": 2}, 1, checkpoint, "second") == {"a": 4}


def test_workers_use_one_blas_thread(checkpoint, monkeypatch):
    from worker_tasks import threads

    assert run_parallel(threads, {"a": 0}, 1, checkpoint, "threads") == {"a": "1"}


@pytest.mark.parametrize("deaths", [1, 2])
def test_a_lost_worker_is_replaced_and_its_task_tried_again(checkpoint, tmp_path, deaths):
    from worker_tasks import square_or_die

    (tmp_path / "deaths").write_text(str(deaths))
    tasks = {f"design {n}": (n, str(tmp_path / "deaths") if n == 2 else None) for n in range(5)}
    assert run_parallel(square_or_die, tasks, 2, checkpoint, "designs") == {f"design {n}": n**2 for n in range(5)}


def test_a_task_that_ends_its_worker_three_times_is_named_and_the_others_are_kept(checkpoint, tmp_path):
    from worker_tasks import square_or_die

    (tmp_path / "deaths").write_text("100")
    tasks = {f"design {n}": (n, str(tmp_path / "deaths") if n == 2 else None) for n in range(5)}
    with pytest.raises(StageError, match="designs: design 2 ended its worker process 3 times"):
        run_parallel(square_or_die, tasks, 2, checkpoint, "designs")
    assert (tmp_path / "deaths").read_text() == "97"
    assert len(Checkpoint(checkpoint.path, "inputs")) == 4


def test_an_exception_names_the_task_and_the_others_are_kept(checkpoint):
    from worker_tasks import square_of_positive

    with pytest.raises(StageError, match="designs: b failed with ValueError: -2 is negative") as caught:
        run_parallel(square_of_positive, {"a": 1, "b": -2, "c": 3}, 2, checkpoint, "designs")
    assert isinstance(caught.value.__cause__, ValueError)
    assert len(Checkpoint(checkpoint.path, "inputs")) == 2


# ------------------------------------------------------------------------- whole runs that are stopped


def start(path: Path) -> subprocess.Popen:
    """A run of 30 slow tasks in a process group of its own, as a terminal would start it."""
    paths = os.pathsep.join((str(PROJECT), str(HERE)))
    return subprocess.Popen(
        [sys.executable, str(HERE / "interrupted_run.py"), str(path)],
        env={**os.environ, "PYTHONPATH": paths},
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        preexec_fn=listen_to_ctrl_c,
    )


def listen_to_ctrl_c() -> None:
    """A shell without job control starts its background jobs, and so this test, deaf to Ctrl-C."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def wait_for_points(path: Path, count: int) -> None:
    deadline = time.monotonic() + 30
    while time.monotonic() < deadline:
        if len(Checkpoint(path, "inputs")) >= count:
            return
        time.sleep(0.05)
    raise AssertionError("the run finished no point")


def wait_until_alone(group: int) -> bool:
    """True when no process of the group is left after some seconds."""
    deadline = time.monotonic() + 10
    while time.monotonic() < deadline:
        try:
            os.killpg(group, 0)
        except ProcessLookupError:
            return True
        time.sleep(0.1)
    return False


@pytest.mark.skipif(os.name != "posix", reason="signals of a terminal")
def test_ctrl_c_keeps_finished_points_says_how_to_go_on_and_leaves_no_process(tmp_path):
    path = tmp_path / "run.jsonl"
    process = start(path)
    wait_for_points(path, 2)
    os.killpg(process.pid, signal.SIGINT)
    _, said = process.communicate(timeout=20)
    kept = len(Checkpoint(path, "inputs"))
    assert process.returncode == 130 and "Traceback" not in said
    assert f"slow run: stopped; {kept} of 30 are finished and kept, the same command goes on from there." in said
    assert 2 <= kept < 30 and wait_until_alone(process.pid)


@pytest.mark.skipif(os.name != "posix", reason="signals of a terminal")
def test_a_killed_run_leaves_its_points_and_no_workers(tmp_path):
    path = tmp_path / "run.jsonl"
    process = start(path)
    wait_for_points(path, 2)
    process.kill()
    process.communicate(timeout=20)
    assert len(Checkpoint(path, "inputs")) >= 2 and wait_until_alone(process.pid)
