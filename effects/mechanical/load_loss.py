"""Load-proportional loss of the drive train."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from effects.law_effects import TorqueEffect
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Power, Touches


@dataclass(frozen=True)
class LoadLoss(TorqueEffect):
    """Gear, belt or coupling between machine and torque cell: T_shaft = T - share |T| tanh(speed / 0.1 rad/s)."""

    title = "load-proportional loss of the drive train"
    looks_like = "a share of the torque missing when motoring, as much too much when braking"
    remedy = ("torque cell on the machine's own shaft",)
    signature = (
        Touches("short_circuit.torque"),
        Touches("dq_supply.*"),
        Power("dq_operation.torque", "i_q", 1.0),
    )
    base_rate = 0.02
    base_rate_source = "engineering judgement: a stage between machine and torque cell, one bench in fifty"

    share: float = parameter(
        0.0,
        "1",
        prior=LogNormal(0.02, 0.7),
        low=0.0,
        high=0.3,
        source="textbook: 1 to 3 % a gear or belt stage (Niemann and Winter, Machine Elements)",
    )

    def lost_torque(self, speed, torque):
        return self.share * np.abs(torque) * np.tanh(speed / 0.1)
