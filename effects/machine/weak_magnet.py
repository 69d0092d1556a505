"""One weak magnet."""

from __future__ import annotations

from dataclasses import dataclass

from effects.base import DesignEffect
from effects.machine.places import FIELD
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameter
from effects.prior import LogNormal


@dataclass(frozen=True)
class WeakMagnet(DesignEffect):
    """One magnet has lost a share of its remanence; which one is an alternative."""

    title = "one weak magnet"
    looks_like = "cogging orders that are multiples of the slots, new orders beside the fundamental of the voltage"
    remedy = ("gaussmeter over every pole", "back-EMF of single coils")
    designs = (MachineAsBuilt,)
    signature = FIELD
    base_rate = 0.02
    base_rate_source = "judgement: overheated or cracked magnets"
    model_error = 0.02  # of a field solution on the mesh of a bench model, and of its expansion

    magnet: int = 0  # its number
    loss: float = parameter(
        0.0, "1", prior=LogNormal(0.10, 0.7), low=0.0, high=0.6, source="overheated or cracked magnet, 3 to 30 %"
    )

    @classmethod
    def variants(cls, design: MachineAsBuilt) -> tuple[WeakMagnet, ...]:
        return tuple(cls(magnet=k) for k in range(len(design.magnet_strengths)))

    def on_design(self, design: MachineAsBuilt) -> MachineAsBuilt:
        strength = design.magnet_strengths[self.magnet] * (1.0 - self.loss)
        return design.with_one("magnet_strengths", self.magnet, strength)
