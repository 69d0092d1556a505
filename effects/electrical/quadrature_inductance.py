"""Other L_q than declared."""

from __future__ import annotations

from dataclasses import dataclass, replace

from effects.base import DesignEffect
from effects.dq_design import DqMachine
from effects.parameter import parameter
from effects.prior import Normal


@dataclass(frozen=True)
class QuadratureInductance(DesignEffect):
    """L_q differs from the declared value: L_q = L_declared (1 + change)."""

    title = "other L_q than declared"
    looks_like = "v_d changes with i_q and speed, at small currents too"
    remedy = ("inductance meter with the rotor locked on q",)
    designs = (DqMachine,)

    change: float = parameter(
        0.0, "1", prior=Normal(0.10), low=-0.6, high=1.5, source="leakage and gap tolerance move L_q by 10 %"
    )

    def on_design(self, design):
        return replace(design, inductance_q=design.inductance_q * (1.0 + self.change))
