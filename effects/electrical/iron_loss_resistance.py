"""Iron loss."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import pi

from effects.base import DesignEffect
from effects.dq_design import DqMachine
from effects.parameter import parameter
from effects.prior import LogNormal, Normal
from effects.signature import Odd, Power, Touches

REFERENCE = 2 * pi * 100.0  # rad/s, electrical, at which conductance and share are meant


@dataclass(frozen=True)
class IronLossResistance(DesignEffect):
    """Iron loss as a conductance across the induced voltage, of eddy currents and of hysteresis:

        P_fe = 1.5 (omega psi)^2 g,   g = conductance (1 - hysteresis + hysteresis omega_0 / |omega|)

    with omega_0 = 2 pi 100 rad/s. Source: Fernandez-Bernal et al., IEEE Trans. IA 37 (2001); the split into parts that
    grow with the square of the frequency and with the frequency is Steinmetz's.
    """

    title = "iron loss"
    looks_like = "drag torque that grows with speed, more electrical power than copper and shaft account for"
    remedy = ("no-load loss against speed", "drag with a dummy without magnets")
    designs = (DqMachine,)
    signature = (
        Power("drag.torque", "speed", 1.0),
        Odd("drag.torque", ("speed",)),
        Touches("back_emf.v_ll"),
        Touches("dq_operation.v_d"),
        Touches("dq_operation.v_q"),
        Touches("dq_operation.torque"),
        Touches("short_circuit.*"),
        Touches("dq_supply.*"),
    )
    model_error = 0.012
    size_error = 0.028
    model_error_source = "benchmarks/law_errors.py: against Bertotti's law with a fifth of the loss as excess"
    base_rate = 0.08
    base_rate_source = "engineering judgement: in every machine, in few simple models, visible in one of twelve"

    conductance: float = parameter(
        0.0,
        "1/ohm",
        prior=LogNormal(5e-3, 1.0),
        low=0.0,
        high=0.5,
        source="engineering judgement: 100 to 1000 ohm for kilowatt machines",
    )

    hysteresis: float = parameter(
        0.0,
        "1",
        prior=Normal(centre=0.4, sd=0.25),
        low=0.0,
        high=1.0,
        source="engineering judgement: of non-oriented sheets of 0.35 to 0.5 mm a quarter to six tenths at 100 Hz",
    )

    @property
    def is_null(self):
        return self.conductance == 0.0

    def on_design(self, design):
        eddy, steady = self.conductance * (1.0 - self.hysteresis), self.conductance * self.hysteresis * REFERENCE
        more = {"iron_conductance": eddy, "iron_hysteresis": steady}
        return replace(design, **{name: getattr(design, name) + value for name, value in more.items()})
