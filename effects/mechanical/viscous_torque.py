"""Viscous bearing torque."""

from __future__ import annotations

from dataclasses import dataclass

from effects.law_effects import TorqueEffect
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Odd, Power, Touches


@dataclass(frozen=True)
class ViscousTorque(TorqueEffect):
    """Grease in the bearings: T_shaft = T - c speed."""

    title = "viscous bearing torque"
    looks_like = "missing torque in proportion to speed, without extra electrical power at the same currents"
    remedy = ("drag hot and cold", "drag with a dummy without magnets")
    signature = (
        Odd("drag.torque", ("speed",)),
        Power("drag.torque", "speed", 1.0),
        Power("dq_operation.torque", "speed", 1.0),
        Power("dq_operation.torque", "i_q", 0.0),
        Touches("short_circuit.torque"),
        Touches("dq_supply.*"),
    )
    base_rate = 0.05
    base_rate_source = "engineering judgement: grease of the bearings, half as often named as dry friction"

    coefficient: float = parameter(
        0.0,
        "Nm s/rad",
        prior=LogNormal(1e-3, 1.2),
        low=0.0,
        high=1.0,
        source="engineering judgement: 0.1 to 1 % of rated torque at rated speed",
    )

    def lost_torque(self, speed, torque):
        return self.coefficient * speed
