"""A synchronous machine with constant parameters as a bench model: ``effects.dq_design.DqMachine``.

Kinds of measurement and their columns, SI, temperatures in degrees Celsius and optional:
    back_emf       speed [, magnet_T]                               -> v_ll            RMS, line to line, open terminals
    dq_operation   i_d, i_q, speed [, winding_T, magnet_T]          -> v_d, v_q, torque  peak phase values; shaft torque
    dq_supply      v_ll, torque, speed [, winding_T, magnet_T]      -> current, power  fed by a sine; RMS, electrical
    dyno_map       speed, torque [, v_dc, winding_T, magnet_T]      -> the meters      fed by an inverter
    dyno_map       speed, i_d, i_q [, winding_T, magnet_T]          -> the meters      fed with currents, peak
    no_load        speed, v_ll [, winding_T, magnet_T]              -> the meters      fed by a sine, nothing coupled
    no_load        speed [, magnet_T]                               -> v_ll, current, power  driven with open terminals;
                                                                       power is that at the shaft, current is zero
    short_circuit  speed [, winding_T, magnet_T]                    -> torque, current  RMS; braking torque positive
    drag           speed [, magnet_T]                               -> torque          braking torque at open terminals
    phase_resistance  [winding_T]                                   -> resistance

The meters: torque at the shaft, power (electrical, into the machine), current (RMS of a phase of a star, so of a line),
v_ll (RMS, line to line, fundamental), power_factor, efficiency (of a motor shaft over electrical power, of a generator
the other way round; 0 to 1), loss (electrical less shaft power). A table has any of them. Which currents an inverter
chooses is in ``control``; with v_dc its voltage is limited.

Where a temperature is not measured the machine is at its reference temperature. Every kind also knows the states
resistance_factor and flux_factor, phase resistance and magnet flux linkage of a row over those of the design.

``[device]`` keys are the fields of ``DqMachine`` with a unit at their end: pole_pairs, psi_m_Vs, inductance_d_mH,
inductance_q_mH, resistance_mohm (of one phase of a star), and if known reference_T_degC, copper_coefficient and
remanence_coefficient [1/K], iron_conductance [1/ohm], voltage_per_dc (0.577 for space vectors up to their circle, 0.637
for six steps).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from math import sqrt

import numpy as np

from effects.base import Columns
from effects.dq_design import DqMachine
from workbench.data.table import Campaign, Tolerance
from workbench.errors import WorkbenchError
from workbench.models import device
from workbench.models.base import BaseModel, Option
from workbench.models.dq.control import least_current, within_voltage
from workbench.models.dq.operation import PEAK_OF_LINE_RMS, Operation, newton
from workbench.models.dq.options import options

_REQUIRED = ("pole_pairs", "psi_m", "inductance_d", "inductance_q", "resistance")
_OPTIONAL = ("reference_T", "copper_coefficient", "remanence_coefficient", "iron_conductance", "voltage_per_dc")


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
        values = tuple((name, column.tobytes()) for name, column in conditions.items())
        return dict(_answered(_Question(design, kind, values, conditions)))

    def doubts(self, design: DqMachine) -> tuple[str, ...]:
        """Of inductance over resistance."""
        return device.doubts_of_winding(max(design.inductance_d, design.inductance_q), design.resistance)

    def options(self, design: DqMachine, campaign: Campaign) -> Sequence[Option]:
        """What could be measured next, with the instruments that the campaign shows."""
        return options(campaign.tables)


@dataclass(frozen=True)
class _Question:
    """A machine at conditions: the same where all their values are, (name, bytes) each."""

    design: DqMachine
    kind: str
    values: tuple[tuple[str, bytes], ...]
    conditions: Columns = field(compare=False)


@lru_cache(maxsize=64)  # instruments are moved and effects of them tried on one and the same machine
def _answered(question: _Question) -> dict[str, np.ndarray]:
    return _ANSWERS[question.kind](Operation(question.design, question.conditions))


def _back_emf(operation: Operation) -> dict[str, np.ndarray]:
    none = np.zeros(operation.rows)
    e_d, e_q, _, _ = _open(operation, none)
    return {"v_ll": np.hypot(e_d, e_q) / PEAK_OF_LINE_RMS}


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


def _dyno_map(operation: Operation) -> dict[str, np.ndarray]:
    """At currents as given, else the smallest that give the torque within the voltage."""
    at = operation.conditions
    if ("torque" in at) == ({"i_d", "i_q"} <= set(at)):
        raise WorkbenchError("a dyno_map has its conditions in torque, or in i_d and i_q, and the other as a response")
    if "torque" not in at:
        return operation.meters(*operation.magnetising(at["i_d"], at["i_q"]))
    if "v_dc" not in at:
        return operation.meters(*least_current(operation, at["torque"]))
    limit = operation.design.voltage_per_dc * at["v_dc"]
    return operation.meters(*within_voltage(operation, at["torque"], limit))


def _no_load(operation: Operation) -> dict[str, np.ndarray]:
    none = np.zeros(operation.rows)
    if "v_ll" in operation.conditions:
        return operation.meters(*_at_sine(operation, none))
    power = _drag(operation)["torque"] * operation.speed
    return {**_back_emf(operation), "current": none, "power": power}


def _short_circuit(operation: Operation) -> dict[str, np.ndarray]:
    d = operation.design
    scale = np.abs(operation.omega) * d.psi_m + 1e-9

    def voltage(m_d: np.ndarray, m_q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        v_d, v_q, _, _ = operation.terminals(m_d, m_q)
        return v_d, v_q

    r, x_d, x_q = operation.resistance, operation.omega * d.inductance_d, operation.omega * d.inductance_q
    i_d = -x_q * operation.omega * d.psi_m / (r**2 + x_d * x_q)
    i_q = -r * operation.omega * d.psi_m / (r**2 + x_d * x_q)
    m_d, m_q = newton(voltage, i_d, i_q, scale, scale)
    _, _, all_d, all_q = operation.terminals(m_d, m_q)
    return {"torque": -operation.shaft_torque(m_d, m_q), "current": np.hypot(all_d, all_q) / sqrt(2.0)}


def _supply(operation: Operation) -> dict[str, np.ndarray]:
    found = operation.meters(*_at_sine(operation, operation.conditions["torque"]))
    return {name: found[name] for name in ("current", "power")}


def _at_sine(operation: Operation, torque: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Stable steady state of a motor at a stiff sine supply: magnetising currents for given |v| and shaft torque."""
    d = operation.design
    voltage = PEAK_OF_LINE_RMS * operation.conditions["v_ll"]
    i_q = torque / (1.5 * d.pole_pairs * d.psi_m)
    flux = voltage / np.abs(operation.omega)
    i_d = (np.sqrt(np.maximum(flux**2 - (d.inductance_q * i_q) ** 2, 0.0)) - operation.psi_m) / d.inductance_d

    def missing(m_d: np.ndarray, m_q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return operation.shaft_torque(m_d, m_q) - torque, operation.voltage(m_d, m_q) - voltage

    return newton(missing, i_d, i_q, operation.torque_scale + np.abs(torque), voltage)


def _resistance(operation: Operation) -> dict[str, np.ndarray]:
    return {"resistance": operation.resistance}


_ANSWERS = {
    "back_emf": _back_emf,
    "dq_operation": _operation,
    "dq_supply": _supply,
    "dyno_map": _dyno_map,
    "no_load": _no_load,
    "short_circuit": _short_circuit,
    "drag": _drag,
    "phase_resistance": _resistance,
}

BASE = DqModel()
