"""Compliance of the mount."""

from __future__ import annotations

from dataclasses import dataclass, replace

from effects.base import DesignEffect
from effects.damper_design import Damper
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Touches


@dataclass(frozen=True)
class MountCompliance(DesignEffect):
    """The mount gives: a spring in series, 1 / k = 1 / k_declared + compliance, c_m = loss k; thesis eq. B.4."""

    title = "compliance of the mount"
    looks_like = "impedance falls and its phase turns negative towards a resonance with the moving mass"
    remedy = ("displacement of the mass itself", "impedance at higher frequency")
    designs = (Damper,)
    signature = (
        Touches("impedance.re"),
        Touches("impedance.im"),
    )
    model_error = 0.03
    size_error = 0.008
    model_error_source = "benchmarks/law_errors.py: against mount that hardens by 2 %, integrated in time"
    base_rate = 0.03
    base_rate_source = "engineering judgement: clamps softer than believed, one shaker test in thirty"

    compliance: float = parameter(
        0.0, "m/N", prior=LogNormal(1e-6, 1.2), low=0.0, high=1e-3, source="2e5 to 9e5 N/m (thesis app. B, 5.3)"
    )
    loss: float = parameter(
        2.5e-4, "s", prior=LogNormal(2.5e-4, 0.7), low=0.0, high=0.1, source="50 N s/m at 2e5 N/m (thesis table B.1)"
    )

    def on_design(self, design):
        if self.is_null:
            return design
        stiffness = 1.0 / (1.0 / design.mount_stiffness + self.compliance)
        return replace(design, mount_stiffness=stiffness, mount_damping=self.loss * stiffness)

    @property
    def is_null(self):
        return self.compliance == 0.0
