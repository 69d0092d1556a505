"""Weaker magnets (warm or aged)."""

from __future__ import annotations

from dataclasses import dataclass, replace

from effects.base import DesignEffect
from effects.damper_design import Damper
from effects.dq_design import DqMachine
from effects.parameter import parameter
from effects.prior import LogNormal


@dataclass(frozen=True)
class WeakMagnets(DesignEffect):
    """All magnets weaker than declared, because warm or aged: K = K_declared (1 - loss), psi_m likewise.

    NdFeB loses about 0.11 % of its remanence per kelvin, so a loss of 0.05 is a rise of 45 K.
    """

    title = "weaker magnets (warm or aged)"
    looks_like = "back-EMF falls with the loss, damping with twice the loss, at all speeds alike"
    remedy = ("back-EMF of the cold machine", "gaussmeter")
    designs = (Damper, DqMachine)

    loss: float = parameter(
        0.0, "1", prior=LogNormal(0.05, 0.9), low=0.0, high=0.6, source="NdFeB data sheets: 0.09 to 0.13 % per kelvin"
    )

    def on_design(self, design):
        if isinstance(design, Damper):
            return replace(design, force_constant=design.force_constant * (1.0 - self.loss))
        return replace(design, psi_m=design.psi_m * (1.0 - self.loss))
