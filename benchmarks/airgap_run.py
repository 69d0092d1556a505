"""A case solved by this project, from the meshed section in memory to torque and flux linkage."""

from __future__ import annotations

import time

import numpy as np
from scipy.spatial import cKDTree

from benchmarks.processes import Cost
from benchmarks.reference_case import FieldCase
from benchmarks.result import CodeResult
from magnetostatics.elements import dof_locations, element_dofs
from magnetostatics.flux_linkage import phase_flux_linkage
from magnetostatics.model import FieldModel
from magnetostatics.newton import NewtonSettings
from magnetostatics.torque import arkkio_torque, maxwell_torque

COLD, PREPARED = "Airgap", "Airgap, prepared"


def _settings(tolerance: float) -> NewtonSettings:
    """The stopping rule of the other codes."""
    return NewtonSettings(tolerance)


def solve_cold(case: FieldCase, tolerance: float) -> CodeResult:
    """Everything after the mesh, in a model that has never solved before."""
    began = time.process_time(), time.perf_counter()
    model = FieldModel(case.section, case.materials, _settings(tolerance), case.order)
    return _solve(COLD, model, case, began)


def solve_prepared(case: FieldCase, tolerance: float) -> CodeResult:
    """The same from zero field, in a model whose numbering and pattern are there, as for the next current."""
    model = FieldModel(case.section, case.materials, _settings(tolerance), case.order)
    model.solve(case.state.point)
    return _solve(PREPARED, model, case, (time.process_time(), time.perf_counter()))


def _solve(code: str, model: FieldModel, case: FieldCase, began: tuple[float, float]) -> CodeResult:
    solution = model.solve(case.state.point)
    torque, linkage = arkkio_torque(solution), phase_flux_linkage(solution)
    cost = Cost(time.process_time() - began[0], time.perf_counter() - began[1])
    others = {"torque_by_contour": maxwell_torque(solution), "unknowns": model.unknowns.count}
    return CodeResult(code, torque, linkage, solution.newton.residuals, cost, solution.a[corner_dofs(case)], others)


def corner_dofs(case: FieldCase) -> np.ndarray:
    """Degree of freedom of this project's numbering at every corner of the case's mesh (n,)."""
    mesh, angle = case.section.mesh, case.state.point.angle
    x, y = dof_locations(mesh, case.order)
    rotor = np.unique(element_dofs(mesh, case.order)[0][:, case.section.rotor_elements])
    place = x + 1j * y
    place[rotor] *= np.exp(1j * angle)
    corners = case.mesh.points[: case.mesh.corners]
    return cKDTree(np.column_stack([place.real, place.imag])).query(corners)[1]
