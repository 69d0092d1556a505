"""Permeability of the steel."""

from __future__ import annotations

from dataclasses import dataclass, replace

from effects.base import DesignEffect
from effects.machine.places import FIELD
from effects.machine_design import BuiltMachine
from effects.parameter import parameter
from effects.prior import LogNormal


@dataclass(frozen=True)
class SteelGrade(DesignEffect):
    """The steel needs more field than its grade for the same polarisation: J(H) = J_grade(H/(1 + excess)).

    B = J + mu_0 H: it saturates at the same polarisation, with the slope mu_0 beyond.
    """

    title = "permeability of the steel"
    looks_like = "slightly lower flux everywhere, most where the steel begins to saturate"
    remedy = ("ring sample", "flux linkage over current")
    designs = (BuiltMachine,)
    signature = FIELD
    base_rate = 0.01
    base_rate_source = "judgement: another grade or sheet not annealed"
    model_error = 0.02  # of a field solution on the mesh of a bench model, and of its expansion

    excess: float = parameter(
        0.0, "1", prior=LogNormal(0.4, 0.6), low=0.0, high=3.0, source="grades and stress after punching"
    )

    def on_design(self, design: BuiltMachine) -> BuiltMachine:
        return replace(design, field_scale=design.field_scale * (1.0 + self.excess))
