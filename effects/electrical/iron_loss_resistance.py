"""Iron loss."""

from __future__ import annotations

from dataclasses import dataclass, replace

from effects.base import DesignEffect
from effects.dq_design import DqMachine
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Odd, Power, Touches


@dataclass(frozen=True)
class IronLossResistance(DesignEffect):
    """Iron loss as a resistance across the induced voltage: P_fe = 1.5 (omega psi)^2 / R_fe. The parameter is 1 / R_fe.

    Source: Fernandez-Bernal et al., IEEE Trans. IA 37 (2001).
    """

    title = "iron loss"
    looks_like = "drag torque in proportion to speed, more electrical power than copper and shaft account for"
    remedy = ("no-load loss against speed", "drag with a dummy without magnets")
    designs = (DqMachine,)
    signature = (
        Power("drag.torque", "speed", 1.0),
        Odd("drag.torque", ("speed",)),
        Touches("back_emf.v_ll"),
        Touches("dq_operation.v_d"),
        Touches("dq_operation.v_q"),
        Touches("dq_operation.torque"),
        Touches("short_circuit.*"),
        Touches("dq_supply.*"),
    )
    model_error = 0.05
    model_error_source = "benchmarks/law_errors.py: against a tenth of the loss as hysteresis"
    base_rate = 0.08
    base_rate_source = "engineering judgement: in every machine, in few simple models, visible in one of twelve"

    conductance: float = parameter(
        0.0,
        "1/ohm",
        prior=LogNormal(5e-3, 1.0),
        low=0.0,
        high=0.5,
        source="engineering judgement: 100 to 1000 ohm for kilowatt machines",
    )

    def on_design(self, design):
        return replace(design, iron_conductance=design.iron_conductance + self.conductance)
