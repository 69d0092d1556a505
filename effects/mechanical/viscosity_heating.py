"""Oil or grease warms up during the test."""

from __future__ import annotations

from dataclasses import dataclass

from effects.base import Columns, StateEffect
from effects.damper_design import Damper
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Like, Touches


@dataclass(frozen=True)
class ViscosityHeating(StateEffect):
    """Oil or grease thins through each scan: c = c_declared / (1 + fall order), order from 0 to 1."""

    title = "oil or grease warms up during the test"
    looks_like = "damping falls from the first to the last row of a scan, in proportion to velocity, open terminals too"
    remedy = ("repeat the first point at the end", "warm up before measuring", "random order of points")
    designs = (Damper,)
    signature = (
        Touches("damping_shunt.damping"),
        Touches("impedance.re"),
        Like("damping_velocity.force", lambda at: at["order"] * at["velocity"]),
    )
    base_rate = 0.02
    base_rate_source = "engineering judgement: usual without a warm-up, small beside electric damping"

    fall: float = parameter(
        0.0,
        "1",
        prior=LogNormal(0.1, 0.8),
        low=0.0,
        high=5.0,
        source="textbook: 3 % of viscosity per kelvin of a mineral oil, engineering judgement: a few kelvin a scan",
    )

    def on_state(self, conditions: Columns, kind: str, design: Damper) -> Columns:
        thin = 1.0 / (1.0 + self.fall * conditions["order"])
        return {**conditions, "viscous_factor": conditions.get("viscous_factor", 1.0) * thin}
