"""Windage torque."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from effects.law_effects import TorqueEffect
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Odd, Power, Touches


@dataclass(frozen=True)
class WindageTorque(TorqueEffect):
    """Air driven round by rotor and fan: T_shaft = T - b speed |speed|."""

    title = "windage torque"
    looks_like = "missing torque that grows with the square of speed"
    remedy = ("drag up to the highest speed", "take the fan off")
    signature = (
        Odd("drag.torque", ("speed",)),
        Power("drag.torque", "speed", 2.0),
        Power("dq_operation.torque", "speed", 2.0),
        Touches("short_circuit.torque"),
        Touches("dq_supply.*"),
    )
    model_error = 0.006
    model_error_source = "benchmarks/law_errors.py: against |speed|^1.97"
    base_rate = 0.02
    base_rate_source = "engineering judgement: fan or bare spider at high speed, one machine in fifty"

    coefficient: float = parameter(
        0.0,
        "Nm s^2/rad^2",
        prior=LogNormal(3e-6, 1.2),
        low=0.0,
        high=1e-2,
        source="engineering judgement: fan-cooled kilowatt machines, 10 to 100 W at 3000 rpm",
    )

    def lost_torque(self, speed, torque):
        return self.coefficient * speed * np.abs(speed)
