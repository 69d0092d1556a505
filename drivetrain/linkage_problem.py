"""What a good linkage is: objectives and constraints over the wheel travel, for whole populations of hardpoints.

Thesis eqs 3.43-3.50, with the constraints on the angles at both ends of their range and the sign of the shortest lever
put right.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import ArrayLike

from drivetrain.four_bar import FourBar, LinkageError, Motion, SwingArm, point_text
from units import DEGREE, MILLIMETRE

TRAVEL_POSITIONS = 81  # every 2 mm of 160 mm; 801 positions move no objective by more than 1e-4
CONSTRAINTS = (
    "transmission angle lambda at its smallest",
    "transmission angle lambda at its largest",
    "transmission angle gamma at its smallest",
    "transmission angle gamma at its largest",
    "nominal transmission ratio",
    "one sign of the transmission ratio",
    "length of the lever BC",
    "closure over the travel",
)


@dataclass(frozen=True)
class Box:
    """Where a hardpoint may lie; low, high: lower left and upper right corner, x + jy [m]."""

    low: complex
    high: complex
    name: str

    def __post_init__(self) -> None:
        if not (self.low.real <= self.high.real and self.low.imag <= self.high.imag):
            raise LinkageError(
                f"the box of hardpoint {self.name} needs its lower left corner before its upper right one; found "
                f"{point_text(self.low)} and {point_text(self.high)}: swap the limits"
            )


@dataclass(frozen=True)
class Travel:
    """Wheel travel, seen at a number of positions that include both ends and 0.

    lowest, highest: rebound (negative) and bump [m]
    """

    lowest: float
    highest: float
    positions: int = TRAVEL_POSITIONS

    def __post_init__(self) -> None:
        if not self.lowest < 0 < self.highest:
            raise LinkageError(
                "the wheel travel must run from below to above the nominal position, upwards positive; found "
                f"{self.lowest / MILLIMETRE:g} to {self.highest / MILLIMETRE:g} mm: check the signs"
            )

    @property
    def values(self) -> np.ndarray:
        """Positions [m], (positions,), evenly spaced."""
        return np.linspace(self.lowest, self.highest, self.positions)


@dataclass(frozen=True)
class Limits:
    """Bounds of a linkage.

    ratio, ratio_spread: largest nominal ratio tau_lim and spread sigma_lim [m/rad]
    angle_window: of the angles about pi/2 [rad]; lever_length: shortest lever [m]
    ratio_weight: w, dimensionless, 1 for the nominal ratio alone, 0 for its spread alone (3.43)
    """

    ratio: float
    ratio_spread: float
    angle_window: float
    lever_length: float
    ratio_weight: float = 1.0

    def __post_init__(self) -> None:
        if not 0 <= self.ratio_weight <= 1:
            raise LinkageError(f"the weight of the nominal ratio must lie between 0 and 1; found {self.ratio_weight:g}")


@dataclass(frozen=True)
class Scores:
    """How good linkages are.

    objectives: f1, dimensionless, and f2 [rad^2], (linkages, 2)
    constraints: satisfied at or below 0, four angles [rad], the others relative, (linkages, 8), as in CONSTRAINTS
    Objectives are NaN where the linkage does not close; the constraint on closure is positive there.
    """

    objectives: np.ndarray
    constraints: np.ndarray

    @property
    def feasible(self) -> np.ndarray:
        """Whether all constraints are satisfied, (linkages,)."""
        return np.all(self.constraints <= 0, axis=-1)


@dataclass(frozen=True)
class LinkageProblem:
    """Swing arm, boxes of hardpoints B and C, wheel travel and limits; a design is (x_B, y_B, x_C, y_C) [m]."""

    arm: SwingArm
    box_b: Box
    box_c: Box
    travel: Travel
    limits: Limits

    @property
    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper limits of a design [m], (4,) each."""
        corners = ((self.box_b.low, self.box_c.low), (self.box_b.high, self.box_c.high))
        lower, upper = (np.array([b.real, b.imag, c.real, c.imag]) for b, c in corners)
        return lower, upper

    def linkage(self, designs: ArrayLike) -> FourBar:
        """Linkages of designs [m], (4,) or (linkages, 4)."""
        x_b, y_b, x_c, y_c = np.moveaxis(np.asarray(designs, dtype=float), -1, 0)
        return FourBar(self.arm, (x_b + 1j * y_b)[()], (x_c + 1j * y_c)[()])

    def score(self, linkage: FourBar) -> Scores:
        """Objectives and constraints of linkages whose hardpoints are arrays."""
        motion = linkage.try_motion(self.travel.values)
        nominal = linkage.try_motion(np.zeros(1)).transmission_ratio[..., 0]
        return Scores(self._objectives(motion, nominal), self._constraints(motion, nominal, linkage.lever_length))

    def _objectives(self, motion: Motion, nominal: np.ndarray) -> np.ndarray:
        """f1: weighed nominal ratio and spread (3.43); f2: squared extremes of the angles about pi/2 (3.44)."""
        limits, weight = self.limits, self.limits.ratio_weight
        spread = np.sqrt(_mean(motion.transmission_ratio**2) - _mean(motion.transmission_ratio) ** 2)
        ratio = weight * nominal / limits.ratio + (1 - weight) * spread / limits.ratio_spread
        return np.stack([ratio, sum(low**2 + high**2 for low, high in _extremes(motion))], axis=-1)

    def _constraints(self, motion: Motion, nominal: np.ndarray, lever: float | np.ndarray) -> np.ndarray:
        """g <= 0 (3.45-3.49): the angles at both extremes, as a maximum alone says nothing of an angle below pi/2;
        the lever not below its shortest, which 3.49 prints with the other sign."""
        limits = self.limits
        angles = [np.abs(end) - limits.angle_window for pair in reversed(_extremes(motion)) for end in pair]
        ratio = nominal / limits.ratio - 1
        sign = -motion.transmission_ratio.min(axis=-1) / limits.ratio
        broken = motion.reach.max(axis=-1) / limits.lever_length
        values = np.stack([*angles, ratio, sign, 1 - lever / limits.lever_length, broken], axis=-1)
        return np.where(np.isnan(values), np.maximum(broken, 0)[..., None], values)


def _mean(values: np.ndarray) -> np.ndarray:
    """Mean over the travel, trapezoidal: independent of how many positions there are."""
    return (values.sum(axis=-1) - (values[..., 0] + values[..., -1]) / 2) / (values.shape[-1] - 1)


def _extremes(motion: Motion) -> tuple[tuple[np.ndarray, np.ndarray], ...]:
    """Smallest and largest gamma and lambda over the travel, less pi/2 [rad]."""
    return tuple((angle.min(axis=-1) - pi / 2, angle.max(axis=-1) - pi / 2) for angle in (motion.gamma, motion.lambda_))


def constraint_text(problem: LinkageProblem, index: int, excess: float) -> str:
    """By how much a constraint is missed, in words; index into CONSTRAINTS.

    excess: as in ``Scores.constraints`` [rad, or relative]
    """
    limits, name = problem.limits, CONSTRAINTS[index]
    if index < 4:
        window = f"{90 - limits.angle_window / DEGREE:g} to {90 + limits.angle_window / DEGREE:g} degrees"
        return f"the {name} is {excess / DEGREE:.1f} degrees outside {window}"
    if index == 4:
        above = excess * limits.ratio / MILLIMETRE
        return f"the {name} is {above:.1f} mm/rad above {limits.ratio / MILLIMETRE:g} mm/rad"
    if index == 5:
        return "the transmission ratio changes its sign over the travel"
    if index == 6:
        short = excess * limits.lever_length / MILLIMETRE
        return f"the {name} is {short:.1f} mm below its {limits.lever_length / MILLIMETRE:g} mm"
    return f"the links lack {excess * limits.lever_length / MILLIMETRE:.1f} mm to close over the travel"
