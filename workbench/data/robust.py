"""The size of what scatters, when a few of it are wild."""

from __future__ import annotations

import numpy as np

WILD = 2.5  # standard deviations from which a disagreement counts as that many only
TAME_SHARE = 0.9749  # mean of min(d^2, WILD^2) of a standard normal d
ROUNDS = 20  # in which the size of what is not cut is found


def size_of(disagreements: np.ndarray) -> float:
    """Standard deviation of disagreements (n,) about zero, cut at WILD times it (Huber's proposal 2)."""
    squares = disagreements**2
    size = np.sqrt(np.mean(squares))
    for _ in range(ROUNDS):
        size = np.sqrt(np.mean(np.minimum(squares, (WILD * size) ** 2)) / TAME_SHARE)
    return float(size)
