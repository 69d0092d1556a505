"""Straight triangles, linear or quadratic, laid out for fast assembly.

Weak form for the vector potential A (per metre of length), B = (dA/dy, -dA/dx):
    integral nu(|B|^2) grad A . grad v = integral J v + integral nu (B_rx dv/dy - B_ry dv/dx)
scikit-fem supplies the reference functions, the quadrature and the numbering; the gradients are mapped once per mesh.
The element index comes last in every array, so that each operation is one pass over contiguous memory.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from skfem import ElementTriP1, ElementTriP2, MeshTri
from skfem.element import Element
from skfem.assembly import Dofs
from skfem.quadrature import get_quadrature


@dataclass(frozen=True, eq=False)
class TriangleOrder:
    """Lagrange functions on the reference triangle at the quadrature points.

    values (F, Q), gradients (F, 2, Q), points (2, Q), weights (Q,); pairs: local (row, column) of the lower triangle, K
    """

    element: Element
    values: np.ndarray
    gradients: np.ndarray
    points: np.ndarray
    weights: np.ndarray
    pairs: tuple[np.ndarray, np.ndarray]

    @classmethod
    def of(cls, element: Element, functions: int) -> TriangleOrder:
        points, weights = get_quadrature(element, 2)  # exact for a constant reluctivity on straight quadratic triangles
        values, gradients = zip(*(element.lbasis(points, i) for i in range(functions)))
        return cls(element, np.stack(values), _same_shape(gradients), points, weights, np.tril_indices(functions))

    @cached_property
    def stiffness(self) -> np.ndarray:
        """integral of (d_u d_u, d_u d_v + d_v d_u, d_v d_v) of every pair over the reference triangle (K, 3)."""
        i, j = self.pairs
        u, v = self.gradients[:, 0], self.gradients[:, 1]
        return np.stack([(u[i] * u[j]), (u[i] * v[j] + v[i] * u[j]), (v[i] * v[j])], axis=1) @ self.weights

    def gradients_at(self, local: np.ndarray) -> np.ndarray:
        """Reference gradients (F, 2, n) at local coordinates (2, n)."""
        return _same_shape([self.element.lbasis(local, i)[1] for i in range(len(self.values))])


def _same_shape(gradients) -> np.ndarray:
    """Stack gradients of which some are constants."""
    return np.stack(np.broadcast_arrays(*(np.asarray(g, dtype=float) for g in gradients)))


LINEAR = TriangleOrder.of(ElementTriP1(), 3)
QUADRATIC = TriangleOrder.of(ElementTriP2(), 6)


def element_dofs(mesh: MeshTri, order: TriangleOrder) -> tuple[np.ndarray, int]:
    """Degrees of freedom (F, E), nodes first, then edges, and their total number."""
    dofs = Dofs(mesh, order.element)
    return dofs.element_dofs, dofs.N


def dof_locations(mesh: MeshTri, order: TriangleOrder) -> np.ndarray:
    """Where the degrees of freedom sit (2, n) [m]: the nodes, then for quadratic functions the middles of the edges."""
    if order is LINEAR:
        return mesh.p
    return np.hstack([mesh.p, mesh.p[:, mesh.facets].mean(axis=1)])


def refine_order(facets: np.ndarray, a: np.ndarray) -> np.ndarray:
    """Degrees of freedom of the quadratic functions (n,) that describe the same field as linear ones; facets (2, k)."""
    return np.concatenate([a, a[facets].mean(axis=0)])


@dataclass(frozen=True, eq=False)
class Elements:
    """A set of straight triangles with F functions each (3 linear, 6 quadratic).

    dofs (F, E); gradients of the functions (F, Q, E) [1/m]; weights (Q, E) [m^2]; points (2, Q, E) [m]
    edges: from the first corner to the second and third (2, 2, E) [m]
    """

    order: TriangleOrder
    dofs: np.ndarray
    gradient_x: np.ndarray
    gradient_y: np.ndarray
    weights: np.ndarray
    points: np.ndarray
    edges: np.ndarray

    @classmethod
    def of(cls, order: TriangleOrder, corners: np.ndarray, dofs: np.ndarray) -> Elements:
        """Elements with corners (2, 3, E) [m] and degrees of freedom (F, E)."""
        a, b, c = corners.transpose(1, 0, 2)
        u, v = b - a, c - a
        determinant = u[0] * v[1] - u[1] * v[0]
        along_u, along_v = order.gradients[:, 0, :, None], order.gradients[:, 1, :, None]
        gradient_x = (along_u * v[1] - along_v * u[1]) / determinant
        gradient_y = (along_v * u[0] - along_u * v[0]) / determinant
        points = a[:, None] + u[:, None] * order.points[0][:, None] + v[:, None] * order.points[1][:, None]
        return cls(
            order, dofs, gradient_x, gradient_y, order.weights[:, None] * np.abs(determinant), points, np.stack([u, v])
        )

    def take(self, which: np.ndarray) -> Elements:
        """The elements with these indices."""
        return Elements(
            self.order,
            self.dofs[:, which],
            self.gradient_x[:, :, which],
            self.gradient_y[:, :, which],
            self.weights[:, which],
            self.points[:, :, which],
            self.edges[:, :, which],
        )

    @cached_property
    def stiffness_basis(self) -> np.ndarray:
        """weights * grad phi_i . grad phi_j for the pairs of functions (K, Q, E): times nu it is the element matrix."""
        i, j = self.order.pairs
        return (self.gradient_x[i] * self.gradient_x[j] + self.gradient_y[i] * self.gradient_y[j]) * self.weights

    @cached_property
    def metric(self) -> np.ndarray:
        """What a constant reluctivity multiplies in the element matrix (3, E): grad . grad in reference coordinates."""
        u, v = self.edges
        determinant = np.abs(u[0] * v[1] - u[1] * v[0])
        return np.stack([(v * v).sum(0), -(u * v).sum(0), (u * u).sum(0)]) / determinant

    def stiffness(self, reluctivity: np.ndarray | float) -> np.ndarray:
        """Element matrices (K, E) for a reluctivity that is constant in each element (E,) [m/H]."""
        return self.order.stiffness @ (self.metric * reluctivity)

    def gradient(self, a: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(dA/dx, dA/dy) at the quadrature points, each (Q, E) [T]."""
        local = a[self.dofs]
        return np.einsum("iqe,ie->qe", self.gradient_x, local), np.einsum("iqe,ie->qe", self.gradient_y, local)

    def forces(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Local vectors integral (x dv/dx + y dv/dy) (F, E) of a vector field given at the quadrature points (Q, E)."""
        x, y = x * self.weights, y * self.weights
        return np.einsum("iqe,qe->ie", self.gradient_x, x) + np.einsum("iqe,qe->ie", self.gradient_y, y)

    def means(self) -> np.ndarray:
        """Local vectors integral v / total area (F, E)."""
        return self.order.values @ self.weights / self.weights.sum()

    def scatter(self, local: np.ndarray, size: int) -> np.ndarray:
        """Sum local vectors (F, E) into a global vector (size,)."""
        return np.bincount(self.dofs.ravel(), weights=local.ravel(), minlength=size)
