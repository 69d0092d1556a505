"""The saturable part of a field problem: forces and tangent of the iron from one pass over its elements.

In reference coordinates, with g the slopes of A, h = M g and b2 = g . h / |D| (``magnetostatics/elements.py``):
    force     integral nu grad A . grad v = sum over the points of nu h . (dv/dxi, dv/deta)
    tangent   nu M + 2 nu' / |D| h h^T between the slopes of u and v
"""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from magnetostatics.elements import LINEAR, Elements, TriangleOrder
from magnetostatics.passes import field_strength_on_tangent, flux, iron_forces, nearer_law, tangent_tensor
from materials.reluctivity import Reluctivity
from units import MU_0

_SERIES = 0.02 / MU_0  # n of ``Iron.drawn_back`` [m/H]; a third to three times as much costs a tenth of the steps more
_NO_FLUX = 1e-12  # T


class Iron:
    """The elements of all steels, one steel after the other.

    counts: how many elements of each; laws: of each
    """

    def __init__(self, elements: Elements, counts: Sequence[int], laws: Sequence[Reluctivity]) -> None:
        self.elements = replace(elements, order=elements.order.of_distinct_gradients)
        ends = np.cumsum(counts)
        parts = [slice(end - count, end) for end, count in zip(ends, counts)]
        one_law = all(law is laws[0] for law in laws)
        self._laws = [(slice(None), laws[0])] if one_law else list(zip(parts, laws, strict=True))

    def of_order(self, order: TriangleOrder, dofs: np.ndarray) -> Iron:
        """The same iron with elements of another order; dofs: indices (F, E)."""
        other = copy(self)
        other.elements = Elements(order.of_distinct_gradients, dofs, self.elements.shape)
        return other

    def at(self, local: np.ndarray) -> IronState:
        """The iron in the field of local values [Wb/m], (F, E)."""
        h1, h2, b2 = flux(local, self.elements.order.slopes, self.elements.metric, self.elements.size)
        return IronState(self.elements, h1, h2, b2, *self._reluctivity(b2))

    def drawn_back(self, field: IronState, tangent: IronState) -> tuple[IronState, np.ndarray]:
        """Where to take the next tangent, and what the forces lack there: local vectors [A], (F, E).

        The field u was found with the tangent of another state, which knew nothing of the law beyond its knee: the flux
        density b of narrow iron is too high, and so is H(b), while the field strength H_t on that tangent is too low.
        The next tangent touches the law between both, in p where it meets the line H = H_t - n (B - b); n is what a
        longer gap in series would give. A step is exact wherever its tangent touches,
            f(p) + K(p) (u + step - p) = load,   so that f(u) - f(p) + K(p) (p - u) is lacking in the residual at u,
        and p is at u to second order near the solution: convergence stays quadratic.
        """
        b, strength = np.sqrt(field.b2), field.strength_on(tangent)
        there = nearer_law((b, strength, _SERIES), b, field.nu, field.slope)
        there = nearer_law((b, strength, _SERIES), there, *self._reluctivity(there**2))
        share, b2 = there / np.maximum(b, _NO_FLUX), there**2
        state = IronState(self.elements, share * field.h1, share * field.h2, b2, *self._reluctivity(b2))
        lacking = field.nu - state.nu + 2 * state.slope * b2 * (share - 1)
        return state, iron_forces(self.elements.order.weighted_slopes, field.h1, field.h2, lacking)

    def _reluctivity(self, b2: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        if len(self._laws) == 1:
            return self._laws[0][1].nu_and_derivative(b2)
        nu, slope = np.empty_like(b2), np.empty_like(b2)
        for part, law in self._laws:
            nu[:, part], slope[:, part] = law.nu_and_derivative(b2[:, part])
        return nu, slope


@dataclass(frozen=True, eq=False)
class IronState:
    """Slopes times metric h1, h2 [Wb/m], squared flux density b2 [T^2], reluctivity nu [m/H] and its slope dnu/d(b2)
    [m/(H T^2)], each (Q, E)."""

    elements: Elements
    h1: np.ndarray
    h2: np.ndarray
    b2: np.ndarray
    nu: np.ndarray
    slope: np.ndarray

    def strength_on(self, tangent: IronState) -> np.ndarray:
        """Field strength along the flux density here [A/m], (Q, E), by the tangent to the law in another state."""
        here, touched = (self.h1, self.h2, self.b2), (tangent.h1, tangent.h2, tangent.b2)
        shape = self.elements.metric, self.elements.size
        return field_strength_on_tangent(*shape, here, touched, tangent.nu, tangent.slope)

    @property
    def forces(self) -> np.ndarray:
        """Local vectors integral nu grad A . grad v [A], (F, E)."""
        return iron_forces(self.elements.order.weighted_slopes, self.h1, self.h2, self.nu)

    @property
    def tangent(self) -> np.ndarray:
        """Local matrices integral nu grad u . grad v + 2 nu' (grad A . grad u)(grad A . grad v) [m/H], (K, E)."""
        return self.elements.order.products @ self._tensor

    @property
    def linear_tangent(self) -> np.ndarray:
        """The same for linear functions on the same triangles in the same field [m/H], (6, E)."""
        order, points = self.elements.order, self._tensor.reshape(3, -1, self.nu.shape[1])
        mean = np.tensordot(order.weights / order.weights.sum(), points, axes=(0, 1))
        return LINEAR.of_distinct_gradients.products @ mean

    @cached_property
    def _tensor(self) -> np.ndarray:
        elements = self.elements
        return tangent_tensor(elements.metric, elements.size, self.h1, self.h2, self.nu, self.slope)
