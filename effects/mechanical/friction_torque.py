"""Dry friction or hysteresis torque."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from effects.law_effects import TorqueEffect
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Odd, Power, Touches

REVERSAL = 0.1  # rad/s, rounds the reversal


@dataclass(frozen=True)
class FrictionTorque(TorqueEffect):
    """Dry friction of bearings and seals, or hysteresis of the iron: T_shaft = T - level tanh(speed / 0.1 rad/s)."""

    title = "dry friction or hysteresis torque"
    looks_like = "the same torque missing at every speed and current, the other way when turning back"
    remedy = ("drag with a dummy without magnets tells friction from hysteresis",)
    signature = (
        Odd("drag.torque", ("speed",)),
        Power("drag.torque", "speed", 0.0),
        Power("dq_operation.torque", "i_q", 0.0),
        Touches("short_circuit.torque"),
        Touches("dq_supply.*"),
    )
    base_rate = 0.1
    base_rate_source = "engineering judgement: every shaft has bearings; undeclared and visible in one of ten"

    level: float = parameter(
        0.0,
        "Nm",
        prior=LogNormal(0.1, 1.2),
        low=0.0,
        high=50.0,
        source="engineering judgement: 0.1 to 1 % of rated torque",
    )

    def lost_torque(self, speed, torque):
        return self.level * np.tanh(speed / REVERSAL)
