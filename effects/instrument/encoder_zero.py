"""Zero of the encoder."""

from __future__ import annotations

from dataclasses import dataclass

from effects.base import InstrumentEffect
from effects.parameter import parameter
from effects.prior import Normal
from effects.signature import Touches


@dataclass(frozen=True)
class EncoderZero(InstrumentEffect):
    """The encoder's zero is not where it was declared: angle = angle_read - offset."""

    title = "zero of the encoder"
    looks_like = "every waveform over angle shifted by the same angle"
    remedy = ("align the rotor with a current in phase A and read the encoder",)
    signature = (
        Touches("back_emf.v_?"),
        Touches("cogging.torque"),
        Touches("locked_rotor.torque"),
        Touches("flux_linkage.dpsi_?"),
    )
    base_rate = 0.04
    base_rate_source = (
        "engineering judgement: couplings slip and are set by eye, one bench in twenty-five beyond its declared zero"
    )

    offset: float = parameter(
        0.0,
        "rad",
        prior=Normal(0.01),
        low=-0.5,
        high=0.5,
        source="engineering judgement: couplings set by eye, 0.1 to 2 degrees",
    )

    def on_condition(self, conditions, kind):
        if "angle_mech" not in conditions:
            return conditions
        return {**conditions, "angle_mech": conditions["angle_mech"] - self.offset}
