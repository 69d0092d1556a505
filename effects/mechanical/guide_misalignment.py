"""Friction that grows away from mid-stroke."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from effects.law_effects import ForceEffect
from effects.mechanical.reversal import REVERSAL
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Power


@dataclass(frozen=True)
class GuideMisalignment(ForceEffect):
    """Guides that bind away from the middle of the stroke: F = gradient |x| tanh(v / 1 mm/s)."""

    title = "friction that grows away from mid-stroke"
    looks_like = "extra loss in the impedance in proportion to 1 / omega, none at constant velocity in mid-stroke"
    remedy = ("impedance at two amplitudes", "slow pull over the whole stroke")
    signature = (
        Power("impedance.re", "frequency", -1.0, 4.0),
        Power("impedance.re", "amplitude", 0.0),
    )
    model_error = 0.015
    size_error = 0.019
    model_error_source = "benchmarks/law_errors.py: against another rounding of reversal and mid-stroke"
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

    def force(self, position, velocity):
        return self.gradient * np.abs(position) * np.tanh(velocity / REVERSAL)
