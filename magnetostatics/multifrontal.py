"""The numbers of a sparse Cholesky factorisation A = L L^T, front by front (``magnetostatics/fronts.py``), compiled.

A field problem has some hundred fronts of ten to two hundred rows. For these sizes loops over four columns at once beat
calls of BLAS: what they add to the fronts stays in the cache.
"""

from __future__ import annotations

import numpy as np

from compiling import vectorised
from magnetostatics.fronts import Fronts


@vectorised
def factorise(fronts: Fronts, values: np.ndarray, factor: np.ndarray, workspace: np.ndarray) -> bool:
    """Fill the factor; false where the matrix is not positive definite.

    values: of the entries in the order of the given pattern [any unit], (k,)
    factor: the panels, [its square root], on the diagonals one over it, (l,)
    workspace: for the update matrices [any unit], (w,)
    """
    for s in range(len(fronts.parent)):
        pivots = fronts.columns[s + 1] - fronts.columns[s]
        height = fronts.row_starts[s + 1] - fronts.row_starts[s]
        below = height - pivots
        panel = factor[fronts.panels[s] : fronts.panels[s + 1]]
        update = workspace[fronts.updates[s] : fronts.updates[s] + below * below]
        panel[:] = 0.0
        update[:] = 0.0
        for k in range(fronts.entry_starts[s], fronts.entry_starts[s + 1]):
            panel[fronts.entry_places[k]] += values[fronts.entry_sources[k]]
        c = fronts.child[s]
        while c != -1:
            _add_child(fronts, c, workspace, panel, fronts.updates[s], pivots, height)
            c = fronts.sibling[c]
        if not _eliminate(panel, pivots, height):
            return False
        _subtract_products(panel, pivots, height, update)
    return True


@vectorised
def _add_child(
    fronts: Fronts,
    child: int,
    workspace: np.ndarray,
    panel: np.ndarray,
    update: int,
    pivots: int,
    height: int,
) -> None:
    """Add the update matrix of a child to panel and update matrix of its parent.

    workspace: [any unit], (w,); panel: [the same], (p,); update: index where the update matrix of the parent begins
    Indices without sign are the fast ones: others are asked whether they count from the end.
    """
    places = fronts.relative[
        fronts.row_starts[child] + fronts.columns[child + 1] - fronts.columns[child] : fronts.row_starts[child + 1]
    ]
    size, below = len(places), height - pivots
    source = workspace[fronts.updates[child] : fronts.updates[child] + size * size]
    for j in range(size):
        if places[j] < pivots:
            column = panel[places[j] * height : (places[j] + 1) * height]
            for i in range(j, size):
                column[places[i]] += source[j * size + i]
        else:
            start = update + (places[j] - pivots) * below - pivots
            for i in range(j, size):
                workspace[np.uint64(start + places[i])] += source[j * size + i]


@vectorised
def _eliminate(panel: np.ndarray, pivots: int, height: int) -> bool:
    """Dense Cholesky factorisation of a panel in its place, [any unit], (p,); false at a pivot that is not positive.

    The diagonal holds the reciprocals, since a solution multiplies sooner than it divides.
    """
    for j in range(pivots):
        column = panel[j * height + j : (j + 1) * height]
        for p in range(0, j - 3, 4):
            start, size = p * height + j, len(column)
            a, b = panel[start : start + size], panel[start + height : start + height + size]
            start += 2 * height
            c, d = panel[start : start + size], panel[start + height : start + height + size]
            a0, b0, c0, d0 = a[0], b[0], c[0], d[0]
            for i in range(len(column)):
                column[i] -= a0 * a[i] + b0 * b[i] + c0 * c[i] + d0 * d[i]
        for p in range(j - j % 4, j):
            a = panel[p * height + j : (p + 1) * height]
            a0 = a[0]
            for i in range(len(column)):
                column[i] -= a0 * a[i]
        if not column[0] > 0.0:
            return False
        scale = 1.0 / np.sqrt(column[0])
        column[0] = scale
        for i in range(1, len(column)):
            column[i] *= scale
    return True


@vectorised
def _subtract_products(panel: np.ndarray, pivots: int, height: int, update: np.ndarray) -> None:
    """Subtract the products of the rows below the pivots from the lower triangle of the update matrix, (p,) and (u,).

    Of every four columns the three entries above the diagonal are filled too, and nobody reads them.
    """
    size = height - pivots
    for j in range(0, size - 3, 4):
        left = size - j
        start = j * size + j
        u, v = update[start : start + left], update[start + size : start + size + left]
        start += 2 * size
        w, x = update[start : start + left], update[start + size : start + size + left]
        for p in range(0, pivots - 3, 4):
            start = p * height + pivots + j
            a, b = panel[start : start + left], panel[start + height : start + height + left]
            start += 2 * height
            c, d = panel[start : start + left], panel[start + height : start + height + left]
            a0, b0, c0, d0 = a[0], b[0], c[0], d[0]
            a1, b1, c1, d1 = a[1], b[1], c[1], d[1]
            a2, b2, c2, d2 = a[2], b[2], c[2], d[2]
            a3, b3, c3, d3 = a[3], b[3], c[3], d[3]
            for i in range(left):
                ai, bi, ci, di = a[i], b[i], c[i], d[i]
                u[i] -= a0 * ai + b0 * bi + c0 * ci + d0 * di
                v[i] -= a1 * ai + b1 * bi + c1 * ci + d1 * di
                w[i] -= a2 * ai + b2 * bi + c2 * ci + d2 * di
                x[i] -= a3 * ai + b3 * bi + c3 * ci + d3 * di
        for p in range(pivots - pivots % 4, pivots):
            a = panel[p * height + pivots + j : (p + 1) * height]
            a0, a1, a2, a3 = a[0], a[1], a[2], a[3]
            for i in range(left):
                u[i] -= a0 * a[i]
                v[i] -= a1 * a[i]
                w[i] -= a2 * a[i]
                x[i] -= a3 * a[i]
    for j in range(size - size % 4, size):
        for p in range(pivots):
            start = p * height + pivots
            for i in range(j, size):
                update[j * size + i] -= panel[start + j] * panel[start + i]


@vectorised
def solve(fronts: Fronts, order: np.ndarray, factor: np.ndarray, given: np.ndarray) -> np.ndarray:
    """The x of L L^T x = b for several b at once [any unit], (m, n).

    order: of elimination, indices (n,); factor: the panels, [square root of the unit of A], (l,)
    given: b [any unit], (m, n)
    """
    front, unknowns, found = np.empty(len(order)), np.empty(given.shape), np.empty(given.shape)
    for k in range(len(given)):
        for i in range(len(order)):
            unknowns[k, i] = given[k, order[i]]
    for s in range(len(fronts.parent)):
        rows = fronts.rows[fronts.row_starts[s] : fronts.row_starts[s + 1]]
        panel = factor[fronts.panels[s] : fronts.panels[s + 1]]
        for k in range(len(unknowns)):
            _forward(panel, rows, fronts.columns[s + 1] - fronts.columns[s], unknowns[k], front)
    for s in range(len(fronts.parent) - 1, -1, -1):
        rows = fronts.rows[fronts.row_starts[s] : fronts.row_starts[s + 1]]
        panel = factor[fronts.panels[s] : fronts.panels[s + 1]]
        for k in range(len(unknowns)):
            _back(panel, rows, fronts.columns[s + 1] - fronts.columns[s], unknowns[k], front)
    for k in range(len(given)):
        for i in range(len(order)):
            found[k, order[i]] = unknowns[k, i]
    return found


@vectorised
def _forward(panel: np.ndarray, rows: np.ndarray, pivots: int, unknowns: np.ndarray, front: np.ndarray) -> None:
    """The part of L x = b in one front, (p,); rows: indices (h,); unknowns, front: [any unit], (n,) both."""
    height = len(rows)
    for i in range(height):
        front[i] = unknowns[rows[i]]
    below = front[pivots:height]
    for j in range(pivots):
        value = front[j] * panel[j * height + j]
        front[j] = value
        for i in range(j + 1, pivots):
            front[i] -= value * panel[j * height + i]
    for p in range(0, pivots - 3, 4):
        start, size = p * height + pivots, len(below)
        a, b = panel[start : start + size], panel[start + height : start + height + size]
        start += 2 * height
        c, d = panel[start : start + size], panel[start + height : start + height + size]
        a0, b0, c0, d0 = front[p], front[p + 1], front[p + 2], front[p + 3]
        for i in range(len(below)):
            below[i] -= a0 * a[i] + b0 * b[i] + c0 * c[i] + d0 * d[i]
    for p in range(pivots - pivots % 4, pivots):
        a, a0 = panel[p * height + pivots : (p + 1) * height], front[p]
        for i in range(len(below)):
            below[i] -= a0 * a[i]
    for i in range(height):
        unknowns[rows[i]] = front[i]


@vectorised
def _back(panel: np.ndarray, rows: np.ndarray, pivots: int, unknowns: np.ndarray, front: np.ndarray) -> None:
    """The part of L^T x = b in one front, (p,); rows: indices (h,); unknowns, front: [any unit], (n,) both."""
    height = len(rows)
    for i in range(height):
        front[i] = unknowns[rows[i]]
    below = front[pivots:height]
    for p in range(0, pivots - 3, 4):
        start, size = p * height + pivots, len(below)
        a, b = panel[start : start + size], panel[start + height : start + height + size]
        start += 2 * height
        c, d = panel[start : start + size], panel[start + height : start + height + size]
        a0, b0, c0, d0 = 0.0, 0.0, 0.0, 0.0
        for i in range(len(below)):
            value = below[i]
            a0 += value * a[i]
            b0 += value * b[i]
            c0 += value * c[i]
            d0 += value * d[i]
        front[p] -= a0
        front[p + 1] -= b0
        front[p + 2] -= c0
        front[p + 3] -= d0
    for p in range(pivots - pivots % 4, pivots):
        a, a0 = panel[p * height + pivots : (p + 1) * height], 0.0
        for i in range(len(below)):
            a0 += below[i] * a[i]
        front[p] -= a0
    for j in range(pivots - 1, -1, -1):
        value = front[j]
        for i in range(j + 1, pivots):
            value -= panel[j * height + i] * front[i]
        front[j] = value * panel[j * height + j]
        unknowns[rows[j]] = front[j]
