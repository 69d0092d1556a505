"""Mean |B| over the probe segments in teeth and back iron (thesis Fig. 3.17) and across narrow iron of the rotor."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree
from skfem import MeshTri

from geometry.cross_section import Probe
from geometry.errors import GeometryError
from magnetostatics.elements import TriangleOrder
from magnetostatics.model import FieldModel, FieldSolution

_ON_EDGE = 1e-9  # barycentric coordinate; beyond it a point lies in one element alone
_NEAREST = 12  # elements tried around a point, by distance of their centres


@dataclass(frozen=True, eq=False)
class ProbeReader:
    """Gradient arrays of all probe points of a model, so that reading a solution is one product.

    dofs: indices (F, n); gradient_x, gradient_y: of the functions [1/m], (F, n)
    weights: share of a point in the mean of its probe (n,); number: index of the probe (n,); names: of the probes
    elements: indices of those that hold the points (n,)
    near: indices of those that may, on a mesh like this one, (n, m)
    """

    dofs: np.ndarray
    gradient_x: np.ndarray
    gradient_y: np.ndarray
    weights: np.ndarray
    number: np.ndarray
    names: tuple[str, ...]
    elements: np.ndarray
    near: np.ndarray
    shares: np.ndarray  # barycentric coordinates of the points in their elements, dimensionless, (3, n)

    def moved(self, model: FieldModel) -> ProbeReader:
        """The same points of the same elements in a model with moved nodes."""
        mesh = model.section.mesh
        dx, dy = _gradients(model.order, mesh.p[:, mesh.t[:, self.elements]], self.shares)
        return replace(self, gradient_x=dx, gradient_y=dy)

    def read(self, solution: FieldSolution) -> dict[str, float]:
        """Mean |B| [T] over every probe, by name (``tooth_0 ...``, ``back_iron_0 ...``, ``bridge_0 ...``)."""
        local = solution.a[self.dofs]
        b = np.hypot((self.gradient_x * local).sum(0), (self.gradient_y * local).sum(0))
        means = np.bincount(self.number, weights=self.weights * b)
        return dict(zip(self.names, means.tolist()))


def probe_reader(model: FieldModel, known: ProbeReader | None = None) -> ProbeReader:
    """Prepare the probes of a model, those of the rotor last; known: those of a model that shares its topology."""
    section = model.section
    probes = section.tooth_probes + section.back_iron_probes + section.rotor_probes
    points = np.hstack([probe.points for probe in probes])
    mesh = section.mesh
    near = _nearest(model, probes) if known is None else known.near
    elements = _locate(mesh, points, near) if known is None else _still(mesh, points, known)
    if elements is None:
        if known is None:
            raise GeometryError("a probe point lies outside the iron: refine the mesh")
        return probe_reader(model)
    corners = mesh.p[:, mesh.t[:, elements]]
    shares = _barycentric(corners, points)
    dx, dy = _gradients(model.order, corners, shares)
    weights = np.concatenate([probe.weights for probe in probes])
    number = np.repeat(np.arange(len(probes)), [len(probe.weights) for probe in probes])
    names = tuple(probe.name for probe in probes)
    return ProbeReader(model.elements.dofs[:, elements], dx, dy, weights, number, names, elements, near, shares)


def _nearest(model: FieldModel, probes: Sequence[Probe]) -> np.ndarray:
    """Indices of the elements of its own iron that are nearest to each point of the probes: (n, m)."""
    mesh, trees = model.section.mesh, {}
    for name in {probe.iron for probe in probes}:
        iron = mesh.subdomains[name]
        trees[name] = iron, cKDTree(mesh.p[:, mesh.t[:, iron]].mean(axis=1).T)
    found = ((trees[probe.iron], probe.points.T) for probe in probes)
    return np.vstack([iron[tree.query(points, k=_NEAREST)[1]] for (iron, tree), points in found])


def _still(mesh: MeshTri, points: np.ndarray, known: ProbeReader) -> np.ndarray | None:
    """As ``_locate``, for points that mostly lie in the elements where they have been, indices (n,)."""
    inside = _barycentric(mesh.p[:, mesh.t[:, known.elements]], points).min(axis=0)
    moved = np.flatnonzero(inside <= _ON_EDGE)
    found = _locate(mesh, points[:, moved], known.near[moved]) if len(moved) else known.elements[moved]
    if found is None:
        return None
    elements = known.elements.copy()
    elements[moved] = found
    return elements


def _locate(mesh: MeshTri, points: np.ndarray, near: np.ndarray) -> np.ndarray | None:
    """Element that holds each point [m], (2, n): the best of those near it by barycentric coordinates, indices (n,).

    near: indices (n, m). None where a point lies in none of its elements.
    """
    inside = _barycentric(mesh.p[:, mesh.t[:, near]], points[:, :, None]).min(axis=0)
    if inside.max(axis=1).min() < -1e-6:
        return None
    return near[np.arange(len(near)), inside.argmax(axis=1)]


def _barycentric(corners: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Barycentric coordinates (3, ...) of points x (2, ...) in triangles with corners (2, 3, ...)."""
    a, b, c = corners.swapaxes(0, 1)
    parts = np.stack([_cross(b - x, c - x), _cross(c - x, a - x), _cross(a - x, b - x)])
    return parts / _cross(b - a, c - a)


def _cross(u: np.ndarray, v: np.ndarray) -> np.ndarray:
    return u[0] * v[1] - u[1] * v[0]


def _gradients(order: TriangleOrder, corners: np.ndarray, shares: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Gradients (F, n) in x and y of the functions of the element around each point, at its barycentric coordinates."""
    a, b, c = corners.swapaxes(0, 1)
    u, v = b - a, c - a
    determinant = _cross(u, v)
    along_u, along_v = order.gradients_at(shares[1:]).swapaxes(0, 1)
    return (along_u * v[1] - along_v * u[1]) / determinant, (along_v * u[0] - along_u * v[0]) / determinant
