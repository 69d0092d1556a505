"""Low-pass filter of a sensor."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from effects.base import InstrumentEffect
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Power, Touches


@dataclass(frozen=True)
class SensorLag(InstrumentEffect):
    """A low-pass filter in the signal chain, Butterworth's of so many poles: Z_read = Z H(j omega); waveforms over
    angle come speed lag late.

        H(s) = product over the poles p of -p / (s lag / T - p),  T = sum of -1 / p

    so that the delay of low frequencies is the lag; with one pole H = 1 / (1 + s lag). One of two poles and more delays
    all that it lets pass alike, and is told from a delay by nothing but where it ends. The small loss of amplitude of
    waveforms is left out; it is of second order in the lag.
    """

    title = "low-pass filter of a sensor"
    looks_like = "phase of the impedance falls in proportion to frequency; waveforms shift with speed"
    remedy = ("look up the filter setting", "known mass on the shaker")
    signature = (
        Power("impedance.im", "frequency", 1.0),
        Touches("impedance.re"),
        Touches("back_emf.v_?"),
    )
    model_error = 0.035
    size_error = 0.008
    model_error_source = "benchmarks/law_errors.py: against Bessel's filter of two poles, up to 1 ms"
    base_rate = 0.02
    base_rate_source = "engineering judgement: a filter setting forgotten, one bench in fifty"

    lag: float = parameter(
        0.0, "s", prior=LogNormal(3e-4, 1.2), low=0.0, high=0.05, source="data sheet class: filters of 20 Hz to 2 kHz"
    )
    poles: int = 1

    @classmethod
    def variants(cls, design: Any) -> tuple[SensorLag, ...]:
        """A resistor and a capacitor, and the filter of a measuring amplifier."""
        return cls(), cls(poles=4)

    def on_condition(self, conditions, kind):
        if "angle_mech" not in conditions or "speed" not in conditions:
            return conditions
        return {**conditions, "angle_mech": conditions["angle_mech"] - conditions["speed"] * self.lag}

    def on_reading(self, response, conditions, kind):
        if "re" not in response or self.is_null:
            return response
        z = (response["re"] + 1j * response["im"]) * self.passed(conditions["frequency"])
        return {**response, "re": z.real, "im": z.imag}

    def passed(self, frequency: np.ndarray) -> np.ndarray:
        """H(j omega) at frequencies [Hz] (n,)."""
        places = np.exp(0.5j * np.pi * (1 + (2 * np.arange(self.poles) + 1) / self.poles))
        s = 2j * np.pi * frequency * self.lag / np.sum(-1 / places).real
        return np.prod(-places / (s[:, None] - places), axis=1)
