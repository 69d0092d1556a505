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
    def of(cls, pairs, dofs: np.ndarray, column: np.ndarray, dof_sign: np.ndarray, size: int) -> Entries:
        """Addresses for elements with degrees of freedom (F, E), given the map of every degree of freedom.

        pairs: local (row, column) of the K entries
        """
        i, j = pairs
        a, b = column[dofs][i], column[dofs][j]
        local_sign = dof_sign[dofs]
        sign = (local_sign[i] * local_sign[j]).ravel()
        keys = (np.minimum(a, b) * np.int64(size) + np.maximum(a, b)).ravel()
        keys[sign == 0] = 0  # fixed unknowns must not fill the pattern; nothing is added there
        distinct, position = np.unique(keys, return_inverse=True)
        return cls(distinct, position, sign)

    def sum(self, local: np.ndarray) -> np.ndarray:
        """Add local entries (K, E) up, one value per key."""
        return np.bincount(self.position, weights=local.ravel() * self.sign, minlength=len(self.keys))


class JoinedPattern:
    """Pattern of the matrix with stator and rotor joined at one number of edges, and its symbolic factorisation.

    iron: addresses of the iron entries; others: sorted keys of the linear entries, with and without the rotor's turn
    """

    def __init__(self, iron: Entries, others: tuple[np.ndarray, ...], size: int):
        keys = _merge(iron.keys, *others)
        self.size, self.iron = size, iron
        self.iron_position, *self.other_positions = (np.searchsorted(keys, part) for part in (iron.keys, *others))
        self.rows, self.columns = keys % size, keys // size
        self.column_starts = np.searchsorted(self.columns, np.arange(size + 1))

    @cached_property
    def system(self) -> SymmetricSystem:
        """The matrix to factorise; every design and current with this pattern shares the analysis."""
        return SymmetricSystem(self.rows, self.columns, self.size)


class JoinedSystem:
    """The matrix of one model at one rotor angle: linear part as a product, whole matrix as a factorisation.

    values: of the linear entries, one array for each of the pattern's ``others``
    """

    def __init__(self, pattern: JoinedPattern, values: tuple[np.ndarray, ...]):
        self.pattern = pattern
        self._linear = np.zeros(len(pattern.rows))
        for position, part in zip(pattern.other_positions, values, strict=True):
            self._linear[position] += part

    @cached_property
    def linear_matrix(self) -> sp.csc_matrix:
        """Lower triangle of the linear part."""
        size = self.pattern.size
        return sp.csc_matrix((self._linear, self.pattern.rows, self.pattern.column_starts), shape=(size, size))

    @cached_property
    def _diagonal(self) -> np.ndarray:
        return self.linear_matrix.diagonal()

    def linear_product(self, u: np.ndarray) -> np.ndarray:
        """Linear part of the matrix times u."""
        return self.linear_matrix @ u + self.linear_matrix.T @ u - self._diagonal * u

    def factorise(self, iron_tangent: np.ndarray) -> SymmetricSystem:
        """Factorise linear part plus the local iron entries (K, E). Good until the next call for the same pattern."""
        values = self._linear.copy()
        values[self.pattern.iron_position] += self.pattern.iron.sum(iron_tangent)
        self.pattern.system.factorise(values)
        return self.pattern.system


def _merge(*sorted_keys: np.ndarray) -> np.ndarray:
    """Sorted distinct keys of several sorted lists."""
    keys = np.sort(np.concatenate(sorted_keys), kind="stable")  # merges sorted runs
    return keys[np.append(True, keys[1:] != keys[:-1])]
