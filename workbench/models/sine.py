"""A motion that is driven as a sine, x = A sin(phase)."""

from __future__ import annotations

import numpy as np

from effects.base import Columns

_FOR_PHASE = {"frequency", "displacement", "velocity"}


def phase_of(conditions: Columns) -> np.ndarray:
    """Phase of each row [rad] (n,): as read, else that of displacement and velocity, atan2(2 pi f x, v).

    Raises:
        WorkbenchError: neither is in the table.
    """
    if "phase" in conditions or not _FOR_PHASE <= conditions.keys():
        return conditions["phase"]
    return np.arctan2(2 * np.pi * conditions["frequency"] * conditions["displacement"], conditions["velocity"])
