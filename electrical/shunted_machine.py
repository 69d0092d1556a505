"""A synchronous machine that is driven, with a resistance at its terminals: how it brakes, steadily and when it swings.

What is connected is an object: three resistances in star, a six-pulse diode bridge with one resistance behind it, or
either with its short circuit at the machine's own terminals. Steady, in star, with R the resistance of a whole phase:

    T = K_t K_e w R / (R^2 + (p w L)^2),   K_t = 1.5 p psi_m,   K_e = p psi_m       (thesis 3.70, for L_d = L_q = L)

so the electrical pole R / L acts on the electrical speed p w. A machine that swings, w = W cos(nu t), answers with both
the speed and the frequency; ``dynamic_damping`` solves the dq equations for it. Two limits are known in closed form:

    p W << R / L:   T / w = K_t K_e / (R + j nu L)          the pole acts on the frequency, as in thesis B.4
    nu << R / L:    fundamental of the steady torque        the pole acts on the speed, as in thesis 3.70

so that B.4 holds for a synchronous machine too, but for small swings only (the frame turns with the rotor).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from math import ceil, pi, sqrt
from typing import Protocol

import numpy as np
from scipy.linalg import solve_banded

from electrical.diode_bridge import BRIDGE_MEAN, bridge_current, bridge_torque
from electrical.dq import require
from electrical.synchronous_machine import SynchronousMachine
from units import Values

_STEPS = 256  # of a period, for the fundamental of a steady law; a torque that falls as 1/w is right to 1e-5
_SIDE_ORDERS = 24  # harmonics beyond the swing in electrical radians; they fall faster than exponentially there


class Circuit(Protocol):
    """What a driven machine feeds, with a resistance [ohm] that the bench can change."""

    def slope(self, machine: SynchronousMachine, shunt: Values) -> Values:
        """dT / dw of the slow machine [Nms/rad], beyond the voltage drop of a rectifier; shunt: [ohm], any shape."""

    def torque(self, machine: SynchronousMachine, speed: Values, shunt: Values) -> Values:
        """Steady braking torque [Nm] at mechanical speed [rad/s] and shunt [ohm], which broadcast."""

    def dynamic_damping(
        self, machine: SynchronousMachine, frequency: Values, top_speed: Values, shunt: Values
    ) -> np.ndarray:
        """Fundamental of the braking torque over that of w = top_speed cos(2 pi frequency t) [Nms/rad], complex.

        frequency: [Hz]; top_speed: mechanical [rad/s]; shunt: [ohm]; they broadcast
        Returns: dynamic_damping of their shape
        """


@dataclass(frozen=True)
class Star:
    """Three equal resistances in star. lead: resistance in series with each [ohm], at every shunt."""

    lead: float = 0.0

    def slope(self, machine: SynchronousMachine, shunt: Values) -> Values:
        """K_t K_e / (R_ph + R_lead + R_shunt) [Nms/rad] (thesis 3.73, B.2); shunt: [ohm], any shape."""
        return machine.torque_constant * machine.pole_pairs * machine.psi_m / self._whole(machine, shunt)

    def torque(self, machine: SynchronousMachine, speed: Values, shunt: Values) -> Values:
        """Thesis 3.70 [Nm], for unequal L_d and L_q as well; speed: [rad/s], shunt: [ohm], which broadcast."""
        whole, omega = self._whole(machine, shunt), machine.pole_pairs * np.asarray(speed)
        scale = machine.psi_m * omega / (whole**2 + omega**2 * machine.inductance_d * machine.inductance_q)
        return -machine.torque(-omega * machine.inductance_q * scale, -whole * scale)

    def dynamic_damping(
        self, machine: SynchronousMachine, frequency: Values, top_speed: Values, shunt: Values
    ) -> np.ndarray:
        """dynamic_damping [Nms/rad], complex, of the arguments' shape: dq equations, exact to the harmonics kept.

        frequency: [Hz]; top_speed: mechanical [rad/s]; shunt: [ohm]; they broadcast
        """
        rows = np.broadcast_arrays(frequency, top_speed, self._whole(machine, shunt))
        answers = [_swing_of_dq(machine.with_resistance(r), 2 * pi * f, w) for f, w, r in zip(*(v.flat for v in rows))]
        return np.array(answers).reshape(rows[0].shape)

    def _whole(self, machine: SynchronousMachine, shunt: Values) -> Values:
        return machine.resistance + self.lead + np.asarray(shunt)


@dataclass(frozen=True)
class LinearStar(Star):
    """A star at a machine of commutator kind, or at a synchronous one that hardly swings: thesis eqs B.2, B.3, B.5."""

    def dynamic_damping(
        self, machine: SynchronousMachine, frequency: Values, top_speed: Values, shunt: Values
    ) -> np.ndarray:
        """dynamic_damping = K_t K_e / (R + j omega L_q) [Nms/rad], of that shape, whatever the top_speed [rad/s]

        frequency: [Hz]; shunt: [ohm]
        """
        whole = self._whole(machine, shunt)
        pole = 1 + 2j * pi * np.asarray(frequency) * machine.inductance_q / whole
        return np.asarray(self.slope(machine, shunt) / pole + 0.0 * np.asarray(top_speed))


@dataclass(frozen=True)
class Bridge:
    """A six-pulse diode bridge with the shunt behind it.

        I = (E_0 - 2 V_d) / (2 R_ph + 2 r_d + R_shunt + 3/pi omega_e L),   E_0 = 3 sqrt(3)/pi p psi_m w
        T w = I^2 (2 R_ph + 2 r_d + R_shunt) + 2 V_d I

    drop: V_d of one diode [V]; diode_resistance: r_d of one diode [ohm]. The direct current is taken as smooth; valid
    while two diodes or three conduct, overlap below 60 degrees. Textbook (Mohan, Undeland and Robbins, ch. 5).
    """

    drop: float = 0.0
    diode_resistance: float = 0.0

    def __post_init__(self) -> None:
        require(self.drop >= 0, "the drop of a diode must not be negative", self.drop)
        require(self.diode_resistance >= 0, "the resistance of a diode must not be negative", self.diode_resistance)

    def slope(self, machine: SynchronousMachine, shunt: Values) -> Values:
        """(E_0 / w)^2 / (2 R_ph + 2 r_d + R_shunt) [Nms/rad]; shunt: [ohm], any shape."""
        return (BRIDGE_MEAN * machine.pole_pairs * machine.psi_m) ** 2 / self._whole(machine, shunt)

    def current(self, machine: SynchronousMachine, speed: Values, shunt: Values) -> np.ndarray:
        """Direct current [A] at mechanical speed [rad/s] and shunt [ohm], which broadcast."""
        inductance = 0.5 * (machine.inductance_d + machine.inductance_q)
        omega, whole = machine.pole_pairs * np.abs(speed), self._whole(machine, shunt)
        return bridge_current(omega, flux=machine.psi_m, inductance=inductance, resistance=whole, voltage=2 * self.drop)

    def torque(self, machine: SynchronousMachine, speed: Values, shunt: Values) -> Values:
        """Power that the resistances and diodes take over the speed [Nm]; speed: [rad/s], shunt: [ohm]."""
        current, whole = self.current(machine, speed, shunt), self._whole(machine, shunt)
        return bridge_torque(current, speed, resistance=whole, voltage=2 * self.drop)

    def dynamic_damping(
        self, machine: SynchronousMachine, frequency: Values, top_speed: Values, shunt: Values
    ) -> np.ndarray:
        """dynamic_damping [Nms/rad], of the arguments' shape: fundamental of the steady torque, for slow swings.

        frequency: [Hz], well below the electrical pole; top_speed: mechanical [rad/s]; shunt: [ohm]; they broadcast
        """
        of_speed = _fundamental(lambda speed, at: self.torque(machine, speed, at), top_speed, shunt)
        return np.asarray(of_speed + 0j * np.asarray(frequency))

    def _whole(self, machine: SynchronousMachine, shunt: Values) -> Values:
        return 2 * (machine.resistance + self.diode_resistance) + np.asarray(shunt)


@dataclass(frozen=True)
class ShortedAtTerminals:
    """A circuit whose shunt of zero is a short circuit of the machine's own terminals, in front of everything else."""

    behind: Circuit
    short: Circuit = field(default_factory=Star)

    def slope(self, machine: SynchronousMachine, shunt: Values) -> Values:
        """As the circuit behind, or shorted [Nms/rad]; shunt: [ohm], any shape."""
        return self._chosen(lambda circuit: circuit.slope(machine, shunt), shunt)

    def torque(self, machine: SynchronousMachine, speed: Values, shunt: Values) -> Values:
        """As the circuit behind, or shorted [Nm]; speed: [rad/s], shunt: [ohm], which broadcast."""
        return self._chosen(lambda circuit: circuit.torque(machine, speed, shunt), shunt)

    def dynamic_damping(
        self, machine: SynchronousMachine, frequency: Values, top_speed: Values, shunt: Values
    ) -> np.ndarray:
        """dynamic_damping [Nms/rad], of the arguments' shape, as the circuit behind, or shorted.

        frequency: [Hz]; top_speed: mechanical [rad/s]; shunt: [ohm]; they broadcast
        """
        return self._chosen(lambda circuit: circuit.dynamic_damping(machine, frequency, top_speed, shunt), shunt)

    def _chosen(self, ask: Callable[[Circuit], Values], shunt: Values) -> np.ndarray:
        return np.where(np.asarray(shunt) > 0, ask(self.behind), ask(self.short))


def steady_fundamental(top_speed: Values, pole_speed: Values) -> Values:
    """Fundamental of v / (1 + (v / v_p)^2) at v = V cos, over V, dimensionless: 2 / a^2 (1 - 1 / sqrt(1 + a^2)).

    top_speed: V [rad/s or m/s]; pole_speed: v_p at which the machine brakes most [rad/s or m/s]; a = V / v_p.
    steady_fundamental is dimensionless, of the shape that both broadcast to.
    The limit of ``Star.dynamic_damping`` for slow swings, with L_d = L_q.
    """
    a2 = np.square(np.asarray(top_speed, dtype=float) / pole_speed)
    root = np.sqrt(1 + a2)
    return 2 / (root * (1 + root))


def _fundamental(law: Callable[[Values, Values], Values], top_speed: Values, shunt: Values) -> np.ndarray:
    """Of a law torque(speed, shunt) at speed = top_speed cos, over top_speed."""
    cosine = np.cos(2 * pi * (np.arange(_STEPS) + 0.5) / _STEPS)
    top, at = np.broadcast_arrays(np.asarray(top_speed, dtype=float), shunt)
    return 2 * np.mean(law(top[..., None] * cosine, at[..., None]) * cosine, axis=-1) / top


def _swing_of_dq(machine: SynchronousMachine, nu: float, top_speed: float) -> complex:
    """-T_1 / W of the periodic solution of  d psi_d/dt = -R i_d + omega_e psi_q,  d psi_q/dt = -R i_q - omega_e psi_d.

    With omega_e = p W cos(nu t) the equations are linear with periodic coefficients: the harmonics n of psi are coupled
    to n - 1 and n + 1 only (Hill's method).
    """
    swing = machine.pole_pairs * top_speed
    most = ceil(swing / nu) + _SIDE_ORDERS
    orders = np.arange(-most, most + 1)
    rates = [1j * nu * orders + machine.resistance / one for one in (machine.inductance_d, machine.inductance_q)]
    bands = np.zeros((7, 2 * len(orders)), dtype=complex)  # of the unknowns psi_d,n and psi_q,n in turn
    bands[3] = np.ravel(rates, order="F")
    bands[[0, 4], 1::2] = -0.5 * swing  # of psi_q in the equation of psi_d, one order lower and one higher
    bands[[2, 6], 0::2] = 0.5 * swing
    source = np.zeros(2 * len(orders), dtype=complex)
    source[2 * most] = machine.resistance * machine.psi_m / machine.inductance_d
    found = solve_banded((3, 3), bands, source, check_finite=False)
    psi_d, psi_q = (_over_time(found[start::2], orders) for start in (0, 1))
    i_d, i_q = (psi_d - machine.psi_m) / machine.inductance_d, psi_q / machine.inductance_q
    angles = 2 * pi * np.arange(len(psi_d)) / len(psi_d)
    return complex(-2 * np.mean(machine.torque(i_d, i_q) * np.exp(-1j * angles)) / top_speed)


def _over_time(harmonics: np.ndarray, orders: np.ndarray) -> np.ndarray:
    """A signal of one period in equal steps, twice as many as harmonics, so that a product of two does not alias."""
    spectrum = np.zeros(2 * len(orders), dtype=complex)
    spectrum[orders] = harmonics
    return np.real(np.fft.ifft(spectrum)) * len(spectrum)


def seen_in_a_line(
    force_constant: float, resistance: float, inductance: float, pole_pairs: int = 1
) -> SynchronousMachine:
    """The machine of a linear damper F = K^2 / R v, with speeds in m/s and torques in N.

    force_constant: K = sqrt(K_t K_e) / tau [N/A = Vs/m]; resistance, inductance: of one phase [ohm], [H]
    pole_pairs: p / tau of the electrical angle over the travel, if it matters; 1 where only the slope is asked for
    """
    psi_m = force_constant / (sqrt(1.5) * pole_pairs)
    return replace(
        SynchronousMachine(pole_pairs, psi_m, 1.0, 1.0, resistance), inductance_d=inductance, inductance_q=inductance
    )
