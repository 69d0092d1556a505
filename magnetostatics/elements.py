"""Quadratic triangles laid out for fast assembly.

Weak form for the vector potential A (per metre of length), B = (dA/dy, -dA/dx):
    integral nu(|B|^2) grad A . grad v = integral J v + integral nu (B_rx dv/dy - B_ry dv/dx)
scikit-fem supplies the reference functions, the quadrature and the numbering; the gradients are mapped once per mesh.
The element index comes last in every array, so that each operation is one pass over contiguous memory.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from skfem import ElementTriP2, MeshTri
from skfem.assembly import Dofs
from skfem.quadrature import get_quadrature

ELEMENT = ElementTriP2()
_POINTS, _WEIGHTS = get_quadrature(ELEMENT, 2)  # exact for a constant reluctivity on straight triangles
_VALUES = np.stack([ELEMENT.lbasis(_POINTS, i)[0] for i in range(6)])  # (6, Q)
_REFERENCE = np.stack([ELEMENT.lbasis(_POINTS, i)[1] for i in range(6)])  # (6, 2, Q)

PAIRS = tuple(np.array(x) for x in np.tril_indices(6))  # local (row, column) of the 21 entries of a symmetric 6 x 6 matrix


def element_dofs(mesh: MeshTri) -> tuple[np.ndarray, int]:
    """Degrees of freedom (6, E) of quadratic triangles, nodes first, then edges, and their total number."""
    dofs = Dofs(mesh, ELEMENT)
    return dofs.element_dofs, dofs.N


def dof_locations(mesh: MeshTri) -> np.ndarray:
    """Where the degrees of freedom sit (2, n) [m]: the nodes, then the middles of the edges."""
    return np.hstack([mesh.p, mesh.p[:, mesh.facets].mean(axis=1)])


@dataclass(frozen=True, eq=False)
class Elements:
    """A set of straight quadratic triangles.

    dofs (6, E); gradients of the functions (6, Q, E) [1/m]; weights (Q, E) [m^2]; points (2, Q, E) [m]
    """

    dofs: np.ndarray
    gradient_x: np.ndarray
    gradient_y: np.ndarray
    weights: np.ndarray
    points: np.ndarray

    @classmethod
    def of(cls, corners: np.ndarray, dofs: np.ndarray) -> Elements:
        """Elements with corners (2, 3, E) [m] and degrees of freedom (6, E)."""
        a, b, c = corners.transpose(1, 0, 2)
        u, v = b - a, c - a
        determinant = u[0] * v[1] - u[1] * v[0]
        along_u, along_v = _REFERENCE[:, 0, :, None], _REFERENCE[:, 1, :, None]
        gradient_x = (along_u * v[1] - along_v * u[1]) / determinant
        gradient_y = (along_v * u[0] - along_u * v[0]) / determinant
        points = a[:, None] + u[:, None] * _POINTS[0][:, None] + v[:, None] * _POINTS[1][:, None]
        return cls(dofs, gradient_x, gradient_y, _WEIGHTS[:, None] * np.abs(determinant), points)

    def take(self, which: np.ndarray) -> Elements:
        """The elements with these indices."""
        return Elements(
            self.dofs[:, which],
            self.gradient_x[:, :, which],
            self.gradient_y[:, :, which],
            self.weights[:, which],
            self.points[:, :, which],
        )

    @cached_property
    def stiffness_basis(self) -> np.ndarray:
        """weights * grad phi_i . grad phi_j for the 21 pairs (21, Q, E): times nu it is the element matrix."""
        i, j = PAIRS
        return (self.gradient_x[i] * self.gradient_x[j] + self.gradient_y[i] * self.gradient_y[j]) * self.weights

    def gradient(self, a: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(dA/dx, dA/dy) at the quadrature points, each (Q, E) [T]."""
        local = a[self.dofs]
        return np.einsum("iqe,ie->qe", self.gradient_x, local), np.einsum("iqe,ie->qe", self.gradient_y, local)

    def forces(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Local vectors integral (x dv/dx + y dv/dy) (6, E) of a vector field given at the quadrature points (Q, E)."""
        x, y = x * self.weights, y * self.weights
        return np.einsum("iqe,qe->ie", self.gradient_x, x) + np.einsum("iqe,qe->ie", self.gradient_y, y)

    def means(self) -> np.ndarray:
        """Local vectors integral v / total area (6, E)."""
        return _VALUES @ self.weights / self.weights.sum()

    def scatter(self, local: np.ndarray, size: int) -> np.ndarray:
        """Sum local vectors (6, E) into a global vector (size,)."""
        return np.bincount(self.dofs.ravel(), weights=local.ravel(), minlength=size)
