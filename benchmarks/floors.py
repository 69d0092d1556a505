"""What no sparse factorisation on this machine can beat: its arithmetic and its memory traffic at measured rates."""

from __future__ import annotations

import time
from functools import cache
from statistics import median

import numpy as np

_REPEATS = 5
_BYTES = 8  # of a number in double precision


def arithmetic_floor(column_counts: np.ndarray) -> float:
    """Time [s] of a Cholesky factorisation at full rate: its operations are the squared entries of every column."""
    return float((column_counts.astype(float) ** 2).sum()) / multiplication_rate()


def memory_floor(column_counts: np.ndarray) -> float:
    """Time [s] to write the factor once."""
    return float(column_counts.sum()) * _BYTES / copy_rate()


@cache
def multiplication_rate(size: int = 1000) -> float:
    """Operations per second of a product of large matrices on the threads that BLAS has now [1/s]."""
    a = np.random.default_rng(0).random((size, size))
    return 2 * size**3 / _time(lambda: a @ a)


@cache
def copy_rate(count: int = 20_000_000) -> float:
    """Bytes per second that a copy larger than all caches writes [B/s]."""
    source, target = np.ones(count), np.empty(count)
    return count * _BYTES / _time(lambda: np.copyto(target, source))


def _time(action) -> float:
    action()
    times = []
    for _ in range(_REPEATS):
        began = time.process_time()
        action()
        times.append(time.process_time() - began)
    return median(times)
