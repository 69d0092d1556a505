"""Shunt warms with its own loss."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from effects.base import Columns, StateEffect
from effects.damper_design import Damper
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Odd, Power, Touches

SUBSTITUTIONS = 6  # each leaves the share rise P of the error before


@dataclass(frozen=True)
class ShuntHeating(StateEffect):
    """The shunt resistor is as warm as its loss in each row: R_s = R_s,cold (1 + rise P),  P = R_s i^2,
    i = K v_rms / (R + R_s), by repeated substitution.

    Validity: rows last longer than the seconds that a resistor without heat sink needs; inductance is left out of i.
    Tables that give no velocity are left alone.
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
        if "shunt" not in conditions or not has_velocity(conditions) or self.is_null:
            return conditions
        cold = warm = conditions["shunt"]
        emf = design.force_constant * rms_velocity(conditions)
        for _ in range(SUBSTITUTIONS):
            warm = self.warmed(cold, warm, emf / (design.internal_resistance + warm))
        return {**conditions, "shunt": warm}

    def warmed(self, cold: np.ndarray, warm: np.ndarray, current: np.ndarray) -> np.ndarray:
        """Resistance of a shunt [ohm] that loses as much as one of resistance ``warm`` at a current [A] does."""
        return cold * (1.0 + self.rise * warm * current**2)


def has_velocity(conditions: Columns) -> bool:
    """Whether the velocity of each row is known, and with it how much is lost in the circuit."""
    return "velocity" in conditions or {"frequency", "amplitude"} <= set(conditions)


def rms_velocity(conditions: Columns) -> np.ndarray:
    """RMS velocity of each row [m/s]: of the sine, or the one that is held."""
    if {"frequency", "amplitude"} <= set(conditions):
        return 2 * np.pi * conditions["frequency"] * conditions["amplitude"] / np.sqrt(2.0)
    return np.abs(conditions["velocity"])
