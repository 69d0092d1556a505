"""Gain of the voltage measurement."""

from __future__ import annotations

from dataclasses import dataclass

from effects.instrument.readings import ReadingGain
from effects.parameter import parameter
from effects.prior import Normal
from effects.signature import Power, Touches


@dataclass(frozen=True)
class VoltageGain(ReadingGain):
    """The voltmeter reads too much: V_read = (1 + gain) V. Likewise power made from it, and flux linkages, its
    integrals."""

    title = "gain of the voltage measurement"
    looks_like = "back-EMF off by a share that torque does not show"
    remedy = ("a second voltmeter",)
    readings = ("voltage", "v_*", "power", "psi_?", "dpsi_?")
    set_points = ("v_ll",)
    signature = (
        Power("back_emf.voltage", "velocity", 1.0),
        Power("back_emf.v_ll", "speed", 1.0),
        Touches("dq_operation.v_d"),
        Touches("dq_operation.v_q"),
        Touches("dq_supply.*"),
        Touches("back_emf.v_?"),
        Touches("flux_linkage.dpsi_?"),
    )
    base_rate = 0.02
    base_rate_source = "engineering judgement: divider ratio or range a little off, one bench in fifty"

    gain: float = parameter(
        0.0, "1", prior=Normal(0.02), low=-0.3, high=0.3, source="data sheet class: uncalibrated dividers 1 to 3 %"
    )
