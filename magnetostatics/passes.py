"""What every Newton iteration does to all elements or entries, each in one compiled pass over them.

As operations on whole arrays the same takes five times as long with linear elements: these arrays are so small that
starting an operation costs more than doing it.
"""

from __future__ import annotations

import numpy as np

from compiling import vectorised


@vectorised
def symmetric_product(starts: np.ndarray, rows: np.ndarray, lower: np.ndarray, u: np.ndarray) -> np.ndarray:
    """Product of a symmetric matrix and a vector [any unit], (n,).

    starts: of the columns, indices (n + 1,); rows: indices (k,); lower: its lower triangle [any unit], (k,)
    u: [any unit], (n,)
    """
    product = np.zeros_like(u)
    for j in range(len(u)):
        total = 0.0
        for k in range(starts[j], starts[j + 1]):
            i = rows[k]
            total += lower[k] * u[i]
            if i != j:
                product[i] += lower[k] * u[j]
        product[j] += total
    return product


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
