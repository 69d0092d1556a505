"""The tangent equation of quadratic elements, by conjugate gradients with linear elements as their coarse level.

The linear functions on the same triangles are contained in the quadratic ones, and the tangent there is factorised in
a tenth of the time. What it leaves are parts that change from one unknown to the next, and these a sweep of
Gauss-Seidel takes away. One sweep forwards, the coarse equation, one sweep backwards make a symmetric preconditioner B;
    z = B r:   (D + L) x = r,   e = P K_c^-1 P^T (r - K x),   (D + L^T) y = r - K (x + e),   z = x + e + y
with K = L + D + L^T. What the first sweep leaves is r - K x = -L^T x, the last one is (D + L^T) (e + y) = -L^T x - L e,
and K z = r + L y: half a product each, and none of its own for K z. The residual falls to 0.3 of itself per iteration
whatever the size of the mesh, without fill. Hackbusch, Multi-Grid Methods and Applications (Springer 1985), ch. 2;
Hestenes and Stiefel, J. Res. Natl. Bur. Stand. 49 (1952).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from compiling import vectorised
from magnetostatics.cholesky import SymmetricSystem
from magnetostatics.fronts import Fronts
from magnetostatics.multifrontal import solve

_MOST = 50  # iterations; what is reached is a direction all the same


@dataclass(frozen=True, eq=False)
class Lower:
    """The lower triangle of a symmetric positive definite matrix, the diagonal first in every column.

    starts: of the columns, indices (n + 1,); rows: indices (k,); values: [m/H], (k,)
    """

    starts: np.ndarray
    rows: np.ndarray
    values: np.ndarray


@dataclass(frozen=True, eq=False)
class Refinement:
    """The quadratic functions' unknowns that describe the same field as those of linear ones: P.

    The unknowns of nodes come first and are shared; the others are of edges.
    ends: index of the unknowns at both ends of every edge, (2, m)
    shares: of them in the edge's unknown, dimensionless, (2, m)
    """

    ends: np.ndarray
    shares: np.ndarray


def response(
    matrix: Lower, refinement: Refinement, coarse: SymmetricSystem, load: np.ndarray, share: float
) -> tuple[np.ndarray, int]:
    """x [Wb/m], (n,), with |load - K x| <= share |load|, or what 50 iterations give, and their number.

    coarse: K of about the same field with linear elements, factorised; load: [A], (n,); share: dimensionless
    Raises ArithmeticError when the matrix is not positive definite.
    """
    wanted = share * float(np.linalg.norm(load))
    lower = matrix.starts, matrix.rows, matrix.values
    x, iterations, is_positive = _found(lower, refinement.ends, refinement.shares, coarse.factors, load, wanted)
    if not is_positive:
        raise ArithmeticError("the matrix is not positive definite")
    return x, iterations


@vectorised
def _found(
    lower: tuple[np.ndarray, np.ndarray, np.ndarray],
    ends: np.ndarray,
    shares: np.ndarray,
    coarse: tuple[Fronts, np.ndarray, np.ndarray],
    load: np.ndarray,
    wanted: float,
) -> tuple[np.ndarray, int, bool]:
    """x [Wb/m], (n,), the number of iterations, and whether the matrix has turned out to be positive.

    lower: the parts of ``Lower``; ends, shares: of ``Refinement``; coarse: ``SymmetricSystem.factors``
    load: [A], (n,); wanted: norm of what may be left of it [A]
    """
    starts, rows, values = lower
    x, p, q = np.zeros_like(load), np.zeros_like(load), np.zeros_like(load)
    r, before, iterations, nodes = load.copy(), np.inf, 0, len(load) - ends.shape[1]
    inverse = _inverse_diagonal(starts, values, len(load))
    while np.sqrt(np.sum(r * r)) > wanted and iterations < _MOST:
        z, left = _forwards(starts, rows, values, inverse, r)
        corner = solve(coarse[0], coarse[1], coarse[2], _restricted(ends, shares, left, nodes).reshape(1, nodes))
        last, product = _backwards(starts, rows, values, inverse, left, _prolonged(ends, shares, corner[0]))
        size, curvature = 0.0, 0.0
        for i in range(len(z)):
            z[i] += last[i]
            size += r[i] * z[i]
        for i in range(len(z)):
            p[i] = z[i] + size / before * p[i]
            q[i] = r[i] + product[i] + size / before * q[i]
            curvature += p[i] * q[i]
        if not (size > 0.0 and curvature > 0.0):
            return x, iterations, False
        for i in range(len(z)):
            x[i] += size / curvature * p[i]
            r[i] -= size / curvature * q[i]
        before = size
        iterations += 1
    return x, iterations, True


@vectorised
def _inverse_diagonal(starts: np.ndarray, values: np.ndarray, size: int) -> np.ndarray:
    """1/D [H/m], (n,): a division takes as long as all that a sweep does besides for an unknown."""
    inverse = np.empty(size)
    for j in range(size):
        inverse[j] = 1.0 / values[starts[j]]
    return inverse


@vectorised
def _forwards(
    starts: np.ndarray, rows: np.ndarray, values: np.ndarray, inverse: np.ndarray, load: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """x [Wb/m] of (D + L) x = load, and what it leaves of the load, -L^T x [A], (n,) each; load: [A], (n,)."""
    x, left = load.copy(), np.empty_like(load)
    for j in range(len(x)):
        x[j] *= inverse[j]
        known = x[j]
        for k in range(starts[j] + 1, starts[j + 1]):
            x[rows[k]] -= values[k] * known
    for j in range(len(x)):
        total = 0.0
        for k in range(starts[j] + 1, starts[j + 1]):
            total -= values[k] * x[rows[k]]
        left[j] = total
    return x, left


@vectorised
def _backwards(
    starts: np.ndarray, rows: np.ndarray, values: np.ndarray, inverse: np.ndarray, left: np.ndarray, middle: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """w [Wb/m] of (D + L^T) w = left - L middle, and L (w - middle) [A], (n,) each.

    left: of the load [A], (n,); middle: potential that the coarse level has added [Wb/m], (n,)
    """
    w, product = left.copy(), np.zeros_like(left)
    for j in range(len(w)):
        known = middle[j]
        for k in range(starts[j] + 1, starts[j + 1]):
            w[rows[k]] -= values[k] * known
    for j in range(len(w) - 1, -1, -1):
        total = w[j]
        for k in range(starts[j] + 1, starts[j + 1]):
            total -= values[k] * w[rows[k]]
        w[j] = total * inverse[j]
        change = w[j] - middle[j]
        for k in range(starts[j] + 1, starts[j + 1]):
            product[rows[k]] += values[k] * change
    return w, product


@vectorised
def _restricted(ends: np.ndarray, shares: np.ndarray, load: np.ndarray, nodes: int) -> np.ndarray:
    """P^T load [A], (nodes,); load: [A], (n,)."""
    found = load[:nodes].copy()
    for side in range(2):
        for edge in range(ends.shape[1]):
            found[ends[side, edge]] += shares[side, edge] * load[nodes + edge]
    return found


@vectorised
def _prolonged(ends: np.ndarray, shares: np.ndarray, coarse: np.ndarray) -> np.ndarray:
    """P u [Wb/m], (n,); coarse: u [Wb/m], (nodes,)."""
    nodes = len(coarse)
    found = np.empty(nodes + ends.shape[1])
    found[:nodes] = coarse
    for edge in range(ends.shape[1]):
        one, other = shares[0, edge] * coarse[ends[0, edge]], shares[1, edge] * coarse[ends[1, edge]]
        found[nodes + edge] = one + other
    return found
