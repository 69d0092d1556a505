"""One slot opening unlike the others."""

from __future__ import annotations

from dataclasses import dataclass

from effects.base import DesignEffect
from effects.machine.places import FIELD
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameter
from effects.prior import Normal
from units import MILLIMETRE


@dataclass(frozen=True)
class WideSlot(DesignEffect):
    """One slot opens wider (or narrower) to the gap than the others; which one is an alternative."""

    title = "one slot opening unlike the others"
    looks_like = "cogging orders that are multiples of the poles, no new orders in the voltage"
    remedy = ("width of the openings",)
    designs = (MachineAsBuilt,)
    signature = FIELD
    base_rate = 0.01
    base_rate_source = "judgement: a damaged or burred tooth"
    model_error = 0.06  # NGSolve has 2 to 13 % less cogging of the first three orders of the poles (9 slots, 8 poles)

    slot: int = 0  # its number
    change: float = parameter(
        0.0,
        "m",
        prior=Normal(0.3 * MILLIMETRE),
        low=-1.0 * MILLIMETRE,
        high=1.0 * MILLIMETRE,
        source="damaged or burred teeth",
    )

    @classmethod
    def variants(cls, design: MachineAsBuilt) -> tuple[WideSlot, ...]:
        return tuple(cls(slot=k) for k in range(len(design.opening_changes)))

    def on_design(self, design: MachineAsBuilt) -> MachineAsBuilt:
        change = design.opening_changes[self.slot] + self.change
        return design.with_one("opening_changes", self.slot, change)
