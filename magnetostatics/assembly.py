"""From local element entries to the reduced symmetric matrix, fast enough to be repeated in every Newton iteration.

The pattern has a part that never changes (everything but the rotor side of the sliding circle) and a small part that
depends on the rotor's turn. Entries are addressed by one integer key, column * size + row of the lower triangle.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from magnetostatics.cholesky import SymmetricSystem


@dataclass(frozen=True, eq=False)
class Entries:
    """Addresses of the local entries (K, E) of a set of elements in the reduced matrix.

    keys (k,): sorted distinct keys; position (K E,): where each local entry goes; sign (K E,): 0 on fixed unknowns
    """

    keys: np.ndarray
    position: np.ndarray
    sign: np.ndarray

    @classmethod
    def of(cls, pairs, dofs: np.ndarray, column: np.ndarray, sign: np.ndarray, size: int) -> Entries:
        """Addresses for elements with degrees of freedom (F, E), given the map of every degree of freedom.

        pairs: local (row, column) of the K entries
        """
        i, j = pairs
        a, b = column[dofs][i], column[dofs][j]
        local_sign = sign[dofs]
        keys = np.minimum(a, b) * np.int64(size) + np.maximum(a, b)
        distinct, position = np.unique(keys, return_inverse=True)
        return cls(distinct, position.ravel(), (local_sign[i] * local_sign[j]).ravel())

    def sum(self, local: np.ndarray) -> np.ndarray:
        """Add local entries (K, E) up, one value per key."""
        return np.bincount(self.position, weights=local.ravel() * self.sign, minlength=len(self.keys))


class JoinedSystem:
    """The matrix with stator and rotor joined at one turn: linear part as a product, whole matrix as a factorisation.

    iron, linear, band: addresses of the iron, of the other elements, and of the elements on the rotor side of the gap
    """

    def __init__(self, iron: Entries, linear: np.ndarray, linear_keys: np.ndarray, band: Entries, band_values, size: int):
        keys = _merge(iron.keys, linear_keys, band.keys)
        self._iron_position = np.searchsorted(keys, iron.keys)
        self._iron = iron
        self._linear = np.zeros(len(keys))
        self._linear[np.searchsorted(keys, linear_keys)] += linear
        self._linear[np.searchsorted(keys, band.keys)] += band_values
        self._rows, self._columns, self._size = keys % size, keys // size, size
        self._system: SymmetricSystem | None = None

    @cached_property
    def linear_matrix(self) -> sp.csc_matrix:
        """Lower triangle of the linear part."""
        starts = np.searchsorted(self._columns, np.arange(self._size + 1))
        return sp.csc_matrix((self._linear, self._rows, starts), shape=(self._size, self._size))

    @cached_property
    def _diagonal(self) -> np.ndarray:
        return self.linear_matrix.diagonal()

    def linear_product(self, u: np.ndarray) -> np.ndarray:
        """Linear part of the matrix times u."""
        return self.linear_matrix @ u + self.linear_matrix.T @ u - self._diagonal * u

    def factorise(self, iron_tangent: np.ndarray) -> SymmetricSystem:
        """Factorise linear part plus the local iron entries (K, E)."""
        if self._system is None:
            self._system = SymmetricSystem(self._rows, self._columns, self._size)
        values = self._linear.copy()
        values[self._iron_position] += self._iron.sum(iron_tangent)
        self._system.factorise(values)
        return self._system


def _merge(*sorted_keys: np.ndarray) -> np.ndarray:
    """Sorted distinct keys of several sorted lists."""
    keys = np.sort(np.concatenate(sorted_keys), kind="stable")  # merges sorted runs
    return keys[np.append(True, keys[1:] != keys[:-1])]
