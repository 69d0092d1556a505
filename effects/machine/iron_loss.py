"""Iron loss that nobody declared."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from effects.base import DesignEffect
from effects.machine.places import CREEP, SPEED
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Odd


@dataclass(frozen=True)
class IronLoss(DesignEffect):
    """The stator steel takes power when its flux turns: ``factor`` times that of a 0.35 mm sheet, M235-35A.

    T_drag = factor P(speed)/speed, P of hysteresis, eddies and excess (``materials.iron_loss``). At a creeping speed
    its hysteresis is a torque against the motion, as of dry friction. It acts where the campaign declares no loss data.
    """

    title = "iron loss"
    looks_like = "drag that starts at a level, as dry friction, and rises with the speed; it falls with warm magnets"
    remedy = ("drag with a rotor without magnets, and the difference", "drag over speed")
    designs = (MachineAsBuilt,)
    signature = (*SPEED, *CREEP, Odd("drag.torque", ("speed",)))
    base_rate = 0.02
    base_rate_source = "judgement: always there, but a campaign that can show it mostly declares the sheet's loss data"

    factor: float = parameter(
        0.0, "1", prior=LogNormal(1.2, 0.5), low=0.0, high=8.0, source="sheets of 0.3 to 0.65 mm as punched"
    )

    @classmethod
    def can_act_on(cls, design: Any) -> bool:
        return super().can_act_on(design) and design.iron_loss is None

    def on_design(self, design: MachineAsBuilt) -> MachineAsBuilt:
        return replace(design, undeclared_iron_loss=design.undeclared_iron_loss + self.factor)
