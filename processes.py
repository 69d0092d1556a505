"""Processes of this machine that run tasks: the stages of a run, the field solutions of a machine on the bench."""

from __future__ import annotations

import ctypes
import gc
import multiprocessing
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from multiprocessing.process import BaseProcess
from typing import Any, ParamSpec, TypeVar

# A solve on two BLAS threads is slower than on one, and the cores are busy with other tasks.
ONE_THREAD = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")

Task = TypeVar("Task")
Result = TypeVar("Result")
Arguments = ParamSpec("Arguments")


def use_one_thread() -> None:
    """BLAS of this process and of those that it starts on one thread; heeded where no library has loaded BLAS yet."""
    for variable in ONE_THREAD:
        os.environ[variable] = "1"


def give_memory_back() -> None:
    """Memory that this process has freed back to the system, which glibc does late or never where free and used blocks
    lie mixed; elsewhere nothing happens."""
    if sys.platform.startswith("linux"):
        trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
        if trim is not None:
            trim(0)


@contextmanager
def without_collecting() -> Iterator[None]:
    """No garbage is looked for among what comes to stay, as modules do: that takes a fifth of the time to load them."""
    gc.disable()
    try:
        yield
    finally:
        gc.freeze()
        gc.enable()


class LostWorker(Exception):
    """The worker that ran a task is gone."""


class Pool:
    """Where tasks run; ``size`` of them at once."""

    size: int

    def submit(self, function: Callable[[Task], Result], task: Task) -> Future[Result]:
        """Start a task; LostWorker where the pool has just lost a worker."""
        raise NotImplementedError

    def result(self, future: Future[Result]) -> Result:
        """Its result, or the exception that the function raised; LostWorker where its worker is gone."""
        raise NotImplementedError

    def end(self, now: bool = False) -> None:
        """Let go of the workers; now: without waiting for what they do."""
        raise NotImplementedError

    def idle(self) -> bool:
        """Whether no worker runs anything, as far as the pool can tell."""
        return False

    def recover(self) -> None:
        """After a lost worker: make the pool usable again."""
        self.end(now=True)


def default_workers() -> int:
    """Number of cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


class ThisProcess(Pool):
    """Runs tasks where they are submitted, one after the other."""

    size = 1

    def submit(self, function: Callable[[Task], Result], task: Task) -> Future[Result]:
        """See ``Pool.submit``."""
        future = Future[Result]()
        try:
            future.set_result(function(task))
        except Exception as error:  # noqa: BLE001 - whoever asks for the result is told
            future.set_exception(error)
        return future

    def result(self, future: Future[Result]) -> Result:
        """See ``Pool.result``."""
        return future.result()

    def end(self, now: bool = False) -> None:
        """See ``Pool.end``; there are none."""


class Processes(Pool):
    """Processes of this machine, started when the first task comes.

    size: how many; preload: modules that are imported once, before the workers are forked
    """

    def __init__(self, size: int | None = None, preload: tuple[str, ...] = ()):
        self.size, self.preload = size or default_workers(), preload
        self._executor: Executor | None = None
        self._children: set[BaseProcess] = set()

    def submit(self, function: Callable[[Task], Result], task: Task) -> Future[Result]:
        """See ``Pool.submit``."""
        try:
            return self._started().submit(_tidily, function, task)
        except BrokenProcessPool as error:
            raise LostWorker from error

    def result(self, future: Future[Result]) -> Result:
        """See ``Pool.result``."""
        try:
            return future.result()
        except BrokenProcessPool as error:
            raise LostWorker from error

    def end(self, now: bool = False) -> None:
        """See ``Pool.end``."""
        executor, self._executor = self._executor, None
        if executor is None:
            return
        executor.shutdown(wait=not now, cancel_futures=now)
        if now:
            for process in set(multiprocessing.active_children()) & self._children:
                process.terminate()

    def _started(self) -> Executor:
        if self._executor is None:
            use_one_thread()
            # Forking this process itself is not safe once libraries have started threads.
            context = multiprocessing.get_context("spawn" if sys.platform == "win32" else "forkserver")
            if hasattr(context, "set_forkserver_preload"):
                context.set_forkserver_preload(list(self.preload))
            self._executor = _TrackingExecutor(
                self._children, self.size, mp_context=context, initializer=_prepare_worker
            )
        return self._executor


class _TrackingExecutor(ProcessPoolExecutor):
    """Knows its processes, so that they can be ended at once."""

    def __init__(self, children: set[BaseProcess], *arguments: Any, **named: Any) -> None:
        super().__init__(*arguments, **named)
        self._ours = children

    def submit(
        self, fn: Callable[Arguments, Result], /, *args: Arguments.args, **kwargs: Arguments.kwargs
    ) -> Future[Result]:
        before = set(multiprocessing.active_children())
        future = super().submit(fn, *args, **kwargs)
        self._ours |= set(multiprocessing.active_children()) - before
        return future


def _tidily(function: Callable[[Task], Result], task: Task) -> Result:
    """Workers live as long as a run, and each stage would leave them larger: 0.64 GB in the place of 0.44 at most."""
    try:
        return function(task)
    finally:
        give_memory_back()


def _prepare_worker() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent decides what Ctrl-C means
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    """A worker of a killed run would wait for work for ever."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)
