"""Fatigue under a load spectrum: Miner's sum on an S-N line, and the safety factor that it leaves."""

from __future__ import annotations

import numpy as np

from gearbox.batch import Batch
from gearbox.material import LifeLine

_BISECTIONS = 40  # the safety factor to 1e-9
_SAFETY_RANGE = (1e-3, 1e3)


def miner_sum(line: LifeLine, stress_ratio: Batch, cycles: Batch) -> Batch:
    """Damage sum_i n_i / N_i over the first axis, dimensionless, 1 at failure (Palmgren and Miner).

    stress_ratio: stress relative to the endurance limit, (classes, ...)
    cycles: number of them endured in each class, (classes, ...)
    """
    life = line.cycles(stress_ratio)
    with np.errstate(divide="ignore", invalid="ignore"):
        damage = np.where(np.asarray(cycles) > 0, cycles / life, 0.0)
    return damage.sum(axis=0)


def spectrum_safety(line: LifeLine, stress_ratio: Batch, cycles: Batch) -> Batch:
    """The factor, dimensionless, on all stresses at which Miner's sum reaches 1 (ISO 6336-6), shape of a class.

    stress_ratio, cycles: as in ``miner_sum``, dimensionless, (classes, ...)
    """
    low, high = (np.full(np.shape(stress_ratio)[1:], np.log(end)) for end in _SAFETY_RANGE)
    for _ in range(_BISECTIONS):
        middle = (low + high) / 2
        failed = miner_sum(line, stress_ratio * np.exp(middle), cycles) >= 1
        low, high = np.where(failed, low, middle), np.where(failed, middle, high)
    return np.exp(low)[()]
