"""North and south magnets from two batches."""

from __future__ import annotations

from dataclasses import dataclass, replace

from effects.base import DesignEffect
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameter
from effects.prior import Normal


@dataclass(frozen=True)
class TwoMagnetBatches(DesignEffect):
    """North magnets are stronger than south ones: B_r (1 + difference/2) and B_r (1 - difference/2)."""

    title = "north and south magnets unlike"
    looks_like = "even electrical orders in the voltage where the winding does not cancel them, faint cogging orders"
    remedy = ("gaussmeter over a north and a south pole",)
    designs = (MachineAsBuilt,)
    base_rate = 0.01
    base_rate_source = "judgement: magnets magnetised before gluing come in two kinds, sometimes from two boxes"

    difference: float = parameter(
        0.0, "1", prior=Normal(0.02), low=-0.3, high=0.3, source="batches of one grade differ by 1 to 3 %"
    )

    def on_design(self, design: MachineAsBuilt) -> MachineAsBuilt:
        signs = (0.5 if k % 2 == 0 else -0.5 for k in range(design.machine.poles))
        strengths = tuple(b * (1.0 + sign * self.difference) for b, sign in zip(design.magnet_strengths, signs))
        return replace(design, magnet_strengths=strengths)
