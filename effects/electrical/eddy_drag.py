"""Eddy-current drag."""

from __future__ import annotations

from dataclasses import dataclass

from effects.law_effects import ForceEffect
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Odd, Power, Touches


@dataclass(frozen=True)
class EddyDrag(ForceEffect):
    """Eddy currents in solid parts brake, ever less above a corner velocity: F = c v / (1 + (v / v_c)^2).

    Source: Smythe (1942), Wouterse (1991), the curve of an eddy-current brake.
    """

    title = "eddy-current drag"
    looks_like = "extra damping at open terminals that bends over at high velocity"
    remedy = ("drag with and without magnets", "drag up to higher velocity")
    signature = (
        Odd("damping_velocity.force", ("velocity",)),
        Power("damping_velocity.force", "shunt", 0.0),
        Touches("damping_shunt.damping"),
        Touches("impedance.re"),
    )
    model_error = 0.018
    size_error = 0.059
    model_error_source = "benchmarks/law_errors.py: against brake curve with another power above the corner"
    base_rate = 0.02
    base_rate_source = "engineering judgement: solid back iron or housing near the magnets, one damper in fifty"

    coefficient: float = parameter(
        0.0,
        "N s/m",
        prior=LogNormal(20.0, 1.0),
        low=0.0,
        high=5e3,
        source="engineering judgement: solid back iron of small actuators",
    )
    corner: float = parameter(
        0.5,
        "m/s",
        prior=LogNormal(0.5, 0.7),
        low=0.05,
        high=50.0,
        source="textbook: skin depth equals pole pitch, 0.1 to 2 m/s (Wouterse 1991)",
    )

    def force(self, position, velocity):
        return self.coefficient * velocity / (1.0 + (velocity / self.corner) ** 2)

    @property
    def is_null(self):
        return self.coefficient == 0.0
