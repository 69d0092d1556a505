"""End stop."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from effects.law_effects import ForceEffect
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Power, Touches


@dataclass(frozen=True)
class EndStop(ForceEffect):
    """A rubber stop is touched at both ends of the motion: F = hardness sign(x) max(|x| - gap, 0)^2, without loss."""

    title = "end stop touched"
    looks_like = "imaginary part of the impedance falls at large amplitude only, with 1 / omega"
    remedy = ("smaller amplitude", "measure the free stroke")
    signature = (Touches("impedance.im"), Power("impedance.im", "frequency", -1.0))
    base_rate = 0.005
    base_rate_source = "engineering judgement: heard on the bench, so that it seldom reaches a file"

    hardness: float = parameter(
        0.0,
        "N/m^2",
        prior=LogNormal(1e8, 1.5),
        low=0.0,
        high=1e12,
        source="engineering judgement: rubber buffers take 100 N at 1 mm",
    )
    gap: float = parameter(
        1.5e-3,
        "m",
        prior=LogNormal(1.5e-3, 0.7),
        low=1e-4,
        high=0.2,
        source="engineering judgement: only a stop within the amplitudes of a shaker is seen, 0.5 to 5 mm",
    )

    def force(self, position, velocity):
        return self.hardness * np.sign(position) * np.maximum(np.abs(position) - self.gap, 0.0) ** 2

    @property
    def is_null(self):
        return self.hardness == 0.0
