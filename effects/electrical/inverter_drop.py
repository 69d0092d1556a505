"""Inverter dead time or voltage drop."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from effects.base import ResponseEffect
from effects.dq_design import DqMachine
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Odd, Power


@dataclass(frozen=True)
class InverterDrop(ResponseEffect):
    """Dead time and switch drop: commanded voltages exceed those at the machine by a constant along the current.

    v_dq = v_dq,machine + drop i_dq / sqrt(i_d^2 + i_q^2 + i_0^2), i_0 = 1 % of the table's largest current.
    Source: Choi and Sul, IEEE Trans. IA 32 (1996): drop = 4 / pi * (dead time * f_s * V_dc + switch drop).
    """

    title = "inverter dead time or voltage drop"
    looks_like = "a constant voltage along the current that does not depend on speed"
    remedy = ("voltage measured at the terminals instead of commanded", "two DC-link voltages")
    designs = (DqMachine,)
    signature = (
        Power("dq_operation.v_d", "speed", 0.0),
        Power("dq_operation.v_q", "speed", 0.0),
        Odd(
            "dq_operation.v_q",
            (
                "i_q",
                "i_d",
            ),
        ),
    )
    base_rate = 0.05
    base_rate_source = "engineering judgement: commanded instead of measured voltages, one drive in twenty"

    drop: float = parameter(
        0.0,
        "V",
        prior=LogNormal(1.5, 0.8),
        low=0.0,
        high=40.0,
        source="Choi and Sul (1996): 2 us at 10 kHz and 100 to 400 V",
    )

    def on_response(self, response, conditions, kind, design):
        if kind != "dq_operation":
            return response
        i_d, i_q = conditions["i_d"], conditions["i_q"]
        size = np.sqrt(i_d**2 + i_q**2 + 1e-4 * np.max(i_d**2 + i_q**2))
        v_d, v_q = response["v_d"] + self.drop * i_d / size, response["v_q"] + self.drop * i_q / size
        return {**response, "v_d": v_d, "v_q": v_q}
