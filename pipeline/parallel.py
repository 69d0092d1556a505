"""Many independent tasks on all cores: progress with remaining time, finished tasks kept, lost workers replaced."""

from __future__ import annotations

import multiprocessing
import os
import signal
import sys
import threading
from collections import Counter
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from typing import Callable, Mapping

from tqdm import tqdm

from pipeline.checkpoint import Checkpoint, digest
from pipeline.stage import StageError

MOST_LOST_WORKERS = 3  # a task that ended its worker this often is given up
# A solve on two BLAS threads is slower than on one, and the cores are busy with other tasks.
_ONE_THREAD = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")


class Interrupted(KeyboardInterrupt):
    """Ctrl-C during a parallel run; the message says what is kept and how to go on."""


def default_workers() -> int:
    """Number of cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def run_parallel(
    function: Callable, tasks: Mapping[str, object], workers: int, checkpoint: Checkpoint, description: str
) -> dict[str, object]:
    """``{name: function(argument)}`` for every task, each on a worker process.

    function: importable by its name (top level of a module), takes one argument, returns what JSON can hold
    tasks: argument of each task by the task's name, in the order in which they start
    workers: number of processes
    checkpoint: holds finished tasks, which are not run again; it may be filled by an earlier run
    description: what the progress bar is called
    Returns the results in the order of the tasks, as JSON gives them back.
    Raises StageError naming the tasks that raised an exception or ended their worker three times, after all other
    tasks are finished; Interrupted after Ctrl-C.
    """
    keys = {name: digest([name, argument]) for name, argument in tasks.items()}
    todo = [name for name in tasks if keys[name] not in checkpoint]
    with _progress(len(tasks), len(tasks) - len(todo), description) as bar:

        def keep(name, result):
            checkpoint.add(keys[name], result)
            bar.update()

        job = _Job(function, tasks, workers, keep)
        try:
            job.finish(todo)
        except KeyboardInterrupt:
            done = sum(key in checkpoint for key in keys.values())
            raise Interrupted(_how_to_go_on(description, done, len(tasks))) from None
    job.report(description)
    return {name: checkpoint[key] for name, key in keys.items()}


def _progress(total: int, done: int, description: str) -> tqdm:
    interval = 0.2 if sys.stderr.isatty() else 10.0  # a log file gets a line now and then
    return tqdm(total=total, initial=done, desc=description, mininterval=interval, dynamic_ncols=True)


def _how_to_go_on(description: str, done: int, total: int) -> str:
    return f"{description}: stopped; {done} of {total} are finished and kept, the same command goes on from there."


class _Job:
    """The tasks of one run, with what became of them."""

    def __init__(self, function: Callable, tasks: Mapping[str, object], workers: int, keep: Callable):
        self.function, self.tasks, self.workers, self.keep = function, tasks, workers, keep
        self.lost: Counter = Counter()  # workers lost while they ran a task
        self.errors: dict[str, BaseException] = {}

    def finish(self, names: list[str]) -> None:
        """Run the tasks together; after a lost worker run those in flight one by one, which shows who did it."""
        waiting = list(names)
        while waiting:
            suspects = self._run_together(waiting, self.workers)
            while suspects:
                alone = [suspects.pop(0)]
                suspects = self._run_together(alone, 1) + suspects

    def report(self, description: str) -> None:
        """Raise StageError when a task has no result."""
        given_up = [name for name, count in self.lost.items() if count >= MOST_LOST_WORKERS]
        if given_up:
            raise StageError(
                f"{description}: {', '.join(given_up)} ended its worker process {MOST_LOST_WORKERS} times (out of "
                "memory, or a crash in a library); all other tasks are finished and kept."
            )
        if self.errors:
            name, error = next(iter(self.errors.items()))
            more = f" (and {len(self.errors) - 1} more)" if len(self.errors) > 1 else ""
            raise StageError(
                f"{description}: {name}{more} failed with {type(error).__name__}: {error}; "
                "all other tasks are finished and kept."
            ) from error

    def _run_together(self, waiting: list[str], workers: int) -> list[str]:
        """Take tasks from ``waiting`` until it is empty or a worker is lost; then return those to be tried again."""
        running: dict[Future, str] = {}
        with _pool(workers, self.function.__module__) as pool:
            try:
                while waiting or running:
                    while waiting and len(running) < workers:  # no more than can start: those in flight are known
                        name = waiting[0]
                        running[pool.submit(self.function, self.tasks[name])] = name
                        waiting.pop(0)
                    for future in wait(running, return_when=FIRST_COMPLETED).done:
                        self._take(running[future], future)
                        del running[future]
            except BrokenProcessPool:
                return self._struck(list(running.values()))
        return []

    def _take(self, name: str, future: Future) -> None:
        error = future.exception()
        if isinstance(error, BrokenProcessPool):
            raise error
        if error is not None:
            self.errors[name] = error
        else:
            self.keep(name, future.result())
            self.lost.pop(name, None)

    def _struck(self, names: list[str]) -> list[str]:
        self.lost.update(names)
        return [name for name in names if self.lost[name] < MOST_LOST_WORKERS]


@contextmanager
def _pool(workers: int, module: str):
    """A pool of fresh processes that are ended at once when the body is left by an exception."""
    for variable in _ONE_THREAD:
        os.environ[variable] = "1"
    # Forking this process itself is not safe once libraries have started threads.
    context = multiprocessing.get_context("spawn" if sys.platform == "win32" else "forkserver")
    if hasattr(context, "set_forkserver_preload"):
        context.set_forkserver_preload([module])  # slow imports once, not in every worker
    earlier = set(multiprocessing.active_children())
    pool = ProcessPoolExecutor(workers, mp_context=context, initializer=_prepare_worker)
    try:
        yield pool
    except BaseException:
        pool.shutdown(wait=False, cancel_futures=True)
        for process in set(multiprocessing.active_children()) - earlier:
            process.terminate()
        raise
    pool.shutdown()


def _prepare_worker() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent decides what Ctrl-C means
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    """A worker of a killed run would wait for work for ever."""
    multiprocessing.parent_process().join()
    os._exit(1)
