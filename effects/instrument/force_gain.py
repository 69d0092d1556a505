"""Gain of the force cell."""

from __future__ import annotations

from dataclasses import dataclass

from effects.instrument.readings import ReadingGain
from effects.parameter import parameter
from effects.prior import Normal


@dataclass(frozen=True)
class ForceGain(ReadingGain):
    """The force cell reads too much: F_read = (1 + gain) F; impedance and damping, which are made from it, likewise."""

    title = "gain of the force cell"
    looks_like = "every force, also at rest of the other instruments, off by the same share"
    remedy = ("hang a known weight on the force cell",)
    readings = ("force", "re", "im", "damping")

    gain: float = parameter(0.0, "1", prior=Normal(0.02), low=-0.3, high=0.3, source="uncalibrated cells 1 to 3 %")
