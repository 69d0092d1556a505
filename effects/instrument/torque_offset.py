"""Zero of the torque cell."""

from __future__ import annotations

from dataclasses import dataclass

from effects.instrument.readings import ReadingOffset
from effects.parameter import parameter
from effects.prior import Normal
from effects.signature import Even, Orders, Power, Touches


@dataclass(frozen=True)
class TorqueOffset(ReadingOffset):
    """The torque cell was not zeroed: T_read = T + offset."""

    title = "zero of the torque cell"
    looks_like = "the same torque added at every angle, current and in both directions"
    remedy = ("zero the cell unloaded, before and after",)
    readings = ("torque",)
    signature = (
        Power("dq_operation.torque", "i_q", 0.0),
        Power("dq_operation.torque", "speed", 0.0),
        Even("drag.torque", ("speed",)),
        Touches("short_circuit.torque"),
        Orders("cogging.torque", (0,)),
        Orders("locked_rotor.torque", (0,)),
    )
    base_rate = 0.03
    base_rate_source = "engineering judgement: not zeroed after mounting, one in thirty"

    offset: float = parameter(
        0.0, "Nm", prior=Normal(0.1), low=-5.0, high=5.0, source="data sheet class: 0.1 to 1 % of 10 to 50 Nm"
    )
