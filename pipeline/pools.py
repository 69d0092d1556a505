"""Tasks on any ``concurrent.futures.Executor``: remaining time, finished tasks kept, lost workers replaced.

``Processes`` of this machine are the default, ``DaskCluster`` is a cluster of any size. A pool lives as long as a run;
its workers keep what they have imported from one stage to the next.
"""

from __future__ import annotations

import asyncio
import sys
from collections import Counter
from collections.abc import Callable, Collection, Mapping
from concurrent.futures import FIRST_COMPLETED, Future, wait
from dataclasses import dataclass
from tempfile import TemporaryDirectory
from types import ModuleType
from typing import Any

from tqdm import tqdm

from pipeline.checkpoint import Checkpoint
from processes import LostWorker, Pool, Result, Task, default_workers, use_one_thread

MOST_LOST_WORKERS = 3  # a task that ended its worker this often is given up
PATIENCE = 30.0  # s without a result, after which it is asked whether anybody still works
SCHEDULER_TIMEOUT = "20s"  # to find a dask scheduler
LOST_WORKER_TIMEOUT = "1w"  # before a dask cluster ends the keeper of a worker that was lost


class TaskError(RuntimeError):
    """Tasks without a result, after all others are finished; the sentence names them."""


class Interrupted(KeyboardInterrupt):
    """Ctrl-C during tasks; the message says what is kept and how to go on."""


class DaskCluster(Pool):
    """Workers of ``dask.distributed``, an optional package.

    address: of a scheduler, ``tcp://host:8786``; None starts a cluster of ``size`` processes on this machine.
    The scheduler blames every task that a lost worker had been given, so that it is told to report the first loss; who
    did it is found as for processes, by running the suspects alone. A lost worker's keeper starts the next one; the
    cluster is told not to end that keeper, as it would where the next one is lost while it looks.
    """

    def __init__(self, size: int | None = None, address: str | None = None) -> None:
        try:
            import dask  # noqa: PLC0415 - optional and heavy
            import distributed  # noqa: PLC0415
        except ImportError:
            raise TaskError(
                "the executor dask needs the package distributed; install it with `pip install -e '.[cluster]'`"
            ) from None
        dask.config.set(
            {"distributed.scheduler.allowed-failures": 0, "distributed.deploy.lost-worker-timeout": LOST_WORKER_TIMEOUT}
        )
        self._lost = distributed.scheduler.KilledWorker
        self._scratch = TemporaryDirectory(prefix="airgap-dask-")
        self._workers = size or default_workers()
        self._cluster = None if address else _local_cluster(distributed, self._workers, self._scratch.name)
        self.client = _client(distributed, address or self._cluster)
        self.client.wait_for_workers(1, timeout=60)
        self.size = max(1, 2 * sum(self.client.nthreads().values()))  # one task runs, the next is on its way

    def submit(self, function: Callable[[Task], Result], task: Task) -> Future[Result]:
        """See ``Pool.submit``.

        The client's own executor looks at a result's status after it has fetched the result: where a worker is lost in
        between, it takes the result for an exception.
        """
        submitted = self.client.submit(function, task, pure=False)
        found = self.client.gather(submitted, asynchronous=True)
        return asyncio.run_coroutine_threadsafe(found, self.client.loop.asyncio_loop)

    def result(self, future: Future[Result]) -> Result:
        """See ``Pool.result``."""
        try:
            return future.result()
        except self._lost as error:
            raise LostWorker from error

    def idle(self) -> bool:
        """See ``Pool.idle``; a worker that could not be replaced on a busy machine leaves its task to nobody."""
        return not any(self.client.processing().values())

    def recover(self) -> None:
        """The cluster replaces its workers itself, unless their replacements died as well.

        Only after ``PATIENCE`` without a worker does it get new ones: a replacement that comes while the cluster is
        made anew is closed with the task that it has just been given, and that task would be blamed.
        """
        if self._cluster is None:
            return
        try:
            self.client.wait_for_workers(1, timeout=PATIENCE)
        except TimeoutError:
            self._cluster.scale(0)
            self._cluster.scale(self._workers)
            self.client.wait_for_workers(1, timeout=60)

    def end(self, now: bool = False) -> None:
        """See ``Pool.end``."""
        self.client.close()
        if self._cluster is not None:
            self._cluster.close()
        self._scratch.cleanup()


def _local_cluster(distributed: ModuleType, size: int, scratch: str) -> Any:
    use_one_thread()
    return distributed.LocalCluster(
        n_workers=size,
        threads_per_worker=1,
        host="127.0.0.1",
        dashboard_address=":0",  # any that is free: another cluster may have the usual one
        silence_logs="ERROR",
        local_directory=scratch,
    )


def _client(distributed: ModuleType, where: Any) -> Any:
    try:
        return distributed.Client(where, timeout=SCHEDULER_TIMEOUT)
    except OSError as error:
        raise TaskError(f"no dask scheduler answers at {where} ({error}); start one with `dask scheduler`") from None


# ---- tasks with checkpoints ------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class PooledWorkers:
    """``tasks.Workers`` on a pool, with finished tasks kept in checkpoints.

    checkpoint_of: what -> the checkpoint of one call
    """

    stage: str
    pool: Pool
    checkpoint_of: Callable[[str], Checkpoint]

    def map(self, what: str, function: Callable[[Task], Result], tasks: Mapping[str, Task]) -> dict[str, Result]:
        """See ``tasks.Workers.map``.

        Raises TaskError naming the tasks that raised an exception or ended their worker three times, after all other
        tasks are finished; Interrupted after Ctrl-C.
        """
        checkpoint, title = self.checkpoint_of(what), what if what == self.stage else f"{self.stage}, {what}"
        todo = [name for name in tasks if name not in checkpoint]
        with _progress(len(tasks), len(tasks) - len(todo), title) as bar:

            def keep(name: str, result: object) -> None:
                checkpoint.add(name, result)
                bar.update()

            job = _Job(function, tasks, self.pool, keep)
            try:
                job.finish(todo)
            except KeyboardInterrupt:
                self.pool.end(now=True)
                done = sum(name in checkpoint for name in tasks)
                raise Interrupted(
                    f"{title}: stopped; {done} of {len(tasks)} are finished and kept, the same command goes on from "
                    "there."
                ) from None
        job.report(title)
        return {name: checkpoint[name] for name in tasks}


def first_of(names: list[str], most: int = 3) -> str:
    """The first of many in words, and how many more there are."""
    more = len(names) - most
    return ", ".join(names[:most]) + (f" and {more} more" if more > 0 else "")


def _progress(total: int, done: int, description: str) -> tqdm:
    interval = 0.2 if sys.stderr.isatty() else 10.0  # a log file gets a line now and then
    return tqdm(total=total, initial=done, desc=description, mininterval=interval, dynamic_ncols=True)


class _Job:
    """The tasks of one call, with what became of them."""

    def __init__(
        self,
        function: Callable[[Any], object],
        tasks: Mapping[str, Any],
        pool: Pool,
        keep: Callable[[str, object], None],
    ) -> None:
        self.function, self.tasks, self.pool, self.keep = function, tasks, pool, keep
        self.lost: Counter[str] = Counter()  # workers lost while they ran a task
        self.errors: dict[str, BaseException] = {}
        self.finished = 0

    def finish(self, names: list[str]) -> None:
        """Run the tasks together; after a lost worker run those in flight one by one, which shows who did it. Where
        every one of the first did it, the others are not tried."""
        waiting = list(names)
        while waiting and not self._is_hopeless:
            suspects = self._run_together(waiting, self.pool.size)
            while suspects and not self._is_hopeless:
                alone = [suspects.pop(0)]
                suspects = self._run_together(alone, 1) + suspects

    def report(self, title: str) -> None:
        """Raise TaskError when a task has no result."""
        if given_up := self._given_up:
            rest = "all other tasks are finished and kept" if not self._is_hopeless else "no task was finished by any"
            raise TaskError(
                f"{title}: {first_of(given_up)} ended its worker process {MOST_LOST_WORKERS} times (out of memory, or "
                f"a crash in a library); {rest}."
            )
        if self.errors:
            name, error = next(iter(self.errors.items()))
            more = f" (and {len(self.errors) - 1} more)" if len(self.errors) > 1 else ""
            raise TaskError(
                f"{title}: {name}{more} failed with {type(error).__name__}: {error}; "
                "all other tasks are finished and kept."
            ) from error

    @property
    def _given_up(self) -> list[str]:
        return [name for name, count in self.lost.items() if count >= MOST_LOST_WORKERS]

    @property
    def _is_hopeless(self) -> bool:
        """Whether workers only die: they may not even start."""
        return not (self.finished or self.errors) and len(self._given_up) >= MOST_LOST_WORKERS

    def _run_together(self, waiting: list[str], most: int) -> list[str]:
        """Take tasks from ``waiting`` until it is empty or a worker is lost; then return those to be tried again."""
        running: dict[Future[object], str] = {}
        try:
            while waiting or running:
                while waiting and len(running) < most:  # no more than can start: those in flight are known
                    running[self.pool.submit(self.function, self.tasks[waiting[0]])] = waiting[0]
                    waiting.pop(0)
                for future in self._done(running):
                    self._take(running[future], future)
                    del running[future]
        except LostWorker:
            for future in running:
                future.cancel()
            self.pool.recover()
            return self._struck(list(running.values()))
        return []

    def _done(self, running: Collection[Future[object]]) -> set[Future[object]]:
        """The next that are finished; LostWorker where nobody works on any of them."""
        while not (done := wait(running, timeout=PATIENCE, return_when=FIRST_COMPLETED).done):
            if self.pool.idle():
                raise LostWorker
        return done

    def _take(self, name: str, future: Future[object]) -> None:
        try:
            found = self.pool.result(future)
        except LostWorker:
            raise
        except Exception as error:  # noqa: BLE001 - whatever a task raises is reported with its name
            self.errors[name] = error
        else:
            self.keep(name, found)
            self.finished += 1
            self.lost.pop(name, None)

    def _struck(self, names: list[str]) -> list[str]:
        self.lost.update(names)
        return [name for name in names if self.lost[name] < MOST_LOST_WORKERS]
