"""Weaker magnets (warm or aged)."""

from __future__ import annotations

from dataclasses import dataclass, replace

from effects.base import DesignEffect
from effects.damper_design import Damper
from effects.dq_design import DqMachine
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Power, Touches


@dataclass(frozen=True)
class WeakMagnets(DesignEffect):
    """All magnets weaker than declared, because warm or aged: K = K_declared (1 - loss), psi_m likewise.

    NdFeB loses about 0.11 % of its remanence per kelvin, so a loss of 0.05 is a rise of 45 K.
    """

    title = "weaker magnets (warm or aged)"
    looks_like = "back-EMF falls with the loss, damping with twice the loss, at all speeds alike"
    remedy = ("back-EMF of the cold machine", "gaussmeter")
    designs = (Damper, DqMachine)
    signature = (
        Power("damping_velocity.force", "velocity", 1.0),
        Power("back_emf.voltage", "velocity", 1.0),
        Touches("damping_shunt.damping"),
        Touches("impedance.re"),
        Touches("short_circuit.*"),
        Touches("dq_supply.*"),
        Power("back_emf.v_ll", "speed", 1.0),
        Power("dq_operation.v_q", "speed", 1.0),
        Power("dq_operation.torque", "i_q", 1.0),
    )
    base_rate = 0.03
    base_rate_source = (
        "engineering judgement: magnets warmer than their data sheet or of a lower grade, one device in thirty"
    )

    loss: float = parameter(
        0.0, "1", prior=LogNormal(0.05, 0.9), low=0.0, high=0.6, source="NdFeB data sheets: 0.09 to 0.13 % per kelvin"
    )

    def on_design(self, design):
        if isinstance(design, Damper):
            return replace(design, force_constant=design.force_constant * (1.0 - self.loss))
        return replace(design, psi_m=design.psi_m * (1.0 - self.loss))
