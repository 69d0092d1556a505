"""Warm winding."""

from __future__ import annotations

from dataclasses import dataclass, replace

from effects.base import DesignEffect
from effects.damper_design import Damper
from effects.dq_design import DqMachine
from effects.electrical.places import SERIES_RESISTANCE
from effects.parameter import parameter
from effects.prior import LogNormal
from materials.conductor import COPPER


@dataclass(frozen=True)
class WindingTemperature(DesignEffect):
    """The winding is warmer than the temperature its resistance was declared at: R = R_declared (1 + alpha rise).

    alpha = 0.00393 / K for copper at 20 degC (IEC 60028).
    """

    title = "warm winding"
    looks_like = "current and braking force fall at low total resistance, nothing changes at open terminals"
    remedy = ("phase resistance right after the run", "thermocouple in the end winding")
    designs = (Damper, DqMachine)
    signature = SERIES_RESISTANCE
    base_rate = 0.04
    base_rate_source = "engineering judgement: run warm and declared cold, one campaign in twenty-five"

    rise: float = parameter(
        0.0,
        "K",
        prior=LogNormal(30.0, 0.9),
        low=0.0,
        high=200.0,
        source="IEC 60085: insulation class H ends at 180 degC",
    )

    def on_design(self, design):
        warm = 1.0 + COPPER.temperature_coefficient * self.rise
        if isinstance(design, Damper):
            return replace(design, internal_resistance=design.internal_resistance * warm)
        return replace(design, resistance=design.resistance * warm)
