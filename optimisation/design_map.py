"""The map of a cross-section over back-iron width and rotor radius, and the best point that can be read off it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import Akima1DInterpolator

_FINE = 201  # points along a width for reading the map between its grid lines


@dataclass(frozen=True)
class BestPoint:
    """Back-iron width and rotor radius [m] and torque per metre [Nm/m], read between the lines of a map."""

    width: float
    radius: float
    torque: float


@dataclass(frozen=True, eq=False)
class DesignMap:
    """Torque [Nm/m] and limited flux density [T] on a grid; NaN where a machine cannot be built.

    widths (n,), radii (m,) [m]; torque, limited: (n, m)
    """

    widths: np.ndarray
    radii: np.ndarray
    torque: np.ndarray
    limited: np.ndarray

    def best_point(self, limit: float) -> BestPoint | None:
        """The largest torque with limited <= limit [T], between the grid lines.

        Along every rotor radius both quantities are interpolated over the width; the best torques of the radii are
        interpolated once more. None when no point of the map holds the limit.
        """
        columns = [self._best_width(m, limit) for m in range(len(self.radii))]
        usable = [m for m, column in enumerate(columns) if column is not None]
        if not usable:
            return None
        widths, torques = np.array([columns[m] for m in usable]).T
        radius, torque = _peak(self.radii[usable], torques)
        return BestPoint(float(np.interp(radius, self.radii[usable], widths)), radius, torque)

    def _best_width(self, column: int, limit: float) -> tuple[float, float] | None:
        known = np.isfinite(self.torque[:, column]) & np.isfinite(self.limited[:, column])
        if known.sum() < 3:
            return None
        widths = np.linspace(self.widths[known][0], self.widths[known][-1], _FINE)
        torque = Akima1DInterpolator(self.widths[known], self.torque[known, column])(widths)
        limited = Akima1DInterpolator(self.widths[known], self.limited[known, column])(widths)
        allowed = np.flatnonzero(limited <= limit)
        if not len(allowed):
            return None
        best = allowed[np.argmax(torque[allowed])]
        return float(widths[best]), float(torque[best])


def _peak(x: np.ndarray, y: np.ndarray) -> tuple[float, float]:
    """Place and size of the largest value of an interpolated curve."""
    if len(x) < 3:
        return float(x[np.argmax(y)]), float(y.max())
    fine = np.linspace(x[0], x[-1], _FINE)
    values = Akima1DInterpolator(x, y)(fine)
    return float(fine[np.argmax(values)]), float(values.max())
