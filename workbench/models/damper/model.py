"""The lumped electromagnetic damper as a bench model: force, voltage and impedance of ``effects.damper_design.Damper``.

Kinds of measurement and their columns, SI:
    damping_velocity  velocity, shunt                      -> force      steady, v constant
    back_emf          velocity [, shunt]                   -> voltage    at the terminals, open where no shunt is given
    damping_shunt     shunt [, velocity]                   -> damping    slope of a straight line F(v) up to velocity
    impedance         frequency [Hz], amplitude, shunt     -> re, im     of F/v, fundamental of both
    force_loop        frequency, amplitude, shunt, phase   -> force      x = A sin(phase)

The force is positive when it opposes a positive velocity. A shunt of 1e6 ohm is an open circuit. Every kind also knows
the states resistance_factor and viscous_factor, winding resistance and viscous damping of a row over the design's.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, replace
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
from workbench.models.damper.play import change_by_play, is_linear
from workbench.models.damper.steady_circuit import circuit_current, coupling_factor
from workbench.models.sine import phase_of

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

    def doubts(self, design: Damper) -> tuple[str, ...]:
        """Of inductance over resistance."""
        return device.doubts_of_winding(design.inductance, design.internal_resistance)

    def respond(self, design: Damper, kind: str, conditions: Columns) -> dict[str, np.ndarray]:
        """Response columns of one table, see the module."""
        if kind not in _ANSWERS:
            raise WorkbenchError(
                f"a damper cannot answer a table of kind {kind!r}; it knows {', '.join(sorted(_ANSWERS))}"
            )
        return _ANSWERS[kind](design, conditions)


def steady_force(
    design: Damper, velocity: np.ndarray, shunt: np.ndarray, viscous_factor: np.ndarray | float = 1.0
) -> np.ndarray:
    """Force at constant velocity [N]: c v + sum of force laws + K g i."""
    still = np.zeros_like(velocity)
    current = circuit_current(design, still, velocity, shunt)
    force = design.viscous_damping * viscous_factor * velocity
    force = force + design.force_constant * coupling_factor(design, still, current) * current
    for law in design.forces:
        force = force + law.force(still, velocity)
    return force


def impedance(design: Damper, drive: Drive) -> np.ndarray:
    """F/v of the fundamentals at the driving point [N s/m], complex (n,).

    Linear dampers by thesis eq. B.4; others by harmonic balance; a free play in the mount by marching in time.
    """
    if is_linear(design) and not design.mount_clearance:
        return linear_impedance(design, drive)
    points, places = _points(drive)
    return _impedance_of_points(design, points.tobytes())[places]


def _points(drive: Drive) -> tuple[np.ndarray, np.ndarray]:
    """The different points of a drive, (fields, k), and which of them every row is, (n,): repeats share their point."""
    columns = drive.columns()
    return _different(columns.tobytes(), len(columns))


@lru_cache(maxsize=64)  # every step of a fit asks at the same conditions again
def _different(columns: bytes, rows: int) -> tuple[np.ndarray, np.ndarray]:
    points, places = np.unique(np.frombuffer(columns).reshape(rows, -1), axis=1, return_inverse=True)
    return points, places


@lru_cache(maxsize=64)  # instruments, held-out rows and every step of a fit ask for the same damper again
def _impedance_of_points(design: Damper, points: bytes) -> np.ndarray:
    drive = Drive(*np.frombuffer(points).reshape(len(fields(Drive)), -1))
    tight = replace(design, mount_clearance=0.0)
    answer = linear_impedance(tight, drive) if is_linear(tight) else fundamental(tight, drive)
    return answer + change_by_play(design, drive) if design.mount_clearance else answer


def linear_impedance(design: Damper, drive: Drive) -> np.ndarray:
    """Thesis eq. B.4: the mount in series with mass, viscous damping and circuit side by side [N s/m].

    Z_i = s m + c + K^2 / (R + R_shunt + s L),   Z_m = c_m + k_m / s,   Z = Z_m Z_i / (Z_m + Z_i)
    """
    s = 2j * np.pi * drive.frequency
    circuit = design.internal_resistance + drive.shunt + s * design.inductance
    inner = s * design.moving_mass + drive.viscous(design)[:, 0] + design.force_constant**2 / circuit
    if isinf(design.mount_stiffness):
        return inner
    mount = design.mount_damping + design.mount_stiffness / s
    return mount * inner / (mount + inner)


def _force(design: Damper, conditions: Columns) -> dict[str, np.ndarray]:
    velocity, shunt = conditions["velocity"], _warm_shunt(design, conditions)
    return {"force": steady_force(design, velocity, shunt, conditions.get("viscous_factor", 1.0))}


def _voltage(design: Damper, conditions: Columns) -> dict[str, np.ndarray]:
    velocity = conditions["velocity"]
    current = circuit_current(design, np.zeros_like(velocity), velocity, _warm_shunt(design, conditions))
    return {"voltage": current * _shunt(conditions)}


def _slope(design: Damper, conditions: Columns) -> dict[str, np.ndarray]:
    shunt, viscous = _warm_shunt(design, conditions), conditions.get("viscous_factor", 1.0)
    if is_linear(design):
        circuit = design.internal_resistance + shunt
        return {"damping": design.viscous_damping * viscous + design.force_constant**2 / circuit}
    top = conditions.get("velocity", np.full_like(shunt, design.test_velocity))
    if not np.all(top > 0):
        raise WorkbenchError(
            "damping_shunt is the slope of a straight line through F(v), which here is none: give the top velocity of "
            "the line as a column velocity_m_per_s or as test_velocity_m_per_s in [device]"
        )
    rows, points = len(shunt), len(SLOPE_POINTS)
    velocity = top[:, None] * SLOPE_POINTS
    flat = (np.repeat(values, points) for values in (shunt, np.broadcast_to(viscous, (rows,))))
    force = steady_force(design, velocity.ravel(), *flat).reshape(rows, points)  # flat: no period for the laws
    centred = velocity - velocity.mean(axis=1, keepdims=True)
    return {"damping": (force * centred).sum(axis=1) / (centred**2).sum(axis=1)}


def _impedance(design: Damper, conditions: Columns) -> dict[str, np.ndarray]:
    z = impedance(design, _drive(design, conditions))
    return {"re": z.real, "im": z.imag}


def _loop(design: Damper, conditions: Columns) -> dict[str, np.ndarray]:
    if design.mount_clearance:
        raise WorkbenchError("force_loop is not answered for a mount with free play: use impedance tables")
    points, rows = _points(_drive(design, conditions))
    force = force_over_a_period(design, Drive(*points), LOOP_POINTS)  # all phases of a sine share their period
    place = np.mod(phase_of(conditions) / (2 * np.pi), 1.0) * LOOP_POINTS - 0.5
    below = np.floor(place).astype(int)
    left, right = force[rows, below % LOOP_POINTS], force[rows, (below + 1) % LOOP_POINTS]
    return {"force": left + (place - below) * (right - left)}


def _drive(design: Damper, conditions: Columns) -> Drive:
    viscous = conditions.get("viscous_factor", 1.0)
    return Drive(conditions["frequency"], conditions["amplitude"], _warm_shunt(design, conditions), viscous)


def _warm_shunt(design: Damper, conditions: Columns) -> np.ndarray:
    """The shunt with what a winding warmer than that of the design adds to the resistance of the circuit [ohm]."""
    shunt = _shunt(conditions)
    if "resistance_factor" not in conditions:
        return shunt
    return shunt + design.internal_resistance * (conditions["resistance_factor"] - 1.0)


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
