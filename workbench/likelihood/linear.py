"""Linear-Gaussian algebra of nuisances: what is left of a signature after the nuisances took what they can.

Whitened residual r = J d + s + noise, d ~ N(0, 1). With the nuisances integrated out, r - s ~ N(0, 1 + J J^T).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np


@dataclass(frozen=True, eq=False)
class Nuisances:
    """J: derivatives of the whitened readings to the nuisances (n, m)."""

    jacobian: np.ndarray

    @cached_property
    def factor(self) -> np.ndarray:
        """A matrix L with P = 1 - L L^T = (1 + J J^T)^-1 (n, m)."""
        m = self.jacobian.shape[1]
        precision = np.eye(m) + self.jacobian.T @ self.jacobian
        return np.linalg.solve(np.linalg.cholesky(precision), self.jacobian.T).T

    @cached_property
    def half_log_det(self) -> float:
        """1/2 ln det(1 + J J^T)."""
        m = self.jacobian.shape[1]
        return 0.5 * np.linalg.slogdet(np.eye(m) + self.jacobian.T @ self.jacobian)[1]

    def project(self, v: np.ndarray) -> np.ndarray:
        """(1 + J J^T)^-1 v for v (n,) or (n, k)."""
        return v - self.factor @ (self.factor.T @ v)

    def square(self, v: np.ndarray) -> np.ndarray:
        """v^T (1 + J J^T)^-1 v, for each column."""
        return np.sum(v * v, axis=0) - np.sum((self.factor.T @ v) ** 2, axis=0)

    def root(self, v: np.ndarray) -> np.ndarray:
        """(1 + J J^T)^(-1/2) v: a signature as it can be seen beside the nuisances."""
        u, size, _ = np.linalg.svd(self.jacobian, full_matrices=False)
        return v - u @ ((1 - 1 / np.sqrt(1 + size**2))[:, None] * (u.T @ v.reshape(len(v), -1))).reshape(
            (u.shape[1],) + v.shape[1:]
        )


def cosine(a: np.ndarray, b: np.ndarray) -> float:
    """Of two vectors; 0 where one of them is nothing."""
    size = np.linalg.norm(a) * np.linalg.norm(b)
    return float(a @ b / size) if size > 0 else 0.0
