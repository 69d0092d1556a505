"""The lumped electromagnetic damper as a bench model: force, voltage and impedance of ``effects.damper_design.Damper``.

Kinds of measurement and their columns, SI:
    damping_velocity  velocity, shunt                      -> force      steady, v constant
    back_emf          velocity [, shunt]                   -> voltage    at the terminals, open where no shunt is given
    damping_shunt     shunt [, velocity]                   -> damping    slope of a straight line F(v) up to velocity
    impedance         frequency [Hz], amplitude, shunt     -> re, im     of F/v, fundamental of both
    force_loop        frequency, amplitude, shunt, phase   -> force      x = A sin(phase)

The force is positive when it opposes a positive velocity. A shunt of 1e6 ohm is an open circuit.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache
from math import isinf

import numpy as np

from effects.base import Columns
from effects.damper_design import Damper
from workbench.data.table import OPEN_CIRCUIT, Tolerance
from workbench.errors import WorkbenchError
from workbench.models import device
from workbench.models.base import BaseModel
from workbench.models.damper.harmonic_balance import Drive, force_over_a_period, fundamental
from workbench.models.damper.play import change_by_play
from workbench.models.damper.steady_circuit import circuit_current, coupling_factor

SLOPE_POINTS = np.linspace(0.1, 1.0, 10)  # velocities of the straight line of damping_shunt, of the top velocity
LOOP_POINTS = 256  # steps of a period of a force loop; linear in between: 8e-5 of the amplitude

_REQUIRED = ("force_constant", "internal_resistance", "moving_mass", "viscous_damping")
_OPTIONAL = ("inductance", "mount_stiffness", "mount_damping", "mount_clearance", "test_velocity")


class DamperModel(BaseModel):
    """The base model of the damper bench; see the module for the kinds it answers."""

    name = "damper"

    def accepts(self, device_table: Mapping[str, object]) -> bool:
        return "force_constant" in device.names(device_table)

    def design(self, device_table: Mapping[str, object]) -> Damper:
        """The damper of the ``[device]`` table; keys are the fields of ``Damper`` with a unit at their end."""
        values = device.numbers(device_table, _REQUIRED, _OPTIONAL)
        device.require_positive(values, "force_constant", "internal_resistance", "moving_mass")
        return Damper(**values)

    def with_tolerance(self, design: Damper, tolerance: Tolerance, z: float) -> Damper:
        """The damper with one constant moved by z standard deviations."""
        return device.moved(design, tolerance, z, _REQUIRED + _OPTIONAL)

    def respond(self, design: Damper, kind: str, conditions: Columns) -> dict[str, np.ndarray]:
        """Response columns of one table, see the module."""
        if kind not in _ANSWERS:
            raise WorkbenchError(
                f"a damper cannot answer a table of kind {kind!r}; it knows {', '.join(sorted(_ANSWERS))}"
            )
        return _ANSWERS[kind](design, conditions)


def steady_force(design: Damper, velocity: np.ndarray, shunt: np.ndarray) -> np.ndarray:
    """Force at constant velocity [N]: c v + sum of force laws + K g i."""
    still = np.zeros_like(velocity)
    current = circuit_current(design, still, velocity, shunt)
    force = design.viscous_damping * velocity
    force = force + design.force_constant * coupling_factor(design, still, current) * current
    for law in design.forces:
        force = force + law.force(still, velocity)
    return force


def impedance(design: Damper, frequency: np.ndarray, amplitude: np.ndarray, shunt: np.ndarray) -> np.ndarray:
    """F/v of the fundamentals at the driving point [N s/m], complex (n,).

    Linear dampers by thesis eq. B.4; others by harmonic balance; a free play in the mount by marching in time.
    """
    if _is_linear(design) and not design.mount_clearance:
        return linear_impedance(design, frequency, shunt)
    points, places = np.unique(np.stack([frequency, amplitude, shunt]), axis=1, return_inverse=True)
    return _impedance_of_points(design, points.tobytes())[places]  # repeats share their point


@lru_cache(maxsize=16)  # instruments and held-out rows ask for the same damper again
def _impedance_of_points(design: Damper, points: bytes) -> np.ndarray:
    drive = Drive(*np.frombuffer(points).reshape(3, -1))
    tight = replace(design, mount_clearance=0.0)
    if _is_linear(tight):
        answer = linear_impedance(tight, drive.frequency, drive.shunt)
    else:
        answer = fundamental(tight, drive)
    return answer + change_by_play(design, drive) if design.mount_clearance else answer


def linear_impedance(design: Damper, frequency: np.ndarray, shunt: np.ndarray) -> np.ndarray:
    """Thesis eq. B.4: the mount in series with mass, viscous damping and circuit side by side [N s/m].

    Z_i = s m + c + K^2 / (R + R_shunt + s L),   Z_m = c_m + k_m / s,   Z = Z_m Z_i / (Z_m + Z_i)
    """
    s = 2j * np.pi * frequency
    circuit = design.internal_resistance + shunt + s * design.inductance
    inner = s * design.moving_mass + design.viscous_damping + design.force_constant**2 / circuit
    if isinf(design.mount_stiffness):
        return inner
    mount = design.mount_damping + design.mount_stiffness / s
    return mount * inner / (mount + inner)


def _is_linear(design: Damper) -> bool:
    return not (design.forces or design.circuits or design.couplings)


def _force(design: Damper, conditions: Columns) -> dict[str, np.ndarray]:
    return {"force": steady_force(design, conditions["velocity"], _shunt(conditions))}


def _voltage(design: Damper, conditions: Columns) -> dict[str, np.ndarray]:
    velocity, shunt = conditions["velocity"], _shunt(conditions)
    return {"voltage": circuit_current(design, np.zeros_like(velocity), velocity, shunt) * shunt}


def _slope(design: Damper, conditions: Columns) -> dict[str, np.ndarray]:
    shunt = conditions["shunt"]
    if _is_linear(design):
        circuit = design.internal_resistance + shunt
        return {"damping": design.viscous_damping + design.force_constant**2 / circuit}
    top = conditions.get("velocity", np.full_like(shunt, design.test_velocity))
    if not np.all(top > 0):
        raise WorkbenchError(
            "damping_shunt is the slope of a straight line through F(v), which here is none: give the top velocity of "
            "the line as a column velocity_m_per_s or as test_velocity_m_per_s in [device]"
        )
    velocity = top[:, None] * SLOPE_POINTS
    force = steady_force(design, velocity, np.broadcast_to(shunt[:, None], velocity.shape))
    centred = velocity - velocity.mean(axis=1, keepdims=True)
    return {"damping": (force * centred).sum(axis=1) / (centred**2).sum(axis=1)}


def _impedance(design: Damper, conditions: Columns) -> dict[str, np.ndarray]:
    z = impedance(design, conditions["frequency"], conditions["amplitude"], _shunt(conditions))
    return {"re": z.real, "im": z.imag}


def _loop(design: Damper, conditions: Columns) -> dict[str, np.ndarray]:
    drive = Drive(conditions["frequency"], conditions["amplitude"], _shunt(conditions))
    if design.mount_clearance:
        raise WorkbenchError("force_loop is not answered for a mount with free play: use impedance tables")
    force = force_over_a_period(design, drive, LOOP_POINTS)
    place = np.mod(conditions["phase"] / (2 * np.pi), 1.0) * LOOP_POINTS - 0.5
    below = np.floor(place).astype(int)
    rows, part = np.arange(len(place)), place - below
    left, right = force[rows, below % LOOP_POINTS], force[rows, (below + 1) % LOOP_POINTS]
    return {"force": left + part * (right - left)}


def _shunt(conditions: Columns) -> np.ndarray:
    if "shunt" in conditions:
        return conditions["shunt"]
    length = len(next(iter(conditions.values())))
    return np.full(length, OPEN_CIRCUIT)


_ANSWERS = {
    "damping_velocity": _force,
    "back_emf": _voltage,
    "damping_shunt": _slope,
    "impedance": _impedance,
    "force_loop": _loop,
}

BASE = DamperModel()
