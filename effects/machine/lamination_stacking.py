"""Stacking factor."""

from __future__ import annotations

from dataclasses import dataclass, replace

from effects.base import DesignEffect
from effects.machine.places import FIELD
from effects.machine_design import BuiltMachine
from effects.parameter import parameter
from effects.prior import LogNormal


@dataclass(frozen=True)
class LaminationStacking(DesignEffect):
    """Insulation takes a share of the length: B = k B_steel(H) + (1 - k) mu_0 H, k = k_drawn - loss."""

    title = "stacking factor"
    looks_like = "less torque and flux change at high current, little without current"
    remedy = ("weight of the stack", "flux linkage at the highest current")
    designs = (BuiltMachine,)
    signature = FIELD
    exceeds = "stacking_factor"
    base_rate = 0.01
    base_rate_source = "judgement: declared stacking factors are good to 1 or 2 %"
    model_error = 0.02  # of a field solution on the mesh of a bench model, and of its expansion

    loss: float = parameter(
        0.0, "1", prior=LogNormal(0.04, 0.5), low=0.0, high=0.2, source="stacking factors 0.90 to 0.98"
    )

    def on_design(self, design: BuiltMachine) -> BuiltMachine:
        return replace(design, stacking_factor=design.stacking_factor - self.loss)
