"""How every result of a field solution changes with any parameter, by one back-substitution each.

At a solution the residual R(a; p) is zero. Along a parameter p, with K the tangent matrix that Newton ended with,
    K da/dp = dR/dp        (R: load minus field forces)
    dQ/dp = dQ/da da/dp + dQ/dp |_a
for every result Q at once: torque, flux linkage, probes. dR/dp at fixed a and dQ along (a + h da/dp, p + h) are forward
differences of formulas, not of field solutions: nothing is solved again, rounding alone says how small a step may be,
and steps of some 1e-6 leave the error of a one-sided difference there, at half the cost of a central one. A parameter
is whatever makes a slightly different model on the same triangles: material, magnet, source or moved nodes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Protocol

import numpy as np

from magnetostatics.model import FieldModel, FieldSolution, OperatingState

Reader = Callable[[FieldSolution], np.ndarray]


class Variation(Protocol):
    """A parameter and the problem with it changed."""

    @property
    def step(self) -> float:
        """A small change, a millionth of what would be a large one [unit of the parameter]."""

    def at(self, model: FieldModel, point: OperatingState, change: float) -> tuple[FieldModel, OperatingState]:
        """The problem with the parameter changed; change: any [unit of the parameter]."""


def sensitivities(
    solution: FieldSolution, variations: dict[str, Variation], read: Reader, here: np.ndarray | None = None
) -> dict[str, np.ndarray]:
    """Derivative of ``read(solution)`` (k,) with respect to each parameter [unit of the result per its own].

    variations: parameters by name; their models must share the triangles of the solution (``FieldModel.like``)
    read: results of a solution as a vector, for example torque and flux densities
    here: what is read of the solution itself [unit of the result], (k,), where that is known
    """
    here = read(solution) if here is None else here
    found = ahead(solution, variations)
    return {name: (read(one) - here) / variations[name].step for name, one in found.items()}


def ahead(solution: FieldSolution, variations: dict[str, Variation]) -> dict[str, FieldSolution]:
    """The field one step of each parameter ahead, to first order, by one back-substitution each; nothing is solved
    again.

    For results that several solutions make together, such as a loss over a period. variations: see ``sensitivities``
    """
    if not variations:
        return {}
    tangent = solution.model.tangent(solution)
    here = tangent.residual
    changed = [v.at(solution.model, solution.point, v.step) for v in variations.values()]
    loads = np.stack([model.residual(point, solution.a) - here for model, point in changed])
    changes = tangent.responses(loads)
    return {
        name: replace(solution, model=model, point=point, a=solution.a + change)
        for name, (model, point), change in zip(variations, changed, changes)
    }
