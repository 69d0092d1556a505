"""Shunts differ from their label."""

from __future__ import annotations

from dataclasses import dataclass

from effects.damper_design import Damper
from effects.instrument.readings import ReadingGain
from effects.parameter import parameter
from effects.prior import Normal
from effects.signature import Odd, Touches


@dataclass(frozen=True)
class ShuntTolerance(ReadingGain):
    """All shunts have less than their label says by the same share: R_s = R_s,label / (1 + gain)."""

    title = "shunts differ from their label"
    looks_like = "braking force off most where the shunt is about the internal resistance, nothing at either end"
    remedy = ("four-wire resistance of each shunt",)
    designs = (Damper,)
    readings = ()
    set_points = ("shunt",)
    signature = (
        Odd("damping_velocity.force", ("velocity",)),
        Touches("damping_shunt.damping"),
        Touches("impedance.re"),
    )
    base_rate = 0.02
    base_rate_source = "engineering judgement: labels believed instead of measured, one bench in fifty"

    gain: float = parameter(
        0.0, "1", prior=Normal(0.02), low=-0.3, high=0.3, source="IEC 60063: power resistors of 1, 5 and 10 %"
    )
