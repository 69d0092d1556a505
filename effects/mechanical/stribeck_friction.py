"""Stribeck friction."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from effects.law_effects import ForceEffect
from effects.mechanical.reversal import reversal_velocity
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Odd, Power, Touches


@dataclass(frozen=True)
class StribeckFriction(ForceEffect):
    """Dry friction that is higher at creeping speed: F = level (1 + excess exp(-(v / v_s)^2)) tanh(v / reversal).

    Source: Armstrong-Helouvry, Dupont, Canudas de Wit, Automatica 30 (1994), eq. 4.
    """

    title = "Stribeck friction"
    looks_like = "as Coulomb friction with more force at the slowest velocities"
    remedy = ("more points at the slowest velocities", "change of grease")
    contains = ("coulomb_friction",)
    signature = (
        Odd("damping_velocity.force", ("velocity",)),
        Power("damping_velocity.force", "shunt", 0.0),
        Touches("damping_shunt.damping"),
        Touches("impedance.re"),
    )
    model_error = 0.005
    size_error = 0.17
    model_error_source = "benchmarks/law_errors.py: against creeping part 1 / (1 + (v / v_s)^2)"
    base_rate = 0.03
    base_rate_source = "engineering judgement: the creeping part stands out in three of ten cases of dry friction"

    level: float = parameter(
        0.0,
        "N",
        prior=LogNormal(5.0, 1.5),
        low=0.0,
        high=1e3,
        source="engineering judgement: seals and guides of suspension actuators, 1 to 50 N",
    )
    excess: float = parameter(
        0.0,
        "1",
        prior=LogNormal(0.6, 0.6),
        low=0.0,
        high=5.0,
        source="textbook: static friction 1.2 to 2 times the sliding one (Armstrong-Helouvry et al. 1994)",
    )
    stribeck_velocity: float = parameter(
        0.05,
        "m/s",
        prior=LogNormal(0.05, 0.5),
        low=5e-3,
        high=1.0,
        source="textbook: lubricated contacts, 0.01 to 0.2 m/s (Armstrong-Helouvry et al. 1994)",
    )
    reversal: float = reversal_velocity()

    def force(self, position, velocity):
        creeping = np.exp(-((velocity / self.stribeck_velocity) ** 2))
        return self.level * (1.0 + self.excess * creeping) * np.tanh(velocity / self.reversal)

    @property
    def is_null(self):
        return self.level == 0.0
