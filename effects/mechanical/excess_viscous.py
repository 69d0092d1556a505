"""More viscous damping than declared."""

from __future__ import annotations

from dataclasses import dataclass, replace

from effects.base import DesignEffect
from effects.damper_design import Damper
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Power


@dataclass(frozen=True)
class ExcessViscous(DesignEffect):
    """More viscous loss than declared, for example cold grease: c = c_declared + excess."""

    title = "more viscous damping than declared"
    looks_like = "the same extra damping at every shunt, frequency and amplitude"
    remedy = ("drag at open terminals against velocity and temperature",)
    designs = (Damper,)
    signature = (
        Power("damping_velocity.force", "velocity", 1.0),
        Power("damping_velocity.force", "shunt", 0.0),
        Power("damping_shunt.damping", "shunt", 0.0),
        Power("impedance.re", "frequency", 0.0),
        Power("impedance.re", "amplitude", 0.0),
    )
    base_rate = 0.04
    base_rate_source = (
        "engineering judgement: cold grease or a new seal beside a declared tolerance, one bench in twenty-five"
    )

    excess: float = parameter(
        0.0, "N s/m", prior=LogNormal(20.0, 1.0), low=0.0, high=5e3, source="70 to 351 N s/m (thesis section 5.2.1)"
    )

    def on_design(self, design):
        return replace(design, viscous_damping=design.viscous_damping + self.excess)
