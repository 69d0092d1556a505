"""Stiffness in parallel."""

from __future__ import annotations

from dataclasses import dataclass

from effects.law_effects import ForceEffect
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Power, Touches


@dataclass(frozen=True)
class ParallelStiffness(ForceEffect):
    """Cables, hoses, bellows or a gas spring pull back: F = stiffness x, in the impedance - j stiffness / omega."""

    title = "stiffness in parallel (cables, bellows)"
    looks_like = "imaginary part of the impedance off with 1 / omega, alike at every amplitude and shunt"
    remedy = ("slow pull over the stroke", "take cables and bellows off")
    signature = (
        Touches("impedance.im"),
        Power("impedance.im", "frequency", -1.0),
        Power("impedance.im", "amplitude", 0.0),
    )
    base_rate = 0.02
    base_rate_source = "engineering judgement: a cable across the moving part on one bench in fifty stands out"

    stiffness: float = parameter(
        0.0,
        "N/m",
        prior=LogNormal(500.0, 1.2),
        low=0.0,
        high=1e6,
        source="engineering judgement: cables 0.1, rubber bellows 1 to 10 N/mm",
    )

    def force(self, position, velocity):
        return self.stiffness * position
