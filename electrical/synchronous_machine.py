"""A synchronous machine with constant parameters, and what a current and a voltage limit leave of it.

Rotor frame, amplitude-invariant: currents, voltages and flux linkages are peak phase values. Motor signs.

    v_d = R i_d - omega_e L_q i_q
    v_q = R i_q + omega_e (L_d i_d + psi_m)
    T   = 1.5 p (psi_d i_q - psi_q i_d) = 1.5 p i_q (psi_m + (L_d - L_q) i_d)

Speeds at the interface are mechanical [rad/s]; omega_e = p omega_m. Iron loss, saturation and mechanical loss are left
out, so that deep field weakening is optimistic: 16 % more power than the thesis's FluxMotor run gives.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt

import numpy as np

GOLDEN = (sqrt(5.0) - 1.0) / 2.0
GOLDEN_STEPS = 64  # shrinks an interval to 4e-14 of its length
VOLTAGE_SLACK = 1e-9  # relative; a point this close to a limit counts as lying on it


@dataclass(frozen=True)
class SynchronousMachine:
    """Constant-parameter permanent-magnet synchronous machine.

    pole_pairs: p
    psi_m: magnet flux linkage, peak of one phase [Wb]
    inductance_d, inductance_q: phase inductances L_d, L_q [H], may differ either way
    resistance: one phase R [ohm], may be zero

    Every field but ``pole_pairs`` may be an array that broadcasts against the speeds: a family of machines.
    """

    pole_pairs: int
    psi_m: float
    inductance_d: float
    inductance_q: float
    resistance: float

    def __post_init__(self):
        _require(self.pole_pairs > 0, "pole pairs must be positive", self.pole_pairs)
        _require(np.all(np.asarray(self.psi_m) > 0), "magnet flux linkage must be positive", self.psi_m)
        _require(np.all(np.asarray(self.inductance_d) > 0), "L_d must be positive", self.inductance_d)
        _require(np.all(np.asarray(self.inductance_q) > 0), "L_q must be positive", self.inductance_q)
        _require(np.all(np.asarray(self.resistance) >= 0), "resistance must not be negative", self.resistance)

    @property
    def saliency(self):
        """L_d - L_q [H]; negative for the usual buried magnet, zero for a magnet on a round rotor."""
        return self.inductance_d - self.inductance_q

    @property
    def torque_constant(self):
        """K_t = 1.5 p psi_m, torque per peak ampere on the q axis [Nm/A]."""
        return 1.5 * self.pole_pairs * self.psi_m

    def flux_linkage(self, i_d, i_q):
        """(psi_d, psi_q) [Wb] at peak phase currents i_d, i_q [A]."""
        return self.psi_m + self.inductance_d * i_d, self.inductance_q * i_q

    def torque(self, i_d, i_q):
        """T = 1.5 p (psi_d i_q - psi_q i_d) [Nm]."""
        psi_d, psi_q = self.flux_linkage(i_d, i_q)
        return 1.5 * self.pole_pairs * (psi_d * i_q - psi_q * i_d)

    def voltage(self, i_d, i_q, speed):
        """(v_d, v_q) in the steady state [V peak phase] at mechanical speed [rad/s]."""
        psi_d, psi_q = self.flux_linkage(i_d, i_q)
        omega_e = self.pole_pairs * speed
        return self.resistance * i_d - omega_e * psi_q, self.resistance * i_q + omega_e * psi_d


@dataclass(frozen=True)
class DriveLimits:
    """What the power electronics allow: peak phase current [A] and peak phase voltage [V]."""

    current_peak: float
    voltage_peak: float

    def __post_init__(self):
        _require(np.all(np.asarray(self.current_peak) > 0), "current limit must be positive", self.current_peak)
        _require(np.all(np.asarray(self.voltage_peak) > 0), "voltage limit must be positive", self.voltage_peak)

    @classmethod
    def from_dc_bus(cls, current_peak, dc_voltage) -> DriveLimits:
        """Limits of an inverter in its linear range: peak phase voltage V_DC / sqrt(3)."""
        return cls(current_peak, dc_voltage / sqrt(3.0))


@dataclass(frozen=True)
class Envelope:
    """Largest motoring torque at each speed and the currents that give it; NaN at speeds out of reach."""

    speed: np.ndarray  # rad/s, mechanical
    torque: np.ndarray  # Nm
    i_d: np.ndarray  # A peak
    i_q: np.ndarray  # A peak
    voltage_peak: np.ndarray  # V

    @property
    def power(self) -> np.ndarray:
        """Mechanical power [W]."""
        return self.torque * self.speed

    @property
    def current_peak(self) -> np.ndarray:
        """Peak phase current [A]."""
        return np.hypot(self.i_d, self.i_q)


@dataclass(frozen=True)
class OperatingMap:
    """Smallest current, and the voltage that goes with it, for each torque and speed; NaN where out of reach."""

    torque: np.ndarray  # Nm
    speed: np.ndarray  # rad/s, mechanical
    i_d: np.ndarray  # A peak
    i_q: np.ndarray  # A peak
    voltage_peak: np.ndarray  # V peak phase

    @property
    def current_peak(self) -> np.ndarray:
        """Peak phase current [A]."""
        return np.hypot(self.i_d, self.i_q)


@dataclass(frozen=True)
class PowerPoint:
    """A mechanical power [W] and the mechanical speed [rad/s] at which it occurs."""

    power: float
    speed: float


def mtpa_currents(machine: SynchronousMachine, current_peak):
    """(i_d, i_q) of the largest torque per ampere at a given peak phase current [A].

    i_d = 2 dL I^2 / (psi_m + sqrt(psi_m^2 + 8 dL^2 I^2)),  dL = L_d - L_q
    i_q = sqrt(I^2 - i_d^2)

    The textbook root (-psi_m + sqrt(...)) / (4 dL) in the form that stays exact at dL = 0.
    """
    d_l = machine.saliency
    root = np.sqrt(machine.psi_m**2 + 8 * d_l**2 * current_peak**2)
    i_d = 2 * d_l * current_peak**2 / (machine.psi_m + root)
    return i_d, np.sqrt(current_peak**2 - i_d**2)


def corner_speed(machine: SynchronousMachine, limits: DriveLimits, i_d, i_q):
    """Mechanical speed at which given motoring currents meet the voltage limit [rad/s]; 0 where R alone uses it up.

    |v|^2 = omega^2 (psi_d^2 + psi_q^2) + 2 R omega T / (1.5 p) + R^2 (i_d^2 + i_q^2) = V^2, positive root.
    """
    psi_d, psi_q = machine.flux_linkage(i_d, i_q)
    quadratic = psi_d**2 + psi_q**2
    half_linear = machine.resistance * machine.torque(i_d, i_q) / (1.5 * machine.pole_pairs)
    constant = np.minimum(machine.resistance**2 * (i_d**2 + i_q**2) - limits.voltage_peak**2, 0.0)
    omega_e = -constant / (half_linear + np.sqrt(half_linear**2 - quadratic * constant))
    return omega_e / machine.pole_pairs


def base_speed(machine: SynchronousMachine, limits: DriveLimits):
    """Highest mechanical speed at which the full current gives its largest torque [rad/s].

    The full current sits on the MTPA point, which is the q axis when L_d = L_q; resistance is counted. Use
    ``corner_speed(machine, limits, 0.0, limits.current_peak)`` for the q axis of a salient machine.
    """
    return corner_speed(machine, limits, *mtpa_currents(machine, limits.current_peak))


def power_at_base_speed(machine: SynchronousMachine, limits: DriveLimits):
    """Mechanical power at the base speed, MTPA torque times base speed [W]."""
    torque = machine.torque(*mtpa_currents(machine, limits.current_peak))
    return torque * base_speed(machine, limits)


def torque_speed_envelope(machine: SynchronousMachine, limits: DriveLimits, speed) -> Envelope:
    """Largest motoring torque under both limits at each speed: MTPA, field weakening and MTPV in one search.

    At one speed the currents inside both limits form a convex set (a disc cut by an ellipse). For each i_d the largest
    allowed i_q is therefore a concave function of i_d, and times the linear psi_m + dL i_d the torque has a single
    maximum, which a golden-section search over i_d finds whichever limit rules there.

    speed: mechanical [rad/s], not negative, any shape
    Quadrant i_q >= 0. Torque and currents are NaN where no current keeps the voltage inside its limit.
    """
    speed = np.asarray(speed, dtype=float)
    _require(np.all(speed >= 0), "the motoring envelope needs speeds that are not negative", speed)
    low, high = _direct_current_range(machine, limits, speed)
    i_d = _golden_maximum(lambda i: _envelope_merit(machine, limits, speed, i), low, high)
    i_q, excess = _largest_i_q(machine, limits, speed, i_d)
    i_q = np.where(excess <= VOLTAGE_SLACK * limits.voltage_peak**2, i_q, np.nan)
    i_d = np.where(np.isnan(i_q), np.nan, i_d)
    voltage = np.hypot(*machine.voltage(i_d, i_q, speed))
    return Envelope(speed, machine.torque(i_d, i_q), i_d, i_q, voltage)


def maximum_power(
    machine: SynchronousMachine, limits: DriveLimits, maximum_speed: float, *, samples: int = 25, zooms: int = 3
) -> PowerPoint:
    """Largest mechanical power up to a given mechanical speed [rad/s]; an ideal machine needs that bound.

    Samples the envelope between base speed and maximum speed, then resamples round the best one. Deep in the MTPV
    region the power hardly changes, so its speed is then the bound itself. A family of machines has its fields in
    arrays of shape (n, 1) and gets powers and speeds of shape (n,).
    """
    low = np.minimum(base_speed(machine, limits), maximum_speed)
    high = np.broadcast_to(float(maximum_speed), np.shape(low))
    for _ in range(zooms):
        speed = low + (high - low) * np.linspace(0.0, 1.0, samples)
        power = np.nan_to_num(torque_speed_envelope(machine, limits, speed).power, nan=-np.inf)
        best = np.argmax(power, axis=-1, keepdims=np.ndim(low) > 0)
        low, high, point = _neighbours(speed, power, best)
    return point


def operating_map(machine: SynchronousMachine, limits: DriveLimits, torque, speed) -> OperatingMap:
    """Peak phase current and voltage needed for each torque and speed, with as little current as the voltage allows.

    On a line of constant torque both |i|^2 and |v|^2 are convex in i_d (the cross term of |v|^2 is 2 R omega T/(1.5 p),
    a constant). The current sits on the MTPA point, or where the voltage meets its limit on the way to the point of
    least voltage. NaN where the torque needs more than the current or the voltage limit.

    torque [Nm] and speed [rad/s, mechanical], arrays that broadcast; any signs (all four quadrants).
    """
    torque, speed = np.broadcast_arrays(np.asarray(torque, dtype=float), np.asarray(speed, dtype=float))
    low, high = _direct_current_range(machine, limits, speed)
    square = _voltage_square(machine, torque, speed)
    mtpa = _golden_maximum(lambda i: -(i**2) - _i_q_for(machine, torque, i) ** 2, low, high)
    mtpv = _golden_maximum(lambda i: -square(i), low, mtpa)
    i_d = _least_weakening(square, limits.voltage_peak**2, mtpv, mtpa)
    i_q = _i_q_for(machine, torque, i_d)
    reached = _inside_limits(limits, i_d, i_q, square(i_d))
    i_d, i_q = np.where(reached, i_d, np.nan), np.where(reached, i_q, np.nan)
    return OperatingMap(torque, speed, i_d, i_q, np.hypot(*machine.voltage(i_d, i_q, speed)))


def _require(condition, expectation, found):
    if not condition:
        raise ValueError(f"{expectation}; found {found}")


def _direct_current_range(machine, limits, speed):
    """Range of i_d inside the current limit in which psi_m + dL i_d stays positive."""
    shape = np.broadcast_shapes(np.shape(speed), np.shape(machine.psi_m), np.shape(limits.current_peak))
    current = np.broadcast_to(np.asarray(limits.current_peak, dtype=float), shape)
    d_l = np.broadcast_to(np.asarray(machine.saliency, dtype=float), shape)
    with np.errstate(divide="ignore"):
        turning = (1 - 1e-9) * machine.psi_m / np.abs(d_l)  # |i_d| at which the torque changes its sign
    low = np.where(d_l > 0, np.maximum(-current, -turning), -current)
    high = np.where(d_l < 0, np.minimum(current, turning), current)
    return low, high


def _largest_i_q(machine, limits, speed, i_d):
    """Largest i_q >= 0 inside both limits at this i_d, and by how much |v|^2 exceeds V^2 at best [V^2]."""
    omega_e = machine.pole_pairs * speed
    psi_d = machine.psi_m + machine.inductance_d * i_d
    quadratic = machine.resistance**2 + (omega_e * machine.inductance_q) ** 2
    half_linear = machine.resistance * omega_e * (psi_d - machine.inductance_q * i_d)
    constant = (machine.resistance * i_d) ** 2 + (omega_e * psi_d) ** 2 - limits.voltage_peak**2
    chord = np.sqrt(np.maximum(limits.current_peak**2 - i_d**2, 0.0))
    with np.errstate(divide="ignore", invalid="ignore"):
        root = np.sqrt(np.maximum(half_linear**2 - quadratic * constant, 0.0))
        on_ellipse = np.where(quadratic > 0, (root - half_linear) / quadratic, np.inf)
        least_voltage = np.where(quadratic > 0, np.clip(-half_linear / quadratic, 0.0, chord), 0.0)
    excess = quadratic * least_voltage**2 + 2 * half_linear * least_voltage + constant
    return np.clip(on_ellipse, 0.0, chord), excess


def _envelope_merit(machine, limits, speed, i_d):
    """Torque where i_d is allowed, minus the excess of |v|^2 elsewhere: one peak over the whole range of i_d."""
    i_q, excess = _largest_i_q(machine, limits, speed, i_d)
    return np.where(excess > 0, -excess, machine.torque(i_d, i_q))


def _golden_maximum(merit, low, high):
    """Position of the single maximum of ``merit`` between low and high, elementwise."""
    for _ in range(GOLDEN_STEPS):
        left, right = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
        go_left = merit(left) > merit(right)
        low, high = np.where(go_left, low, left), np.where(go_left, right, high)
    return (low + high) / 2


def _neighbours(speed, power, best):
    """New search interval round the best sample, and that sample."""
    last = speed.shape[-1] - 1
    take = _take_last if np.ndim(best) else _take_scalar
    low, high = take(speed, np.maximum(best - 1, 0)), take(speed, np.minimum(best + 1, last))
    point = PowerPoint(_squeeze(take(power, best)), _squeeze(take(speed, best)))
    return low, high, point


def _take_last(array, index):
    return np.take_along_axis(array, index, axis=-1)


def _take_scalar(array, index):
    return array[index]


def _squeeze(value):
    return value[..., 0] if np.ndim(value) else float(value)


def _i_q_for(machine, torque, i_d):
    """i_q [A] that gives this torque at this i_d."""
    return torque / (1.5 * machine.pole_pairs * (machine.psi_m + machine.saliency * i_d))


def _voltage_square(machine, torque, speed):
    """|v|^2 as a function of i_d on the lines of constant torque."""

    def square(i_d):
        v_d, v_q = machine.voltage(i_d, _i_q_for(machine, torque, i_d), speed)
        return v_d**2 + v_q**2

    return square


def _least_weakening(square, limit, mtpv, mtpa):
    """i_d nearest to MTPA at which |v|^2 <= limit, by bisection; the MTPV point where even that exceeds the limit."""
    allowed, wanted = mtpv, mtpa
    allowed = np.where(square(mtpa) <= limit, mtpa, allowed)
    for _ in range(GOLDEN_STEPS):
        middle = (allowed + wanted) / 2
        fits = square(middle) <= limit
        allowed, wanted = np.where(fits, middle, allowed), np.where(fits, wanted, middle)
    return allowed


def _inside_limits(limits, i_d, i_q, square):
    inside_current = i_d**2 + i_q**2 <= limits.current_peak**2 * (1 + VOLTAGE_SLACK)
    return inside_current & (square <= limits.voltage_peak**2 * (1 + VOLTAGE_SLACK))
