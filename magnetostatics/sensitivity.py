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
from dataclasses import replace
from typing import Protocol

import numpy as np

from magnetostatics.model import FieldModel, FieldSolution, OperatingState

Reader = Callable[[FieldSolution], np.ndarray]


class Variation(Protocol):
    """A parameter and the problem with it changed, ``at(model, point, change)``.

    step, change: small and any [unit of the parameter]
    """

    step: float

    def at(self, model: FieldModel, point: OperatingState, change: float) -> tuple[FieldModel, OperatingState]: ...


def sensitivities(solution: FieldSolution, variations: dict[str, Variation], read: Reader) -> dict[str, np.ndarray]:
    """Derivative of ``read(solution)`` (k,) with respect to each parameter [unit of the result per its own].

    variations: parameters by name; their models must share the triangles of the solution (``FieldModel.like``)
    read: results of a solution as a vector, for example torque and flux densities
    """
    ends = {name: _both_ways(solution, variation) for name, variation in variations.items()}
    tangent = solution.model.tangent(solution)
    slopes = {name: tangent.response(_residual_slope(solution, two)) for name, two in ends.items()}
    return {name: _along(solution, two, slopes[name], read) for name, two in ends.items()}


# (change, model, point) on both sides of the solution
_Ends = tuple[tuple[float, FieldModel, OperatingState], tuple[float, FieldModel, OperatingState]]


def _both_ways(solution: FieldSolution, variation: Variation) -> _Ends:
    step, (model, point) = variation.step, (solution.model, solution.point)
    return (step, *variation.at(model, point, step)), (-step, *variation.at(model, point, -step))


def _residual_slope(solution: FieldSolution, ends: _Ends) -> np.ndarray:
    """dR/dp at fixed potential (m,)."""
    forward, back = (model.residual(point, solution.a) for _, model, point in ends)
    return (forward - back) / (ends[0][0] - ends[1][0])


def _along(solution: FieldSolution, ends: _Ends, slope: np.ndarray, read: Reader) -> np.ndarray:
    """Derivative of the results along the changed problem and the changed potential."""
    forward, back = (
        read(replace(solution, model=model, point=point, a=solution.a + change * slope))
        for change, model, point in ends
    )
    return (forward - back) / (ends[0][0] - ends[1][0])
