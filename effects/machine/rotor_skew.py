"""Skew."""

from __future__ import annotations

from dataclasses import dataclass, replace

from effects.base import DesignEffect
from effects.machine.places import FIELD
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameter
from effects.prior import LogNormal
from units import DEGREE


@dataclass(frozen=True)
class RotorSkew(DesignEffect):
    """Rotor and stator are turned against each other along the length, evenly, by ``angle`` from end to end.

    Every order m over the revolution is multiplied by sin(m angle/2)/(m angle/2).
    """

    title = "skew"
    looks_like = "cogging falls most, then the higher harmonics of the voltage"
    remedy = ("cogging", "look along the magnets")
    designs = (MachineAsBuilt,)
    signature = FIELD
    base_rate = 0.01
    base_rate_source = "judgement: rotors put together without a jig"
    model_error = 0.02  # of a field solution on the mesh of a bench model, and of its expansion

    angle: float = parameter(
        0.0, "rad", prior=LogNormal(1.0 * DEGREE, 0.7), low=0.0, high=15 * DEGREE, source="assembly of rotor segments"
    )

    def on_design(self, design: MachineAsBuilt) -> MachineAsBuilt:
        return replace(design, skew=design.skew + self.angle)
