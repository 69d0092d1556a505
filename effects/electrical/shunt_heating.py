"""Shunt warms with its own loss."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from effects.base import Columns, StateEffect
from effects.damper_design import Damper
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Odd, Power, Touches


@dataclass(frozen=True)
class ShuntHeating(StateEffect):
    """The shunt resistor is as warm as its loss in each row: R_s = R_s,cold (1 + rise P),  P = R_s,cold i^2 of the cold
    circuit,  i = K v_rms / (R + R_s,cold).

    Validity: rows last longer than the seconds that a resistor without heat sink needs; inductance is left out of i.
    """

    title = "shunt warms with its own loss"
    looks_like = "braking force falls behind as the cube of velocity at low shunt; open terminals unchanged"
    remedy = ("voltage and current of the shunt at the highest speed", "shunt on a heat sink")
    designs = (Damper,)
    signature = (
        Touches("damping_shunt.damping"),
        Odd("damping_velocity.force", ("velocity",)),
        Power("damping_velocity.force", "velocity", 3.0),
        Power("impedance.re", "amplitude", 2.0),
    )
    base_rate = 0.01
    base_rate_source = "engineering judgement: resistors of low drift are the rule at a bench"

    rise: float = parameter(
        0.0,
        "1/W",
        prior=LogNormal(5e-4, 1.2),
        low=0.0,
        high=0.02,
        source="data sheet class: wirewound 100 to 400 ppm/K, 2 to 10 K/W",
    )

    def on_state(self, conditions: Columns, kind: str, design: Damper) -> Columns:
        if "shunt" not in conditions or self.is_null:
            return conditions
        shunt = conditions["shunt"]
        current = design.force_constant * rms_velocity(conditions, design) / (design.internal_resistance + shunt)
        return {**conditions, "shunt": shunt * (1.0 + self.rise * shunt * current**2)}


def rms_velocity(conditions: Columns, design: Damper) -> np.ndarray | float:
    """RMS velocity of each row [m/s]; the top velocity of the device where a table gives none."""
    if "frequency" in conditions:
        return 2 * np.pi * conditions["frequency"] * conditions["amplitude"] / np.sqrt(2.0)
    return np.abs(conditions.get("velocity", design.test_velocity))
