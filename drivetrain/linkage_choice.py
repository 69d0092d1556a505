"""Which linkage of a Pareto front is built. A rule is an object with one verb; a study names one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from drivetrain.four_bar import LinkageError
from drivetrain.linkage_front import ParetoFront
from units import MILLIMETRE


class ChoiceRule:
    """Picks one point of a front."""

    def pick(self, front: ParetoFront) -> int:
        """Index of the chosen point; raises LinkageError when the rule excludes every point."""
        raise NotImplementedError

    @property
    def reason(self) -> str:
        """Why the point was chosen, in words."""
        raise NotImplementedError


def _least(values: np.ndarray, allowed: np.ndarray, refusal: str) -> int:
    """Index of the smallest allowed value; LinkageError with the refusal where none is allowed."""
    if not allowed.any():
        raise LinkageError(refusal)
    return int(np.where(allowed, values, np.inf).argmin())


@dataclass(frozen=True)
class SmallestRatio(ChoiceRule):
    """Smallest ratio objective f1 among the points whose angles are good enough, f2 <= worst_quality [rad^2].

    The actuator's gearbox gains most from a small ratio; the limit on f2 keeps the links from locking.
    """

    worst_quality: float

    def pick(self, front: ParetoFront) -> int:
        ratio, quality = front.objectives.T
        return _least(
            ratio,
            quality <= self.worst_quality,
            f"no linkage of the front has angles as good as f2 = {self.worst_quality:g}; the best reaches "
            f"{quality.min():.3f}: allow more",
        )

    @property
    def reason(self) -> str:
        return f"smallest transmission ratio with transmission angles no worse than f2 = {self.worst_quality:g}"


@dataclass(frozen=True)
class BestAngles(ChoiceRule):
    """Best angles, smallest f2, among the points whose nominal transmission ratio is at most largest_ratio [m/rad]."""

    largest_ratio: float

    def pick(self, front: ParetoFront) -> int:
        ratio = front.nominal_ratios
        return _least(
            front.objectives[:, 1],
            ratio <= self.largest_ratio,
            f"no linkage of the front has a nominal ratio of {self.largest_ratio / MILLIMETRE:g} mm/rad or less; "
            f"the smallest is {ratio.min() / MILLIMETRE:.1f} mm/rad: allow more",
        )

    @property
    def reason(self) -> str:
        return f"best transmission angles with a nominal ratio of at most {self.largest_ratio / MILLIMETRE:g} mm/rad"


@dataclass(frozen=True)
class Knee(ChoiceRule):
    """The point farthest from the straight line between the ends of the front, both objectives scaled to 0 ... 1."""

    def pick(self, front: ParetoFront) -> int:
        low, high = front.objectives.min(axis=0), front.objectives.max(axis=0)
        scaled = (front.objectives - low) / np.where(high > low, high - low, 1)
        return int(np.argmin(scaled.sum(axis=1)))

    @property
    def reason(self) -> str:
        return "knee of the front, where either objective costs most of the other"
