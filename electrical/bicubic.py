"""Bicubic splines of flux linkages over currents, looked up in one compiled pass: the innermost loop of every search
over a flux map."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from compiling import compiled


@dataclass(frozen=True, eq=False)
class Bicubics:
    """k flux linkages over two currents x and y, twice continuously differentiable; beyond the grid as at its edge.

    x (n + 1,), y (m + 1,): where one cubic passes into the next, increasing, four or more each [A]
    cubics: of every cell, from its lower corner, highest powers first [Wb and over A] (n, m, k, 4, 4)
    """

    x: np.ndarray
    y: np.ndarray
    cubics: np.ndarray

    @classmethod
    def through(cls, x: np.ndarray, y: np.ndarray, values: Sequence[np.ndarray]) -> Bicubics:
        """Interpolating, the third derivative continuous at the second and last but one of the points (de Boor's
        not-a-knot). x (n + 1,), y (m + 1,): [A];  values: k of (n + 1, m + 1) [Wb]"""
        powers_x = CubicSpline(x, np.array(values), axis=1).c  # (4, n, k, m + 1)
        powers = CubicSpline(y, powers_x, axis=3).c  # (4, m, 4, n, k)
        return cls(x, y, np.ascontiguousarray(powers.transpose(3, 1, 4, 2, 0)))

    def __call__(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Flux linkages (k, ...) [Wb] at currents x and y [A], which broadcast; NaN stays NaN."""
        return self._of(values_at, (), x, y)

    def slopes(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """(d/dx, d/dy) of each (k, 2, ...) [H] at currents x and y [A]."""
        return self._of(slopes_at, (2,), x, y)

    def _of(
        self, look_up: Callable[..., np.ndarray], kind: tuple[int, ...], x: np.ndarray, y: np.ndarray
    ) -> np.ndarray:
        x, y = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
        return look_up(self.x, self.y, self.cubics, x.ravel(), y.ravel()).reshape(self.cubics.shape[2], *kind, *x.shape)


@compiled
def values_at(ends_x: np.ndarray, ends_y: np.ndarray, cubics: np.ndarray, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Flux linkages (k, points) [Wb] at currents x and y (points,) [A].

    ends_x (n + 1,), ends_y (m + 1,): [A];  cubics: [Wb and over A] (n, m, k, 4, 4), all as of ``Bicubics``
    """
    found = np.empty((cubics.shape[2], len(x)))
    for p in range(len(x)):
        i, u = place(ends_x, x[p])
        j, v = place(ends_y, y[p])
        for k in range(len(found)):
            value = 0.0
            for c in cubics[i, j, k]:
                value = value * u + ((c[0] * v + c[1]) * v + c[2]) * v + c[3]
            found[k, p] = value
    return found


@compiled
def slopes_at(ends_x: np.ndarray, ends_y: np.ndarray, cubics: np.ndarray, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """d/dx and d/dy (k, 2, points) [H] at currents x and y (points,) [A].

    ends_x (n + 1,), ends_y (m + 1,): [A];  cubics: [Wb and over A] (n, m, k, 4, 4), all as of ``Bicubics``
    """
    found = np.empty((cubics.shape[2], 2, len(x)))
    for p in range(len(x)):
        i, u = place(ends_x, x[p])
        j, v = place(ends_y, y[p])
        for k in range(len(found)):
            value = along_x = along_y = 0.0
            for c in cubics[i, j, k]:
                along_x = along_x * u + value
                along_y = along_y * u + (3.0 * c[0] * v + 2.0 * c[1]) * v + c[2]
                value = value * u + ((c[0] * v + c[1]) * v + c[2]) * v + c[3]
            found[k, 0, p], found[k, 1, p] = along_x, along_y
    return found


@compiled
def place(ends: np.ndarray, x: float) -> tuple[int, float]:
    """Number of the interval in which x [A] lies, and how far from its lower end [A]; where x is beyond, the nearest.

    ends: of the intervals, increasing [A] (n + 1,)
    """
    x = min(max(x, ends[0]), ends[-1]) if x == x else x
    low, high = 0, len(ends) - 1
    while high - low > 1:
        middle = (low + high) // 2
        if x >= ends[middle]:
            low = middle
        else:
            high = middle
    return low, x - ends[low]
