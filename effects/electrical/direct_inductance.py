"""Other L_d than declared."""

from __future__ import annotations

from dataclasses import dataclass, replace

from effects.base import DesignEffect
from effects.dq_design import DqMachine
from effects.parameter import parameter
from effects.prior import Normal
from effects.signature import Power, Touches


@dataclass(frozen=True)
class DirectInductance(DesignEffect):
    """L_d differs from the declared value: L_d = L_declared (1 + change), for example by another magnet thickness."""

    title = "other L_d than declared"
    looks_like = "v_q changes with i_d and speed, short-circuit current changes"
    remedy = ("inductance meter with the rotor locked on d", "short-circuit current")
    designs = (DqMachine,)
    signature = (
        Power("dq_operation.v_q", "i_d", 1.0),
        Power("dq_operation.v_q", "speed", 1.0),
        Power("dq_operation.torque", "i_q", 1.0),
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
        source="engineering judgement: end leakage and gap tolerance move L_d by 10 %",
    )

    def on_design(self, design):
        return replace(design, inductance_d=design.inductance_d * (1.0 + self.change))
