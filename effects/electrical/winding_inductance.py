"""Inductance of the winding (electrical pole)."""

from __future__ import annotations

from dataclasses import dataclass, replace

from effects.base import DesignEffect
from effects.damper_design import Damper
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Power, Touches


@dataclass(frozen=True)
class WindingInductance(DesignEffect):
    """The winding's inductance delays the current: electrical pole omega_e = (R + R_shunt) / L, thesis eq. B.5."""

    title = "inductance of the winding (electrical pole)"
    looks_like = "the real part of the impedance falls with frequency at low shunt, the imaginary part goes negative"
    remedy = ("impedance at higher frequency and low shunt", "inductance meter at the terminals")
    designs = (Damper,)
    signature = (
        Power("impedance.im", "frequency", 1.0),
        Touches("impedance.re"),
    )
    base_rate = 0.03
    base_rate_source = (
        "engineering judgement: left out of quasi-static models, one damper in thirty is driven fast enough to see it"
    )

    inductance: float = parameter(
        0.0,
        "H",
        prior=LogNormal(1.5e-3, 1.2),
        low=0.0,
        high=0.5,
        source="thesis table B.1: 0.35 mH; engineering judgement: to 20 mH",
    )

    def on_design(self, design):
        return replace(design, inductance=design.inductance + self.inductance)
