"""Other L_q than declared."""

from __future__ import annotations

from dataclasses import dataclass, replace

from effects.base import DesignEffect
from effects.dq_design import DqMachine
from effects.parameter import parameter
from effects.prior import Normal
from effects.signature import Power, Touches


@dataclass(frozen=True)
class QuadratureInductance(DesignEffect):
    """L_q differs from the declared value: L_q = L_declared (1 + change)."""

    title = "other L_q than declared"
    looks_like = "v_d changes with i_q and speed, at small currents too"
    remedy = ("inductance meter with the rotor locked on q",)
    designs = (DqMachine,)
    signature = (
        Power("dq_operation.v_d", "i_q", 1.0),
        Power("dq_operation.v_d", "speed", 1.0),
        Power("dq_operation.torque", "i_d", 1.0),
        Touches("short_circuit.*"),
        Touches("dq_supply.*"),
    )
    base_rate = 0.03
    base_rate_source = (
        "engineering judgement: calculated instead of measured, one machine in thirty beyond its tolerance"
    )

    change: float = parameter(
        0.0,
        "1",
        prior=Normal(0.10),
        low=-0.6,
        high=1.5,
        source="engineering judgement: leakage and gap tolerance move L_q by 10 %",
    )

    def on_design(self, design):
        return replace(design, inductance_q=design.inductance_q * (1.0 + self.change))
