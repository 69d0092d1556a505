"""Force constant falls away from mid-stroke."""

from __future__ import annotations

from dataclasses import dataclass

from effects.law_effects import CouplingEffect
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Power, Touches


@dataclass(frozen=True)
class ForceConstantOverStroke(CouplingEffect):
    """Magnets leave the winding towards the ends of the stroke: K(x) = K / (1 + curvature x^2), force and back-EMF."""

    title = "force constant falls away from mid-stroke"
    looks_like = "damping at low shunt falls with the square of the amplitude; nothing changes in mid-stroke"
    remedy = ("back-EMF at several positions", "impedance at two amplitudes, low shunt")
    signature = (
        Touches("impedance.re"),
        Power("impedance.re", "amplitude", 2.0),
        Power("impedance.re", "frequency", 0.0),
    )
    model_error = 0.001
    size_error = 0.009
    model_error_source = "benchmarks/law_errors.py: against 1 - curvature x^2"
    base_rate = 0.01
    base_rate_source = "engineering judgement: designed out within the rated stroke"

    curvature: float = parameter(
        0.0,
        "1/m^2",
        prior=LogNormal(1e3, 1.5),
        low=0.0,
        high=1e5,
        source="engineering judgement: 5 % lost at 2 to 20 mm from mid-stroke of voice coils",
    )

    def coupling(self, position, current):
        return 1.0 / (1.0 + self.curvature * position**2)
