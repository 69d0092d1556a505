"""Windage of the rotor of a machine on its bench."""

from __future__ import annotations

from dataclasses import dataclass, replace

from effects.base import DesignEffect
from effects.machine.places import SPEED
from effects.machine_design import BuiltMachine
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Odd, Power


@dataclass(frozen=True)
class RotorWindage(DesignEffect):
    """Air driven round by the rotor and what is fixed to it: T - c speed |speed|."""

    title = "windage of the rotor"
    looks_like = "drag that grows with the square of the speed"
    remedy = ("drag up to the highest speed", "drag with the fan or the open coupling covered")
    designs = (BuiltMachine,)
    signature = (*SPEED, Odd("drag.torque", ("speed",)), Power("drag.torque", "speed", 2.0))
    base_rate = 0.005
    base_rate_source = "judgement: seen with fans and at high speed only"

    coefficient: float = parameter(
        0.0,
        "Nm s^2/rad^2",
        prior=LogNormal(1e-8, 2.0),
        low=0.0,
        high=1e-3,
        source="smooth rotors of 15 mm radius 1e-10 (C_M = 0.01), with a fan 1e-6",
    )

    def on_design(self, design: BuiltMachine) -> BuiltMachine:
        return replace(design, windage=design.windage + self.coefficient)
