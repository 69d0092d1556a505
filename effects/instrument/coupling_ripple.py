"""Torque of a misaligned coupling."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from effects.base import InstrumentEffect
from effects.parameter import parameter
from effects.prior import Normal
from effects.signature import Orders

_SOURCE = "engineering judgement: elastic couplings at 0.1 mm or 1 degree of misalignment, 1 to 30 mNm"


@dataclass(frozen=True)
class CouplingRipple(InstrumentEffect):
    """A misaligned coupling between machine and torque cell: T_read = T + sum over k = 1, 2 of a_k cos(k angle) +
    b_k sin(k angle). Parallel misalignment makes once a turn, angular twice; a side load on the cell, once a turn.
    """

    title = "torque of a misaligned coupling"
    looks_like = "torque once and twice a turn, the same with and without current"
    remedy = ("turn the coupling by 90 degrees and measure again", "align the shafts")
    signature = (Orders("cogging.torque", (1, 2)), Orders("locked_rotor.torque", (1, 2)))
    base_rate = 0.04
    base_rate_source = "engineering judgement: one bench in twenty-five has it above the noise of its cogging torque"

    cosine_1: float = parameter(0.0, "Nm", prior=Normal(0.01), low=-1.0, high=1.0, source=_SOURCE)
    sine_1: float = parameter(0.0, "Nm", prior=Normal(0.01), low=-1.0, high=1.0, source=_SOURCE)
    cosine_2: float = parameter(0.0, "Nm", prior=Normal(0.01), low=-1.0, high=1.0, source=_SOURCE)
    sine_2: float = parameter(0.0, "Nm", prior=Normal(0.01), low=-1.0, high=1.0, source=_SOURCE)

    def on_reading(self, response, conditions, kind):
        if "torque" not in response or "angle_mech" not in conditions or self.is_null:
            return response
        angle = conditions["angle_mech"]
        once = self.cosine_1 * np.cos(angle) + self.sine_1 * np.sin(angle)
        twice = self.cosine_2 * np.cos(2 * angle) + self.sine_2 * np.sin(2 * angle)
        return {**response, "torque": response["torque"] + once + twice}
