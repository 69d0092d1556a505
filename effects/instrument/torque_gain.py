"""Gain of the torque cell."""

from __future__ import annotations

from dataclasses import dataclass

from effects.instrument.readings import ReadingGain
from effects.parameter import parameter
from effects.prior import Normal
from effects.signature import Power, Touches


@dataclass(frozen=True)
class TorqueGain(ReadingGain):
    """The torque cell reads too much: T_read = (1 + gain) T."""

    title = "gain of the torque cell"
    looks_like = "every torque off by the same share, voltages and currents agree"
    remedy = ("lever and weight on the torque cell",)
    readings = ("torque",)
    signature = (
        Power("dq_operation.torque", "i_q", 1.0),
        Touches("short_circuit.torque"),
        Touches("cogging.torque"),
        Touches("locked_rotor.torque"),
    )
    base_rate = 0.02
    base_rate_source = "engineering judgement: cell without a current certificate, one in fifty"

    gain: float = parameter(
        0.0, "1", prior=Normal(0.02), low=-0.3, high=0.3, source="data sheet class: uncalibrated cells 1 to 3 %"
    )
