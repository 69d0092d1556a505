"""Windage torque."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from effects.law_effects import TorqueEffect
from effects.parameter import parameter
from effects.prior import LogNormal


@dataclass(frozen=True)
class WindageTorque(TorqueEffect):
    """Air driven round by rotor and fan: T_shaft = T - b speed |speed|."""

    title = "windage torque"
    looks_like = "missing torque that grows with the square of speed"
    remedy = ("drag up to the highest speed", "take the fan off")
    model_error = 0.02

    coefficient: float = parameter(
        0.0, "Nm s^2/rad^2", prior=LogNormal(3e-6, 1.2), low=0.0, high=1e-2, source="fan-cooled kilowatt machines"
    )

    def lost_torque(self, speed, torque):
        return self.coefficient * speed * np.abs(speed)
