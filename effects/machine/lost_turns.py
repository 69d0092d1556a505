"""Turns missing in one coil."""

from __future__ import annotations

from dataclasses import dataclass

from effects.base import DesignEffect
from effects.machine.places import PHASE_A
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameter
from effects.prior import LogNormal


@dataclass(frozen=True)
class LostTurns(DesignEffect):
    """One coil has fewer turns that count than drawn (wound short, or shorted and idle); which one is an alternative.

    Its flux linkage, ampere-turns and resistance fall with its turns. The current that shorted turns carry when the
    machine runs is left out: it brakes, and is small at the speed of a bench. More than all turns cannot be missing.
    """

    title = "turns missing in one coil"
    looks_like = "one phase lower in voltage, flux change and resistance, torque ripple with the poles"
    remedy = ("resistance and back-EMF of single coils",)
    designs = (MachineAsBuilt,)
    signature = PHASE_A  # of the first variant
    base_rate = 0.01
    base_rate_source = "judgement: hand-wound coils"

    coil: int = 0  # its number
    turns: float = parameter(
        0.0, "1", prior=LogNormal(0.7, 0.6), low=0.0, high=20.0, source="one turn wound short or shorted"
    )

    @classmethod
    def variants(cls, design: MachineAsBuilt) -> tuple[LostTurns, ...]:
        return tuple(cls(coil=k) for k in range(len(design.turns)))

    def on_design(self, design: MachineAsBuilt) -> MachineAsBuilt:
        if not self.turns:
            return design
        return design.without_turns(self.coil, min(self.turns, design.turns[self.coil]))
