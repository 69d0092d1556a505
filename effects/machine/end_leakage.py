"""End leakage."""

from __future__ import annotations

from dataclasses import dataclass, replace

from effects.machine.magnet_effect import MagnetEffect
from effects.machine.places import LEAKAGE
from effects.machine_design import BuiltMachine
from effects.parameter import parameter
from effects.prior import LogNormal


@dataclass(frozen=True)
class EndLeakage(MagnetEffect):
    """A share of the magnets' flux closes beyond the ends of the stack instead of through the winding.

    Voltage and the torque of magnets and current fall by the share, cogging by its square, flux change not at all.
    """

    title = "end leakage"
    looks_like = "voltage and torque constant lower as with warm magnets, flux change with current unchanged"
    remedy = ("flux linkage against current", "a longer and a shorter stack")
    signature = LEAKAGE
    base_rate = 0.02
    base_rate_source = "judgement: every short machine has some, designs mostly allow for it"

    share: float = parameter(
        0.0, "1", prior=LogNormal(0.04, 0.6), low=0.0, high=0.3, source="stacks shorter than their bore: 2 to 10 %"
    )

    def on_design(self, design: BuiltMachine) -> BuiltMachine:
        return replace(design, end_leakage=design.end_leakage + self.share)
