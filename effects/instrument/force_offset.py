"""Zero of the force cell."""

from __future__ import annotations

from dataclasses import dataclass

from effects.instrument.readings import ReadingOffset
from effects.parameter import parameter
from effects.prior import Normal


@dataclass(frozen=True)
class ForceOffset(ReadingOffset):
    """The force cell was not zeroed: F_read = F + offset."""

    title = "zero of the force cell"
    looks_like = "the same force added in both directions of motion"
    remedy = ("zero the cell unloaded, before and after",)
    readings = ("force",)

    offset: float = parameter(0.0, "N", prior=Normal(2.0), low=-200.0, high=200.0, source="0.1 to 1 % of full scale")
