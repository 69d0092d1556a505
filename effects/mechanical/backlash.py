"""Backlash."""

from __future__ import annotations

from dataclasses import dataclass, replace

from effects.base import DesignEffect
from effects.damper_design import Damper
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Touches


@dataclass(frozen=True)
class Backlash(DesignEffect):
    """Free play in the joint between driving point and mass, stop to stop; in it the mass is free."""

    title = "backlash"
    looks_like = "impedance falls at small amplitude, the more the smaller; nothing changes at constant velocity"
    remedy = ("impedance at two amplitudes", "dial gauge on the joint while rocking it")
    designs = (Damper,)
    signature = (
        Touches("impedance.re"),
        Touches("impedance.im"),
    )
    model_error = 0.006
    model_error_source = "benchmarks/law_errors.py: against flight and contact piece by piece"
    base_rate = 0.02
    base_rate_source = "engineering judgement: worn or loose rod ends, one rig in fifty"

    play: float = parameter(
        0.0,
        "m",
        prior=LogNormal(5e-5, 1.2),
        low=0.0,
        high=2e-3,
        source="engineering judgement: rod ends new 10 um, worn 0.5 mm",
    )

    def on_design(self, design):
        return replace(design, mount_clearance=design.mount_clearance + self.play)
