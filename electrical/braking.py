"""A machine that brakes: with shorted phases, which needs no power, and as hard as current and voltage allow.

Rotor frame and signs as in ``electrical.dq``; turning forwards and braking, i_q < 0. With zero voltage

    R i_d = omega_e psi_q,   R i_q = -omega_e psi_d

so that a machine with L_d = L_q = L brakes with T = 1.5 p^2 psi_m^2 R w / (R^2 + (p w L)^2): damping at low speed, less
beyond the electrical pole R / (p L). A braking machine needs the voltage that a motoring one with -R would.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from electrical.dq import LIMIT_SLACK, DqMachine, DriveLimits, Values, torque_of, voltage_of
from electrical.flux_map_machine import FluxMapMachine, FluxMapMachineError
from electrical.newton import damped_newton

_CLOSE = 1e-12  # voltage that is left, of the back-EMF
_CURRENTS, _ANGLES = 41, 61  # of a search for the strongest braking, over size and angle of the current
_ZOOMS = 5  # around the best point, each time to the second neighbours on both sides


@dataclass(frozen=True, eq=False)
class Braking:
    """Torque against the motion and currents at each speed; NaN where the machine's description does not reach.

    speed: mechanical [rad/s], any shape; torque [Nm], i_d, i_q: peak [A], of the shape of speed and family
    """

    speed: np.ndarray
    torque: np.ndarray
    i_d: np.ndarray
    i_q: np.ndarray

    @property
    def damping(self) -> np.ndarray:
        """T / omega [Nms/rad], of the shape of the torque."""
        return self.torque / self.speed

    @property
    def current_peak(self) -> np.ndarray:
        """Peak phase current [A], of the shape of the torque."""
        return np.hypot(self.i_d, self.i_q)


def short_circuit(machine: FluxMapMachine, speed: Values) -> Braking:
    """The steady state with shorted phases; speed: mechanical [rad/s], positive, any shape."""
    speed = np.asarray(speed, dtype=float)
    shape = np.broadcast_shapes(speed.shape, np.shape(machine.resistance))
    omega, resistance = (np.broadcast_to(v, shape) for v in (machine.pole_pairs * speed, machine.resistance))
    i = _shorted(machine, omega.ravel(), resistance.ravel()).reshape(2, *shape)
    i = np.where(machine.holds(*i), i, np.nan)
    return Braking(speed, -machine.torque(*i), *i)


def _shorted(machine: FluxMapMachine, omega: np.ndarray, resistance: np.ndarray) -> np.ndarray:
    """Currents (2, n) at electrical speeds [rad/s] and resistances [ohm] (n,).

    Raises FluxMapMachineError where no steady state is found.
    """

    def missing(i: np.ndarray) -> np.ndarray:
        psi_d, psi_q = machine.continued_flux_linkage(i)
        return -np.stack(voltage_of(resistance, (psi_d, psi_q), i[0], i[1], omega))

    def slope(i: np.ndarray) -> np.ndarray:
        (l_dd, l_dq), (l_qd, l_qq) = machine.continued_inductances(i)
        return np.array([[resistance - omega * l_qd, -omega * l_qq], [omega * l_dd, resistance + omega * l_dq]])

    close = _CLOSE * omega * float(machine.flux_linkage(0.0, 0.0)[0])
    i, found = damped_newton(missing, slope, _without_saturation(machine, omega, resistance), close)
    if not found.all():
        raise FluxMapMachineError(
            f"no steady state with shorted phases was found at {np.count_nonzero(~found)} of {len(found)} speeds: "
            "solve a finer map"
        )
    return i


def _without_saturation(machine: FluxMapMachine, omega: np.ndarray, resistance: np.ndarray) -> np.ndarray:
    plain = machine.constant_parameters(0.5 * machine.reach)
    whole = resistance**2 + omega**2 * plain.inductance_d * plain.inductance_q
    return -omega * plain.psi_m / whole * np.stack([omega * plain.inductance_q, resistance])


def strongest_braking(machine: DqMachine, limits: DriveLimits, speed: Values) -> Braking:
    """The largest torque against the motion inside current and voltage limit at each speed.

    speed: mechanical [rad/s], positive, of one shape with the machine's resistance and the limits. NaN where no current
    keeps the voltage inside its limit. A search over size and angle of the current, narrowed around the best.
    """
    speed = np.asarray(speed, dtype=float)
    most = np.broadcast_to(np.asarray(limits.current_peak, dtype=float), speed.shape)
    sizes, angles = (np.stack([np.zeros_like(most), end]) for end in (most, np.full_like(most, np.pi / 2)))
    for _ in range(_ZOOMS):
        size, angle, torque = _best_of(machine, limits, speed, sizes, angles)
        sizes, angles = _around(size, sizes, _CURRENTS), _around(angle, angles, _ANGLES)
    i_d, i_q = -size * np.sin(angle), -size * np.cos(angle)
    reached = np.isfinite(torque)
    return Braking(speed, *(np.where(reached, v, np.nan) for v in (torque, i_d, i_q)))


def _best_of(
    machine: DqMachine, limits: DriveLimits, speed: np.ndarray, sizes: np.ndarray, angles: np.ndarray
) -> tuple[np.ndarray, ...]:
    """Size [A] and angle of the best current of a grid between ends (2, ...), and its torque, -inf where none is."""
    share = [np.linspace(0.0, 1.0, n).reshape(-1, *[1] * speed.ndim) for n in (_CURRENTS, _ANGLES)]
    size, angle = (low + (high - low) * s for (low, high), s in zip((sizes, angles), share))
    size, angle = np.broadcast_arrays(size[:, None], angle[None])
    size, angle = (v.reshape(-1, *speed.shape) for v in (size, angle))
    i_d, i_q = -size * np.sin(angle), size * np.cos(angle)
    psi = machine.flux_linkage(i_d, i_q)  # of the mirror image: i_q, psi_q and torque turn their sign, R its own
    v_d, v_q = voltage_of(-machine.resistance, psi, i_d, i_q, machine.pole_pairs * speed)
    torque = torque_of(machine.pole_pairs, psi, i_d, i_q)
    allowed = v_d**2 + v_q**2 <= np.square(limits.voltage_peak) * (1 + LIMIT_SLACK)
    torque = np.where(allowed, torque, -np.inf)
    best = np.argmax(torque, axis=0)[None]
    return tuple(np.take_along_axis(v, best, 0)[0] for v in (size, angle, torque))


def _around(at: np.ndarray, ends: np.ndarray, points: int) -> np.ndarray:
    """Ends of the next search: the second neighbours of the best point, inside the present ones."""
    step = 2 * (ends[1] - ends[0]) / (points - 1)
    return np.clip(np.stack([at - step, at + step]), ends[0], ends[1])


def holds_up_to(speed: np.ndarray, damping: np.ndarray, needed: float) -> float:
    """The speed [m/s or rad/s] up to which a damping is reached without a gap, linear between points; 0 where it never
    is.

    speed: increasing [m/s or rad/s] (n,); damping, needed: [Ns/m or Nms/rad], damping (n,), NaN counts as none
    """
    enough = np.nan_to_num(damping) >= needed
    if enough.all():
        return float(speed[-1])
    first = int(np.argmin(enough))
    if first == 0:
        return 0.0
    high, low = damping[first - 1], np.nan_to_num(damping[first])
    return float(speed[first - 1] + (speed[first] - speed[first - 1]) * (high - needed) / (high - low))
