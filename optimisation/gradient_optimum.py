"""The constrained optimum by gradients: sequential quadratic models of torque, limited flux density and rules.

Torque and flux density come with their exact derivatives in every free dimension from one field solution on a moved
mesh, so no grid is needed and any number of dimensions may be free. Differences of the derivatives teach the models
their curvatures (symmetric rank-one; Nocedal and Wright, Numerical Optimization, ch. 6.2), each function its own: so
the models need no line search, and each of their optima is the next design. Where it no longer moves, the machine is
meshed anew, and what the new mesh changes of the values is put right.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from math import inf

import numpy as np
from scipy.optimize import minimize

from geometry.errors import GeometryError
from geometry.family import Combination
from geometry.machine import Machine
from geometry.variables import SWEPT
from optimisation.constrained_optimum import BestDesign, NoOptimumError
from optimisation.design import Design, DesignSolver, Judge
from optimisation.freedom import AS_SWEPT, Freedom
from units import MILLIMETRE

_FARTHEST = 0.35  # relative change of a dimension in one step
_DIFFERENCE = 1e-6  # relative change for the derivatives
_BENDS = -2.0, -0.2  # second derivatives of the relative torque in the relative dimensions swept, and in others
_TEACHES = 1e-2  # cosine between a step and what the curvatures lack of it, below which it teaches nothing
_PENALTY = 2.0  # relative torque per relative excess over limit or rule; a limit gives half its excess in torque
_BROKEN, _KEPT = 0.25, 0.75  # shares of a promised gain after which a step reaches less far, or farther
_MOST_LOOKS = 100
_STANDS_STILL = 5e-3  # relative change of a dimension below which the models are not taught again
_SHORTEST = 1e-6  # relative; a shorter step does not put right what is not held
_WORTH = 5e-5  # relative torque that is still worth a look
_HELD = 1e-4  # relative excess over the limit at which a design counts
_BINDS = 5e-3  # relative distance from the limit at which it still counts as binding
_RULE_SLACK = 1e-3  # relative, of a rule at the end of a search


@dataclass(frozen=True, eq=False)
class _Models:
    """Quadratics of the relative torque and of the room below the limit and of every rule, over relative changes.

    place: of the design that they were made at (k,); values: there (f,); slopes: (f, k); bends: (f, k, k)
    """

    place: np.ndarray
    values: np.ndarray
    slopes: np.ndarray
    bends: np.ndarray

    def at(self, x: np.ndarray) -> np.ndarray:
        """Values (f,) at x (k,)."""
        way = x - self.place
        return self.values + self.slopes @ way + (self.bends @ way) @ way / 2

    def slopes_at(self, x: np.ndarray) -> np.ndarray:
        """Slopes (f, k) at x (k,)."""
        return self.slopes + self.bends @ (x - self.place)

    def moved(self, x: np.ndarray, values: np.ndarray) -> _Models:
        """Made at x (k,), where only the values (f,) are known."""
        return replace(self, place=x, values=values, slopes=self.slopes_at(x))

    def taught(self, x: np.ndarray, slopes: np.ndarray) -> _Models:
        """With curvatures that give the slopes (f, k) at x (k,) too."""
        way, lacking = x - self.place, slopes - self.slopes_at(x)
        along, sizes = lacking @ way, np.linalg.norm(lacking, axis=1) * np.linalg.norm(way)
        teaches = np.abs(along) > _TEACHES * sizes
        shares = np.divide(1.0, along, where=teaches, out=np.zeros_like(along))
        return replace(self, bends=self.bends + np.einsum("f,fi,fj->fij", shares, lacking, lacking))

    def best(self, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        """x (k,) between bounds (k,) with the largest torque that has room, or the least excess for its torque."""
        start = np.append(self.place, max(0.0, -self.values[1:].min()))
        to_excess = np.ones((len(self.values) - 1, 1))
        return minimize(
            lambda x: _PENALTY * x[-1] - self.at(x[:-1])[0],
            start,
            jac=lambda x: np.append(-self.slopes_at(x[:-1])[0], _PENALTY),
            method="SLSQP",
            bounds=[*zip(low, high), (0.0, None)],
            constraints={
                "type": "ineq",
                "fun": lambda x: self.at(x[:-1])[1:] + x[-1],
                "jac": lambda x: np.hstack([self.slopes_at(x[:-1])[1:], to_excess]),
            },
        ).x[:-1]


def _merit(values: np.ndarray) -> float:
    """Relative torque less the penalty of what is not held; values: as of ``_Models`` (f,)."""
    return float(values[0] - _PENALTY * max(0.0, -values[1:].min()))


@dataclass
class _Search:
    """Designs over relative changes x (k,) of the free dimensions from ``start`` (k,) [m or 1]."""

    solver: DesignSolver
    combination: Combination
    stator_outer_radius: float
    limit: float
    freedom: Freedom
    start: np.ndarray
    looks: int = 0
    scale: float = field(init=False)  # torque of the first design [Nm/m]
    models: _Models = field(init=False)
    design: Design = field(init=False)  # that they were made at
    meshed_at: np.ndarray = field(init=False)
    reach: float = _FARTHEST  # of a step

    def best(self) -> BestDesign:
        """Go from optimum to optimum of the models."""
        self._begin()
        while self.looks < _MOST_LOOKS:
            x = self.models.best(*self._bounds)
            step = np.abs(x - self.models.place).max()
            if step > _STANDS_STILL:
                self._advance(x)
            elif not _is_near(x, self.meshed_at):
                self._mesh_anew(x)
            elif self._is_held and self.models.at(x)[0] < self.models.values[0] + _WORTH:
                return BestDesign(self.design, self.design.limited > self.limit * (1 - _BINDS), self.looks)
            elif step < _SHORTEST:
                break
            else:
                self._correct(x)
        raise NoOptimumError(self._complaint)

    def _begin(self) -> None:
        x = np.zeros(len(self.start))
        self.meshed_at, self.design = x, self._require(x)
        self.scale = self.design.torque
        values = self._values(self.design)
        bends = np.zeros((len(values), len(x), len(x)))
        bends[0] = np.diag([_BENDS[one not in SWEPT] for one in self.freedom.variables])
        self.models = _Models(x, values, self._slopes(x), bends)

    def _advance(self, x: np.ndarray) -> None:
        """Look at x with its slopes; go on from there where it is better."""
        found, before = self._look(x), self.models
        if found is None:
            self._reach_as_promised(x, -inf)
            return
        values, slopes = self._values(found), self._slopes(x)
        gain = _merit(values) - _merit(before.values)
        self._reach_as_promised(x, gain)
        self.models = before.taught(x, slopes)
        if gain > 0:
            self.design, self.models = found, replace(self.models, place=x, values=values, slopes=slopes)

    def _reach_as_promised(self, x: np.ndarray, gain: float) -> None:
        """Less reach after a step to x (k,) that brought little of what was promised, more after one that kept it."""
        promised = _merit(self.models.at(x)) - _merit(self.models.values)
        step = np.abs(x - self.models.place).max()
        if gain < _BROKEN * promised:
            self.reach = step / 2
        elif gain > _KEPT * promised:
            self.reach = min(_FARTHEST, max(self.reach, 2 * step))

    def _mesh_anew(self, x: np.ndarray) -> None:
        self.solver.mesh_anew()
        self.meshed_at, self.reach = x, _FARTHEST
        self._correct(x)

    def _correct(self, x: np.ndarray) -> None:
        """Go to x, so close that the slopes are those of the models."""
        self.design = self._require(x)
        self.models = self.models.moved(x, self._values(self.design))

    def _look(self, x: np.ndarray) -> Design | None:
        """The design at x; None where it cannot be built."""
        self.looks += 1
        try:
            return self.solver.design(self._machine(x))
        except GeometryError:
            return None

    def _require(self, x: np.ndarray) -> Design:
        found = self._look(x)
        if found is None:
            raise NoOptimumError(f"{self._where}: the search has come to where no machine can be built")
        return found

    def _machine(self, x: np.ndarray) -> Machine:
        values = (self.start * (1 + x)).tolist()
        dimensions = {one.name: value for one, value in zip(self.freedom.variables, values, strict=True)}
        family = self.solver.judge.case.family
        return family.machine(self.combination, stator_outer_radius=self.stator_outer_radius, **dimensions)

    def _values(self, design: Design) -> np.ndarray:
        room = 1 - design.limited / self.limit
        return np.array([design.torque / self.scale, room, *self._rooms(design.machine)])

    def _slopes(self, x: np.ndarray) -> np.ndarray:
        """Of the design at x, which was solved last; the rules are formulas, a difference of them is exact enough."""
        steps = np.full(len(x), _DIFFERENCE)
        torque, limited = self.solver.gradient(lambda changes: self._machine(x + changes), steps)
        ahead, behind = ([self._rooms(self._machine(x + s)) for s in d * np.diag(steps)] for d in (1, -1))
        rules = (np.array(ahead) - np.array(behind)).T / (2 * _DIFFERENCE)
        return np.vstack([torque / self.scale, -limited / self.limit, rules])

    def _rooms(self, machine: Machine) -> list[float]:
        """Of every rule, relative."""
        layout = self.solver.judge.case.layout(machine)
        return [rule.room(machine, layout) for rule in self.freedom.rules]

    @property
    def _bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Of x (k,): those of the variables, and how far a step goes."""
        low, high = (np.array([getattr(one, end) for one in self.freedom.variables]) for end in ("low", "high"))
        at = self.models.place
        return np.maximum(at - self.reach, low / self.start - 1), np.minimum(at + self.reach, high / self.start - 1)

    @property
    def _is_held(self) -> bool:
        room, *rules = self.models.values[1:]
        return room > -_HELD and min(rules, default=0.0) > -_RULE_SLACK

    @property
    def _complaint(self) -> str:
        machine = self.design.machine
        layout = self.solver.judge.case.layout(machine)
        broken = (rule for rule in self.freedom.rules if rule.room(machine, layout) < -_RULE_SLACK)
        words = "".join(f" and has {rule.words(machine, layout)}: widen [variables]" for rule in broken)
        return f"{self._where}: the search does not settle on a design that holds the limit{words}"

    @property
    def _where(self) -> str:
        return f"{self.combination.words}, stator radius {self.stator_outer_radius / MILLIMETRE:g} mm"


def _is_near(x: np.ndarray, other: np.ndarray) -> bool:
    return bool(np.abs(x - other).max() < _STANDS_STILL)


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
    first = np.array([one.inside(at) for one, at in zip(freedom.variables, start, strict=True)])
    return _Search(DesignSolver(judge), combination, stator_outer_radius, limit, freedom, first).best()
