"""Resistance of leads and cables."""

from __future__ import annotations

from dataclasses import dataclass, replace

from effects.base import DesignEffect
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Touches

PHASES = "abc"


@dataclass(frozen=True)
class LeadResistance(DesignEffect):
    """Leads, cable and contacts are measured with the winding: R_x + resistance, in all phases or in one.

    What a two-wire reading has and a four-wire one avoids.
    """

    title = "resistance of leads and cables"
    looks_like = "phase resistance too high by the same ohms at every temperature, in one phase or in all"
    remedy = ("four-wire measurement at the winding's own ends", "tighten the terminals and measure again")
    designs = (MachineAsBuilt,)
    signature = (Touches("phase_resistance.r_?"),)
    base_rate = 0.05
    base_rate_source = "engineering judgement: the most usual fault of milliohm readings, one in twenty"

    phase: str = ""  # a, b or c; all of them when empty
    resistance: float = parameter(
        0.0,
        "ohm",
        prior=LogNormal(2e-3, 1.0),
        low=0.0,
        high=1.0,
        source="IEC 60228: 1 m of 10 mm^2 copper has 1.8 mohm; a crimp or screw 0.1 to 1 mohm",
    )

    @classmethod
    def variants(cls, design: MachineAsBuilt) -> tuple[LeadResistance, ...]:
        return tuple(cls(phase=x) for x in ("", *PHASES))

    def on_design(self, design: MachineAsBuilt) -> MachineAsBuilt:
        more = (self.resistance if self.phase in ("", x) else 0.0 for x in PHASES)
        return replace(design, lead_resistance=tuple(r + m for r, m in zip(design.lead_resistance, more)))
