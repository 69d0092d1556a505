"""A synchronous machine with constant parameters as a bench model: ``effects.dq_design.DqMachine``.

Kinds of measurement and their columns, SI, temperatures in degrees Celsius and optional:
    back_emf       speed [, magnet_T]                               -> v_ll            RMS, line to line, open terminals
    dq_operation   i_d, i_q, speed [, winding_T, magnet_T]          -> v_d, v_q, torque  peak phase values; shaft torque
    dq_supply      v_ll, torque, speed [, winding_T, magnet_T]      -> current, power  fed by a sine; RMS, electrical
    short_circuit  speed [, winding_T, magnet_T]                    -> torque, current  RMS; braking torque positive
    drag           speed [, magnet_T]                               -> torque          braking torque at open terminals
    phase_resistance  [winding_T]                                   -> resistance

Where a temperature is not measured the machine is at its reference temperature. Every kind also knows the states
resistance_factor and flux_factor, phase resistance and magnet flux linkage of a row over those of the design.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import sqrt

import numpy as np

from effects.base import Columns
from effects.dq_design import DqMachine
from workbench.data.table import Tolerance
from workbench.errors import WorkbenchError
from workbench.models import device
from workbench.models.base import BaseModel

PEAK_OF_LINE_RMS = sqrt(2.0 / 3.0)  # peak phase voltage of an RMS line-to-line voltage
STEPS = 60  # of Newton's method; some six are needed
CLOSE = 1e-11  # residual, of its scale
FAR = 1e9  # the same, where Newton has left every machine

_REQUIRED = ("pole_pairs", "psi_m", "inductance_d", "inductance_q", "resistance")
_OPTIONAL = ("reference_T", "copper_coefficient", "remanence_coefficient", "iron_conductance")


class DqModel(BaseModel):
    """The base model of the dq bench; see the module for the kinds it answers."""

    name = "dq"

    def accepts(self, device_table: Mapping[str, object]) -> bool:
        return {"psi_m", "inductance_q"} <= set(device.names(device_table))

    def design(self, device_table: Mapping[str, object]) -> DqMachine:
        """The machine of the ``[device]`` table; keys are the fields of ``DqMachine`` with a unit at their end."""
        values = device.numbers(device_table, _REQUIRED, _OPTIONAL)
        device.require_positive(values, *_REQUIRED)
        return DqMachine(**values)

    def with_tolerance(self, design: DqMachine, tolerance: Tolerance, z: float) -> DqMachine:
        """The machine with one constant moved by z standard deviations."""
        return device.moved(design, tolerance, z, _REQUIRED + _OPTIONAL)

    def respond(self, design: DqMachine, kind: str, conditions: Columns) -> dict[str, np.ndarray]:
        """Response columns of one table, see the module."""
        if kind not in _ANSWERS:
            raise WorkbenchError(
                f"a dq machine cannot answer a table of kind {kind!r}; it knows {', '.join(sorted(_ANSWERS))}"
            )
        return _ANSWERS[kind](Operation(design, conditions))


class Operation:
    """A machine at speeds and temperatures (n,)."""

    def __init__(self, design: DqMachine, conditions: Columns):
        self.design, self.conditions = design, conditions
        self.rows = len(next(iter(conditions.values())))
        self.speed = conditions.get("speed", np.zeros(self.rows))
        self.omega = design.pole_pairs * self.speed
        self.resistance = design.resistance * self._warm(design.copper_coefficient, "winding_T", "resistance_factor")
        self.psi_m = design.psi_m * self._warm(design.remanence_coefficient, "magnet_T", "flux_factor")

    def _warm(self, coefficient: float, column: str, state: str) -> np.ndarray:
        factor = self.conditions.get(state, np.ones(self.rows))
        if not coefficient or column not in self.conditions:
            return factor
        return factor * (1.0 + coefficient * (self.conditions[column] - self.design.reference_T))

    def flux_linkage(self, i_d: np.ndarray, i_q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """psi_d, psi_q [Vs] at magnetising currents [A]."""
        psi_d, psi_q = self.psi_m + self.design.inductance_d * i_d, self.design.inductance_q * i_q
        for law in self.design.fluxes:
            more_d, more_q = law.flux(i_d, i_q, self.design)
            psi_d, psi_q = psi_d + more_d, psi_q + more_q
        return psi_d, psi_q

    def induced(self, i_d: np.ndarray, i_q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """e_d, e_q [V] at magnetising currents."""
        psi_d, psi_q = self.flux_linkage(i_d, i_q)
        return -self.omega * psi_q, self.omega * psi_d

    def terminals(self, i_d: np.ndarray, i_q: np.ndarray) -> tuple[np.ndarray, ...]:
        """v_d, v_q [V] and i_d, i_q [A] at the terminals, from magnetising currents."""
        e_d, e_q = self.induced(i_d, i_q)
        all_d, all_q = i_d + self.design.iron_conductance * e_d, i_q + self.design.iron_conductance * e_q
        return self.resistance * all_d + e_d, self.resistance * all_q + e_q, all_d, all_q

    def shaft_torque(self, i_d: np.ndarray, i_q: np.ndarray) -> np.ndarray:
        """T at the shaft [Nm] at magnetising currents."""
        psi_d, psi_q = self.flux_linkage(i_d, i_q)
        torque = 1.5 * self.design.pole_pairs * (psi_d * i_q - psi_q * i_d)
        lost = sum(law.lost_torque(self.speed, torque) for law in self.design.torques)
        return torque - lost

    def magnetising(self, i_d: np.ndarray, i_q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Magnetising currents of terminal currents [A]."""
        if not self.design.iron_conductance:
            return i_d, i_q

        def too_much(m_d, m_q):
            _, _, all_d, all_q = self.terminals(m_d, m_q)
            return all_d - i_d, all_q - i_q

        scale = np.abs(i_d) + np.abs(i_q) + 1e-3 * self.design.psi_m / self.design.inductance_d
        return newton(too_much, i_d, i_q, scale, scale)


def newton(
    residual: Callable, x: np.ndarray, y: np.ndarray, size_a: np.ndarray, size_b: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """x, y of residual(x, y) = (a, b) = 0, all rows at once, slopes over small steps; scales of a and b to judge by.

    Raises WorkbenchError where there is no answer, for example a voltage too low for the torque.
    """
    step = 1e-6 * (np.abs(x).max() + np.abs(y).max() + 1.0)
    for _ in range(STEPS):
        a, b = residual(x, y)
        worst = np.maximum(np.abs(a) / size_a, np.abs(b) / size_b)
        if worst.max() < CLOSE:
            return x, y
        if not worst.max() < FAR:
            break
        (a_x, b_x), (a_y, b_y) = residual(x + step, y), residual(x, y + step)
        a_x, b_x, a_y, b_y = (a_x - a) / step, (b_x - b) / step, (a_y - a) / step, (b_y - b) / step
        determinant = a_x * b_y - a_y * b_x
        determinant = np.where(determinant == 0.0, np.finfo(float).tiny, determinant)  # a far step: it is refused above
        x, y = x - (a * b_y - b * a_y) / determinant, y - (a_x * b - b_x * a) / determinant
    if worst.max() < 1e3 * CLOSE:
        return x, y
    row = int(np.argmax(worst))
    raise WorkbenchError(f"row {row}: the machine has no steady state there, the voltage is too low for the torque")


def _back_emf(operation: Operation) -> dict[str, np.ndarray]:
    none = np.zeros(operation.rows)
    v_d, v_q, _, _ = _open(operation, none)
    return {"v_ll": np.hypot(v_d, v_q) / PEAK_OF_LINE_RMS}


def _open(operation: Operation, none: np.ndarray) -> tuple[np.ndarray, ...]:
    m_d, m_q = operation.magnetising(none, none)
    e_d, e_q = operation.induced(m_d, m_q)
    return e_d, e_q, m_d, m_q


def _drag(operation: Operation) -> dict[str, np.ndarray]:
    _, _, m_d, m_q = _open(operation, np.zeros(operation.rows))
    return {"torque": -operation.shaft_torque(m_d, m_q)}


def _operation(operation: Operation) -> dict[str, np.ndarray]:
    m_d, m_q = operation.magnetising(operation.conditions["i_d"], operation.conditions["i_q"])
    v_d, v_q, _, _ = operation.terminals(m_d, m_q)
    return {"v_d": v_d, "v_q": v_q, "torque": operation.shaft_torque(m_d, m_q)}


def _short_circuit(operation: Operation) -> dict[str, np.ndarray]:
    d = operation.design
    scale = np.abs(operation.omega) * d.psi_m + 1e-9

    def voltage(m_d, m_q):
        return operation.terminals(m_d, m_q)[:2]

    r, x_d, x_q = operation.resistance, operation.omega * d.inductance_d, operation.omega * d.inductance_q
    i_d = -x_q * operation.omega * d.psi_m / (r**2 + x_d * x_q)
    i_q = -r * operation.omega * d.psi_m / (r**2 + x_d * x_q)
    m_d, m_q = newton(voltage, i_d, i_q, scale, scale)
    _, _, all_d, all_q = operation.terminals(m_d, m_q)
    return {"torque": -operation.shaft_torque(m_d, m_q), "current": np.hypot(all_d, all_q) / sqrt(2.0)}


def _supply(operation: Operation) -> dict[str, np.ndarray]:
    """Stable steady state of a motor at a stiff sine supply: given |v| and shaft torque, currents and power."""
    d, torque = operation.design, operation.conditions["torque"]
    voltage = PEAK_OF_LINE_RMS * operation.conditions["v_ll"]
    i_q = torque / (1.5 * d.pole_pairs * d.psi_m)
    flux = voltage / np.abs(operation.omega)
    i_d = (np.sqrt(np.maximum(flux**2 - (d.inductance_q * i_q) ** 2, 0.0)) - operation.psi_m) / d.inductance_d

    def missing(m_d, m_q):
        v_d, v_q, _, _ = operation.terminals(m_d, m_q)
        return operation.shaft_torque(m_d, m_q) - torque, np.hypot(v_d, v_q) - voltage

    m_d, m_q = newton(missing, i_d, i_q, np.abs(torque).max() + np.abs(torque), voltage)
    v_d, v_q, all_d, all_q = operation.terminals(m_d, m_q)
    return {"current": np.hypot(all_d, all_q) / sqrt(2.0), "power": 1.5 * (v_d * all_d + v_q * all_q)}


def _resistance(operation: Operation) -> dict[str, np.ndarray]:
    return {"resistance": operation.resistance}


_ANSWERS = {
    "back_emf": _back_emf,
    "dq_operation": _operation,
    "dq_supply": _supply,
    "short_circuit": _short_circuit,
    "drag": _drag,
    "phase_resistance": _resistance,
}

BASE = DqModel()
