"""Magnet flux falls with temperature."""

from __future__ import annotations

from dataclasses import dataclass, replace

from effects.base import DesignEffect
from effects.dq_design import DqMachine
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Power, Touches


@dataclass(frozen=True)
class RemanenceDrift(DesignEffect):
    """Magnets weaken with their measured temperature: psi_m = psi_ref (1 - coefficient (T_magnet - T_ref)).

    Needs a column magnet_T (or its best proxy) in the tables.
    """

    title = "magnet flux falls with temperature"
    looks_like = "back-EMF and torque per ampere fall with the magnet temperature"
    remedy = ("back-EMF hot and cold",)
    designs = (DqMachine,)
    signature = (
        Power("back_emf.v_ll", "speed", 1.0),
        Power("dq_operation.v_q", "speed", 1.0),
        Touches("dq_operation.torque"),
        Touches("short_circuit.*"),
        Touches("dq_supply.*"),
    )
    base_rate = 0.03
    base_rate_source = (
        "engineering judgement: device tables without a coefficient although the magnets are read, one in thirty"
    )

    coefficient: float = parameter(
        0.0,
        "1/K",
        prior=LogNormal(1.1e-3, 0.3),
        low=0.0,
        high=5e-3,
        source="NdFeB data sheets: 0.09 to 0.13 % per kelvin",
    )

    def on_design(self, design):
        return replace(design, remanence_coefficient=design.remanence_coefficient - self.coefficient)
