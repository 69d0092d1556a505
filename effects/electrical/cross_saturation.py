"""Cross saturation."""

from __future__ import annotations

from dataclasses import dataclass

from effects.law_effects import FluxEffect
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Even, Power, Touches


@dataclass(frozen=True)
class CrossSaturation(FluxEffect):
    """Current of one axis takes permeability from the other: psi_d falls by k i_q^2, psi_q by 2 k i_d i_q.

    Both from the co-energy -k i_d i_q^2, so that the flux linkages are reciprocal.
    Source: Vagati et al., IEEE Trans. IA 36 (2000).
    """

    title = "cross saturation"
    looks_like = "v_q falls with the square of i_q"
    remedy = ("flux linkage over i_d and i_q", "back-EMF under q current")
    signature = (
        Power("dq_operation.v_q", "i_q", 2.0),
        Even("dq_operation.v_q", ("i_q",)),
        Touches("dq_operation.v_d"),
        Touches("dq_operation.torque"),
        Touches("short_circuit.*"),
        Touches("dq_supply.*"),
    )
    model_error = 0.015
    size_error = 0.034
    model_error_source = "benchmarks/law_errors.py: against flux that bends at 5 % of rated current squared"
    base_rate = 0.02
    base_rate_source = "engineering judgement: seen where the q current is large, a third as often as q saturation"

    coefficient: float = parameter(
        0.0,
        "Vs/A^2",
        prior=LogNormal(2e-6, 1.2),
        low=0.0,
        high=1e-2,
        source="engineering judgement: 2 to 10 % of psi_m at rated currents of 10 to 200 A",
    )

    def flux(self, i_d, i_q, machine):
        return -self.coefficient * i_q**2, -2.0 * self.coefficient * i_d * i_q
