"""Coulomb friction."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from effects.law_effects import ForceEffect
from effects.parameter import parameter
from effects.prior import LogNormal

REVERSAL = 1e-3  # m/s, below it presliding rounds the reversal (Armstrong-Helouvry et al. 1994)


@dataclass(frozen=True)
class CoulombFriction(ForceEffect):
    """Dry friction of seals, bearings and guides: F = level tanh(v / reversal)."""

    title = "Coulomb friction"
    looks_like = "a constant force that changes sign with the velocity; real part of impedance falls as 1 / (A omega)"
    remedy = ("drag at open terminals, slowest velocities both ways", "impedance at two amplitudes")
    model_error = 0.01

    level: float = parameter(
        0.0, "N", prior=LogNormal(5.0, 1.5), low=0.0, high=1e3, source="seals and guides of suspension actuators"
    )
    reversal: float = parameter(
        REVERSAL, "m/s", prior=LogNormal(REVERSAL, 0.7), low=1e-5, high=0.05, source="presliding of lubricated contacts"
    )

    def force(self, position, velocity):
        return self.level * np.tanh(velocity / self.reversal)

    @property
    def is_null(self):
        return self.level == 0.0
