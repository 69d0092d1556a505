"""A case solved by scikit-fem from the forms of the weak form, from the mesh in memory to torque and flux linkage."""

from __future__ import annotations

import time

from benchmarks.airgap_run import corner_dofs
from benchmarks.processes import Cost
from benchmarks.reference_case import FieldCase
from benchmarks.result import CodeResult
from magnetostatics.weak_form import WeakForm

SCIKIT_FEM = "scikit-fem"
_DEGREES = {3: 2, 7: 5}  # of the polynomials that scikit-fem's rules of so many points integrate exactly


def solve_weak_form(case: FieldCase, tolerance: float, points: int = 3) -> CodeResult:
    """Forms assembled by scikit-fem in every Newton step and solved by its default solver, SuperLU; nothing prepared.

    tolerance: residual relative to the load; points: of the quadrature in a triangle
    """
    began = time.process_time(), time.perf_counter()
    angle, ampere_turns = case.state.point.angle, case.state.point.ampere_turns(case.section)
    problem = WeakForm(case.section, case.materials, angle, case.order, _DEGREES[points])
    found = problem.solve(ampere_turns, tolerance)
    cost = Cost(time.process_time() - began[0], time.perf_counter() - began[1])
    potential, others = found.a[corner_dofs(case)], {"unknowns": problem.P.shape[1]}
    return CodeResult(SCIKIT_FEM, found.torque, found.flux_linkage, found.residuals[1:], cost, potential, others)
