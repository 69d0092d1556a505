"""Zero of the torque cell."""

from __future__ import annotations

from dataclasses import dataclass

from effects.instrument.readings import ReadingOffset
from effects.parameter import parameter
from effects.prior import Normal


@dataclass(frozen=True)
class TorqueOffset(ReadingOffset):
    """The torque cell was not zeroed: T_read = T + offset."""

    title = "zero of the torque cell"
    looks_like = "the same torque added at every angle, current and in both directions"
    remedy = ("zero the cell unloaded, before and after",)
    readings = ("torque",)

    offset: float = parameter(0.0, "Nm", prior=Normal(0.1), low=-5.0, high=5.0, source="0.1 to 1 % of 10 to 50 Nm")
