"""The constrained optimum by gradients: sequential quadratic programming on torque and limited flux density.

Both come with their exact derivatives in (back-iron width, rotor radius) from one field solution on a moved mesh, so no
grid is needed. At the end the machine is meshed anew and the search goes on from there until it stands still.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from scipy.optimize import minimize

from geometry.machine import Machine
from optimisation.constrained_optimum import BestDesign, NoOptimumError
from optimisation.design import Design, DesignSolver, Judge
from units import MILLIMETRE

_FARTHEST = 0.35  # relative change of a dimension in one search
_STEPS = np.full(2, 1e-4)  # relative changes for the derivatives
_TOLERANCE = 1e-4  # of torque and limit, relative; below it the search jams in the rounding of the field solutions
_BINDS = 5e-3  # relative distance from the limit at which it still counts as binding


@dataclass
class _Problem:
    """Torque and limited flux density, relative, over relative changes x (2,) of the dimensions at ``centre``."""

    solver: DesignSolver
    slots: int
    stator_outer_radius: float
    limit: float
    centre: np.ndarray
    known: dict[bytes, tuple[Design, np.ndarray, np.ndarray]] = field(default_factory=dict)

    def machine(self, x: np.ndarray) -> Machine:
        width, radius = self.centre * (1 + x)
        return self.solver.judge.case.family.machine(self.slots, self.stator_outer_radius, float(width), float(radius))

    def look(self, x: np.ndarray) -> tuple[Design, np.ndarray, np.ndarray]:
        """(design, torque slopes, limited slopes) at x, each solved once."""
        key = np.asarray(x, dtype=float).tobytes()
        if key not in self.known:
            design = self.solver.design(self.machine(x))
            slopes = self.solver.gradient(lambda changes: self.machine(x + changes), _STEPS)
            self.known[key] = (design, *slopes)
        return self.known[key]

    def search(self) -> np.ndarray:
        """x of the largest torque under the limit."""
        scale = self.look(np.zeros(2))[0].torque
        allowed = {
            "type": "ineq",
            "fun": lambda x: 1 - self.look(x)[0].limited / self.limit,
            "jac": lambda x: -self.look(x)[2] / self.limit,
        }
        found = minimize(
            lambda x: -self.look(x)[0].torque / scale,
            np.zeros(2),
            jac=lambda x: -self.look(x)[1] / scale,
            method="SLSQP",
            bounds=[(-_FARTHEST, _FARTHEST)] * 2,
            constraints=[allowed],
            options={"ftol": _TOLERANCE, "maxiter": 12},
        )
        if not found.success:
            raise NoOptimumError(
                f"{self.slots} slots, stator radius {self.stator_outer_radius / MILLIMETRE:g} mm: {found.message}"
            )
        return found.x


def find_optimum_by_gradients(
    judge: Judge,
    slots: int,
    stator_outer_radius: float,
    limit: float,
    start: tuple[float, float],
) -> BestDesign:
    """Largest torque with the limited flux density at most ``limit`` [T]; arguments as ``find_optimum``.

    start: (back-iron width, rotor radius) [m], within a third of the optimum
    Raises NoOptimumError when the search does not settle, GeometryError when it leaves what can be built.
    """
    solves, centre = 0, np.array(start)
    for _ in range(2):  # the second time on a mesh of the optimum itself
        problem = _Problem(DesignSolver(judge), slots, stator_outer_radius, limit, centre)
        x = problem.search()
        solves += len(problem.known)
        centre = centre * (1 + x)
    design = problem.look(x)[0]
    return BestDesign(design, design.limited > limit * (1 - _BINDS), solves)
