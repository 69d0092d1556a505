"""The constrained optimum by gradients: sequential quadratic programming on torque and limited flux density.

Both come with their exact derivatives in every free dimension from one field solution on a moved mesh, so no grid is
needed and any number of dimensions may be free. At the end the machine is meshed anew and the search goes on from
there until it stands still.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.optimize import OptimizeResult, minimize

from geometry.errors import GeometryError
from geometry.family import Combination
from geometry.machine import Machine
from geometry.variables import Variable
from optimisation.constrained_optimum import BestDesign, NoOptimumError
from optimisation.design import Design, DesignSolver, Judge
from optimisation.freedom import AS_SWEPT, Freedom
from units import MILLIMETRE

_FARTHEST = 0.35  # relative change of a dimension in one search
_STEP = 1e-6  # relative change for the derivatives
_TOLERANCE = 1e-5  # of torque and limit, relative
_ROUNDS = 12  # of one search
_SHORTEST = 1e-4  # relative; designs closer together differ by the rounding of their field solutions
_HELD = 2e-4  # relative excess over limit and rules at which a design of a search that ends there still counts
_SEARCHES = 2, 6  # at least, at most; each on a mesh of where the last one ended
_STANDS_STILL = 5e-3  # relative change of every dimension in the last search
_BINDS = 5e-3  # relative distance from the limit at which it still counts as binding
_RULE_SLACK = 1e-3  # relative, of a rule at the end of a search
_UNBUILDABLE = 1.0  # torque and limit of a design that cannot be built, relative: worse than any

_Slopes = tuple[np.ndarray, np.ndarray]  # of torque [Nm/m] and limited flux density [T], (k,)


class _StandsStillError(Exception):
    """The search asks for a design that differs from a known one by rounding."""


@dataclass
class _Problem:
    """Torque and limited flux density, relative, over relative changes x (k,) of the free dimensions at ``centre``."""

    solver: DesignSolver
    combination: Combination
    stator_outer_radius: float
    limit: float
    freedom: Freedom
    centre: np.ndarray
    known: dict[bytes, Design | None] = field(default_factory=dict)
    sloped: dict[bytes, _Slopes] = field(default_factory=dict)

    @property
    def variables(self) -> tuple[Variable, ...]:
        return self.freedom.variables

    def machine(self, x: np.ndarray) -> Machine:
        values = self.centre * (1 + x)
        dimensions = {one.name: float(value) for one, value in zip(self.variables, values, strict=True)}
        family = self.solver.judge.case.family
        return family.machine(self.combination, stator_outer_radius=self.stator_outer_radius, **dimensions)

    def look(self, x: np.ndarray) -> Design | None:
        """The design at x, each solved once; None where it cannot be built."""
        key = _key(x)
        if key not in self.known:
            self._require_a_step(x)
            try:
                self.known[key] = self.solver.design(self.machine(x))
            except GeometryError:
                self.known[key] = None
        return self.known[key]

    def _require_a_step(self, x: np.ndarray) -> None:
        if any(np.abs(x - np.frombuffer(key)).max() < _SHORTEST for key in self.known):
            raise _StandsStillError

    def require(self, x: np.ndarray) -> Design:
        """As ``look``. Raises NoOptimumError where no machine can be built."""
        found = self.look(x)
        if found is None:
            raise NoOptimumError(f"{self.where}: the search has come to where no machine can be built")
        return found

    def slopes(self, x: np.ndarray) -> _Slopes:
        """Of the design at x, where the search goes on from; that is where it looked last. Raises as ``require``."""
        key = _key(x)
        if key not in self.sloped:
            if self.require(x).machine != self.solver.last_machine:
                self.solver.design(self.machine(x))
            steps = np.full(len(x), _STEP)
            self.sloped[key] = self.solver.gradient(lambda changes: self.machine(x + changes), steps)
        return self.sloped[key]

    @property
    def where(self) -> str:
        return f"{self.combination.words}, stator radius {self.stator_outer_radius / MILLIMETRE:g} mm"

    @property
    def bounds(self) -> list[tuple[float, float]]:
        """Of x: those of the variables, and how far one search goes."""
        ends = zip(self.variables, self.centre, strict=True)
        return [(max(-_FARTHEST, one.low / at - 1), min(_FARTHEST, one.high / at - 1)) for one, at in ends]

    def search(self) -> np.ndarray:
        """x of the largest torque under the limit."""
        try:
            found = self._minimised()
            end, why = found.x, found.message
            x = end if found.success else self._best_known()
        except _StandsStillError:
            x, why = self._best_known(), "the search stands still where the limit is not held"
            end = np.zeros(len(self.centre))
        self._require_rules(end if x is None else x)
        if x is None:
            raise NoOptimumError(f"{self.where}: {why}")
        return x

    def _minimised(self) -> OptimizeResult:
        still = np.zeros(len(self.centre))
        scale = self.require(still).torque
        return minimize(
            lambda x: _UNBUILDABLE if (seen := self.look(x)) is None else -seen.torque / scale,
            still,
            jac=lambda x: -self.slopes(x)[0] / scale,
            method="SLSQP",
            bounds=self.bounds,
            constraints=[{"type": "ineq", "fun": self.room, "jac": self.room_slopes}],
            options={"ftol": _TOLERANCE, "maxiter": _ROUNDS},
        )

    def _best_known(self) -> np.ndarray | None:
        """x of the largest torque among the designs that were looked at and hold limit and rules.

        A search that starts at its optimum ends in the rounding of the field solutions.
        """
        places = {key: np.frombuffer(key) for key, seen in self.known.items() if seen is not None}
        held = [key for key, x in places.items() if self.room(x).min() > -_HELD]
        return places[max(held, key=self._torque_of)] if held else None

    def _torque_of(self, key: bytes) -> float:
        seen = self.known[key]
        assert seen is not None  # those that cannot be built are left out
        return seen.torque

    def _require_rules(self, x: np.ndarray) -> None:
        machine = self.machine(x)
        layout = self.solver.judge.case.layout(machine)
        for rule in self.freedom.rules:
            if rule.room(machine, layout) < -_RULE_SLACK:
                raise NoOptimumError(
                    f"{self.where}: no design was found that holds the limit and has {rule.words(machine, layout)}: "
                    "widen [variables]"
                )

    def room(self, x: np.ndarray) -> np.ndarray:
        """What is left below the limit and of every rule, relative (1 + rules,)."""
        seen = self.look(x)
        if seen is None:
            return np.full(1 + len(self.freedom.rules), -_UNBUILDABLE)
        return np.array([1 - seen.limited / self.limit, *self._rules(x)])

    def room_slopes(self, x: np.ndarray) -> np.ndarray:
        """Derivatives of ``room`` (1 + rules, k); the rules are formulas, so a difference of them is exact enough."""
        steps = _STEP * np.eye(len(x))
        rules = [(self._rules(x + step) - self._rules(x - step)) / (2 * _STEP) for step in steps]
        return np.vstack([-self.slopes(x)[1] / self.limit, np.transpose(rules)])

    def _rules(self, x: np.ndarray) -> np.ndarray:
        if not self.freedom.rules:  # most searches have none, and each look asks
            return np.empty(0)
        machine = self.machine(x)
        layout = self.solver.judge.case.layout(machine)
        return np.array([rule.room(machine, layout) for rule in self.freedom.rules])


def find_optimum_by_gradients(
    judge: Judge,
    combination: Combination,
    stator_outer_radius: float,
    limit: float,
    start: Sequence[float],
    freedom: Freedom = AS_SWEPT,
) -> BestDesign:
    """Largest torque with the limited flux density at most ``limit`` [T]; arguments as ``find_optimum``.

    start: of every variable of the freedom [m or 1], (k,), back iron and rotor radius within a third of the optimum
    Raises NoOptimumError when the search does not settle or leaves what can be built.
    """
    solves, centre = 0, np.array([one.inside(at) for one, at in zip(freedom.variables, start, strict=True)])
    least, most = _SEARCHES
    for number in range(1, most + 1):
        problem = _Problem(DesignSolver(judge), combination, stator_outer_radius, limit, freedom, centre)
        x = problem.search()
        solves += len(problem.known)
        centre = centre * (1 + x)
        if number >= least and np.abs(x).max() < _STANDS_STILL:
            break
    design = problem.require(x)
    return BestDesign(design, design.limited > limit * (1 - _BINDS), solves)


def _key(x: np.ndarray) -> bytes:
    return np.asarray(x, dtype=float).tobytes()
