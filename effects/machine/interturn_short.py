"""Turns of one coil shorted among themselves."""

from __future__ import annotations

from dataclasses import dataclass, replace

from effects.base import DesignEffect
from effects.machine.places import PHASE_A, SPEED
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameter
from effects.prior import LogNormal


@dataclass(frozen=True)
class InterturnShort(DesignEffect):
    """Some turns of one coil are closed on themselves: lost to their phase, and braking; which coil is an alternative.

    The magnets drive a current through them, T = -sum of orders of (e^2/2) R/(R^2 + X^2)/speed: in proportion to the
    speed while the resistance R of the turns limits it.
    """

    title = "short between turns of one coil"
    looks_like = "as turns missing in one coil, and a drag that rises with the speed, at low speed in proportion to it"
    remedy = ("drag over speed", "resistance and back-EMF of single coils", "surge test")
    designs = (MachineAsBuilt,)
    signature = (*PHASE_A, *SPEED)  # of the first variant
    contains = ("lost_turns",)
    base_rate = 0.005
    base_rate_source = "judgement: hand-wound prototypes now and then; a finished machine fails by it"

    coil: int = 0  # its number
    turns: float = parameter(0.0, "1", prior=LogNormal(1.0, 0.5), low=0.0, high=20.0, source="one or two turns touch")

    @classmethod
    def variants(cls, design: MachineAsBuilt) -> tuple[InterturnShort, ...]:
        return tuple(cls(coil=k) for k in range(len(design.turns)))

    def on_design(self, design: MachineAsBuilt) -> MachineAsBuilt:
        if not self.turns:
            return design
        shorted = min(self.turns, design.turns[self.coil])
        open_turns = design.without_turns(self.coil, shorted)
        return replace(open_turns, shorted_turns=shorted, shorted_coil=self.coil)
