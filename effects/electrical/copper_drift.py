"""Resistance rises with temperature."""

from __future__ import annotations

from dataclasses import dataclass, replace

from effects.base import DesignEffect
from effects.dq_design import DqMachine
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Touches
from materials.conductor import COPPER


@dataclass(frozen=True)
class CopperDrift(DesignEffect):
    """Resistance follows the measured winding temperature: R = R_ref (1 + coefficient (T_winding - T_ref))."""

    title = "resistance rises with temperature"
    looks_like = "copper loss and v_q at low speed rise with the winding temperature"
    remedy = ("phase resistance hot and cold",)
    designs = (DqMachine,)
    signature = (
        Touches("dq_operation.v_d"),
        Touches("dq_operation.v_q"),
        Touches("short_circuit.*"),
        Touches("dq_supply.*"),
        Touches("phase_resistance.resistance"),
    )
    base_rate = 0.03
    base_rate_source = (
        "engineering judgement: device tables without a coefficient although the winding is read, one in thirty"
    )

    coefficient: float = parameter(
        0.0,
        "1/K",
        prior=LogNormal(COPPER.temperature_coefficient, 0.1),
        low=0.0,
        high=0.01,
        source="IEC 60028: copper 0.393 %/K at 20 degC; alloys and end effects 10 %",
    )

    def on_design(self, design):
        return replace(design, copper_coefficient=design.copper_coefficient + self.coefficient)
