"""Gain of the force cell."""

from __future__ import annotations

from dataclasses import dataclass

from effects.instrument.readings import ReadingGain
from effects.parameter import parameter
from effects.prior import Normal
from effects.signature import Odd, Power, Touches


@dataclass(frozen=True)
class ForceGain(ReadingGain):
    """The force cell reads too much: F_read = (1 + gain) F; impedance and damping, which are made from it, likewise."""

    title = "gain of the force cell"
    looks_like = "every force, also at rest of the other instruments, off by the same share"
    remedy = ("hang a known weight on the force cell",)
    readings = ("force", "re", "im", "damping")
    signature = (
        Power("damping_velocity.force", "velocity", 1.0),
        Odd("damping_velocity.force", ("velocity",)),
        Touches("damping_shunt.damping"),
        Touches("impedance.re"),
        Touches("impedance.im"),
    )
    base_rate = 0.02
    base_rate_source = "engineering judgement: cell without a current certificate, one in fifty"

    gain: float = parameter(
        0.0, "1", prior=Normal(0.02), low=-0.3, high=0.3, source="data sheet class: uncalibrated cells 1 to 3 %"
    )
