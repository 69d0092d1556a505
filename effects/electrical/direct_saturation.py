"""Saturation of the d axis."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from effects.law_effects import FluxEffect
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Even, Power, Touches


@dataclass(frozen=True)
class DirectSaturation(FluxEffect):
    """The magnets hold the d axis near saturation, current against them relieves it: psi_d = psi_m + L_d i_d - k i_d^2.

    From the co-energy -k i_d^3 / 3: psi_q is untouched. The differential inductance L_d - 2 k i_d falls forwards.
    """

    title = "saturation of the d axis"
    looks_like = "v_q falls with the square of i_d, either sign of it alike; short-circuit current changes"
    remedy = ("flux linkage against i_d at standstill, both signs",)
    signature = (
        Even("dq_operation.v_q", ("i_d",)),
        Power("dq_operation.v_q", "i_d", 2.0),
        Power("dq_operation.v_q", "speed", 1.0),
        Power("dq_operation.torque", "i_d", 2.0),
        Power("dq_operation.torque", "i_q", 1.0),
        Touches("short_circuit.*"),
        Touches("dq_supply.*"),
    )
    model_error = 0.05
    size_error = 0.23
    model_error_source = "benchmarks/law_errors.py: against tanh with the same slope and curvature"
    base_rate = 0.02
    base_rate_source = "engineering judgement: small beside the q axis, whose saturation is met three times as often"

    coefficient: float = parameter(
        0.0,
        "Vs/A^2",
        prior=LogNormal(5e-6, 1.8),
        low=0.0,
        high=1e-2,
        source="engineering judgement: L_d changes by a tenth between rated currents of either sign, 10 to 300 A",
    )

    def flux(self, i_d, i_q, machine):
        return -self.coefficient * i_d**2, np.zeros_like(i_q)
