"""Damping that differs between the two directions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from effects.law_effects import ForceEffect
from effects.parameter import parameter
from effects.prior import Normal
from effects.signature import Even, Power, Touches


@dataclass(frozen=True)
class DirectionAsymmetry(ForceEffect):
    """Compression and rebound are damped differently, for example by valves or lips: F = difference |v|.

    Viscous damping is c + difference forwards and c - difference backwards; at a sine the two halves cancel in the
    fundamental.
    """

    title = "damping that differs with direction"
    looks_like = "force off by the same sign in both directions, in proportion to velocity; impedance unchanged"
    remedy = ("force-velocity line both ways with the damper turned end for end", "second harmonic of the force")
    signature = (
        Touches("damping_shunt.damping"),
        Even("damping_velocity.force", ("velocity",)),
        Power("damping_velocity.force", "velocity", 1.0),
        Power("damping_velocity.force", "shunt", 0.0),
    )
    base_rate = 0.02
    base_rate_source = "engineering judgement: usual in hydraulic dampers, rare in electric ones with seals"

    difference: float = parameter(
        0.0,
        "N s/m",
        prior=Normal(10.0),
        low=-2e3,
        high=2e3,
        source="engineering judgement: up to a tenth of the 70 to 351 N s/m of such dampers (thesis section 5.2.1)",
    )

    def force(self, position, velocity):
        return self.difference * np.abs(velocity)
