"""One phase unlike the others."""

from __future__ import annotations

from dataclasses import dataclass

from effects.base import DesignEffect
from effects.machine.places import PHASE_A
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameter
from effects.prior import Normal


@dataclass(frozen=True)
class PhaseImbalance(DesignEffect):
    """All coils of one phase have a share more (or fewer) turns than drawn; which phase is an alternative."""

    title = "one phase unlike the others"
    looks_like = "one phase off in voltage, flux change and resistance by the same share"
    remedy = ("resistance of the phases", "back-EMF of the phases")
    designs = (MachineAsBuilt,)
    signature = PHASE_A  # of the first variant
    base_rate = 0.01
    base_rate_source = "judgement: hand-wound phases"

    phase: int = 0  # 0 A, 1 B, 2 C
    share: float = parameter(0.0, "1", prior=Normal(0.02), low=-0.15, high=0.15, source="winding by hand")

    @classmethod
    def variants(cls, design: MachineAsBuilt) -> tuple[PhaseImbalance, ...]:
        return tuple(cls(phase=k) for k in range(3))

    def on_design(self, design: MachineAsBuilt) -> MachineAsBuilt:
        return design.with_phase_turns(self.phase, 1.0 + self.share) if self.share else design
