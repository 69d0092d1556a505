"""Run-out of the encoder."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from effects.base import InstrumentEffect
from effects.parameter import parameter
from effects.prior import Normal
from effects.signature import Touches


@dataclass(frozen=True)
class AngleRunout(InstrumentEffect):
    """An encoder disc off its centre: angle = angle_read - a cos(angle_read) - b sin(angle_read)."""

    title = "run-out of the encoder"
    looks_like = "an error once a revolution: sidebands one order beside every order of the waveform"
    remedy = ("second reading head opposite the first",)
    signature = (
        Touches("back_emf.v_?"),
        Touches("cogging.torque"),
        Touches("locked_rotor.torque"),
        Touches("flux_linkage.dpsi_?"),
    )
    base_rate = 0.03
    base_rate_source = "engineering judgement: encoders on a coupling, one bench in thirty"

    cosine: float = parameter(
        0.0, "rad", prior=Normal(0.005), low=-0.1, high=0.1, source="geometry: 20 um on a disc of 10 mm"
    )
    sine: float = parameter(
        0.0, "rad", prior=Normal(0.005), low=-0.1, high=0.1, source="geometry: 20 um on a disc of 10 mm"
    )

    def on_condition(self, conditions, kind):
        if "angle_mech" not in conditions:
            return conditions
        read = conditions["angle_mech"]
        return {**conditions, "angle_mech": read - self.cosine * np.cos(read) - self.sine * np.sin(read)}
