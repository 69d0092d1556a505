"""Viscosity falls with temperature."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from effects.base import Columns, StateEffect
from effects.damper_design import Damper
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Odd, Power

COLUMNS = ("damper_T", "oil_T", "grease_T")  # degC, the first that a table has
REFERENCE = 20.0  # degC, at which the viscous damping was declared


@dataclass(frozen=True)
class ViscosityTemperature(StateEffect):
    """Oil or grease thins with its measured temperature: c = c_declared exp(-coefficient (T - 20 degC)).

    Needs a column damper_T, oil_T or grease_T. Source: Reynolds (1886), the exponential law of lubricants.
    """

    title = "viscosity falls with temperature"
    looks_like = "viscous damping falls as the measured temperature of oil or grease rises, the rest stays"
    remedy = ("drag at open terminals, cold and warm",)
    designs = (Damper,)
    signature = (
        Odd("damping_velocity.force", ("velocity",)),
        Power("damping_velocity.force", "velocity", 1.0),
        Power("damping_velocity.force", "shunt", 0.0),
    )
    model_error = 0.027
    size_error = 0.081
    model_error_source = (
        "benchmarks/law_errors.py: against Walther's law (ASTM D341) of an ISO VG 32 oil, 20 to 45 degC"
    )
    base_rate = 0.01
    base_rate_source = "engineering judgement: needs a temperature reading, which few damper files have"

    coefficient: float = parameter(
        0.0,
        "1/K",
        prior=LogNormal(0.03, 0.5),
        low=0.0,
        high=0.2,
        source="textbook: mineral oils lose half their viscosity in 15 to 30 K near room temperature",
    )

    def on_state(self, conditions: Columns, kind: str, design: Damper) -> Columns:
        found = [name for name in COLUMNS if name in conditions]
        if not found or self.is_null:
            return conditions
        thin = np.exp(-self.coefficient * (conditions[found[0]] - REFERENCE))
        return {**conditions, "viscous_factor": conditions.get("viscous_factor", 1.0) * thin}
