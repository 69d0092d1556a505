"""The saturable part of a field problem: forces and tangent of the iron from one pass over its elements.

In reference coordinates, with g the slopes of A, h = M g and b2 = g . h / |D| (``magnetostatics/elements.py``):
    force     integral nu grad A . grad v = sum over the points of nu h . (dv/dxi, dv/deta)
    tangent   nu M + 2 nu' / |D| h h^T between the slopes of u and v
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Sequence

import numpy as np

from magnetostatics.elements import Elements
from materials.reluctivity import Reluctivity


class Iron:
    """Elements of constant law, one after the other.

    parts: elements and law of every region
    """

    def __init__(self, parts: Sequence[tuple[Elements, Reluctivity]]):
        order = parts[0][0].order.of_distinct_gradients
        self.elements = Elements(
            order,
            *(np.concatenate([getattr(e, name) for e, _ in parts], axis=-1) for name in ("dofs", "first", "edges")),
        )
        ends = np.cumsum([len(elements.determinant) for elements, _ in parts])
        self._laws = [(slice(end - len(e.determinant), end), law) for end, (e, law) in zip(ends, parts)]
        if all(law is parts[0][1] for _, law in parts):
            self._laws = [(slice(None), parts[0][1])]

    def at(self, local: np.ndarray) -> IronState:
        """The iron in the field of local values (F, E)."""
        elements = self.elements
        m11, m12, m22 = elements.metric
        g1, g2 = elements.slopes(local)
        h1, h2 = m11 * g1 + m12 * g2, m12 * g1 + m22 * g2
        nu, slope = self._reluctivity((g1 * h1 + g2 * h2) / np.abs(elements.determinant))
        return IronState(elements, h1, h2, nu, slope)

    def _reluctivity(self, b2: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        nu, slope = np.empty_like(b2), np.empty_like(b2)
        for part, law in self._laws:
            nu[:, part], slope[:, part] = law.nu_and_derivative(b2[:, part])
        return nu, slope


@dataclass(frozen=True, eq=False)
class IronState:
    """Slopes times metric h1, h2, reluctivity nu [m/H] and dnu/d(b2) at the points of the iron, each (Q, E)."""

    elements: Elements
    h1: np.ndarray
    h2: np.ndarray
    nu: np.ndarray
    slope: np.ndarray

    @property
    def forces(self) -> np.ndarray:
        """Local vectors integral nu grad A . grad v (F, E)."""
        return self.elements.order.weighted_slopes @ np.concatenate([self.nu * self.h1, self.nu * self.h2])

    @property
    def tangent(self) -> np.ndarray:
        """Local matrices integral nu grad u . grad v + 2 nu' (grad A . grad u)(grad A . grad v) (K, E)."""
        m11, m12, m22 = self.elements.metric
        s1 = self.slope * self.h1 * (2 / np.abs(self.elements.determinant))
        s2 = self.slope * self.h2 * (2 / np.abs(self.elements.determinant))
        tensor = self.nu * m11 + s1 * self.h1, self.nu * m12 + s1 * self.h2, self.nu * m22 + s2 * self.h2
        return self.elements.order.products @ np.concatenate(tensor)
