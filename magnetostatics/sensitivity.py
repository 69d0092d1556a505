"""How every result of a field solution changes with any parameter, by one back-substitution each.

At a solution the residual R(a; p) is zero. Along a parameter p, with K the tangent matrix that Newton ended with,
    K da/dp = dR/dp        (R: load minus field forces)
    dQ/dp = dQ/da da/dp + dQ/dp |_a
for every result Q at once: torque, flux linkage, probes. dR/dp at fixed a and dQ along (a + h da/dp, p + h) are central
differences of formulas, not of field solutions: nothing is solved again, and the step is limited by rounding only. A
parameter is whatever makes a slightly different model on the same triangles: material, magnet, source or moved nodes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from magnetostatics.model import FieldModel, FieldSolution, OperatingState

Reader = Callable[[FieldSolution], np.ndarray]


class Variation(Protocol):
    """A parameter and the problem with it changed."""

    @property
    def step(self) -> float:
        """A small change [unit of the parameter]."""

    def at(self, model: FieldModel, point: OperatingState, change: float) -> tuple[FieldModel, OperatingState]:
        """The problem with the parameter changed; change: any [unit of the parameter]."""


@dataclass(frozen=True, eq=False)
class Neighbours:
    """The field on both sides of a solution along one parameter, to first order.

    change: of the parameter [unit of the parameter] up to ``forward``, and as much the other way to ``back``
    """

    change: float
    forward: FieldSolution
    back: FieldSolution


def sensitivities(solution: FieldSolution, variations: dict[str, Variation], read: Reader) -> dict[str, np.ndarray]:
    """Derivative of ``read(solution)`` (k,) with respect to each parameter [unit of the result per its own].

    variations: parameters by name; their models must share the triangles of the solution (``FieldModel.like``)
    read: results of a solution as a vector, for example torque and flux densities
    """
    return {
        name: (read(both.forward) - read(both.back)) / (2 * both.change)
        for name, both in neighbours(solution, variations).items()
    }


def neighbours(solution: FieldSolution, variations: dict[str, Variation]) -> dict[str, Neighbours]:
    """The field a step of each parameter to either side, by one back-substitution each; nothing is solved again.

    For results that several solutions make together, such as a loss over a period. variations: see ``sensitivities``
    """
    ends = {name: _both_ways(solution, variation) for name, variation in variations.items()}
    tangent = solution.model.tangent(solution)
    steps = {name: variation.step for name, variation in variations.items()}
    slopes = {name: tangent.response(_residual_slope(solution, two, steps[name])) for name, two in ends.items()}
    return {name: _along(solution, steps[name], two, slopes[name]) for name, two in ends.items()}


# (model, point) on both sides of the solution
_Ends = tuple[tuple[FieldModel, OperatingState], tuple[FieldModel, OperatingState]]


def _both_ways(solution: FieldSolution, variation: Variation) -> _Ends:
    model, point = solution.model, solution.point
    return variation.at(model, point, variation.step), variation.at(model, point, -variation.step)


def _residual_slope(solution: FieldSolution, ends: _Ends, step: float) -> np.ndarray:
    """dR/dp at fixed potential (m,)."""
    forward, back = (model.residual(point, solution.a) for model, point in ends)
    return (forward - back) / (2 * step)


def _along(solution: FieldSolution, step: float, ends: _Ends, slope: np.ndarray) -> Neighbours:
    """The changed problems with the changed potential."""
    forward, back = (
        replace(solution, model=model, point=point, a=solution.a + change * slope)
        for change, (model, point) in zip((step, -step), ends)
    )
    return Neighbours(step, forward, back)
