"""Force constant saturates with current."""

from __future__ import annotations

from dataclasses import dataclass

from effects.law_effects import CouplingEffect
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Odd, Power, Touches


@dataclass(frozen=True)
class ForceConstantSaturation(CouplingEffect):
    """Iron saturates under the winding's own field: K(i) = K / (1 + s i^2), for force and back-EMF alike."""

    title = "force constant saturates with current"
    looks_like = "force falls behind at high current, as the cube of the current; open circuit is unchanged"
    remedy = ("force at high velocity and low shunt", "locked force against current")
    signature = (
        Power("damping_velocity.force", "velocity", 3.0, 0.0, 0.15),
        Odd("damping_velocity.force", ("velocity",)),
        Touches("damping_shunt.damping"),
        Touches("impedance.re"),
    )
    model_error = 0.015
    size_error = 0.048
    model_error_source = "benchmarks/law_errors.py: against K / sqrt(1 + (i / i_s)^2)"
    base_rate = 0.01
    base_rate_source = "engineering judgement: rated currents are chosen below it, one damper in a hundred"

    saturation: float = parameter(
        0.0,
        "1/A^2",
        prior=LogNormal(3e-4, 1.2),
        low=0.0,
        high=0.1,
        source="engineering judgement: 5 % lost at 5 to 50 A",
    )

    def coupling(self, position, current):
        return 1.0 / (1.0 + self.saturation * current**2)
