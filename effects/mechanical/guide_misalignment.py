"""Friction that grows away from mid-stroke."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from effects.law_effects import ForceEffect
from effects.mechanical.reversal import REVERSAL
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Odd, Power


@dataclass(frozen=True)
class GuideMisalignment(ForceEffect):
    """Guides that bind away from the middle of the stroke: F = gradient sqrt(x^2 + clearance^2) tanh(v / 1 mm/s).

    Within its clearance a guide is pressed as the rod happens to lie in it: some friction is left in mid-stroke.
    """

    title = "friction that grows away from mid-stroke"
    looks_like = "extra loss in the impedance in proportion to 1 / omega, little at constant velocity in mid-stroke"
    remedy = ("impedance at two amplitudes", "slow pull over the whole stroke")
    signature = (
        Odd("damping_velocity.force", ("velocity",)),
        Power("damping_velocity.force", "velocity", 0.0),
        Power("impedance.re", "frequency", -1.0, 4.0),
        Power("impedance.re", "amplitude", 0.0),
    )
    model_error = 0.013
    size_error = 0.022
    model_error_source = "benchmarks/law_errors.py: against another rounding of the reversal, half the clearance"
    base_rate = 0.02
    base_rate_source = "engineering judgement: side load on a rod, one rig in fifty"

    gradient: float = parameter(
        0.0,
        "N/m",
        prior=LogNormal(2e3, 1.5),
        low=0.0,
        high=1e6,
        source="engineering judgement: 10 N over 2 mm, guides with 0.1 mm of run-out",
    )
    clearance: float = parameter(
        1e-4,
        "m",
        prior=LogNormal(1e-4, 1.0),
        low=1e-6,
        high=5e-3,
        source="engineering judgement: running fits and bushes of guides, 0.03 to 0.3 mm",
    )

    def force(self, position, velocity):
        return self.gradient * np.hypot(position, self.clearance) * np.tanh(velocity / REVERSAL)

    @property
    def is_null(self):
        return self.gradient == 0.0
