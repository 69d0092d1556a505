"""Low-pass filter of a sensor."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from effects.base import InstrumentEffect
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Power, Touches


@dataclass(frozen=True)
class SensorLag(InstrumentEffect):
    """A low-pass filter in the signal chain: Z_read = Z / (1 + j omega lag); waveforms over angle come speed lag late.

    The small loss of amplitude of waveforms is left out; it is of second order in the lag.
    """

    title = "low-pass filter of a sensor"
    looks_like = "phase of the impedance falls in proportion to frequency; waveforms shift with speed"
    remedy = ("look up the filter setting", "known mass on the shaker")
    signature = (
        Power("impedance.im", "frequency", 1.0),
        Touches("impedance.re"),
        Touches("back_emf.v_?"),
    )
    model_error = 0.1
    model_error_source = "benchmarks/law_errors.py: against low-pass of second order, up to 1 ms"
    base_rate = 0.02
    base_rate_source = "engineering judgement: a filter setting forgotten, one bench in fifty"

    lag: float = parameter(
        0.0, "s", prior=LogNormal(3e-4, 1.2), low=0.0, high=0.05, source="data sheet class: filters of 20 Hz to 2 kHz"
    )

    def on_condition(self, conditions, kind):
        if "angle_mech" not in conditions or "speed" not in conditions:
            return conditions
        return {**conditions, "angle_mech": conditions["angle_mech"] - conditions["speed"] * self.lag}

    def on_reading(self, response, conditions, kind):
        if "re" not in response:
            return response
        z = response["re"] + 1j * response["im"]
        z = z / (1.0 + 2j * np.pi * conditions["frequency"] * self.lag)
        return {**response, "re": z.real, "im": z.imag}
