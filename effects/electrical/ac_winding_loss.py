"""AC loss of the winding."""

from __future__ import annotations

from dataclasses import dataclass

from effects.base import Columns, StateEffect
from effects.dq_design import DqMachine
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Power, Touches

SCALE = 1000.0  # rad/s, electrical


@dataclass(frozen=True)
class AcWindingLoss(StateEffect):
    """Skin and proximity effect raise the resistance: R = R_dc (1 + excess (omega / 1000 rad/s)^2), omega electrical.

    Source: Dowell, Proc. IEE 113 (1966), the first term of his series. Validity: wires thinner than the skin depth.
    """

    title = "AC loss of the winding"
    looks_like = "copper loss grows with the square of speed at the same current; standstill resistance is right"
    remedy = ("resistance with an LCR meter up to the electrical frequency, rotor out", "copper loss at two speeds")
    designs = (DqMachine,)
    signature = (
        Power("dq_operation.v_d", "speed", 2.0),
        Power("dq_operation.v_q", "speed", 2.0),
        Power("dq_operation.v_q", "i_q", 1.0),
        Touches("short_circuit.*"),
        Touches("dq_supply.*"),
    )
    model_error = 0.002
    size_error = 0.006
    model_error_source = "benchmarks/law_errors.py: against Dowell's law of four layers"
    base_rate = 0.02
    base_rate_source = "engineering judgement: thick wire or hairpins at high speed, one machine in fifty"

    excess: float = parameter(
        0.0,
        "1",
        prior=LogNormal(0.05, 1.2),
        low=0.0,
        high=3.0,
        source="Dowell (1966): 1 to 2 mm wire in 2 to 8 layers at 160 Hz",
    )

    def on_state(self, conditions: Columns, kind: str, design: DqMachine) -> Columns:
        if "speed" not in conditions:
            return conditions
        more = 1.0 + self.excess * (design.pole_pairs * conditions["speed"] / SCALE) ** 2
        return {**conditions, "resistance_factor": conditions.get("resistance_factor", 1.0) * more}
