"""How far a torque or a flux linkage can be trusted: by triangles of half the size and by both torque routes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from skfem import MeshTri

from geometry.cross_section import CrossSection
from magnetostatics.elements import QUADRATIC, refine_order
from magnetostatics.flux_linkage import phase_flux_linkage
from magnetostatics.model import FieldModel, FieldSolution, OperatingState
from magnetostatics.torque import arkkio_torque, maxwell_torque

# What halving the triangles changes, times this, bounds what they are off by. Corners of the iron leave an error of the
# order h^(4/3), so halving takes away 0.6 of it and 1/0.6 = 1.7 would do on an ever finer mesh.
SAFETY = 2.0
_SAME_RADIUS = 1e-6  # of the radius
# Halves of the edges of a triangle and the edges between their middles, by its degrees of freedom.
_HALVES = np.array([[0, 1, 1, 2, 2, 0, 3, 4, 5], [3, 3, 4, 4, 5, 5, 4, 5, 3]])


def torque_with_error(model: FieldModel, point: OperatingState) -> tuple[float, float]:
    """Torque [Nm/m] by ``arkkio_torque`` and a bound of what the mesh may have put it off by [Nm/m].

    error = |T_ring - T_circle| + 2 max over both routes |T(mesh) - T(mesh refined once)| + tolerance of Newton |T|
    Costs some five solutions. The error of the model itself (materials, tolerances, end effects) is not in it.
    """
    solution = model.solve(point)
    return arkkio_torque(solution), torque_error(solution, refined_solution(solution))


def torque_errors(solutions: Sequence[FieldSolution]) -> list[float]:
    """The bound of ``torque_with_error`` [Nm/m] of several solutions of one model; those at one angle share work."""
    finer = refined_model(solutions[0].model)
    fine: list[FieldSolution] = []
    for solution in solutions:
        fine.append(finer.solve(solution.point, fine[-1]) if fine else refined_solution(solution, finer))
    return [torque_error(*both) for both in zip(solutions, fine, strict=True)]


def flux_linkage_with_error(model: FieldModel, point: OperatingState) -> tuple[np.ndarray, float]:
    """Flux linkage of the phases (3,) and a bound of what the mesh may have put any of them off by [Wb/m per turn].

    error = 2 max over the phases |psi(mesh) - psi(mesh refined once)|
    """
    solution = model.solve(point)
    psi = phase_flux_linkage(solution)
    return psi, float(SAFETY * np.abs(psi - phase_flux_linkage(refined_solution(solution))).max())


def torque_error(solution: FieldSolution, finer: FieldSolution) -> float:
    """The bound of ``torque_with_error`` from two solutions of one point [Nm/m]."""
    coarse, fine = (np.array([arkkio_torque(field), maxwell_torque(field)]) for field in (solution, finer))
    unsolved = solution.model.settings.tolerance * abs(coarse[0])
    return float(np.ptp(coarse) + SAFETY * np.abs(coarse - fine).max() + unsolved)


def refined_solution(solution: FieldSolution, finer: FieldModel | None = None) -> FieldSolution:
    """The same operating point on the refined mesh, from the field on the coarse one.

    Linear elements are solved there before: a start from quadratic ones would else be changed by what linear ones lack.
    finer: the model of the refined mesh, where there is one already
    """
    finer = finer or refined_model(solution.model)
    start = prolonged(solution, finer)
    if start.coarse is not None:
        start = replace(start, coarse=finer.coarse_model.solve(solution.point, start.coarse))
    return finer.solve(solution.point, start)


def prolonged(solution: FieldSolution, finer: FieldModel) -> FieldSolution:
    """The same field on the triangles of the refined model, to start from: Newton's method has less to go there.

    The nodes of the refined mesh are numbered like the degrees of freedom of quadratic elements on the coarse one, so
    that what is known at these is a field of linear elements on the refined one.
    """
    if solution.coarse is None:
        nodes = refine_order(solution.model.topology.facets, solution.a)
        return replace(solution, model=finer, a=nodes)
    linear = replace(solution.coarse, model=finer.coarse_model, a=solution.a)
    return replace(solution, model=finer, a=np.concatenate([solution.a, _at_halves(solution, finer)]), coarse=linear)


def _at_halves(solution: FieldSolution, finer: FieldModel) -> np.ndarray:
    """Quadratic potential in the middles of the edges of the refined mesh [Wb/m], (k,)."""
    dofs, element, facets = solution.model.topology.dofs, QUADRATIC.element, finer.topology.facets
    middles = element.doflocs[_HALVES].mean(axis=0).T
    values = np.stack([element.lbasis(middles, i)[0] for i in range(len(dofs))])
    keys, found = _key(facets), np.empty(facets.shape[1])
    order = np.argsort(keys)
    found[order[np.searchsorted(keys, _key(dofs[_HALVES]), sorter=order)]] = values.T @ solution.a[dofs]
    return found


def _key(ends: np.ndarray) -> np.ndarray:
    """One number for two nodes, indices (2, ...), in any order."""
    return (np.min(ends, axis=0).astype(np.int64) << 32) + np.max(ends, axis=0)


def refined_model(model: FieldModel) -> FieldModel:
    """The same problem on the refined mesh."""
    return FieldModel(refined(model.section), model.materials, model.settings, model.order)


def refined(section: CrossSection) -> CrossSection:
    """The same section with every triangle divided into four.

    New nodes lie in the middles of the edges; on arcs of the drawing and on the sliding circle they are moved out onto
    the arc. Such a mesh can be solved on, but not be moved by a ``Morpher``: move first, then refine.
    """
    coarse, mesh = section.mesh, section.mesh.refined()
    points, edges = mesh.p.copy(), _outline(coarse)
    for place in {(0.0, 0.0), section.assembly.stator_centre, section.assembly.rotor_centre}:
        centre = np.array(place)[:, None]
        first, last = (np.hypot(*(coarse.p[:, nodes] - centre)) for nodes in coarse.facets[:, edges])
        on_arc = (np.abs(last - first) < _SAME_RADIUS * first) & (first > 0)
        middles = coarse.p.shape[1] + edges[on_arc]  # scikit-fem numbers the new nodes like the edges
        away = points[:, middles] - centre
        points[:, middles] = centre + away * first[on_arc] / np.hypot(*away)
    return replace(section, mesh=replace(mesh, doflocs=points), pieces=())


def _outline(mesh: MeshTri) -> np.ndarray:
    """Edges between two regions or on the border."""
    region = np.zeros(mesh.nelements, dtype=int)
    for number, elements in enumerate(mesh.subdomains.values()):
        region[elements] = number
    first, second = mesh.f2t
    return np.flatnonzero((second < 0) | (region[first] != region[second]))
