"""Stribeck friction."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from effects.law_effects import ForceEffect
from effects.mechanical.coulomb_friction import REVERSAL
from effects.parameter import parameter
from effects.prior import LogNormal


@dataclass(frozen=True)
class StribeckFriction(ForceEffect):
    """Dry friction that is higher at creeping speed: F = level (1 + excess exp(-(v / v_s)^2)) tanh(v / reversal).

    Source: Armstrong-Helouvry, Dupont, Canudas de Wit, Automatica 30 (1994), eq. 4.
    """

    title = "Stribeck friction"
    looks_like = "as Coulomb friction with more force at the slowest velocities"
    remedy = ("more points at the slowest velocities", "change of grease")
    contains = ("coulomb_friction",)
    model_error = 0.03

    level: float = parameter(
        0.0, "N", prior=LogNormal(5.0, 1.5), low=0.0, high=1e3, source="seals and guides of suspension actuators"
    )
    excess: float = parameter(
        0.0, "1", prior=LogNormal(0.6, 0.6), low=0.0, high=5.0, source="static friction 1.2 to 2 times the sliding one"
    )
    stribeck_velocity: float = parameter(
        0.05, "m/s", prior=LogNormal(0.05, 0.5), low=5e-3, high=1.0, source="lubricated line contacts"
    )
    reversal: float = parameter(
        REVERSAL, "m/s", prior=LogNormal(REVERSAL, 0.7), low=1e-5, high=0.05, source="presliding of lubricated contacts"
    )

    def force(self, position, velocity):
        creeping = np.exp(-((velocity / self.stribeck_velocity) ** 2))
        return self.level * (1.0 + self.excess * creeping) * np.tanh(velocity / self.reversal)

    @property
    def is_null(self):
        return self.level == 0.0
