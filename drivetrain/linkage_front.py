"""Pareto front of linkages by NSGA-II, several seeds merged, and where a given linkage stands against it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from pymoo.algorithms.moo.nsga2 import NSGA2
from pymoo.core.problem import Problem
from pymoo.optimize import minimize
from scipy.optimize import minimize as minimize_locally

from drivetrain.four_bar import FourBar, LinkageError
from drivetrain.linkage_problem import CONSTRAINTS, LinkageProblem, constraint_text
from drivetrain.pareto import non_dominated

_STEP = 1e-6  # of the width of a box, for derivatives
_SAFETY = 1e-8  # kept from every limit, so that rounding does not cost the feasibility


@dataclass(frozen=True)
class GeneticSettings:
    """Seeds of the runs, individuals of a generation, generations of a run; points of the sharpened front."""

    seeds: tuple[int, ...] = (1, 2, 3, 4)
    population: int = 100
    generations: int = 150
    sharpened_points: int = 120

    def __post_init__(self) -> None:
        if not (self.seeds and self.population >= 4 and self.generations >= 1):
            raise LinkageError(
                "the genetic algorithm needs one seed, four individuals and one generation at least; found "
                f"{len(self.seeds)}, {self.population} and {self.generations}"
            )


@dataclass(frozen=True)
class ParetoFront:
    """Non-dominated linkages in the order of rising f1 (falling f2).

    designs: (points, 4) x_B, y_B, x_C, y_C [m]; objectives: f1, dimensionless, and f2 [rad^2], (points, 2)
    seed: number of the run that found each, (points,)
    """

    problem: LinkageProblem
    designs: np.ndarray
    objectives: np.ndarray
    seed: np.ndarray

    @property
    def linkages(self) -> FourBar:
        """All linkages of the front, hardpoints (points,)."""
        return self.problem.linkage(self.designs)

    @property
    def nominal_ratios(self) -> np.ndarray:
        """Transmission ratio of every linkage in the nominal position [m/rad], (points,)."""
        return self.linkages.motion(np.zeros(1)).transmission_ratio[:, 0]

    def linkage(self, index: int) -> FourBar:
        """One linkage."""
        return self.problem.linkage(self.designs[index])

    def first_at(self, second: float) -> float:
        """f1 (dimensionless) of the front at f2 = second [rad^2], linear between its points; NaN outside the front."""
        firsts, seconds = self.objectives[np.argsort(self.objectives[:, 1])].T
        return float(np.interp(second, seconds, firsts, left=np.nan, right=np.nan))

    def second_at(self, first: float) -> float:
        """f2 [rad^2] of the front at f1 = first (dimensionless), linear between its points; NaN outside the front."""
        firsts, seconds = self.objectives.T
        return float(np.interp(first, firsts, seconds, left=np.nan, right=np.nan))


@dataclass(frozen=True)
class Standing:
    """A linkage against a front: its objectives, whether a point of the front dominates it, and the gains there.

    objectives: f1, dimensionless, and f2 [rad^2]
    first_at_same_second, second_at_same_first: f1, dimensionless, and f2 [rad^2] of the front level with the linkage;
        NaN where it has none
    """

    objectives: tuple[float, float]
    feasible: bool
    dominated: bool
    first_at_same_second: float
    second_at_same_first: float


class _Population(Problem):
    """``LinkageProblem`` as pymoo calls it, one array of designs at a time."""

    def __init__(self, problem: LinkageProblem) -> None:
        lower, upper = problem.bounds
        super().__init__(n_var=4, n_obj=2, n_ieq_constr=len(CONSTRAINTS), xl=lower, xu=upper)
        self.problem = problem

    def _evaluate(self, x: np.ndarray, out: dict[str, np.ndarray], *arguments: Any, **named: Any) -> None:
        scores = self.problem.score(self.problem.linkage(x))
        # NSGA-II ranks infeasible designs by their constraints alone; infinity is never compared with an objective.
        out["F"] = np.where(np.isnan(scores.objectives), np.inf, scores.objectives)
        out["G"] = scores.constraints


def pareto_front(problem: LinkageProblem, settings: GeneticSettings = GeneticSettings()) -> ParetoFront:
    """Front of the feasible linkages, merged over the seeds and sharpened; the same settings give the same front.

    The genetic algorithm finds where the front is, but stays up to 2 % above it; a gradient search for the least f2 at
    evenly spaced f1 then takes it down to the last digits (``sharpened``).

    Raises LinkageError, which names the constraint that is hardest to meet, when no seed finds a feasible linkage.
    """
    runs = [_run(problem, settings, seed) for seed in settings.seeds]
    designs = np.concatenate([found for found in runs])
    seeds = np.repeat(settings.seeds, [len(found) for found in runs])
    scores = problem.score(problem.linkage(designs))
    if not scores.feasible.any():
        raise LinkageError(_nothing_feasible(problem, scores.constraints))
    keep = np.flatnonzero(scores.feasible)
    return sharpened(_front(problem, designs[keep], seeds[keep]), settings.sharpened_points)


def _front(problem: LinkageProblem, designs: np.ndarray, seeds: np.ndarray) -> ParetoFront:
    """The non-dominated among feasible designs."""
    objectives = problem.score(problem.linkage(designs)).objectives
    keep = non_dominated(objectives)
    return ParetoFront(problem, designs[keep], objectives[keep], seeds[keep])


def sharpened(front: ParetoFront, points: int) -> ParetoFront:
    """The front with a point of least f2 at each of so many evenly spaced f1, from the smallest to the largest.

    Each search starts at the nearest point of the front, which stays where the search finds nothing feasible.
    """
    problem = front.problem
    least = _descend(problem, front.designs[0], objective=0, largest_first=np.inf)
    levels = np.linspace(_first(problem, least), front.objectives[-1, 0], points)[1:]
    starts = np.concatenate([[0], np.abs(front.objectives[:, :1] - levels).argmin(axis=0)])
    found = [_descend(problem, front.designs[k], 1, level) for k, level in zip(starts[1:], levels, strict=True)]
    designs = np.stack([least, *found])
    usable = problem.score(problem.linkage(designs)).feasible[:, None]
    return _front(problem, np.where(usable, designs, front.designs[starts]), front.seed[starts])


def _first(problem: LinkageProblem, design: np.ndarray) -> float:
    """f1 of one design."""
    return problem.score(problem.linkage(design[None])).objectives[0, 0]


def _descend(problem: LinkageProblem, start: np.ndarray, objective: int, largest_first: float) -> np.ndarray:
    """Feasible design of least objective near a start with f1 <= largest_first, by sequential quadratic programs."""
    lower, upper = problem.bounds
    span = np.where(upper > lower, upper - lower, 1.0)

    def values(unit: np.ndarray) -> np.ndarray:
        """The objective and the slacks of all limits at unit designs, (designs, 1 + limits)."""
        scores = problem.score(problem.linkage(lower + np.atleast_2d(unit) * span))
        slack = np.column_stack([largest_first - scores.objectives[:, 0], -scores.constraints])
        return np.column_stack([scores.objectives[:, objective], slack[:, np.isfinite(slack).all(axis=0)]])

    def slopes(unit: np.ndarray) -> np.ndarray:
        """Derivatives of ``values`` [per unit], (4, 1 + limits), one-sided and inwards at the bounds."""
        step = np.where(unit > 0.5, -_STEP, _STEP)
        around = values(np.vstack([unit, unit + np.diag(step)]))
        return (around[1:] - around[0]) / step[:, None]

    limits = {"type": "ineq", "fun": lambda x: values(x)[0, 1:] - _SAFETY, "jac": lambda x: slopes(x)[:, 1:].T}
    result = minimize_locally(
        lambda x: values(x)[0, 0],
        (start - lower) / span,
        jac=lambda x: slopes(x)[:, 0],
        method="SLSQP",
        bounds=[(0, 1)] * len(span),
        constraints=[limits],
        options={"ftol": 1e-10},
    )
    return lower + np.clip(result.x, 0, 1) * span


def _run(problem: LinkageProblem, settings: GeneticSettings, seed: int) -> np.ndarray:
    """Last generation of one run, (population, 4)."""
    algorithm = NSGA2(pop_size=settings.population)
    result = minimize(_Population(problem), algorithm, ("n_gen", settings.generations), seed=seed, verbose=False)
    return result.pop.get("X")


def _nothing_feasible(problem: LinkageProblem, constraints: np.ndarray) -> str:
    """Sentence on the design that misses least, among those that close if any does."""
    closure = CONSTRAINTS.index("closure over the travel")
    closing = constraints[:, closure] <= 0
    constraints = constraints[closing] if closing.any() else constraints
    nearest = constraints[np.argmin(np.maximum(constraints, 0).sum(axis=-1))]
    worst = int(np.argmax(nearest)) if closing.any() else closure
    return (
        "no linkage with B and C inside their boxes satisfies the constraints; where the miss is smallest, "
        f"{constraint_text(problem, worst, nearest[worst])}: widen the boxes or relax that limit"
    )


def standing(front: ParetoFront, linkage: FourBar) -> Standing:
    """Where a linkage stands against a front, with the problem of the front."""
    scores = front.problem.score(FourBar(linkage.arm, np.array([linkage.hardpoint_b]), np.array([linkage.hardpoint_c])))
    own = scores.objectives[0]
    better = np.all(front.objectives <= own, axis=1) & np.any(front.objectives < own, axis=1)
    first, second = front.first_at(own[1]), front.second_at(own[0])
    return Standing((float(own[0]), float(own[1])), bool(scores.feasible[0]), bool(better.any()), first, second)
