"""Saturation of the steel."""

from __future__ import annotations

from dataclasses import dataclass, replace

from effects.base import DesignEffect
from effects.machine.places import FIELD
from effects.machine_design import BuiltMachine
from effects.parameter import parameter
from effects.prior import Normal


@dataclass(frozen=True)
class SteelSaturation(DesignEffect):
    """The steel saturates at another polarisation than its grade: J(H) = (1 + change) J_grade(H/(1 + change))."""

    title = "saturation of the steel"
    looks_like = "flux change and torque at the highest currents off, little at low current"
    remedy = ("flux linkage at the highest current", "ring sample")
    designs = (BuiltMachine,)
    signature = FIELD
    base_rate = 0.01
    base_rate_source = "judgement: another alloy"
    model_error = 0.02  # of a field solution on the mesh of a bench model, and of its expansion

    change: float = parameter(0.0, "1", prior=Normal(0.04), low=-0.2, high=0.2, source="silicon content, 1.95 to 2.1 T")

    def on_design(self, design: BuiltMachine) -> BuiltMachine:
        return replace(design, saturation_scale=design.saturation_scale * (1.0 + self.change))
