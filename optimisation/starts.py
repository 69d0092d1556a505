"""From which fields the solution of a design starts: a polynomial over its dimensions through those of similar designs.

The nearest design's field alone leaves one more Newton step with linear elements, and every fourth time one with
quadratic ones.
"""

from __future__ import annotations

import numpy as np

_MOST_WEIGHT = 3.0  # sum of the absolute weights; beyond it a polynomial goes too far from its places
_SAME = 1e-9  # difference of a dimension below which it counts as the same


def weights_at_origin(places: np.ndarray) -> np.ndarray:
    """Weights of the values at some places in that of a polynomial at the origin, dimensionless (n,).

    The polynomial of second order, of first order or the constant that the places allow, fitted by least squares with
    the reciprocal squares of the distances as weights. The constant is the value at the first place, the nearest one.
    places: dimensionless, (n, k)
    """
    for terms in _polynomials(places):
        if len(places) >= terms.shape[1] and np.linalg.svd(terms, compute_uv=False)[-1] > np.sqrt(_SAME):
            weighted = terms / (_SAME + np.square(places).sum(axis=1, keepdims=True))
            weights = weighted @ np.linalg.solve(terms.T @ weighted, np.eye(terms.shape[1])[0])
            if np.abs(weights).sum() < _MOST_WEIGHT:
                return weights
    return np.eye(len(places))[0]


def _polynomials(places: np.ndarray) -> list[np.ndarray]:
    """Terms of the polynomials of second and first order at the places (n, terms), dimensionless, the constant first.

    places: dimensionless, (n, k); those of their directions in which all are alike are left out
    """
    x = places[:, np.abs(places).max(axis=0) > _SAME]
    x = x / np.abs(x).max() if x.size else x
    first = np.column_stack([np.ones(len(x)), x])
    rows, columns = np.tril_indices(x.shape[1])
    return [np.column_stack([first, x[:, rows] * x[:, columns]]), first]
