"""Quadratic (windage) drag."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from effects.law_effects import ForceEffect
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Odd, Power, Touches


@dataclass(frozen=True)
class QuadraticDrag(ForceEffect):
    """Air or oil pushed through openings: F = b v |v|."""

    title = "quadratic (windage) drag"
    looks_like = "extra force that grows with the square of velocity; damping grows with A omega"
    remedy = ("drag at open terminals up to the highest velocity", "open the covers")
    signature = (
        Odd("damping_velocity.force", ("velocity",)),
        Power("damping_velocity.force", "velocity", 2.0),
        Power("impedance.re", "frequency", 1.0),
        Power("impedance.re", "amplitude", 1.0),
        Touches("damping_shunt.damping"),
    )
    model_error = 0.009
    size_error = 0.022
    model_error_source = "benchmarks/law_errors.py: against |v|^1.97"
    base_rate = 0.01
    base_rate_source = "engineering judgement: needs enclosed air or oil, one damper in a hundred"

    coefficient: float = parameter(
        0.0,
        "N s^2/m^2",
        prior=LogNormal(50.0, 1.2),
        low=0.0,
        high=2e4,
        source="engineering judgement: flow through openings of some square centimetres",
    )

    def force(self, position, velocity):
        return self.coefficient * velocity * np.abs(velocity)
