"""Zero of the voltage measurement."""

from __future__ import annotations

from dataclasses import dataclass

from effects.instrument.readings import ReadingOffset
from effects.parameter import parameter
from effects.prior import Normal


@dataclass(frozen=True)
class VoltageOffset(ReadingOffset):
    """The voltmeter has a zero error: V_read = V + offset."""

    title = "zero of the voltage measurement"
    looks_like = "the same voltage added at every speed"
    remedy = ("short the leads and read",)
    readings = ("voltage", "v_[abcdq]")

    offset: float = parameter(0.0, "V", prior=Normal(0.05), low=-10.0, high=10.0, source="amplifier zero")
