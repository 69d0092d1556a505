"""Rotary inertia (inertance)."""

from __future__ import annotations

from dataclasses import dataclass, replace

from effects.base import DesignEffect
from effects.damper_design import Damper
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Power


@dataclass(frozen=True)
class Inertance(DesignEffect):
    """Rotary inertia seen through the transmission: m = m_declared + J / tau^2, thesis eq. 3.125."""

    title = "rotary inertia (inertance)"
    looks_like = "imaginary part of the impedance grows faster with frequency, nothing changes at constant velocity"
    remedy = ("impedance at open terminals up to higher frequency", "weigh the parts, swing test of the rotor")
    designs = (Damper,)
    signature = (
        Power("impedance.im", "frequency", 1.0),
        Power("impedance.im", "amplitude", 0.0),
    )
    base_rate = 0.03
    base_rate_source = (
        "engineering judgement: rotor or fixture masses left out of the moving mass, one campaign in thirty"
    )

    mass: float = parameter(
        0.0, "kg", prior=LogNormal(0.3, 1.2), low=0.0, high=50.0, source="5 kg for 60 g of rotor (thesis table B.1)"
    )

    def on_design(self, design):
        return replace(design, moving_mass=design.moving_mass + self.mass)
