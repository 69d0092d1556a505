"""Resistance of a lead or joint before the winding."""

from __future__ import annotations

from dataclasses import dataclass, replace

from effects.base import DesignEffect
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameter
from effects.prior import LogNormal

ALL = 3  # instead of the number of a phase


@dataclass(frozen=True)
class LeadResistance(DesignEffect):
    """A lead or a joint in series with one phase, or with every phase: R_read = R + r; which is an alternative."""

    title = "resistance of leads and joints"
    looks_like = "resistance higher in one phase or in all, by the same ohms at every temperature; voltages unchanged"
    remedy = ("four wires at the winding itself", "resistance while the joint is pressed")
    designs = (MachineAsBuilt,)
    base_rate = 0.02
    base_rate_source = "judgement: two-wire readings and crimped joints are met now and then"

    phase: int = 0  # 0 A, 1 B, 2 C, 3 all
    resistance: float = parameter(
        0.0, "ohm", prior=LogNormal(5e-4, 1.2), low=0.0, high=1.0, source="10 cm of 2.5 mm^2 copper is 0.7 mohm"
    )

    @classmethod
    def variants(cls, design: MachineAsBuilt) -> tuple[LeadResistance, ...]:
        return tuple(cls(phase=k) for k in (0, 1, 2, ALL))

    def on_design(self, design: MachineAsBuilt) -> MachineAsBuilt:
        more = [self.resistance * (self.phase in (k, ALL)) for k in range(3)]
        return replace(design, lead_resistance=tuple(a + b for a, b in zip(design.lead_resistance, more)))
