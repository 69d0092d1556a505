"""More iron loss than the sheet's data say."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from effects.base import DesignEffect
from effects.machine.places import CREEP, SPEED
from effects.machine_design import BuiltMachine
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Odd


@dataclass(frozen=True)
class IronLossExcess(DesignEffect):
    """The stack loses more than the declared data of its sheet: P = (1 + excess) P_sheet."""

    title = "iron loss beyond the data of the sheet"
    looks_like = "drag above the model in the proportion of the iron loss, at every speed"
    remedy = ("drag with a rotor without magnets, and the difference", "loss of a stamped ring")
    designs = (BuiltMachine,)
    signature = (*SPEED, *CREEP, Odd("drag.torque", ("speed",)))
    base_rate = 0.03
    base_rate_source = "judgement: punching, welding and flux that turns make it the rule, a declared factor holds most"

    excess: float = parameter(
        0.0, "1", prior=LogNormal(0.5, 0.6), low=0.0, high=5.0, source="building factors of small machines 1.2 to 2.5"
    )

    @classmethod
    def can_act_on(cls, design: Any) -> bool:
        return super().can_act_on(design) and design.iron_loss is not None

    def on_design(self, design: BuiltMachine) -> BuiltMachine:
        return replace(design, iron_loss_factor=design.iron_loss_factor * (1.0 + self.excess))
