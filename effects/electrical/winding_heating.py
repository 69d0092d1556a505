"""Winding warms up during the test."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import accumulate

import numpy as np

from effects.base import Columns, StateEffect
from effects.damper_design import Damper
from effects.dq_design import DqMachine
from effects.electrical.shunt_heating import has_velocity, rms_velocity
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Touches
from materials.conductor import COPPER


@dataclass(frozen=True)
class WindingHeating(StateEffect):
    """The winding warms with its own loss and remembers it: R = R_declared (1 + alpha T), row k of a scan after k-1,

        T_k = T_(k-1) + (thermal_resistance P_k - T_(k-1)) (1 - exp(-1 / memory)),   T before the first row is zero.

    P: copper loss at the resistance declared, R i^2 or 1.5 R i^2 (peak). alpha = 0.00393 / K (IEC 60028).
    Validity: rows last about equally long. Supply tables: i is the q current of the torque, their i_d is left out.
    Short circuits and tables without velocity or current are left alone.
    """

    title = "winding warms up during the test"
    looks_like = "resistance rises after rows of high current and falls back slowly: the order of rows matters"
    remedy = ("phase resistance between rows", "thermocouple in the winding", "random order of points")
    designs = (Damper, DqMachine)
    signature = (
        Touches("damping_velocity.force"),
        Touches("impedance.re"),
        Touches("dq_operation.v_d"),
        Touches("dq_operation.v_q"),
        Touches("dq_supply.*"),
        Touches("damping_shunt.damping"),
    )
    base_rate = 0.03
    base_rate_source = "engineering judgement: one long scan at high current in thirty campaigns"

    thermal_resistance: float = parameter(
        0.0,
        "K/W",
        prior=LogNormal(0.3, 1.0),
        low=0.0,
        high=20.0,
        source="data sheet class: winding to housing, servo motors of 0.1 to 5 kW, 0.1 to 1 K/W",
    )
    memory: float = parameter(
        30.0,
        "rows",
        prior=LogNormal(30.0, 1.0),
        low=1.0,
        high=1e4,
        source="data sheet class: thermal time constants of windings 1 to 10 min, at some ten seconds a row",
    )

    def on_state(self, conditions: Columns, kind: str, design: Damper | DqMachine) -> Columns:
        power = _copper_loss(conditions, design)
        if power is None or self.is_null:
            return conditions
        warm = 1.0 + COPPER.temperature_coefficient * self.rise(power, conditions["order"])
        return {**conditions, "resistance_factor": conditions.get("resistance_factor", 1.0) * warm}

    def rise(self, power: np.ndarray, order: np.ndarray) -> np.ndarray:
        """Rise of the winding in each row [K] from its loss [W]; order is zero where a scan begins."""
        forgets = -np.expm1(-1.0 / self.memory)
        ends = self.thermal_resistance * power

        def next_row(rise: float, row: tuple[float, float]) -> float:
            end, place = row
            return (rise if place > 0.0 else 0.0) * (1.0 - forgets) + end * forgets

        return np.array(list(accumulate(zip(ends, order), next_row, initial=0.0))[1:])

    @property
    def is_null(self):
        return self.thermal_resistance == 0.0


def _copper_loss(conditions: Columns, design: Damper | DqMachine) -> np.ndarray | None:
    """Loss in the winding of each row [W]; None where no current is known."""
    if isinstance(design, Damper):
        if "shunt" not in conditions or not has_velocity(conditions):
            return None
        resistance = design.internal_resistance
        current = design.force_constant * rms_velocity(conditions) / (resistance + conditions["shunt"])
        return resistance * current**2
    squared = _squared_current(conditions, design)
    return None if squared is None else 1.5 * design.resistance * squared


def _squared_current(conditions: Columns, design: DqMachine) -> np.ndarray | None:
    """Square of the peak current [A^2]."""
    if "i_q" in conditions:
        return conditions["i_d"] ** 2 + conditions["i_q"] ** 2
    if "torque" in conditions:
        return (conditions["torque"] / (1.5 * design.pole_pairs * design.psi_m)) ** 2
    return None
