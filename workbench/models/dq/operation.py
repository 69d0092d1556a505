"""A dq machine at speeds and temperatures: flux linkages, terminal voltages, shaft torque, and what its meters show."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from math import sqrt

import numpy as np

from effects.base import Columns
from effects.dq_design import DqMachine
from workbench.errors import WorkbenchError

PEAK_OF_LINE_RMS = sqrt(2.0 / 3.0)  # peak phase voltage of an RMS line-to-line voltage
STEPS = 60  # of Newton's method; some six are needed
CLOSE = 1e-11  # residual, of its scale
HALVINGS = 12  # of a step that makes a row worse
TINY = np.finfo(float).tiny  # in the place of a determinant that is zero
TOO_LOW = "the machine has no steady state there, the voltage is too low for the torque"
_STILL = 1e-3  # rad/s, electrical, below which hysteresis no longer brakes
_SLOPE_STEP = 1e-3  # of the current that cancels the magnets, for slopes by central differences

Currents = tuple[np.ndarray, np.ndarray]


class Operation:
    """A machine at speeds and temperatures (n,).

    Where a temperature is not measured the machine is at its reference temperature. The columns ``resistance_factor``
    and ``flux_factor`` are states of winding and magnets, over what the design and the temperatures say [1].
    """

    def __init__(self, design: DqMachine, conditions: Columns):
        self.design, self.conditions = design, conditions
        self.rows = len(next(iter(conditions.values())))
        self.resistance = design.resistance * self._warm(design.copper_coefficient, "winding_T")
        self.psi_m = design.psi_m * self._warm(design.remanence_coefficient, "magnet_T")
        self.resistance = self.resistance * conditions.get("resistance_factor", 1.0)
        self.psi_m = self.psi_m * conditions.get("flux_factor", 1.0)

    @cached_property
    def speed(self) -> np.ndarray:
        """Mechanical [rad/s]."""
        return self.conditions["speed"]

    @cached_property
    def omega(self) -> np.ndarray:
        """Electrical [rad/s]."""
        return self.design.pole_pairs * self.speed

    @cached_property
    def iron_conductance(self) -> np.ndarray:
        """Beside the induced voltage [S]."""
        turning = np.maximum(np.abs(self.omega), _STILL)
        return self.design.iron_conductance + self.design.iron_hysteresis / turning

    def _warm(self, coefficient: float, column: str) -> np.ndarray:
        if not coefficient or column not in self.conditions:
            return np.ones(self.rows)
        return 1.0 + coefficient * (self.conditions[column] - self.design.reference_T)

    def of(self, rows: np.ndarray) -> Operation:
        """The same machine in some of the rows."""
        return Operation(self.design, {name: values[rows] for name, values in self.conditions.items()})

    @property
    def cancelling_current(self) -> np.ndarray:
        """psi_m / L_d [A], peak: a scale of all currents."""
        return self.psi_m / self.design.inductance_d

    @property
    def torque_scale(self) -> np.ndarray:
        """1.5 p psi_m^2 / L_d [Nm]: of the current that would cancel the magnets."""
        return 1.5 * self.design.pole_pairs * self.psi_m * self.cancelling_current

    def flux_linkage(self, i_d: np.ndarray, i_q: np.ndarray) -> Currents:
        """psi_d, psi_q [Vs] at magnetising currents [A]."""
        psi_d, psi_q = self.psi_m + self.design.inductance_d * i_d, self.design.inductance_q * i_q
        for law in self.design.fluxes:
            more_d, more_q = law.flux(i_d, i_q, self.design)
            psi_d, psi_q = psi_d + more_d, psi_q + more_q
        return psi_d, psi_q

    def induced(self, i_d: np.ndarray, i_q: np.ndarray) -> Currents:
        """e_d, e_q [V] at magnetising currents."""
        psi_d, psi_q = self.flux_linkage(i_d, i_q)
        return -self.omega * psi_q, self.omega * psi_d

    def terminals(self, i_d: np.ndarray, i_q: np.ndarray) -> tuple[np.ndarray, ...]:
        """v_d, v_q [V] and i_d, i_q [A] at the terminals, from magnetising currents."""
        e_d, e_q = self.induced(i_d, i_q)
        all_d, all_q = i_d + self.iron_conductance * e_d, i_q + self.iron_conductance * e_q
        return self.resistance * all_d + e_d, self.resistance * all_q + e_q, all_d, all_q

    def voltage(self, i_d: np.ndarray, i_q: np.ndarray) -> np.ndarray:
        """Peak phase voltage [V] at magnetising currents."""
        return np.hypot(*self.terminals(i_d, i_q)[:2])

    def shaft_torque(self, i_d: np.ndarray, i_q: np.ndarray) -> np.ndarray:
        """T at the shaft [Nm] at magnetising currents."""
        psi_d, psi_q = self.flux_linkage(i_d, i_q)
        torque = 1.5 * self.design.pole_pairs * (psi_d * i_q - psi_q * i_d)
        lost = sum(law.lost_torque(self.speed, torque) for law in self.design.torques)
        braked = sum(law.lost_torque(self.speed, i_d, i_q) for law in self.design.brakes)
        return torque - lost - braked

    def slopes(self, of: Callable[..., np.ndarray], i_d: np.ndarray, i_q: np.ndarray) -> Currents:
        """d/di_d and d/di_q of a function of the magnetising currents, by central differences."""
        h = _SLOPE_STEP * self.cancelling_current
        return (of(i_d + h, i_q) - of(i_d - h, i_q)) / (2 * h), (of(i_d, i_q + h) - of(i_d, i_q - h)) / (2 * h)

    def magnetising(self, i_d: np.ndarray, i_q: np.ndarray) -> Currents:
        """Magnetising currents of terminal currents [A]."""
        if not np.any(self.iron_conductance):
            return i_d, i_q

        def too_much(m_d: np.ndarray, m_q: np.ndarray) -> Currents:
            _, _, all_d, all_q = self.terminals(m_d, m_q)
            return all_d - i_d, all_q - i_q

        scale = np.abs(i_d) + np.abs(i_q) + 1e-3 * self.design.psi_m / self.design.inductance_d
        return newton(too_much, i_d, i_q, scale, scale)

    def meters(self, i_d: np.ndarray, i_q: np.ndarray) -> dict[str, np.ndarray]:
        """What power analyser and torque cell show at magnetising currents; see ``workbench.data.kinds``."""
        v_d, v_q, all_d, all_q = self.terminals(i_d, i_q)
        power, torque = 1.5 * (v_d * all_d + v_q * all_q), self.shaft_torque(i_d, i_q)
        current, v_ll = np.hypot(all_d, all_q) / sqrt(2.0), np.hypot(v_d, v_q) / PEAK_OF_LINE_RMS
        shaft = torque * self.speed
        return {
            "torque": torque,
            "power": power,
            "current": current,
            "v_ll": v_ll,
            "power_factor": _ratio(power, sqrt(3.0) * v_ll * current),
            "efficiency": np.where(shaft >= 0, _ratio(shaft, power), _ratio(power, shaft)),
            "loss": power - shaft,
        }


def _ratio(of: np.ndarray, over: np.ndarray) -> np.ndarray:
    """Zero where nothing flows at all."""
    return np.where(over == 0.0, 0.0, of / np.where(over == 0.0, 1.0, over))


def newton(
    residual: Callable[[np.ndarray, np.ndarray], Currents],
    x: np.ndarray,
    y: np.ndarray,
    size_a: np.ndarray,
    size_b: np.ndarray,
    failed: str = TOO_LOW,
) -> Currents:
    """x, y of residual(x, y) = (a, b) = 0, all rows at once, slopes over small steps; scales of a and b to judge by.

    A step that makes a row worse is halved there: flux maps bend.
    failed: what it means when there is no answer, for example a voltage too low for the torque
    Raises WorkbenchError there.
    """

    def off(a: np.ndarray, b: np.ndarray) -> np.ndarray:
        return np.maximum(np.abs(a) / size_a, np.abs(b) / size_b)

    h = 1e-6 * (np.abs(x).max() + np.abs(y).max() + 1.0)
    a, b = residual(x, y)
    for _ in range(STEPS):
        worst = off(a, b)
        if worst.max() < CLOSE or not np.isfinite(worst).all():
            break
        step_x, step_y = _newton_step(residual, x, y, a, b, h)
        share = np.ones(x.shape)
        for _ in range(HALVINGS):
            a, b = residual(x + share * step_x, y + share * step_y)
            worse = ~(off(a, b) <= np.maximum(worst, CLOSE))
            if not worse.any():
                break
            share = np.where(worse, 0.5 * share, share)
        else:  # at the last share nobody has asked
            a, b = residual(x + share * step_x, y + share * step_y)
        x, y = x + share * step_x, y + share * step_y
    if worst.max() < 1e3 * CLOSE:
        return x, y
    row = int(np.argmax(np.nan_to_num(worst, nan=np.inf)))
    raise WorkbenchError(f"row {row}: {failed}")


def _newton_step(residual, x, y, a, b, h: float) -> Currents:
    """What Newton adds to x and y, slopes over h."""
    (a_x, b_x), (a_y, b_y) = residual(x + h, y), residual(x, y + h)
    a_x, b_x, a_y, b_y = (a_x - a) / h, (b_x - b) / h, (a_y - a) / h, (b_y - b) / h
    determinant = a_x * b_y - a_y * b_x
    determinant = np.where(determinant == 0.0, TINY, determinant)  # a far step: it is halved
    return -(a * b_y - b * a_y) / determinant, -(a_x * b - b_x * a) / determinant
