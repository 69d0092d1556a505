"""Fatigue of shafts and laminations: cycles of the load over the life, Goodman's mean stress, Miner's sum.

    sigma_eq = K_f sigma_a / (1 - sigma_m / R_m)      reversed amplitude that does as much as (sigma_a, sigma_m)
    N = N_D (sigma_D / sigma_eq)^k                    S-N line, k' = 2 k - 1 beyond its knee (Haibach)
    sum n / N <= 1                                    Palmgren and Miner

Bending and torsion of ductile steel act together by their equivalent stresses of von Mises, amplitudes and means each.
Sources: Goodman line and the combination of stresses, Shigley's Mechanical Engineering Design, chapters 6 and 7; line
of steel that is not welded, k = 5 with its knee at 10^6 cycles, and sigma_D / R_m, FKM guideline. Means of pressure
count as if they were tension, which is on the safe side.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from gearbox.fatigue import spectrum_safety
from gearbox.material import LifeLine
from gearbox.spectrum import rainflow

_SLOPE, _KNEE = 5.0, 1e6
_FIRST, _LAST = 1e4, 1e12  # cycles; below the first the static strength is checked, after the last nothing tires
LINE = LifeLine(
    _FIRST, (_KNEE / _FIRST) ** (1 / _SLOPE), _KNEE, _LAST, (_KNEE / _LAST) ** (1 / (2 * _SLOPE - 1))
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class LoadCycles:
    """Cycles of a load over the life; amplitude, mean: magnitudes [any unit], (n,); number: dimensionless, (n,)"""

    amplitude: np.ndarray
    mean: np.ndarray
    number: np.ndarray

    def times(self, constant: float) -> LoadCycles:
        """Of something in proportion to the load; constant: [its unit per unit of the load]."""
        return LoadCycles(constant * self.amplitude, constant * self.mean, self.number)

    def with_amplitude(self, other: float) -> LoadCycles:
        """With other: a reversed amplitude [same unit] at right angles, as stresses of von Mises add up."""
        return LoadCycles(np.hypot(self.amplitude, other), self.mean, self.number)


def recorded_cycles(history: np.ndarray, step: float, life: float) -> LoadCycles:
    """Rainflow of a history (n,) [any unit] that returns over the life; step: of its time [s]; life: [s]."""
    width, mean, count = rainflow(history).T
    return LoadCycles(width / 2, np.abs(mean), count * life / (len(history) * step))


def reversed_cycles(peak: float, number: float) -> LoadCycles:
    """Between minus and plus a peak [any unit]; number: of cycles, dimensionless."""
    return LoadCycles(np.array([peak]), np.zeros(1), np.array([number]))


def cycles_from_rest(peak: float, number: float) -> LoadCycles:
    """Between nothing and a peak [any unit]; number: of cycles, dimensionless."""
    return LoadCycles(np.array([peak / 2]), np.array([peak / 2]), np.array([number]))


def together(cycles: Sequence[LoadCycles]) -> LoadCycles:
    """All cycles of several, in one unit."""
    rows = ((one.amplitude, one.mean, one.number) for one in cycles)
    return LoadCycles(*(np.concatenate(column) for column in zip(*rows, strict=True)))


@dataclass(frozen=True)
class FatigueStrength:
    """tensile: R_m [Pa]; share: of the reversed amplitude that is endured at the knee, sigma_D / R_m, dimensionless;
    notch: K_f of notch, surface and size together, dimensionless."""

    tensile: float
    share: float
    notch: float

    @property
    def endured(self) -> float:
        """sigma_D, reversed amplitude at the knee [Pa]."""
        return self.share * self.tensile

    def equivalent(self, stress: LoadCycles) -> np.ndarray:
        """sigma_eq [Pa], (n,), infinite from a mean of R_m on; stress: nominal [Pa]."""
        left = 1 - stress.mean / self.tensile
        with np.errstate(divide="ignore"):
            return np.where(left > 0, self.notch * stress.amplitude / np.maximum(left, 0.0), np.inf)

    def acting(self, stress: LoadCycles) -> float:
        """The one reversed amplitude [Pa] that does at the knee what all cycles do; stress: nominal [Pa]."""
        safety = spectrum_safety(LINE, self.equivalent(stress) / self.endured, stress.number)
        return self.endured / float(safety)
