"""Gain of the voltage measurement."""

from __future__ import annotations

from dataclasses import dataclass

from effects.instrument.readings import ReadingGain
from effects.parameter import parameter
from effects.prior import Normal


@dataclass(frozen=True)
class VoltageGain(ReadingGain):
    """The voltmeter reads too much: V_read = (1 + gain) V. Electrical power made from it likewise."""

    title = "gain of the voltage measurement"
    looks_like = "back-EMF off by a share that torque does not show"
    remedy = ("a second voltmeter",)
    readings = ("voltage", "v_*", "power")
    set_points = ("v_ll",)

    gain: float = parameter(0.0, "1", prior=Normal(0.02), low=-0.3, high=0.3, source="uncalibrated dividers 1 to 3 %")
