"""Pareto front of linkages, the one that is built and why, and where the stated one stands (thesis Fig. 3.14)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from drivetrain.four_bar import FourBar, Motion
from drivetrain.linkage_choice import ChoiceRule
from drivetrain.linkage_front import GeneticSettings, ParetoFront, Standing, pareto_front, standing
from drivetrain.linkage_problem import LinkageProblem
from drivetrain.requirements import InstallationSpace, Linkage


@dataclass(frozen=True)
class LinkageSearch:
    """What is searched, how, which point of the front is built, and a linkage to hold against it, if there is one."""

    problem: LinkageProblem
    settings: GeneticSettings
    rule: ChoiceRule
    stated: FourBar | None


@dataclass(frozen=True, eq=False)
class LinkageInMotion:
    """One linkage and its motion over the wheel travel; ratio_nominal: in the nominal position [m/rad]."""

    linkage: FourBar
    motion: Motion
    ratio_nominal: float

    @property
    def ratio_range(self) -> tuple[float, float]:
        """Smallest and largest transmission ratio over the travel [m/rad]."""
        return _range(self.motion.transmission_ratio)

    @property
    def gamma_range(self) -> tuple[float, float]:
        """Smallest and largest angle at B over the travel [rad]."""
        return _range(self.motion.gamma)

    @property
    def lambda_range(self) -> tuple[float, float]:
        """Smallest and largest angle at A over the travel [rad]."""
        return _range(self.motion.lambda_)

    @property
    def angle_deviation(self) -> float:
        """Largest distance of gamma and lambda from a right angle [rad]."""
        return max(abs(angle - np.pi / 2) for angle in (*self.gamma_range, *self.lambda_range))


@dataclass(frozen=True, eq=False)
class StatedLinkage:
    """A linkage that was stated, and where it stands against the front."""

    built: LinkageInMotion
    standing: Standing


@dataclass(frozen=True, eq=False)
class LinkageFront:
    """The front, the point that is built and why, and the stated linkage beside it.

    chosen: number of the point of the front; reason: in words; built: the chosen linkage over the wheel travel
    """

    front: ParetoFront
    chosen: int
    reason: str
    built: LinkageInMotion
    stated: StatedLinkage | None

    @property
    def nominal_ratios(self) -> np.ndarray:
        """Nominal transmission ratio of every point [m/rad], (points,)."""
        return self.front.nominal_ratios


def linkage_stage(search: LinkageSearch) -> LinkageFront:
    """Search the front and choose from it; the same search gives the same front.

    Raises LinkageError where no linkage is feasible, the rule excludes every point, or the stated one does not close.
    """
    front = pareto_front(search.problem, search.settings)
    chosen = search.rule.pick(front)
    built = in_motion(front.linkage(chosen), search.problem)
    return LinkageFront(front, chosen, search.rule.reason, built, _stated(search, front))


def chosen_linkage(found: LinkageFront, space: InstallationSpace) -> Linkage:
    """The linkage that is built, as the stages behind it read it."""
    return Linkage(found.built.ratio_nominal, found.built.ratio_range[1], space.radius_max)


def in_motion(linkage: FourBar, problem: LinkageProblem) -> LinkageInMotion:
    """A linkage over the wheel travel of a problem; LinkageError where it does not close."""
    nominal = linkage.motion(np.zeros(1)).transmission_ratio[0]
    return LinkageInMotion(linkage, linkage.motion(problem.travel.values), float(nominal))


def _stated(search: LinkageSearch, front: ParetoFront) -> StatedLinkage | None:
    if search.stated is None:
        return None
    return StatedLinkage(in_motion(search.stated, search.problem), standing(front, search.stated))


def _range(values: np.ndarray) -> tuple[float, float]:
    return float(values.min()), float(values.max())
