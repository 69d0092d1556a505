"""Magnets warm up during the test."""

from __future__ import annotations

from dataclasses import dataclass

from effects.base import Columns, StateEffect
from effects.dq_design import DqMachine
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Like, Touches


@dataclass(frozen=True)
class MagnetHeating(StateEffect):
    """The magnets warm, and weaken, through each scan: psi_m = psi_declared (1 - fall order), order from 0 to 1."""

    title = "magnets warm up during the test"
    looks_like = "back-EMF and torque per ampere lower in the last rows of a scan than in the first"
    remedy = ("back-EMF before and after", "repeat the first point at the end")
    designs = (DqMachine,)
    signature = (
        Like("back_emf.v_ll", lambda at: at["order"] * at["speed"]),
        Like("dq_operation.v_q", lambda at: at["order"] * at["speed"]),
        Like("dq_operation.torque", lambda at: at["order"] * at["i_q"]),
        Touches("short_circuit.*"),
        Touches("dq_supply.*"),
    )
    base_rate = 0.02
    base_rate_source = "engineering judgement: long runs at high speed, one campaign in fifty without a rotor reading"

    fall: float = parameter(
        0.0,
        "1",
        prior=LogNormal(0.01, 0.9),
        low=0.0,
        high=0.2,
        source="NdFeB data sheets: 0.09 to 0.13 % per kelvin; engineering judgement: 3 to 30 K a scan",
    )

    def on_state(self, conditions: Columns, kind: str, design: DqMachine) -> Columns:
        weak = 1.0 - self.fall * conditions["order"]
        return {**conditions, "flux_factor": conditions.get("flux_factor", 1.0) * weak}
