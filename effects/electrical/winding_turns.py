"""Other number of turns."""

from __future__ import annotations

from dataclasses import dataclass

from effects.base import DesignEffect
from effects.dq_design import DqMachine
from effects.drawn_design import DrawnAsBuilt
from effects.parameter import parameter
from effects.prior import Normal
from effects.signature import Power, Touches


@dataclass(frozen=True)
class WindingTurns(DesignEffect):
    """Another number of turns than declared: psi_m with n, inductances and resistance with n^2 (same slot fill)."""

    title = "other number of turns"
    looks_like = "back-EMF, inductances and resistance all off in the ratio n : n^2 : n^2"
    remedy = ("count, or phase resistance together with back-EMF",)
    designs = (DqMachine, DrawnAsBuilt)
    signature = (
        Power("back_emf.v_ll", "speed", 1.0),
        Touches("dq_operation.v_d"),
        Touches("dq_operation.v_q"),
        Touches("dq_operation.torque"),
        Touches("short_circuit.current"),
        Touches("dq_supply.*"),
        Touches("phase_resistance.resistance"),
    )
    base_rate = 0.01
    base_rate_source = "engineering judgement: a winding other than on the drawing, one prototype in a hundred"

    change: float = parameter(
        0.0, "1", prior=Normal(0.05), low=-0.5, high=0.5, source="geometry: one turn of ten to forty"
    )

    def on_design(self, design):
        return design.with_turns(1.0 + self.change)
