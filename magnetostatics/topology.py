"""What a field problem knows from the connectivity of its mesh alone: numbering, regions, matrix patterns.

Two cross-sections with the same triangles and other node positions share all of this, and so do all currents and rotor
angles. It is the part of a field solution that is worth keeping.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from geometry.cross_section import CrossSection
from magnetostatics.assembly import Entries, FixedPattern, JoinedPattern
from magnetostatics.cholesky import FactorMemory
from magnetostatics.elements import TriangleOrder, element_dofs
from magnetostatics.unknowns import number_unknowns

IRON = ("stator_iron", "rotor_iron")
_TURNS = 4  # neighbouring numbers of edges that share a pattern
_MOST_TURNED = 8  # numbers of edges of which the unknowns are kept; one takes 100 kilobytes
MOST_PATTERNS = 20  # that are kept; one takes two to ten megabytes


class Topology:
    """Numbering and patterns of a meshed cross-section for one order of elements.

    most_patterns: that are kept; whoever goes round more angles than they are for finds none of them the next time
    """

    def __init__(self, section: CrossSection, order: TriangleOrder, most_patterns: int = MOST_PATTERNS) -> None:
        self.order, self.most_patterns = order, most_patterns
        self.dofs, self.size = element_dofs(section.mesh, order)
        self.unknowns = number_unknowns(section, order)
        self.facets = section.mesh.facets
        self.regions = section.mesh.subdomains
        self.rotor_band = section.rotor_band  # the only elements that change with the angle
        self.band_dofs = self.dofs[:, self.rotor_band]
        self.band_nodes, self.band_corners = np.unique(section.mesh.t[:, self.rotor_band], return_inverse=True)
        self._patterns: dict[int, JoinedPattern] = {}
        self._memory = FactorMemory()  # of the factor made last: it alone is several times as large as its pattern
        self._turned: dict[int, tuple[np.ndarray, np.ndarray]] = {}

    @cached_property
    def linear(self) -> np.ndarray:
        """Indices (k,) of the elements of constant reluctivity outside the rotor side of the gap."""
        is_linear = np.ones(self.dofs.shape[1], dtype=bool)
        for name in IRON:
            is_linear[self.regions[name]] = False
        is_linear[self.rotor_band] = False
        return np.flatnonzero(is_linear)

    @cached_property
    def iron(self) -> np.ndarray:
        """Indices (E,) of the elements of the iron: stator, then rotor."""
        return np.concatenate([self.regions[name] for name in IRON])

    @cached_property
    def iron_unknowns(self) -> tuple[np.ndarray, np.ndarray]:
        """Index of the free unknown and sign of every degree of freedom of the iron, each (F, E); of any angle."""
        dofs = self.dofs[:, self.iron]
        return self.unknowns.column[dofs], self.unknowns.sign[dofs]

    @cached_property
    def fixed_pattern(self) -> FixedPattern:
        """The pattern without the rotor side of the gap."""
        return FixedPattern.of(self._entries(self.iron), self._entries(self.linear), self.unknowns.count)

    def _entries(self, which: np.ndarray) -> Entries:
        u = self.unknowns
        return Entries.of(self.order.pairs, self.dofs[:, which], u.column, u.sign, u.count)

    def turned(self, edges: int) -> tuple[np.ndarray, np.ndarray]:
        """(column, sign), index and dimensionless, (n,) each, as ``Unknowns.turned``; the last few are kept."""
        if edges not in self._turned:
            if len(self._turned) == _MOST_TURNED:
                self._turned.pop(next(iter(self._turned)))
            self._turned[edges] = self.unknowns.turned(edges)
        return self._turned[edges]

    def pattern(self, edges: int) -> JoinedPattern:
        """Pattern with the rotor turned by whole edges."""
        group = edges // _TURNS
        if group not in self._patterns:
            if len(self._patterns) == self.most_patterns:
                self._patterns.pop(next(iter(self._patterns)))
            turns = range(group * _TURNS, (group + 1) * _TURNS)
            bands = {turn: self._band_entries(turn) for turn in turns}
            self._patterns[group] = JoinedPattern(self.fixed_pattern, bands, self._memory)
        return self._patterns[group]

    def _band_entries(self, edges: int) -> Entries:
        return Entries.of(self.order.pairs, self.band_dofs, *self.unknowns.turned(edges), self.unknowns.count)
