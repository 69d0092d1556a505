"""Tasks: finished ones are kept whatever happens to others, to a worker, to the whole run, here and on a cluster."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from pipeline.checkpoint import Checkpoint
from pipeline.modules import PROJECT
from pipeline.pools import DaskCluster, PooledWorkers, TaskError
from pipeline.running import modules_of
from pipeline.stages import graph_of
from processes import Processes
from study.read import read_study

HERE = Path(__file__).parent
EXIT_INTERRUPTED = 130


@pytest.fixture(scope="module")
def processes():
    pool = Processes(2)
    yield pool
    pool.end()


@pytest.fixture(scope="module")
def cluster():
    pool = DaskCluster(2)
    yield pool
    pool.end()


@pytest.fixture(params=["processes", "cluster"])
def pool(request):
    return request.getfixturevalue(request.param)


@pytest.fixture
def path(tmp_path):
    return tmp_path / "run.jsonl"


def workers(pool, path):
    return PooledWorkers("designs", pool, lambda what: Checkpoint(path, "inputs"))


def test_results_come_in_the_order_of_the_tasks(pool, path, capsys):
    from worker_tasks import square

    tasks = {f"design {number}": number for number in (3, 1, 2)}
    assert workers(pool, path).map("squares", square, tasks) == {"design 3": 9, "design 1": 1, "design 2": 4}
    assert "designs, squares: 100%" in capsys.readouterr().err


def test_finished_tasks_are_not_run_again(pool, path):
    from worker_tasks import square, square_of_positive

    workers(pool, path).map("first", square, {"a": -1, "b": 2})
    again = workers(pool, path).map("second", square_of_positive, {"a": -1, "b": 2, "c": 3})
    assert again == {"a": 1, "b": 4, "c": 9}


def test_records_come_back_as_they_were(pool, path):
    from worker_tasks import design

    assert workers(pool, path).map("designs", design, {"a": 2.0})["a"] == design(2.0)


def test_workers_use_one_blas_thread(pool, path):
    from worker_tasks import threads

    assert workers(pool, path).map("threads", threads, {"a": 0}) == {"a": "1"}


@pytest.mark.parametrize("deaths", [1, 2])
def test_a_lost_worker_is_replaced_and_its_task_tried_again(pool, path, tmp_path, deaths):
    from worker_tasks import square_or_die

    file = tmp_path / "deaths"
    file.write_text(str(deaths))
    tasks = {"a": (1, None), "b": (2, str(file)), "c": (3, None), "d": (4, None)}
    assert workers(pool, path).map("squares", square_or_die, tasks) == {"a": 1, "b": 4, "c": 9, "d": 16}


def test_a_task_that_always_ends_its_worker_is_named_and_the_others_are_kept(pool, path, tmp_path):
    from worker_tasks import square_or_die

    file = tmp_path / "deaths"
    file.write_text("1000")
    tasks = {"a": (1, None), "bad one": (2, str(file)), "c": (3, None)}
    with pytest.raises(TaskError, match="bad one.* ended its worker process 3 times"):
        workers(pool, path).map("squares", square_or_die, tasks)
    kept = Checkpoint(path, "inputs")
    assert "a" in kept and "c" in kept and "bad one" not in kept


def test_where_workers_only_die_not_all_tasks_are_tried(processes, path, tmp_path):
    from worker_tasks import square_or_die

    files = [tmp_path / f"deaths {number}" for number in range(50)]
    for file in files:
        file.write_text("1000")
    tasks = {file.name: (1, str(file)) for file in files}
    with pytest.raises(TaskError, match=r"deaths \d+, deaths \d+, deaths \d+ .* no task was finished by any"):
        workers(processes, path).map("squares", square_or_die, tasks)
    assert sum(1000 - int(file.read_text()) for file in files) < 15


def test_a_cluster_without_workers_gets_new_ones(path, monkeypatch):
    """As when the replacements of lost workers die too: their tasks would wait for ever."""
    from worker_tasks import square

    monkeypatch.setattr("pipeline.pools.PATIENCE", 0.5)
    pool = DaskCluster(1)
    pool._cluster.scale(0)
    while pool.client.scheduler_info()["workers"]:
        time.sleep(0.05)
    assert workers(pool, path).map("squares", square, {"a": 3}) == {"a": 9}
    pool.end()


def test_a_result_that_was_fetched_counts_though_its_worker_is_lost_then(path, monkeypatch):
    """A worker that dies after a result has been fetched, and before its status is looked at."""
    import distributed
    from worker_tasks import square

    gathered = distributed.Client._gather

    async def gather_and_lose(client, futures, **options):
        found = await gathered(client, futures, **options)
        for future in distributed.client.futures_of(futures):
            future._state.lose()
        return found

    monkeypatch.setattr(distributed.Client, "_gather", gather_and_lose)
    pool = DaskCluster(1)
    assert workers(pool, path).map("squares", square, {"a": 3, "b": 4}) == {"a": 9, "b": 16}
    pool.end()


def test_an_error_in_a_task_is_named_with_its_cause_and_the_others_are_kept(pool, path):
    from worker_tasks import square_of_positive

    with pytest.raises(TaskError, match="minus one failed with ValueError: -1 is negative") as caught:
        workers(pool, path).map("squares", square_of_positive, {"minus one": -1, "two": 2})
    assert isinstance(caught.value.__cause__, ValueError) and "two" in Checkpoint(path, "inputs")


def start_slow_run(path):
    environment = {**os.environ, "PYTHONPATH": f"{HERE}{os.pathsep}{PROJECT}"}
    return subprocess.Popen(
        [sys.executable, HERE / "interrupted_run.py", path], stderr=subprocess.PIPE, text=True, env=environment
    )


def wait_for_points(path, number):
    end = time.monotonic() + 60
    while time.monotonic() < end:
        if path.is_file() and len(Checkpoint(path, "inputs")) >= number:
            return
        time.sleep(0.05)
    raise AssertionError("the run did not get anywhere")


def children_of(pid):
    found = subprocess.run(["ps", "-o", "pid=", "--ppid", str(pid)], capture_output=True, text=True).stdout.split()
    return [int(one) for one in found]


def test_ctrl_c_keeps_what_is_finished_and_says_how_to_go_on(path):
    run = start_slow_run(path)
    wait_for_points(path, 3)
    run.send_signal(signal.SIGINT)
    _, errors = run.communicate(timeout=30)
    assert run.returncode == EXIT_INTERRUPTED
    assert "are finished and kept, the same command goes on from there." in errors and "Traceback" not in errors
    assert 3 <= len(Checkpoint(path, "inputs")) < 30


def test_a_killed_run_loses_nothing_and_leaves_no_workers(path):
    run = start_slow_run(path)
    wait_for_points(path, 3)
    workers_of_run = [grandchild for child in children_of(run.pid) for grandchild in children_of(child)]
    run.kill()
    run.communicate(timeout=30)
    end = time.monotonic() + 20
    while time.monotonic() < end and any(Path(f"/proc/{pid}").exists() for pid in workers_of_run):
        time.sleep(0.1)
    assert not any(Path(f"/proc/{pid}").exists() for pid in workers_of_run)
    assert len(Checkpoint(path, "inputs")) >= 3


def test_no_scheduler_at_the_address_is_said_in_a_sentence(monkeypatch):
    import pipeline.pools

    monkeypatch.setattr(pipeline.pools, "SCHEDULER_TIMEOUT", "1s")
    with pytest.raises(TaskError, match="no dask scheduler answers at tcp://127.0.0.1:1"):
        DaskCluster(address="tcp://127.0.0.1:1")


KEPT = []


def resident_mb(_):
    return next(int(line.split()[1]) / 1024 for line in Path("/proc/self/status").open() if line.startswith("VmRSS"))


def leave_holes(count):
    """Blocks of which the last one stays, so that the heap cannot shrink from its end by itself."""
    blocks = [bytes(1000) for _ in range(count)]
    KEPT.append(blocks.pop())
    return len(blocks)


@pytest.mark.skipif(sys.platform != "linux", reason="asks /proc; elsewhere nothing is given back")
def test_a_worker_is_no_larger_after_a_task_than_before():
    pool = Processes(1)
    before, _, after = (
        pool.result(pool.submit(*one)) for one in ((resident_mb, 0), (leave_holes, 100_000), (resident_mb, 0))
    )
    pool.end()
    assert after < before + 20


def test_workers_have_no_tables_loaded():
    """Of 0.28 GB that a worker starts with pandas and xarray would be 0.08."""
    modules = ", ".join(modules_of(graph_of(read_study("motorcycle"))))
    look = f"import sys, {modules}; print([name for name in ('pandas.core', 'xarray.core') if name in sys.modules])"
    end = subprocess.run([sys.executable, "-c", look], cwd=PROJECT, capture_output=True, text=True, check=True)
    assert end.stdout.strip() == "[]"
