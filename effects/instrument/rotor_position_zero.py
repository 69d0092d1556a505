"""Zero of the rotor position in the drive."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from effects.base import InstrumentEffect
from effects.parameter import parameter
from effects.prior import Normal
from effects.signature import Touches


@dataclass(frozen=True)
class RotorPositionZero(InstrumentEffect):
    """The drive's rotor position is off by a constant electrical angle, so that its d and q axes are turned.

    i_dq = R(-offset) i_dq,read,   v_dq,read = R(offset) v_dq;   R(a) turns by a from d towards q.
    """

    title = "zero of the rotor position in the drive"
    looks_like = "torque without the set i_q, v_d at open terminals in proportion to speed"
    remedy = ("v_d while coasting at zero current", "align the rotor with a direct current")
    signature = (
        Touches("dq_operation.v_d"),
        Touches("dq_operation.v_q"),
        Touches("dq_operation.torque"),
    )
    base_rate = 0.04
    base_rate_source = (
        "engineering judgement: alignment by a short current pulse, one drive in twenty-five off by a degree"
    )

    offset: float = parameter(
        0.0,
        "rad",
        prior=Normal(0.02),
        low=-0.8,
        high=0.8,
        source="engineering judgement: one electrical degree is good, three are met",
    )

    def on_condition(self, conditions, kind):
        return self._turned(conditions, "i", -self.offset)

    def on_reading(self, response, conditions, kind):
        return self._turned(response, "v", self.offset)

    def _turned(self, columns, letter, angle):
        d, q = f"{letter}_d", f"{letter}_q"
        if angle == 0.0 or d not in columns or q not in columns:
            return columns
        cos, sin = np.cos(angle), np.sin(angle)
        return {**columns, d: cos * columns[d] - sin * columns[q], q: sin * columns[d] + cos * columns[q]}
