"""A run as the compiled equations take it, the step that they need, and the energy of a state."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product

import numpy as np

from actuator.compiled import MASS, VELOCITY, Record
from actuator.model import IDEAL, Actuator
from actuator.parts import CompliantMount
from control.force_loop import ForceLoop
from vehicle.commands import Command, Feedback
from vehicle.damping import DamperCurve
from vehicle.errors import VehicleError
from vehicle.models import Vehicle
from vehicle.motion import AXLE, BODY, CONTROL, FEEDS_BACK, FOLLOWS_CURVE, HELD, Equations, jacobian

_STABLE = 2.0  # step times the fastest rate; the limit of the Runge-Kutta rule is 2.78 when damped, 2.83 when not
# Largest step with an actuator that has states of its own [s]: its contact and its limits come and go within some
# milliseconds. Works are then within 0.1 % of those of a quarter of the step.
_COARSEST = 2.5e-4
_NO_CURVE = np.array([[-1.0, 1.0], [0.0, 0.0]])
_GROWS = 1e-3  # 1/s, e-fold in a quarter of an hour; less is rounding, or does not matter
_INTO = 1e-3  # m, beyond an end stop
_STEEPEST = (0.0, 0.75, 1.0)  # shares of a mount's transition; near the second its force is steepest


def equations(
    vehicle: Vehicle, actuator: Actuator, command: Command, loop: ForceLoop | None, propulsion: float
) -> Equations:
    """A vehicle whose last axle carries an actuator that is asked for a command; propulsion: F_prop [N]."""
    body = (vehicle.sprung_mass, vehicle.pitch_inertia, vehicle.cog_height, propulsion)
    rows = [
        (
            axle.position,
            axle.unsprung_mass,
            axle.spring_stiffness,
            axle.stops.bump,
            axle.stops.rebound,
            axle.stops.stiffness,
            axle.tyre.stiffness,
            axle.static_load,
        )
        for axle in vehicle.axles
    ]
    source, curve, row = _source(command)
    gains = (0.0, 0.0, 0.0, 0.0) if loop is None else (loop.proportional, loop.integral, loop.derivative, loop.filter)
    return Equations(
        _record(BODY, body),
        np.array(rows, AXLE),
        _stacked(vehicle.passive_dampers),
        *actuator.numbers,
        _record(CONTROL, (source, loop is not None, *gains)),
        curve,
        row,
        np.zeros(1),
    )


def _record(kind: np.dtype, values: tuple[float, ...]) -> Record:
    return np.array([values], kind)[0]


def _source(command: Command) -> tuple[int, np.ndarray, np.ndarray]:
    if isinstance(command, DamperCurve):
        return FOLLOWS_CURVE, np.array([command.velocity, command.force]), np.zeros(4)
    if isinstance(command, Feedback):
        return FEEDS_BACK, _NO_CURVE, np.array(command.row, dtype=float)
    return HELD, _NO_CURVE, np.zeros(4)


def _stacked(curves: Sequence[DamperCurve]) -> np.ndarray:
    """(curves, 2, points): the short ones go straight on."""
    most = max((len(curve.velocity) for curve in curves), default=2)
    stacked = np.empty((len(curves), 2, most))
    for table, curve in zip(stacked, curves, strict=True):
        v, f = np.array(curve.velocity), np.array(curve.force)
        on = v[-1] + np.arange(1, most - len(v) + 1)
        slope = (f[-1] - f[-2]) / (v[-1] - v[-2])
        table[:] = np.concatenate([v, on]), np.concatenate([f, f[-1] + slope * (on - v[-1])])
    return stacked


def largest_step(vehicle: Vehicle, actuator: Actuator, command: Command, e: Equations) -> float:
    """Step that the Runge-Kutta rule stays stable and close with [s]."""
    probed = [np.abs(np.linalg.eigvals(jacobian(e, state))).max() for state in _probes(actuator, command, e)]
    stable = _STABLE / max(_fastest_of_vehicle(vehicle), *probed)
    has_states = isinstance(actuator.mount, CompliantMount) or actuator.drive.time_constant > 0
    return float(min(stable, _COARSEST) if has_states else stable)


def _fastest_of_vehicle(vehicle: Vehicle) -> float:
    """Bound of the rates without the actuator [1/s]."""
    rates = []
    for axle, curve in zip(vehicle.axles, (*vehicle.passive_dampers, None), strict=True):
        mobility = 1 / vehicle.sprung_mass + axle.position**2 / vehicle.pitch_inertia + 1 / axle.unsprung_mass
        stiffness = axle.spring_stiffness + axle.stops.stiffness + axle.tyre.stiffness
        rates += [(stiffness * mobility) ** 0.5, 0.0 if curve is None else curve.steepest * mobility]
    return max(rates)


def _probes(actuator: Actuator, command: Command, e: Equations) -> Iterator[np.ndarray]:
    """States at which something is steep: the mount, the command's curve, an end stop, or all of them."""
    mount, stops = actuator.mount, e.axles[-1]
    deformations = [0.0]
    if isinstance(mount, CompliantMount):
        deformations = [mount.play + share * mount.transition + 1e-9 for share in _STEEPEST]
    strokes = [0.0, stops["rebound"] + _INTO] if stops["stop"] > 0 else [0.0]
    rates = [0.0, _steepest_at(command)] if isinstance(command, DamperCurve) else [0.0]
    body_rate, own = 2 + len(e.axles), 2 * (2 + len(e.axles))
    for stroke, rate, deformation in product(strokes, rates, deformations):
        state = np.zeros(e.size)
        state[0], state[body_rate] = stroke, rate
        state[own + MASS], state[own + VELOCITY] = stroke - deformation, rate
        yield state


def _steepest_at(curve: DamperCurve) -> float:
    """Middle of the steepest part of a curve [m/s]."""
    v = np.array(curve.velocity)
    k = int(np.argmax(np.diff(curve.force) / np.diff(v)))
    return float(v[k] + v[k + 1]) / 2


def require_stable_law(vehicle: Vehicle, law: Feedback) -> None:
    """VehicleError for a law that makes the vehicle swing by itself, with an ideal actuator about equilibrium."""
    e = equations(vehicle, IDEAL, law, None, 0.0)
    moving = 2 * (2 + len(vehicle.axles))
    growth = np.linalg.eigvals(jacobian(e, np.zeros(e.size))[:moving, :moving]).real.max()
    if growth > _GROWS:
        raise VehicleError(
            f"control law '{law.name}': unstable, the motion grows with {growth:.3g} /s even with an ideal actuator; "
            "change its coefficients"
        )


def stored_energy(vehicle: Vehicle, actuator: Actuator, state: np.ndarray, road: np.ndarray) -> float:
    """Kinetic and elastic energy above static equilibrium, of the actuator too [J].

    state: [SI], (size,); road: heights [m], (n,)
    """
    count = len(vehicle.axles)
    heights, rates, own = state[: 2 + count], state[2 + count : 4 + 2 * count], state[4 + 2 * count :]
    masses = [vehicle.sprung_mass, vehicle.pitch_inertia, *(axle.unsprung_mass for axle in vehicle.axles)]
    energy = float(np.dot(masses, rates**2)) / 2
    turn = np.array([heights[0], np.sin(heights[1]), *heights[2:]])
    speed = np.array([rates[0], np.cos(heights[1]) * rates[1], *rates[2:]])
    stroke, moving = vehicle.stretch_matrix @ turn, vehicle.stretch_matrix @ speed
    for k, axle in enumerate(vehicle.axles):
        beyond = stroke[k] - min(max(stroke[k], axle.stops.bump), axle.stops.rebound)
        energy += (axle.spring_stiffness * stroke[k] ** 2 + axle.stops.stiffness * beyond**2) / 2
        compression = min(heights[2 + k] - road[k], axle.static_tyre_deflection)
        lifted = heights[2 + k] - road[k] - compression  # in the air the wheel goes on rising against its weight
        energy += axle.tyre.stiffness * compression**2 / 2 + axle.static_load * lifted
    return energy + _inside_actuator(actuator, float(stroke[-1]), float(moving[-1]), own)


def _inside_actuator(actuator: Actuator, stroke: float, moving: float, own: np.ndarray) -> float:
    soft = isinstance(actuator.mount, CompliantMount)
    x, v = (own[MASS], own[VELOCITY]) if soft else (stroke, moving)
    mass = actuator.equivalent_mass * (actuator.ratio.nominal / float(actuator.ratio.at(x))) ** 2
    elastic = float(actuator.mount.energy(stroke - x)) if isinstance(actuator.mount, CompliantMount) else 0.0
    return float(mass * v**2 / 2 + elastic)
