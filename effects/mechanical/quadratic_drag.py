"""Quadratic (windage) drag."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from effects.law_effects import ForceEffect
from effects.parameter import parameter
from effects.prior import LogNormal


@dataclass(frozen=True)
class QuadraticDrag(ForceEffect):
    """Air or oil pushed through openings: F = b v |v|."""

    title = "quadratic (windage) drag"
    looks_like = "extra force that grows with the square of velocity; damping grows with A omega"
    remedy = ("drag at open terminals up to the highest velocity", "open the covers")
    model_error = 0.02

    coefficient: float = parameter(
        0.0, "N s^2/m^2", prior=LogNormal(50.0, 1.2), low=0.0, high=2e4, source="flow through cm^2 openings"
    )

    def force(self, position, velocity):
        return self.coefficient * velocity * np.abs(velocity)
