"""The points that no other one betters in every respect."""

from __future__ import annotations

import numpy as np


def non_dominated(costs: np.ndarray) -> np.ndarray:
    """Indices (k,) of the points that no other one dominates, by rising first cost; equal points count once.

    costs: [any units], (points, objectives), all to be made small
    """
    unique, first = np.unique(costs, axis=0, return_index=True)
    return first[[not _dominated(point, unique) for point in unique]]


def _dominated(point: np.ndarray, others: np.ndarray) -> bool:
    """Whether one of the others (points, objectives) is no worse anywhere and better somewhere."""
    return bool(np.any(np.all(others <= point, axis=1) & np.any(others < point, axis=1)))
