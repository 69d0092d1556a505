"""From local element entries to the reduced symmetric matrix, fast enough to be repeated in every Newton iteration.

The pattern has a part that never changes (everything but the rotor side of the sliding circle) and a small part that
depends on the rotor's turn. Entries are addressed by one integer key, column * size + row of the lower triangle.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, reduce

import numpy as np

from magnetostatics.cholesky import FactorMemory, SymmetricSystem
from magnetostatics.passes import add_scattered, addresses, found_in, merged, symmetric_product
from magnetostatics.two_level import Lower


@dataclass(frozen=True, eq=False)
class Entries:
    """Addresses of the local entries (K, E) of a set of elements in the reduced matrix.

    keys (k,): sorted distinct integers, dimensionless; places: index of the key of every local entry, (K, E)
    signs: of every local entry, dimensionless, 0 where an unknown is fixed, (K, E)
    """

    keys: np.ndarray
    places: np.ndarray
    signs: np.ndarray

    @classmethod
    def of(
        cls,
        pairs: tuple[np.ndarray, np.ndarray],
        dofs: np.ndarray,
        column: np.ndarray,
        dof_sign: np.ndarray,
        size: int,
    ) -> Entries:
        """Addresses for elements, given the map of every degree of freedom.

        pairs: local (row, column) indices of the K entries, each (K,); dofs: indices, (F, E)
        column: index of the unknown of every degree of freedom, (n,); dof_sign: its sign, dimensionless, (n,)
        """
        return cls(*addresses(pairs, dofs, column, dof_sign, size))

    def sum(self, local: np.ndarray) -> np.ndarray:
        """The local entries (K, E) [m/H] summed up, one value per key [m/H], (k,)."""
        total = np.zeros(len(self.keys))
        add_scattered(total, local, self.places, self.signs)
        return total


@dataclass(frozen=True, eq=False)
class FixedPattern:
    """What of the pattern does not depend on the rotor's turn.

    keys: sorted, dimensionless, (k,)
    iron, linear: indices of the keys of ``iron_entries`` and of ``linear_entries`` in them, (k_iron,), (k_linear,)
    """

    iron_entries: Entries
    linear_entries: Entries
    keys: np.ndarray
    iron: np.ndarray
    linear: np.ndarray
    size: int

    @classmethod
    def of(cls, iron: Entries, linear: Entries, size: int) -> FixedPattern:
        """The pattern of the entries of the iron and of everything linear."""
        keys, linear_position, iron_position = merged(linear.keys, iron.keys)
        return cls(iron, linear, keys, iron_position, linear_position, size)


class JoinedPattern:
    """Pattern of the matrix with the rotor turned by one of a few numbers of edges, and its symbolic factorisation.

    It holds the entries of all these turns, so that they share the analysis, which costs more than a factorisation;
    four neighbouring turns together make the factorisation 3 % slower.
    bands: addresses of the rotor side of the gap, by number of edges
    memory: of the factor, shared with other patterns that are factorised in turn; None for its own
    """

    def __init__(self, fixed: FixedPattern, bands: dict[int, Entries], memory: FactorMemory | None = None) -> None:
        band_keys = reduce(lambda known, band: merged(known, band.keys)[0], bands.values(), np.empty(0, np.int64))
        keys, fixed_position, _ = merged(fixed.keys, band_keys)
        self.fixed, self.bands, self.size, self._memory = fixed, bands, fixed.size, memory
        columns, rows = np.divmod(keys, self.size)
        self.rows = rows.astype(np.uint32)  # unsigned: compiled code need not ask whether they count from the end
        self.column_starts = np.searchsorted(columns, np.arange(self.size + 1)).astype(np.uint32)
        self.linear_position = fixed_position.astype(np.uint32)[fixed.linear]
        self.iron_places = fixed_position.astype(np.int32)[fixed.iron][fixed.iron_entries.places]
        found = {edges: found_in(keys, self.column_starts, band.keys) for edges, band in bands.items()}
        self.band_positions = {edges: positions.astype(np.uint32) for edges, positions in found.items()}

    @property
    def columns(self) -> np.ndarray:
        """Index of the column of every entry, (k,)."""
        counts: np.ndarray = np.diff(self.column_starts.astype(np.int64))
        return np.repeat(np.arange(self.size), counts)

    @cached_property
    def system(self) -> SymmetricSystem:
        """The matrix to factorise; every design and current with this pattern shares the analysis."""
        return SymmetricSystem(self.rows, self.columns, self.size, self._memory)


class JoinedSystem:
    """The matrix of one model at one rotor angle: linear part as a product, whole matrix as a factorisation.

    edges: that the rotor is turned by; linear: values of the linear entries [m/H], in the order of their keys (k,)
    band: local entries of the rotor side of the gap [m/H], (K, E)
    """

    def __init__(self, pattern: JoinedPattern, edges: int, linear: np.ndarray, band: np.ndarray) -> None:
        self.pattern = pattern
        self._linear = np.zeros(len(pattern.rows))
        self._linear[pattern.linear_position] = linear
        self._linear[pattern.band_positions[edges]] += pattern.bands[edges].sum(band)

    def linear_product(self, u: np.ndarray) -> np.ndarray:
        """Linear part of the matrix times the unknowns [A], (n,); u: [Wb/m], (n,)."""
        return symmetric_product(self.pattern.column_starts, self.pattern.rows, self._linear, u)

    def factorise(self, iron_tangent: np.ndarray) -> SymmetricSystem:
        """Factorise linear part plus iron. Good until the next call for a pattern with the same memory.

        iron_tangent: local iron entries [m/H], (K, E)
        """
        self.pattern.system.factorise(self.tangent(iron_tangent).values)
        return self.pattern.system

    def tangent(self, iron_tangent: np.ndarray) -> Lower:
        """Linear part plus iron; iron_tangent: local iron entries [m/H], (K, E)."""
        values = self._linear.copy()
        add_scattered(values, iron_tangent, self.pattern.iron_places, self.pattern.fixed.iron_entries.signs)
        return Lower(self.pattern.column_starts, self.pattern.rows, values)
