"""Delay between the channels of an analyser."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from effects.base import InstrumentEffect
from effects.parameter import parameter
from effects.prior import Normal
from effects.signature import Touches


@dataclass(frozen=True)
class AnalyserDelay(InstrumentEffect):
    """Force and velocity are sampled at different instants: Z_read = Z exp(-j omega delay), amplitude unchanged."""

    title = "delay between the channels of the analyser"
    looks_like = "phase of the impedance off in proportion to frequency, its size right"
    remedy = ("the same signal on both channels", "exchange the channels")
    signature = (
        Touches("impedance.re"),
        Touches("impedance.im"),
    )
    base_rate = 0.01
    base_rate_source = "engineering judgement: multiplexed inputs or one anti-alias filter, one analyser in a hundred"

    delay: float = parameter(
        0.0,
        "s",
        prior=Normal(1e-4),
        low=-0.02,
        high=0.02,
        source="data sheet class: multiplexed data acquisition, 1 to 10 kHz a channel",
    )

    def on_reading(self, response, conditions, kind):
        if "re" not in response or self.is_null:
            return response
        z = (response["re"] + 1j * response["im"]) * np.exp(-2j * np.pi * conditions["frequency"] * self.delay)
        return {**response, "re": z.real, "im": z.imag}
