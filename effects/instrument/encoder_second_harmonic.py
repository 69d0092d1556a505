"""Twice-a-turn error of the encoder."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from effects.base import InstrumentEffect
from effects.parameter import parameter
from effects.prior import Normal
from effects.signature import Touches


@dataclass(frozen=True)
class EncoderSecondHarmonic(InstrumentEffect):
    """A tilted or oval disc, or a joint at an angle: angle = angle_read - a cos(2 angle_read) - b sin(2 angle_read).

    A cardan joint at an angle beta gives b = beta^2 / 4.
    """

    title = "twice-a-turn error of the encoder"
    looks_like = "sidebands two orders beside every order of the waveform"
    remedy = ("second reading head", "turn the encoder by 90 degrees on its shaft")
    signature = (
        Touches("back_emf.v_?"),
        Touches("cogging.torque"),
        Touches("locked_rotor.torque"),
        Touches("flux_linkage.dpsi_?"),
    )
    base_rate = 0.01
    base_rate_source = "engineering judgement: behind an error once a turn, one in three of those benches"

    cosine: float = parameter(
        0.0, "rad", prior=Normal(0.002), low=-0.1, high=0.1, source="engineering judgement: joints at 3 to 8 degrees"
    )
    sine: float = parameter(
        0.0, "rad", prior=Normal(0.002), low=-0.1, high=0.1, source="engineering judgement: joints at 3 to 8 degrees"
    )

    def on_condition(self, conditions, kind):
        if "angle_mech" not in conditions or self.is_null:
            return conditions
        read = conditions["angle_mech"]
        return {**conditions, "angle_mech": read - self.cosine * np.cos(2 * read) - self.sine * np.sin(2 * read)}
