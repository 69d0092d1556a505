"""Dry friction of the bearings of a machine on its bench."""

from __future__ import annotations

from dataclasses import dataclass, replace

from effects.base import DesignEffect
from effects.machine.places import CREEP, SPEED
from effects.machine_design import BuiltMachine
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Odd, Power


@dataclass(frozen=True)
class BearingFriction(DesignEffect):
    """Dry friction of the bearings between torque cell and rotor: the cell reads T - level sign(motion).

    It acts wherever the direction of the motion is known: by the speed, or by a column ``direction``.
    """

    title = "dry friction of the bearings"
    looks_like = "both directions of a cogging scan apart by twice the same torque"
    remedy = ("drag with a rotor without magnets",)
    designs = (BuiltMachine,)
    signature = (*SPEED, *CREEP, Odd("drag.torque", ("speed",)), Power("drag.torque", "speed", 0.0))
    base_rate = 0.9
    base_rate_source = "judgement: every rotor turns in bearings, and one bench in ten declares their friction"

    level: float = parameter(
        0.0, "Nm", prior=LogNormal(0.01, 1.0), low=0.0, high=1.0, source="small ball bearings with seals, 1 to 50 mNm"
    )

    def on_design(self, design: BuiltMachine) -> BuiltMachine:
        return replace(design, dry_friction=design.dry_friction + self.level)
