"""Coulomb friction."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from effects.law_effects import ForceEffect
from effects.mechanical.reversal import reversal_velocity
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Odd, Power


@dataclass(frozen=True)
class CoulombFriction(ForceEffect):
    """Dry friction of seals, bearings and guides: F = level tanh(v / reversal)."""

    title = "Coulomb friction"
    looks_like = "a constant force that changes sign with the velocity; real part of impedance falls as 1 / (A omega)"
    remedy = ("drag at open terminals, slowest velocities both ways", "impedance at two amplitudes")
    signature = (
        Odd("damping_velocity.force", ("velocity",)),
        Power("damping_velocity.force", "velocity", 0.0),
        Power("damping_velocity.force", "shunt", 0.0),
        Power("impedance.re", "frequency", -1.0, 4.0),
        Power("impedance.re", "amplitude", -1.0),
    )
    model_error = 0.005
    size_error = 0.011
    model_error_source = "benchmarks/law_errors.py: against another rounding of the reversal"
    base_rate = 0.1
    base_rate_source = "engineering judgement: every rod has a seal or bush; undeclared and visible in one of ten"

    level: float = parameter(
        0.0,
        "N",
        prior=LogNormal(5.0, 1.5),
        low=0.0,
        high=1e3,
        source="engineering judgement: seals and guides of suspension actuators, 1 to 50 N",
    )
    reversal: float = reversal_velocity()

    def force(self, position, velocity):
        return self.level * np.tanh(velocity / self.reversal)

    @property
    def is_null(self):
        return self.level == 0.0
