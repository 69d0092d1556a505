"""Gain of the current measurement."""

from __future__ import annotations

from dataclasses import dataclass

from effects.instrument.readings import ReadingGain
from effects.parameter import parameter
from effects.prior import Normal
from effects.signature import Touches


@dataclass(frozen=True)
class CurrentGain(ReadingGain):
    """The current probe reads too much: i_read = (1 + gain) i; a current that was set is truly i_read / (1 + gain)."""

    title = "gain of the current measurement"
    looks_like = "torque per ampere off by a share that the back-EMF does not show"
    remedy = ("a shunt resistor in series with the probe",)
    readings = ("current", "power")
    set_points = ("i_*",)
    signature = (
        Touches("dq_operation.v_d"),
        Touches("dq_operation.v_q"),
        Touches("dq_operation.torque"),
        Touches("short_circuit.current"),
        Touches("dq_supply.*"),
        Touches("locked_rotor.torque"),
        Touches("flux_linkage.dpsi_?"),
    )
    base_rate = 0.02
    base_rate_source = "engineering judgement: probe range or turns ratio a little off, one bench in fifty"

    gain: float = parameter(
        0.0, "1", prior=Normal(0.02), low=-0.3, high=0.3, source="data sheet class: Hall probes 1 to 3 %"
    )
