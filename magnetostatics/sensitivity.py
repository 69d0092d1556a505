"""How every result of a field solution changes with any parameter, by one back-substitution each.

At a solution the residual R(a; p) is zero. Along a parameter p, with K the tangent matrix that Newton ended with,
    K da/dp = dR/dp        (R: load minus field forces)
    dQ/dp = dQ/da da/dp + dQ/dp |_a
for every result Q at once: torque, flux linkage, probes. dR/dp at fixed a and dQ along (a + h da/dp, p + h) are central
differences of formulas, not of field solutions: nothing is solved again, and the step is limited by rounding only. A
parameter is whatever makes a slightly different model on the same triangles: material, magnet, source or moved nodes.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Callable, Protocol

import numpy as np

from magnetostatics.model import FieldModel, FieldSolution, OperatingPoint

Reader = Callable[[FieldSolution], np.ndarray]


class Variation(Protocol):
    """A parameter: ``step`` is a small length in its own unit, ``at(model, point, change)`` the changed problem."""

    step: float

    def at(self, model: FieldModel, point: OperatingPoint, change: float) -> tuple[FieldModel, OperatingPoint]:
        ...


def sensitivities(solution: FieldSolution, variations: dict[str, Variation], read: Reader) -> dict[str, np.ndarray]:
    """Derivative of ``read(solution)`` (k,) with respect to each parameter, in the unit of the result per its own unit.

    variations: parameters by name; their models must share the triangles of the solution (``FieldModel.like``)
    read: results of a solution as a vector, for example torque and flux densities
    """
    tangent = solution.model.tangent(solution)
    slopes = {name: tangent.response(_residual_slope(solution, v)) for name, v in variations.items()}
    return {name: _along(solution, variation, slopes[name], read) for name, variation in variations.items()}


def _residual_slope(solution: FieldSolution, variation: Variation) -> np.ndarray:
    """dR/dp at fixed potential (m,)."""
    ends = []
    for change in (variation.step, -variation.step):
        model, point = variation.at(solution.model, solution.point, change)
        ends.append(model.residual(point, solution.a))
    return (ends[0] - ends[1]) / (2 * variation.step)


def _along(solution: FieldSolution, variation: Variation, slope: np.ndarray, read: Reader) -> np.ndarray:
    """Derivative of the results along the changed problem and the changed potential."""
    ends = []
    for change in (variation.step, -variation.step):
        model, point = variation.at(solution.model, solution.point, change)
        ends.append(read(replace(solution, model=model, point=point, a=solution.a + change * slope)))
    return (ends[0] - ends[1]) / (2 * variation.step)
