"""What every Newton iteration does to all elements or entries, each in one compiled pass over them.

As operations on whole arrays the same takes five times as long with linear elements: these arrays are so small that
starting an operation costs more than doing it.
"""

from __future__ import annotations

import numpy as np

from compiling import compiled, vectorised


@vectorised
def symmetric_product(starts: np.ndarray, rows: np.ndarray, lower: np.ndarray, u: np.ndarray) -> np.ndarray:
    """Product of a symmetric matrix and a vector [any unit], (n,).

    starts: of the columns, indices (n + 1,); rows: indices (k,); lower: its lower triangle [any unit], (k,), the
        diagonal first in every column
    u: [any unit], (n,)
    """
    product = np.zeros_like(u)
    for j in range(len(u)):
        one, total = u[j], lower[starts[j]] * u[j]
        for k in range(starts[j] + 1, starts[j + 1]):
            i = rows[k]
            total += lower[k] * u[i]
            product[i] += lower[k] * one
        product[j] += total
    return product


@vectorised
def edges_of(points: np.ndarray, corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """First corners (2, E) [m] and the edges from them to the second and the third corners (2, 2, E) [m].

    points: [m], (2, n); corners: indices (3, E)
    """
    first, edges = np.empty((2, corners.shape[1])), np.empty((2, 2, corners.shape[1]))
    for axis in range(2):
        for e in range(corners.shape[1]):
            first[axis, e] = points[axis, corners[0, e]]
            for edge in range(2):
                edges[edge, axis, e] = points[axis, corners[edge + 1, e]] - first[axis, e]
    return first, edges


@vectorised
def metric_of(edges: np.ndarray) -> np.ndarray:
    """M_11, M_12, M_22 of triangles, dimensionless (3, E); edges: ``Triangles.edges`` [m], (2, 2, E)."""
    metric = np.empty((3, edges.shape[2]))
    for e in range(edges.shape[2]):
        u, v, x, y = edges[0, 0, e], edges[0, 1, e], edges[1, 0, e], edges[1, 1, e]
        size = abs(u * y - v * x)
        metric[0, e] = (x * x + y * y) / size
        metric[1, e] = -(u * x + v * y) / size
        metric[2, e] = (u * u + v * v) / size
    return metric


@vectorised
def flux(
    local: np.ndarray, slopes: np.ndarray, metric: np.ndarray, size: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """h = M g, both components [Wb/m], and b2 = g . h / |D| [T^2] at the quadrature points, (Q, E) each.

    local: values of the elements [Wb/m], (F, E); slopes: of the functions, dimensionless, (2 Q, F)
    metric: M_11, M_12, M_22, dimensionless (3, E); size: |D| [m^2], (E,)
    """
    points, elements = len(slopes) // 2, local.shape[1]
    h1, h2, b2 = np.empty((points, elements)), np.empty((points, elements)), np.empty((points, elements))
    for q in range(points):
        g1, g2 = np.zeros(elements), np.zeros(elements)
        for f in range(len(local)):
            along_xi, along_eta = slopes[q, f], slopes[points + q, f]
            for e in range(elements):
                g1[e] += along_xi * local[f, e]
                g2[e] += along_eta * local[f, e]
        for e in range(elements):
            h1[q, e] = metric[0, e] * g1[e] + metric[1, e] * g2[e]
            h2[q, e] = metric[1, e] * g1[e] + metric[2, e] * g2[e]
            b2[q, e] = (g1[e] * h1[q, e] + g2[e] * h2[q, e]) / size[e]
    return h1, h2, b2


@vectorised
def gathered(values: np.ndarray, places: np.ndarray, signs: np.ndarray) -> np.ndarray:
    """Local values of elements [any unit], (F, E), from those of all unknowns [the same], (n,).

    places: indices (F, E); signs: dimensionless, (F, E)
    """
    local = np.empty(places.shape)
    for f in range(len(places)):
        for e in range(places.shape[1]):
            local[f, e] = signs[f, e] * values[places[f, e]]
    return local


@vectorised
def add_scattered(total: np.ndarray, local: np.ndarray, places: np.ndarray, signs: np.ndarray) -> None:
    """Add local values to those of all unknowns, in place.

    total: [any unit], (n,); local: [the same], (F, E); places: indices (F, E); signs: dimensionless, (F, E)
    """
    for f in range(len(places)):
        for e in range(places.shape[1]):
            total[places[f, e]] += signs[f, e] * local[f, e]


@vectorised
def lowered(facets: np.ndarray, loads: np.ndarray) -> np.ndarray:
    """Loads on the linear functions [A], (m, nodes), from those on the quadratic ones [A], (m, n).

    facets: indices of the ends of the edges, (2, k); loads: [A], (m, n)
    """
    nodes = loads.shape[1] - facets.shape[1]
    found = loads[:, :nodes].copy()
    for m in range(len(loads)):
        for edge in range(facets.shape[1]):
            half = loads[m, nodes + edge] / 2
            found[m, facets[0, edge]] += half
            found[m, facets[1, edge]] += half
    return found


@vectorised
def iron_forces(weighted: np.ndarray, h1: np.ndarray, h2: np.ndarray, nu: np.ndarray) -> np.ndarray:
    """Local vectors integral nu grad A . grad v [A], (F, E).

    weighted: ``TriangleOrder.weighted_slopes``, dimensionless, (F, 2 Q); h1, h2 [Wb/m] and nu [m/H]: (Q, E) each
    """
    points, elements = nu.shape
    forces = np.zeros((len(weighted), elements))
    for q in range(points):
        x, y = nu[q] * h1[q], nu[q] * h2[q]
        for f in range(len(weighted)):
            along_xi, along_eta = weighted[f, q], weighted[f, points + q]
            for e in range(elements):
                forces[f, e] += along_xi * x[e] + along_eta * y[e]
    return forces


@vectorised
def tangent_tensor(
    metric: np.ndarray, size: np.ndarray, h1: np.ndarray, h2: np.ndarray, nu: np.ndarray, slope: np.ndarray
) -> np.ndarray:
    """nu M + 2 nu' / |D| h h^T [m/H]: its entries 11, 12 and 22 at the quadrature points, (3 Q, E).

    metric: M_11, M_12, M_22, dimensionless (3, E); size: |D| [m^2], (E,); h1, h2 [Wb/m]: (Q, E) each
    nu [m/H] and slope, dnu/d(b2) [m/(H T^2)]: (Q, E) each
    """
    points, elements = nu.shape
    tensor = np.empty((3 * points, elements))
    for q in range(points):
        for e in range(elements):
            twice = 2.0 * slope[q, e] / size[e]
            tensor[q, e] = nu[q, e] * metric[0, e] + twice * h1[q, e] * h1[q, e]
            tensor[points + q, e] = nu[q, e] * metric[1, e] + twice * h1[q, e] * h2[q, e]
            tensor[2 * points + q, e] = nu[q, e] * metric[2, e] + twice * h2[q, e] * h2[q, e]
    return tensor


@vectorised
def field_strength_on_tangent(
    metric: np.ndarray,
    size: np.ndarray,
    here: tuple[np.ndarray, np.ndarray, np.ndarray],
    touched: tuple[np.ndarray, np.ndarray, np.ndarray],
    nu: np.ndarray,
    slope: np.ndarray,
) -> np.ndarray:
    """What a tangent of H(B) says of the field strength along the flux density [A/m], (Q, E).

    H . B / |B| with H = nu B + 2 nu' (B_t . (B - B_t)) B_t, where the tangent touches the law in B_t
    metric: M_11, M_12, M_22, dimensionless (3, E), of determinant one; size: |D| [m^2], (E,)
    here, touched: h1, h2 [Wb/m] and b2 [T^2] of B and of B_t, (Q, E) each; nu [m/H], slope [m/(H T^2)]: there, (Q, E)
    """
    strength = np.empty_like(nu)
    for q in range(len(nu)):
        for e in range(len(size)):
            h1, h2, b = here[0][q, e], here[1][q, e], np.sqrt(here[2][q, e])
            g1, g2 = metric[2, e] * h1 - metric[1, e] * h2, metric[0, e] * h2 - metric[1, e] * h1
            common = (touched[0][q, e] * g1 + touched[1][q, e] * g2) / size[e]
            bent = 2.0 * slope[q, e] * (common - touched[2][q, e]) * common
            strength[q, e] = nu[q, e] * b + (bent / b if b > 0.0 else 0.0)
    return strength


@vectorised
def nearer_law(
    line: tuple[np.ndarray, np.ndarray, float], b: np.ndarray, nu: np.ndarray, slope: np.ndarray
) -> np.ndarray:
    """One step of Newton's method from b towards where H(B) meets the line H = H_0 - n (B - B_0) [T], (Q, E).

    line: B_0 [T] and H_0 [A/m], (Q, E) each, and n [m/H]; b: [T], (Q, E)
    nu [m/H] and slope, dnu/d(b2) [m/(H T^2)]: there, (Q, E) each
    """
    step = np.empty_like(b)
    for q in range(len(b)):
        for e in range(b.shape[1]):
            excess = nu[q, e] * b[q, e] - line[1][q, e] + line[2] * (b[q, e] - line[0][q, e])
            step[q, e] = excess / (nu[q, e] + 2.0 * slope[q, e] * b[q, e] ** 2 + line[2])
            step[q, e] = max(b[q, e] - step[q, e], 0.0)
    return step


@compiled
def addresses(
    pairs: tuple[np.ndarray, np.ndarray], dofs: np.ndarray, column: np.ndarray, dof_sign: np.ndarray, size: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Keys (k,), sorted and distinct, and of every local entry the index of its key and its sign, (K, E) each.

    A fixed unknown has sign 0, no key of its own, and index 0. Keys are column times size plus row, dimensionless.
    pairs: local (row, column) indices, (K,) each; dofs: indices, (F, E); size: number of unknowns
    column: index of the unknown of every degree of freedom, (n,); dof_sign: its sign, dimensionless, (n,)
    """
    count, elements = len(pairs[0]), dofs.shape[1]
    lower, upper = np.empty(count * elements, np.int64), np.empty(count * elements, np.int64)
    signs, free = np.empty((count, elements), np.int8), np.empty(count * elements, np.int64)
    found = 0
    for k in range(count):
        for e in range(elements):
            first, second = dofs[pairs[0][k], e], dofs[pairs[1][k], e]
            lower[k * elements + e] = max(column[first], column[second])
            upper[k * elements + e] = min(column[first], column[second])
            signs[k, e] = dof_sign[first] * dof_sign[second]
            if signs[k, e] != 0:
                free[found] = k * elements + e
                found += 1
    order = _sorted_by(upper, _sorted_by(lower, free[:found], size), size)
    keys, places = np.empty(found, np.int64), np.zeros(count * elements, np.int32)
    distinct = 0
    for entry in order:
        key = upper[entry] * size + lower[entry]
        if distinct == 0 or keys[distinct - 1] != key:
            keys[distinct] = key
            distinct += 1
        places[entry] = distinct - 1
    return keys[:distinct].copy(), places.reshape(count, elements), signs


@compiled
def _sorted_by(keys: np.ndarray, entries: np.ndarray, size: int) -> np.ndarray:
    """The entries (k,) by their keys, those of equal keys in their old order, indices; keys: indices below size."""
    starts, order = np.zeros(size + 1, np.int64), np.empty_like(entries)
    for entry in entries:
        starts[keys[entry] + 1] += 1
    for key in range(size):
        starts[key + 1] += starts[key]
    for entry in entries:
        order[starts[keys[entry]]] = entry
        starts[keys[entry]] += 1
    return order


@compiled
def merged(first: np.ndarray, second: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Sorted distinct keys (k,) of two sorted lists of distinct keys, and the indices in them of either list.

    first, second: dimensionless, (m,) and (l,)
    """
    keys = np.empty(len(first) + len(second), np.int64)
    of_first, of_second = np.empty(len(first), np.int64), np.empty(len(second), np.int64)
    i, j, found = 0, 0, 0
    while i < len(first) or j < len(second):
        is_first = j == len(second) or (i < len(first) and first[i] <= second[j])
        is_second = i == len(first) or (j < len(second) and second[j] <= first[i])
        if is_first:
            keys[found] = first[i]
            of_first[i] = found
            i += 1
        if is_second:
            keys[found] = second[j]
            of_second[j] = found
            j += 1
        found += 1
    return keys[:found].copy(), of_first, of_second


@compiled
def found_in(keys: np.ndarray, column_starts: np.ndarray, some: np.ndarray) -> np.ndarray:
    """Indices (k,) of some keys among all; keys: sorted, dimensionless, column times n plus row, (m,).

    column_starts: where the keys of every column begin, indices (n + 1,); some: of the keys, dimensionless, (k,)
    """
    places = np.empty(len(some), np.int64)
    for k in range(len(some)):
        place = column_starts[some[k] // (len(column_starts) - 1)]
        while keys[place] != some[k]:
            place += 1
        places[k] = place
    return places
