"""Contact or rectifier resistance."""

from __future__ import annotations

from dataclasses import dataclass, replace

from effects.base import DesignEffect
from effects.damper_design import Damper
from effects.dq_design import DqMachine
from effects.electrical.places import SERIES_RESISTANCE
from effects.parameter import parameter
from effects.prior import LogNormal


@dataclass(frozen=True)
class ContactResistance(DesignEffect):
    """Leads, contacts or the slope of a rectifier in series with the winding: R = R_declared + resistance."""

    title = "contact or rectifier resistance"
    looks_like = "current and braking force fall at low total resistance, as with a warm winding"
    remedy = ("four-wire resistance at the shunt's own terminals", "tighten and measure again")
    designs = (Damper, DqMachine)
    signature = SERIES_RESISTANCE
    base_rate = 0.04
    base_rate_source = "engineering judgement: two-wire wiring or a loose screw, one bench in twenty-five"

    resistance: float = parameter(
        0.0, "ohm", prior=LogNormal(0.05, 1.0), low=0.0, high=10.0, source="thesis app. B: 70 mohm for a diode bridge"
    )

    def on_design(self, design):
        if isinstance(design, Damper):
            return replace(design, internal_resistance=design.internal_resistance + self.resistance)
        return replace(design, resistance=design.resistance + self.resistance)
