"""Delay between voltage and rotor position in the drive."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from effects.base import Columns, ResponseEffect
from effects.dq_design import DqMachine
from effects.parameter import parameter
from effects.prior import Normal
from effects.signature import Touches


@dataclass(frozen=True)
class DriveDelay(ResponseEffect):
    """Voltage and rotor position belong to different instants: PWM and sampling delay that the drive does not take
    back, or the filter of the voltage dividers.  v_dq,read = R(omega delay) v_dq, R(a) turns by a from d towards q.

    Source: Bae and Sul, IEEE Trans. IA 39 (2003), one and a half periods of the PWM.
    """

    title = "delay between voltage and rotor position"
    looks_like = "voltage turned by an angle in proportion to speed: v_d off with the square of speed; torque agrees"
    remedy = ("v_d at open terminals over speed", "two PWM frequencies", "filter setting of the dividers")
    designs = (DqMachine,)
    signature = (Touches("dq_operation.v_d"), Touches("dq_operation.v_q"))
    base_rate = 0.03
    base_rate_source = "engineering judgement: one drive in thirty is commissioned without it"

    delay: float = parameter(
        0.0,
        "s",
        prior=Normal(3e-5),
        low=-1e-3,
        high=1e-3,
        source="Bae and Sul (2003): 1.5 periods, 150 us at 10 kHz; engineering judgement: a fifth of it is left",
    )

    def on_response(self, response: Columns, conditions: Columns, kind: str, design: DqMachine) -> Columns:
        if kind != "dq_operation" or self.is_null:
            return response
        angle = design.pole_pairs * conditions["speed"] * self.delay
        cos, sin = np.cos(angle), np.sin(angle)
        v_d, v_q = response["v_d"], response["v_q"]
        return {**response, "v_d": cos * v_d - sin * v_q, "v_q": sin * v_d + cos * v_q}
