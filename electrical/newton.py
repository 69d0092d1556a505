"""Newton's method for two unknowns in many problems at once, each with its own step length."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

_MOST_ITERATIONS = 60
_HALVINGS = 10  # of a step that does not come nearer

Function = Callable[[np.ndarray], np.ndarray]


def damped_newton(
    miss: Function, slope: Function, start: np.ndarray, close: np.ndarray | float
) -> tuple[np.ndarray, np.ndarray]:
    """(x, found): where what is missing vanishes [unit of the start] (2, k), and in which problems it was found (k,).

    miss: x (2, k) -> what is wanted less what is there (2, k); slope: derivatives of what is there (2, 2, k)
    start: [unit of x] (2, k); close: size of what is missing that is none [unit of ``miss``], a number or (k,)
    """
    x, left = start, miss(start)
    for _ in range(_MOST_ITERATIONS):
        if np.all(np.hypot(*left) <= close):
            break
        x, left = _nearer(miss, x, _solve_2x2(slope(x), left), np.maximum(np.hypot(*left), close))
    return x, np.hypot(*left) <= close


def _nearer(miss: Function, x: np.ndarray, step: np.ndarray, size: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The longest of the steps 1, 1/2, 1/4 ... that leaves no more than ``size`` (k,), and what it leaves."""
    length = np.ones_like(size)
    for _ in range(_HALVINGS):
        trial = x + length * step
        found = miss(trial)
        worse = np.hypot(*found) > size
        if not worse.any():
            break
        length = np.where(worse, length / 2, length)
    return trial, found


def _solve_2x2(matrix: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Solutions (2, k) of k systems (2, 2, k)."""
    (a, b), (c, d) = matrix
    return np.stack([d * right[0] - b * right[1], a * right[1] - c * right[0]]) / (a * d - b * c)
