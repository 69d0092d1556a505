"""Straight triangles, linear or quadratic, laid out for fast assembly.

Weak form for the vector potential A (per metre of length), B = (dA/dy, -dA/dx):
    integral nu(|B|^2) grad A . grad v = integral J v + integral nu (B_rx dv/dy - B_ry dv/dx)
scikit-fem supplies the reference functions and the quadrature, and its numbering is kept: nodes, then edges. In
reference coordinates (xi, eta) the functions are the same in every triangle: what differs is three numbers, the metric
M, and so a vector or a matrix of all elements is one small constant matrix times a few numbers per element,
    grad A . grad v = (dA/dxi, dA/deta) M (dv/dxi, dv/deta) / |D|,   M = |D| J^-1 J^-T,   D = det J
The element index comes last in every array, so that each operation is one pass over contiguous memory.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from skfem import ElementTriP1, ElementTriP2, MeshTri
from skfem.element import Element
from skfem.quadrature import get_quadrature

from magnetostatics.passes import edges_of, lowered, metric_of


@dataclass(frozen=True, eq=False)
class TriangleOrder:
    """Lagrange functions on the reference triangle at the quadrature points.

    All in reference coordinates, dimensionless.
    values: dimensionless, (F, Q); gradients: dimensionless, (F, 2, Q); points: dimensionless, (2, Q)
    weights: shares of the area 1/2, (Q,); pairs: local (row, column) indices of the lower triangle, each (K,)
    """

    element: Element
    values: np.ndarray
    gradients: np.ndarray
    points: np.ndarray
    weights: np.ndarray
    pairs: tuple[np.ndarray, np.ndarray]

    @classmethod
    def of(cls, element: Element, functions: int) -> TriangleOrder:
        """Of an element of scikit-fem with so many shape functions, F, at points that integrate quadratics exactly."""
        points, weights = get_quadrature(element, 2)  # exact for a constant reluctivity on straight quadratic triangles
        values, gradients = zip(*(element.lbasis(points, i) for i in range(functions)))
        return cls(element, np.stack(values), _same_shape(gradients), points, weights, np.tril_indices(functions))

    @cached_property
    def slopes(self) -> np.ndarray:
        """Derivatives along xi at all points, then along eta (2 Q, F), dimensionless."""
        return np.ascontiguousarray(self.gradients.transpose(1, 2, 0).reshape(-1, len(self.values)))

    @cached_property
    def weighted_slopes(self) -> np.ndarray:
        """The slopes times the weights of their points (F, 2 Q), dimensionless.

        Sums a field at the points up to local vectors.
        """
        return np.ascontiguousarray((self.gradients * self.weights).reshape(len(self.values), -1))

    @cached_property
    def products(self) -> np.ndarray:
        """Weighted (d_xi u d_xi v, d_xi u d_eta v + d_eta u d_xi v, d_eta u d_eta v) per pair and point.

        products: dimensionless, (K, 3 Q)
        """
        i, j = self.pairs
        u, v = self.gradients[:, 0], self.gradients[:, 1]
        parts = np.stack([u[i] * u[j], u[i] * v[j] + v[i] * u[j], v[i] * v[j]], axis=1) * self.weights
        return np.ascontiguousarray(parts.reshape(len(i), -1))

    @cached_property
    def stiffness(self) -> np.ndarray:
        """The products summed over the points (K, 3), dimensionless: what the metric is multiplied with."""
        return self.products.reshape(len(self.products), 3, -1).sum(axis=2)

    @cached_property
    def of_distinct_gradients(self) -> TriangleOrder:
        """One point instead of all where the gradients are constant: enough for whatever depends on B alone."""
        if np.ptp(self.gradients, axis=2).max() > 0:
            return self
        middle, whole = self.points.mean(axis=1, keepdims=True), self.weights.sum(keepdims=True)
        values = self.values.mean(axis=1, keepdims=True)
        return TriangleOrder(self.element, values, self.gradients[:, :, :1], middle, whole, self.pairs)

    def gradients_at(self, local: np.ndarray) -> np.ndarray:
        """Reference gradients (F, 2, n) at local coordinates (2, n), both dimensionless."""
        return _same_shape([self.element.lbasis(local, i)[1] for i in range(len(self.values))])


def _same_shape(gradients: Iterable[np.ndarray]) -> np.ndarray:
    """Stack gradients of which some are constants."""
    return np.stack(np.broadcast_arrays(*(np.asarray(g, dtype=float) for g in gradients)))


LINEAR = TriangleOrder.of(ElementTriP1(), 3)
QUADRATIC = TriangleOrder.of(ElementTriP2(), 6)


def element_dofs(mesh: MeshTri, order: TriangleOrder) -> tuple[np.ndarray, int]:
    """Indices of the degrees of freedom (F, E), nodes first, then edges, and their total number."""
    nodes = mesh.p.shape[1]
    if order is LINEAR:
        return mesh.t, nodes
    return np.vstack([mesh.t, nodes + mesh.t2f]), nodes + mesh.facets.shape[1]


def dof_locations(mesh: MeshTri, order: TriangleOrder) -> np.ndarray:
    """Where the degrees of freedom sit (2, n) [m]: the nodes, then for quadratic functions the middles of the edges."""
    if order is LINEAR:
        return mesh.p
    return np.hstack([mesh.p, mesh.p[:, mesh.facets].mean(axis=1)])


def refine_order(facets: np.ndarray, a: np.ndarray) -> np.ndarray:
    """Potential [Wb/m], (n,), of the quadratic functions that describes the same field as that of linear ones.

    facets: indices of the ends of the edges, (2, k); a: potential at the nodes [Wb/m], (nodes,)
    """
    return np.concatenate([a, (a[facets[0]] + a[facets[1]]) / 2])


def lower_order(facets: np.ndarray, load: np.ndarray) -> np.ndarray:
    """Load on the linear functions [A], (nodes,), from that on the quadratic ones; the transpose of ``refine_order``.

    facets: indices of the ends of the edges, (2, k); load: on the quadratic functions [A], (n,); or several, (m, n)
    """
    return lowered(facets, np.atleast_2d(load)).reshape(*load.shape[:-1], load.shape[-1] - facets.shape[1])


@dataclass(frozen=True, eq=False)
class Triangles:
    """Straight triangles; elements of either order share what is known of their shape.

    first: the first corners (2, E) [m]; edges: from them to the second and third corners (2, 2, E) [m]
    """

    first: np.ndarray
    edges: np.ndarray

    @classmethod
    def of(cls, points: np.ndarray, corners: np.ndarray) -> Triangles:
        """Triangles with corners, indices (3, E) of points (2, n) [m]."""
        return cls(*edges_of(points, corners))

    def take(self, which: np.ndarray) -> Triangles:
        """The triangles with these indices; which: indices (k,)."""
        return Triangles(*(np.take(part, which, axis=-1) for part in (self.first, self.edges)))

    @cached_property
    def determinant(self) -> np.ndarray:
        """Of the map from the reference triangle (E,) [m^2]: twice the signed area."""
        u, v = self.edges
        return u[0] * v[1] - u[1] * v[0]

    @cached_property
    def size(self) -> np.ndarray:
        """|D|, twice the area (E,) [m^2]."""
        return np.abs(self.determinant)

    @cached_property
    def metric(self) -> np.ndarray:
        """M_11, M_12, M_22, dimensionless (3, E): grad . grad times |D| in reference coordinates."""
        return metric_of(self.edges)


@dataclass(frozen=True, eq=False)
class Elements:
    """A set of straight triangles with F functions each (3 linear, 6 quadratic).

    dofs: indices (F, E); shape: the triangles
    """

    order: TriangleOrder
    dofs: np.ndarray
    shape: Triangles

    @classmethod
    def of(cls, order: TriangleOrder, points: np.ndarray, corners: np.ndarray, dofs: np.ndarray) -> Elements:
        """Elements with corners, indices (3, E) of points (2, n) [m], and dofs, indices (F, E)."""
        return cls(order, dofs, Triangles.of(points, corners))

    def take(self, which: np.ndarray) -> Elements:
        """The elements with these indices; which: indices (k,)."""
        return Elements(self.order, np.take(self.dofs, which, axis=-1), self.shape.take(which))

    @property
    def determinant(self) -> np.ndarray:
        """Of the map from the reference triangle (E,) [m^2]: twice the signed area."""
        return self.shape.determinant

    @property
    def size(self) -> np.ndarray:
        """|D|, twice the area (E,) [m^2]."""
        return self.shape.size

    @property
    def metric(self) -> np.ndarray:
        """M_11, M_12, M_22, dimensionless (3, E): grad . grad times |D| in reference coordinates."""
        return self.shape.metric

    @cached_property
    def weights(self) -> np.ndarray:
        """Area that belongs to every quadrature point (Q, E) [m^2]."""
        return self.order.weights[:, None] * self.size

    @cached_property
    def points(self) -> np.ndarray:
        """Quadrature points (2, Q, E) [m]."""
        (u, v), (along_u, along_v) = self.shape.edges, self.order.points[:, :, None]
        return self.shape.first[:, None] + u[:, None] * along_u + v[:, None] * along_v

    @cached_property
    def gradient_x(self) -> np.ndarray:
        """d/dx of the functions at the quadrature points (F, Q, E) [1/m]."""
        (u, v), (along_u, along_v) = self.shape.edges, self.order.gradients[..., None].swapaxes(0, 1)
        return (along_u * v[1] - along_v * u[1]) / self.determinant

    @cached_property
    def gradient_y(self) -> np.ndarray:
        """d/dy of the functions at the quadrature points (F, Q, E) [1/m]."""
        (u, v), (along_u, along_v) = self.shape.edges, self.order.gradients[..., None].swapaxes(0, 1)
        return (along_v * u[0] - along_u * v[0]) / self.determinant

    def stiffness(self, reluctivity: np.ndarray | float) -> np.ndarray:
        """Element matrices [m/H], (K, E), for a reluctivity that is constant in each element [m/H], (E,) or scalar."""
        return self.order.stiffness @ (self.metric * reluctivity)

    def slopes(self, local: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(dA/dxi, dA/deta) [Wb/m] at the quadrature points, each (Q, E), of local values [Wb/m], (F, E)."""
        return tuple((self.order.slopes @ local).reshape(2, -1, local.shape[1]))

    def gradient(self, a: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(dA/dx, dA/dy) at the quadrature points [T], each (Q, E); a: potential [Wb/m], (n,)."""
        (u, v), (along_u, along_v) = self.shape.edges / self.determinant, self.slopes(a[self.dofs])
        return along_u * v[1] - along_v * u[1], along_v * u[0] - along_u * v[0]

    def forces(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Local vectors integral (x dv/dx + y dv/dy) of a vector field given at the quadrature points.

        x, y: [A/m], (Q, E); forces: [A], (F, E), or in metres times another unit of the field
        """
        u, v = self.shape.edges * np.sign(self.determinant)
        return self.order.weighted_slopes @ np.concatenate([x * v[1] - y * v[0], y * u[0] - x * u[1]])

    def integrals(self) -> np.ndarray:
        """Local vectors integral v (F, E) [m^2]."""
        return self.order.values @ self.weights

    def scatter(self, local: np.ndarray, size: int) -> np.ndarray:
        """Sum local vectors [A], (F, E), into a global vector [A], (size,); or both in another unit."""
        return np.bincount(self.dofs.ravel(), weights=local.ravel(), minlength=size)
