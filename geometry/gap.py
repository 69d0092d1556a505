"""The two halves of the air gap, also where the rim of stator or rotor stands beside the axis of rotation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class GapHalf:
    """Circles between the sliding circle about the axis of rotation and the rim of stator or rotor.

    At the height h, 0 on the sliding circle and 1 on the rim, the circle has the centre h c and the radius r_0 + h D,

        |p - h c| = r_0 + h D,   D = r_1 - r_0,   |c| < |D|

    slide_radius: r_0 [m]; rim_radius: r_1 [m]; rim_centre: c, where the rim's centre stands [m]
    """

    slide_radius: float
    rim_radius: float
    rim_centre: tuple[float, float] = (0.0, 0.0)

    @property
    def depth(self) -> float:
        """D = r_1 - r_0 [m], negative towards the rotor."""
        return self.rim_radius - self.slide_radius

    def height(self, points: np.ndarray) -> np.ndarray:
        """h (dimensionless) at points [m], (2, ...).

        The small root of (c^2 - D^2) h^2 - 2 (p.c + r_0 D) h + p^2 - r_0^2 = 0.
        """
        (x, y), (cx, cy), depth = points, self.rim_centre, self.depth
        half = x * cx + y * cy + self.slide_radius * depth
        rest = x * x + y * y - self.slide_radius**2
        square = half**2 - (cx * cx + cy * cy - depth * depth) * rest
        root = np.sqrt(np.maximum(square, 0.0))  # zero at the axis, but for rounding
        return rest / (half + np.copysign(root, depth))

    def sheared(self, points: np.ndarray, angle: float) -> np.ndarray:
        """The points turned about the axis by an angle [rad] on the sliding circle and beyond, by nothing on the rim,
        in between by as much as they are close to the circle.

        points, sheared: [m], (2, ...)
        """
        radius = np.hypot(*points)
        direction = np.arctan2(points[1], points[0]) + angle * np.clip(1 - self.height(points), 0.0, 1.0)
        return radius * np.stack([np.cos(direction), np.sin(direction)])

    def gradient(self, points: np.ndarray) -> np.ndarray:
        """grad h = q/(D + q.c) [1/m], (2, ...), at points [m], (2, ...); q: unit vector from h c to the point."""
        centre = np.array(self.rim_centre).reshape(2, *[1] * (np.ndim(points) - 1))
        away = points - self.height(points) * centre
        unit = away / np.hypot(*away)
        return unit / (self.depth + (unit * centre).sum(0))
