"""The nearest design in which everything holds: all levers moved together, as little as will do.

With x the logarithms of each lever's value over its present one,

    minimise |x|^2   so that   margin of every requirement >= 0,   |x| <= ln ``LEVER_RANGE``

by sequential quadratic programming from the present design. Where that finds none, the least margin is made as large as
it gets first, from the best of many designs spread over the range.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import scipy
from scipy.optimize import minimize

from drivetrain.asked import Check, Requirement
from drivetrain.capability import ActuatorDesign, together
from drivetrain.proof import Impossibility, impossibility
from drivetrain.remedies import LEVER_RANGE, Lever

_SPREAD = 6  # 2^6 designs over the range
_STEP = 1e-4  # of a logarithm, for derivatives
_INSIDE = 1e-4  # relative, by which every requirement is held in the search, so that rounding does not lose it
_ROUNDS = 40
_OfX = Callable[[np.ndarray], Any]


@dataclass(frozen=True)
class Move:
    """One lever in the nearest design; now, value: [unit of the lever, SI]."""

    lever: Lever
    now: float
    value: float


@dataclass(frozen=True)
class NearestDesign:
    """All levers together, and how every requirement stands then.

    moves: of the levers; checks: of the requirements at the new values. Where no design of the range was found that
        holds all of them, it is the one that comes nearest to that: the largest shortfall is least
    impossible: the proof that there is none, None where there is one or the bounds prove nothing
    """

    moves: tuple[Move, ...]
    checks: tuple[Check, ...]
    impossible: Impossibility | None = None

    @property
    def holds(self) -> bool:
        """Whether every requirement does."""
        return all(one.holds for one in self.checks)


def nearest_design(
    design: ActuatorDesign, requirements: Sequence[Requirement], levers: Sequence[Lever]
) -> NearestDesign:
    """The design of least |x| that meets all requirements, or the one with the least shortfall."""
    asked = _Asked(design, tuple(requirements), tuple(levers))
    near = asked.nearest_from(np.zeros(len(asked.levers)))
    if asked.least_margin(near) >= 0:
        return asked.at(near)
    best = asked.best_from(asked.of_a_spread())
    near = asked.nearest_from(best) if asked.least_margin(best) >= 0 else best
    found = asked.at(near if asked.least_margin(near) >= 0 else best)
    return found if found.holds else replace(found, impossible=impossibility(design, requirements, levers))


@dataclass(frozen=True, eq=False)
class _Asked:
    """Requirements over the logarithms x of moved levers."""

    design: ActuatorDesign
    requirements: tuple[Requirement, ...]
    levers: tuple[Lever, ...]

    def moved(self, x: np.ndarray) -> ActuatorDesign:
        """One batch of designs; x: (n, levers)"""
        return together([self._one(row) for row in np.atleast_2d(x)])

    def _one(self, x: np.ndarray) -> ActuatorDesign:
        moved = self.design
        for lever, logarithm in zip(self.levers, x, strict=True):
            moved = lever.moved(moved, float(lever.value(self.design)) * float(np.exp(logarithm)))
        return moved

    def margins(self, x: np.ndarray) -> np.ndarray:
        """Relative, of every requirement that asks for something (requirements, n); x: (n, levers)"""
        batch, count = self.moved(x), len(np.atleast_2d(x))
        rows = [one.margin(one.reached(batch)) for one in self.requirements if one.needed]
        return np.array([np.broadcast_to(row, count) for row in rows])

    def of_a_spread(self) -> np.ndarray:
        """x of many spread over the range, of which the least margin is largest."""
        reach = np.log(LEVER_RANGE)
        spread = reach * (2 * scipy.stats.qmc.Sobol(len(self.levers), scramble=False).random_base2(_SPREAD) - 1)
        return np.asarray(spread[int(self.margins(spread).min(axis=0).argmax())])

    def least_margin(self, x: np.ndarray) -> float:
        """The smallest of all margins at x (levers,), relative."""
        return float(self.margins(x).min())

    def nearest_from(self, start: np.ndarray) -> np.ndarray:
        """x of least length that meets all, from a start."""
        inside = {"type": "ineq", "fun": self._inside, "jac": self._slopes}
        return self._minimised(lambda x: float(x @ x), lambda x: 2 * x, inside, start)

    def best_from(self, start: np.ndarray) -> np.ndarray:
        """x of which the least margin is largest, from a start: that margin is a variable beside x."""
        ahead = np.append(np.zeros(len(start)), -1.0)
        above = {
            "type": "ineq",
            "fun": lambda y: self._inside(y[:-1]) - y[-1],
            "jac": lambda y: np.insert(self._slopes(y[:-1]), len(start), -1.0, axis=1),
        }
        begin = np.append(start, self.least_margin(start))
        return self._minimised(lambda y: -float(y[-1]), lambda y: ahead, above, begin)[:-1]

    def _minimised(
        self, function: _OfX, slope: _OfX, constraint: Mapping[str, object], start: np.ndarray
    ) -> np.ndarray:
        reach = np.log(LEVER_RANGE)
        free = [(-np.inf, np.inf)] * (len(start) - len(self.levers))
        bounds, options = [(-reach, reach)] * len(self.levers) + free, {"maxiter": _ROUNDS, "ftol": 1e-9}
        found = minimize(
            function, start, jac=slope, bounds=bounds, constraints=constraint, method="SLSQP", options=options
        )
        return np.clip(found.x, *np.transpose(bounds))

    def _inside(self, x: np.ndarray) -> np.ndarray:
        return self.margins(x)[:, 0] - _INSIDE

    def _slopes(self, x: np.ndarray) -> np.ndarray:
        steps = _STEP * np.eye(len(x))
        ahead, behind = np.split(self.margins(np.concatenate([x + steps, x - steps])), 2, axis=1)
        return (ahead - behind) / (2 * _STEP)

    def at(self, x: np.ndarray) -> NearestDesign:
        """The levers at x and what holds there."""
        now = [float(lever.value(self.design)) for lever in self.levers]
        moves = tuple(Move(lever, n, n * float(np.exp(v))) for lever, n, v in zip(self.levers, now, x, strict=True))
        there = self._one(x)
        return NearestDesign(moves, tuple(one.check(there) for one in self.requirements))
