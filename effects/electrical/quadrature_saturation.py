"""Saturation of the q axis."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from effects.law_effects import FluxEffect
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Odd, Power, Touches


@dataclass(frozen=True)
class QuadratureSaturation(FluxEffect):
    """The q axis, where iron closes the path, saturates: psi_q = L_q i_q / (1 + s |i_q|).

    Source: the two-parameter form of de Jong (1980); Boldea, Reluctance Synchronous Machines, ch. 2.
    """

    title = "saturation of the q axis"
    looks_like = "more current than predicted at high torque, v_d falls behind at high i_q"
    remedy = ("flux linkage against i_q at standstill", "torque against current angle")
    signature = (
        Power("dq_operation.v_d", "i_q", 2.0),
        Odd("dq_operation.v_d", ("i_q",)),
        Power("dq_operation.v_d", "speed", 1.0),
        Touches("dq_operation.torque"),
        Touches("short_circuit.*"),
        Touches("dq_supply.*"),
    )
    model_error = 0.008
    model_error_source = "benchmarks/law_errors.py: against logarithmic saturation, ever further from this one"
    base_rate = 0.06
    base_rate_source = "engineering judgement: usual with buried magnets, seldom otherwise, one in seventeen"

    saturation: float = parameter(
        0.0,
        "1/A",
        prior=LogNormal(2e-3, 1.0),
        low=0.0,
        high=0.2,
        source="engineering judgement: L_q halves at 100 to 1000 A peak",
    )

    @property
    def size_error(self):
        return 9.6 * self.saturation  # [A]: 5.2 % one standard deviation above the middle of the prior, 14 % at two

    def flux(self, i_d, i_q, machine):
        linear = machine.inductance_q * i_q
        return np.zeros_like(i_q), linear / (1.0 + self.saturation * np.abs(i_q)) - linear
