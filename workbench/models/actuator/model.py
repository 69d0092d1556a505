"""An actuator with its gears and linkage as a bench model, measured at the wheel or at the output shaft.

Kinds of measurement and their columns, SI; at a shaft "velocity" is "speed" and "force" is "torque":
    locked_force      current [, direction]              -> force       output held; current: peak, on the q axis
    damping_velocity  velocity, shunt [, winding_T]      -> force       steady; shunt to a phase, in star, 0 is a short
    back_emf          velocity                           -> v_ll        RMS, line to line, open terminals
    drag              velocity                           -> force       open terminals
    phase_resistance  [winding_T]                        -> resistance  of one phase
    force_loop        frequency, amplitude, shunt, phase -> force       x = A sin(phase), slow: 2 pi f L << R + shunt

The device is the description that every simulation and the exported unit take (``actuator.model.Actuator``) with its
machine (``workbench.models.actuator.design``). All effects of a damper act (``effects.damper_design``): the constants
are brought to the output by the ratio. Voltages are RMS line to line, resistances those of one phase, currents
sqrt(3/2) of the peak q-axis one.

The meshes stand between the output and all that turns, friction and rotor (``GearEfficiency.through``). At a held
output ``direction`` is +1 where the current pushes the friction and -1 where the output pushes it back; without it the
mean of both is meant. Iron loss is no part of the model.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from math import isinf, pi

import numpy as np

from actuator.errors import ActuatorError
from effects.base import Columns
from effects.damper_design import Damper
from materials.conductor import COPPER
from workbench.data.table import Tolerance
from workbench.errors import WorkbenchError
from workbench.models import device
from workbench.models.actuator.design import (
    OF_PEAK,
    OPTIONAL,
    REQUIRED,
    BenchActuator,
    Reactance,
    read,
    written,
)
from workbench.models.base import BaseModel
from workbench.models.damper.steady_circuit import circuit_current, coupling_factor
from workbench.models.sine import phase_of

CREEP = 0.05  # m/s or rad/s, at which the friction of a held output is read: beyond presliding, before viscosity
SLOW = 0.1  # 2 pi f L over R + shunt up to which a force loop is answered; it errs by half its square


class ActuatorModel(BaseModel):
    """The base model of the actuator bench; see the module for the kinds it answers."""

    name = "actuator"

    def accepts(self, device_table: Mapping[str, object]) -> bool:
        return {"psi_m", "transmission_ratio"} <= set(device.names(device_table))

    def design(self, device_table: Mapping[str, object]) -> BenchActuator:
        """The actuator of the ``[device]`` table: the numbers of ``workbench.models.actuator.design``, a unit at their
        end, and ``output = "wheel"`` or ``"shaft"``."""
        values = device.numbers(device_table, REQUIRED, OPTIONAL)
        device.require_positive(values, *REQUIRED)
        device.require_whole(values, "pole_pairs")
        output = device_table.get("output", "wheel")
        if output not in ("wheel", "shaft"):
            raise WorkbenchError(f'[device] output must be "wheel" or "shaft", found {output!r}')
        return _actuator(values, output == "shaft")

    def with_tolerance(self, design: BenchActuator, tolerance: Tolerance, z: float) -> BenchActuator:
        """The actuator with one drawn number moved by z standard deviations."""
        return _actuator(device.moved_number(written(design.drawn), tolerance, z), design.is_shaft)

    def respond(self, design: BenchActuator, kind: str, conditions: Columns) -> dict[str, np.ndarray]:
        """Response columns of one table, see the module."""
        if kind not in _ANSWERS:
            known = ", ".join(sorted(_ANSWERS))
            raise WorkbenchError(f"an actuator cannot answer a table of kind {kind!r}; it knows {known}")
        return _ANSWERS[kind](design, conditions)


def _actuator(values: Mapping[str, float], is_shaft: bool) -> BenchActuator:
    """Raises WorkbenchError for numbers that no actuator has."""
    try:
        return BenchActuator.of(read(values), is_shaft)
    except ActuatorError as wrong:
        raise WorkbenchError(f"[device] {wrong}") from None


def steady_force(design: BenchActuator, velocity: np.ndarray, shunt: np.ndarray) -> np.ndarray:
    """Force that the output must give at constant velocity [N or Nm]: friction and machine, through the meshes."""
    still = np.zeros_like(velocity)
    turning = _turning(design, velocity)
    current = circuit_current(turning, still, velocity, shunt)
    made = design.force_constant * coupling_factor(design, still, current) * current
    return design.drawn.actuator.gears.through(made + friction(design, velocity), velocity)


def friction(design: Damper, velocity: np.ndarray) -> np.ndarray:
    """Viscous damping and all force laws at a constant velocity [N or Nm]."""
    still = np.zeros_like(velocity)
    return design.viscous_damping * velocity + sum(law.force(still, velocity) for law in design.forces)


def _turning(design: BenchActuator, velocity: np.ndarray) -> Damper:
    """The actuator at constant velocity, where the inductance is a reactance."""
    frequency = design.drawn.machine.pole_pairs * velocity / design.drawn.actuator.ratio.nominal
    law = Reactance(frequency * design.inductance)
    return replace(design, circuits=(law, *design.circuits))


def _warm(design: BenchActuator, conditions: Columns) -> BenchActuator:
    """With the resistance at ``winding_T``, where that is read."""
    if "winding_T" not in conditions:
        return design
    reference = COPPER.resistivity(design.drawn.reference_T)
    factor = COPPER.resistivity(conditions["winding_T"]) / reference
    return replace(design, internal_resistance=design.internal_resistance * factor)


def _motion(conditions: Columns) -> np.ndarray:
    for name in ("velocity", "speed"):
        if name in conditions:
            return conditions[name]
    raise WorkbenchError("an actuator that moves needs a column velocity, at a shaft a column speed")


def _named(design: BenchActuator, force: np.ndarray) -> dict[str, np.ndarray]:
    return {"torque" if design.is_shaft else "force": force}


def _locked(design: BenchActuator, conditions: Columns) -> dict[str, np.ndarray]:
    current = OF_PEAK * conditions["current"]
    made = design.force_constant * coupling_factor(design, np.zeros_like(current), current) * current
    if "direction" not in conditions:
        return _named(design, made)
    creep = -np.sign(current * conditions["direction"]) * CREEP  # the current pushes against the sense of its force
    held = made + friction(replace(design, viscous_damping=0.0), creep)
    return _named(design, design.drawn.actuator.gears.through(held, creep))


def _damping(design: BenchActuator, conditions: Columns) -> dict[str, np.ndarray]:
    return _named(design, steady_force(_warm(design, conditions), _motion(conditions), conditions["shunt"]))


def _back_emf(design: BenchActuator, conditions: Columns) -> dict[str, np.ndarray]:
    velocity = _motion(conditions)
    factor = coupling_factor(design, np.zeros_like(velocity), np.zeros_like(velocity))
    return {"v_ll": np.abs(design.force_constant * factor * velocity)}


def _drag(design: BenchActuator, conditions: Columns) -> dict[str, np.ndarray]:
    velocity = _motion(conditions)
    return _named(design, design.drawn.actuator.gears.through(friction(design, velocity), velocity))


def _resistance(design: BenchActuator, conditions: Columns) -> dict[str, np.ndarray]:
    rows = len(next(iter(conditions.values())))
    return {"resistance": np.broadcast_to(_warm(design, conditions).internal_resistance, (rows,)).astype(float)}


def _loop(design: BenchActuator, conditions: Columns) -> dict[str, np.ndarray]:
    """F = F_steady(v) + m a, friction and machine as at constant velocity."""
    frequency, amplitude, shunt = (conditions[name] for name in ("frequency", "amplitude", "shunt"))
    if np.any(2 * pi * frequency * design.inductance > SLOW * (design.internal_resistance + shunt)):
        raise WorkbenchError("force_loop of an actuator is answered where 2 pi f L is a tenth of R + shunt at most")
    if design.mount_clearance or not isinf(design.mount_stiffness):
        raise WorkbenchError("force_loop of an actuator is answered for a rigid mount without free play")
    omega, phase = 2 * pi * frequency, phase_of(conditions)
    velocity, acceleration = amplitude * omega * np.cos(phase), -amplitude * omega**2 * np.sin(phase)
    return _named(design, steady_force(design, velocity, shunt) + design.moving_mass * acceleration)


_ANSWERS: dict[str, Callable[[BenchActuator, Columns], dict[str, np.ndarray]]] = {
    "locked_force": _locked,
    "damping_velocity": _damping,
    "back_emf": _back_emf,
    "drag": _drag,
    "phase_resistance": _resistance,
    "force_loop": _loop,
}

BASE = ActuatorModel()
