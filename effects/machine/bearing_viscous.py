"""Viscous friction of the bearings of a machine on its bench."""

from __future__ import annotations

from dataclasses import dataclass, replace

from effects.base import DesignEffect
from effects.machine.places import SPEED
from effects.machine_design import BuiltMachine
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Odd, Power


@dataclass(frozen=True)
class BearingViscous(DesignEffect):
    """Viscous drag of bearings and grease: T - slope speed, wherever the speed is known."""

    title = "viscous friction of the bearings"
    looks_like = "drag in proportion to the speed"
    remedy = ("drag with a rotor without magnets",)
    designs = (BuiltMachine,)
    signature = (*SPEED, Odd("drag.torque", ("speed",)), Power("drag.torque", "speed", 1.0))
    base_rate = 0.03
    base_rate_source = "judgement: greased bearings have it, seals and dry friction hide most of it"

    slope: float = parameter(0.0, "Nms/rad", prior=LogNormal(2e-5, 1.0), low=0.0, high=0.1, source="greased bearings")

    def on_design(self, design: BuiltMachine) -> BuiltMachine:
        return replace(design, viscous_friction=design.viscous_friction + self.slope)
