"""A synchronous machine in the rotor frame, and what a current and a voltage limit leave of it.

Rotor frame, amplitude-invariant: currents, voltages and flux linkages are peak phase values. Motor signs.

    T   = 1.5 p (psi_d i_q - psi_q i_d)
    v_d = R i_d - omega_e psi_q,    v_q = R i_q + omega_e psi_d,    omega_e = p omega_m

Whatever describes the flux linkages is a ``DqMachine``: constant parameters (``SynchronousMachine``) or a map of field
solutions (``FluxMapMachine``). MTPA, base speed, envelope, MTPV and operating map are written here once, for both.
Speeds are mechanical [rad/s]. Iron loss and mechanical loss are left out, so that deep field weakening is optimistic.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import sqrt
from typing import Any, Protocol

import numpy as np

GOLDEN = (sqrt(5.0) - 1.0) / 2.0
GOLDEN_STEPS = 40  # shrinks an interval to 4e-9 of its length; a smooth maximum is known no better in double precision
LIMIT_SLACK = 1e-9  # relative; a point this close to a limit counts as lying on it

_ANGLES = 65  # of the current, between which the best one is bracketed
_SAMPLES = 33  # of i_q on a line of constant i_d, between which the voltage limit is bracketed
# Of a root, which more than doubles its digits in two steps. The loops are our own: those of scipy's elementwise
# module hand the function the elements that still move, which a family of machines held in arrays cannot follow.
_ILLINOIS_STEPS = 16
_ROUND_OFF = 2e-16  # relative; a root that moves by less has been found
_DIRECT = 241  # values of i_d on a line of constant torque
_QUADRATURE = 161  # values of i_q between which the torque is inverted
_NEWTON_STEPS = 3  # from there to round-off
_CHUNK = 4000  # points whose lines of constant torque are looked at together, to bound the memory
_BEYOND = 1.5  # times the current limit: how far lines of constant torque are followed

Values = Any  # a number or an array of numbers [float64], of a shape that broadcasts against its neighbours


class DqMachine(Protocol):
    """What the searches here need of a machine; i_d, i_q: peak phase currents [A], arrays that broadcast.

    The machine is its own mirror image about the d axis: psi_d is even in i_q, psi_q and torque are odd.
    """

    @property
    def pole_pairs(self) -> int:
        """p."""

    @property
    def resistance(self) -> Values:
        """Of one phase [ohm], zero or more; an array is a family of machines."""

    @property
    def reach(self) -> float:
        """Largest peak current [A] of which the whole motoring quarter is described; infinite where nothing ends."""

    def flux_linkage(self, i_d: Values, i_q: Values) -> tuple[Values, Values]:
        """(psi_d, psi_q) [Wb peak]."""

    def incremental_inductances(self, i_d: Values, i_q: Values) -> np.ndarray:
        """d(psi_d, psi_q) / d(i_d, i_q) (2, 2, ...) [H]."""

    def torque(self, i_d: Values, i_q: Values) -> Values:
        """T = 1.5 p (psi_d i_q - psi_q i_d) [Nm]."""

    def voltage(self, i_d: Values, i_q: Values, speed: Values) -> tuple[Values, Values]:
        """(v_d, v_q) in the steady state [V peak] at mechanical speed [rad/s]."""

    def direct_range(self, current: Values) -> tuple[Values, Values]:
        """Lowest and highest i_d [A] to search at this peak current [A], in which torque rises with i_q.

        Raises a ValueError where the current is beyond what the machine is described for.
        """

    def with_resistance(self, resistance: Values) -> DqMachine:
        """The same machine with another resistance of one phase [ohm]; an array makes it a family."""

    def check_best(self, i_d: Values, current: Values) -> None:
        """Raises a ValueError where a best i_d [A] lies where the description ends, so that a better one may lie
        beyond; current: the limit [A]."""


@dataclass(frozen=True)
class DriveLimits:
    """What the power electronics allow, of a phase: current_peak [A], voltage_peak [V]; arrays for a family."""

    current_peak: Values
    voltage_peak: Values

    def __post_init__(self) -> None:
        require(bool(np.all(np.asarray(self.current_peak) > 0)), "current limit must be positive", self.current_peak)
        require(bool(np.all(np.asarray(self.voltage_peak) > 0)), "voltage limit must be positive", self.voltage_peak)

    @classmethod
    def from_dc_bus(cls, current_peak: Values, dc_voltage: Values) -> DriveLimits:
        """Limits of an inverter in its linear range: peak phase voltage V_DC / sqrt(3); current_peak: [A]."""
        return cls(current_peak, dc_voltage / sqrt(3.0))


@dataclass(frozen=True, eq=False)
class Envelope:
    """Largest motoring torque at each speed and the currents that give it; NaN at speeds out of reach."""

    speed: np.ndarray  # mechanical [rad/s], any shape
    torque: np.ndarray  # [Nm], the shape that speed and family broadcast to
    i_d: np.ndarray  # peak [A], shape of the torque
    i_q: np.ndarray  # peak [A], shape of the torque
    voltage_peak: np.ndarray  # of a phase [V], shape of the torque

    @property
    def power(self) -> np.ndarray:
        """Mechanical power [W], of the shape of the torque."""
        return self.torque * self.speed

    @property
    def current_peak(self) -> np.ndarray:
        """Peak phase current [A], of the shape of the torque."""
        return np.hypot(self.i_d, self.i_q)


@dataclass(frozen=True, eq=False)
class OperatingMap:
    """Smallest current, and the voltage that goes with it, for each torque and speed; NaN where out of reach."""

    torque: np.ndarray  # [Nm], any shape, broadcast with the speed
    speed: np.ndarray  # mechanical [rad/s], that shape
    i_d: np.ndarray  # peak [A], that shape
    i_q: np.ndarray  # peak [A], that shape
    voltage_peak: np.ndarray  # of a phase [V], that shape

    @property
    def current_peak(self) -> np.ndarray:
        """Peak phase current [A], of the shape of the torque."""
        return np.hypot(self.i_d, self.i_q)


@dataclass(frozen=True)
class PowerPoint:
    """A mechanical power [W] and the mechanical speed [rad/s] at which it occurs; arrays for a family."""

    power: Values
    speed: Values


# ---- torque and voltage, the same for every description -------------------------------------------------------------


def torque_of(pole_pairs: int, psi: tuple[Values, Values], i_d: Values, i_q: Values) -> Values:
    """T = 1.5 p (psi_d i_q - psi_q i_d) [Nm] at flux linkages psi = (psi_d, psi_q) [Wb]."""
    return 1.5 * pole_pairs * (psi[0] * i_q - psi[1] * i_d)


def voltage_of(
    resistance: Values, psi: tuple[Values, Values], i_d: Values, i_q: Values, omega_e: Values
) -> tuple[Values, Values]:
    """(v_d, v_q) = (R i_d - omega_e psi_q, R i_q + omega_e psi_d) [V peak]; psi [Wb]; omega_e: electrical [rad/s]."""
    return resistance * i_d - omega_e * psi[1], resistance * i_q + omega_e * psi[0]


# ---- one current ----------------------------------------------------------------------------------------------------


def mtpa_currents(machine: DqMachine, current_peak: Values) -> tuple[Values, Values]:
    """(i_d, i_q) [A] of the largest torque at a given current_peak [A], of a phase, any shape.

    The root of dT/d gamma = dT/d i_q i_d - dT/d i_d i_q over the current angle, i_d = -I sin(gamma) and
    i_q = I cos(gamma); where the torque still rises at the end of the range, that end.
    Raises a ValueError when the circle leaves the machine's description.
    """
    low, high = machine.direct_range(current_peak)
    shape = np.broadcast_shapes(np.shape(low), np.shape(current_peak), np.shape(machine.resistance))
    current = np.broadcast_to(np.asarray(current_peak, dtype=float), shape)
    ends = [_angle_of(np.broadcast_to(end, shape), current) for end in (high, low)]
    gamma = _best_angle(machine, current, *ends)
    return (-current * np.sin(gamma))[()], (current * np.cos(gamma))[()]


def corner_speed(machine: DqMachine, limits: DriveLimits, i_d: Values, i_q: Values) -> Values:
    """Mechanical speed at which given motoring currents meet the voltage limit [rad/s]; 0 where R alone uses it up.

    |v|^2 = omega^2 (psi_d^2 + psi_q^2) + 2 R omega T / (1.5 p) + R^2 (i_d^2 + i_q^2) = V^2, positive root.
    """
    psi = machine.flux_linkage(i_d, i_q)
    quadratic = psi[0] ** 2 + psi[1] ** 2
    half_linear = machine.resistance * (psi[0] * i_q - psi[1] * i_d)
    constant = np.minimum(machine.resistance**2 * (i_d**2 + i_q**2) - limits.voltage_peak**2, 0.0)
    omega_e = -constant / (half_linear + np.sqrt(half_linear**2 - quadratic * constant))
    return omega_e / machine.pole_pairs


def base_speed(machine: DqMachine, limits: DriveLimits) -> Values:
    """Highest mechanical speed at which the full current gives its largest torque [rad/s].

    The full current sits on the MTPA point; resistance is counted. ``corner_speed(machine, limits, 0.0, current)`` is
    that of the q axis.
    """
    return corner_speed(machine, limits, *mtpa_currents(machine, limits.current_peak))


def peak_torque(machine: DqMachine, limits: DriveLimits) -> Values:
    """Torque of the full current at MTPA [Nm], mean over one electrical period."""
    return machine.torque(*mtpa_currents(machine, limits.current_peak))


def power_at_base_speed(machine: DqMachine, limits: DriveLimits) -> Values:
    """Mechanical power at the base speed, MTPA torque times base speed [W]."""
    return peak_torque(machine, limits) * base_speed(machine, limits)


def _angle_of(i_d: np.ndarray, current: np.ndarray) -> np.ndarray:
    """gamma at which a current [A] has this i_d [A], asin(-i_d / I)."""
    share = np.divide(-i_d, current, out=np.zeros(np.shape(current)), where=current > 0)
    return np.arcsin(np.clip(share, -1.0, 1.0))


def _best_angle(machine: DqMachine, current: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """gamma of the largest torque between low and high: sampled, then the root of dT/d gamma between neighbours."""

    def fall(gamma: np.ndarray) -> np.ndarray:
        i_d, i_q = -current * np.sin(gamma), current * np.cos(gamma)
        along_d, along_q = _torque_slopes(machine, i_d, i_q)
        return along_d * i_q - along_q * i_d

    samples = low + (high - low) * np.linspace(0.0, 1.0, _ANGLES).reshape(-1, *[1] * np.ndim(low))
    best = np.argmax(machine.torque(-current * np.sin(samples), current * np.cos(samples)), axis=0)
    before, at, after = (_picked(samples, np.clip(best + step, 0, _ANGLES - 1)) for step in (-1, 0, 1))
    at_before, at_after = fall(before), fall(after)
    return np.where((at_before <= 0) & (at_after > 0), _root(fall, before, after, at_before, at_after), at)


def _torque_slopes(machine: DqMachine, i_d: Values, i_q: Values) -> tuple[Values, Values]:
    """(dT/d i_d, dT/d i_q) over 1.5 p [Wb]."""
    psi_d, psi_q = machine.flux_linkage(i_d, i_q)
    (l_dd, l_dq), (l_qd, l_qq) = machine.incremental_inductances(i_d, i_q)
    return l_dd * i_q - l_qd * i_d - psi_q, psi_d + l_dq * i_q - l_qq * i_d


# ---- torque over speed ----------------------------------------------------------------------------------------------


def torque_speed_envelope(machine: DqMachine, limits: DriveLimits, speed: Values) -> Envelope:
    """Largest motoring torque under both limits at each speed: MTPA, field weakening and MTPV in one search.

    For each i_d the largest allowed i_q lies on the current circle or on |v| = V. With constant parameters it is a
    concave function of i_d and the torque has a single maximum, which a golden-section search over i_d finds whichever
    limit rules there; saturation bends that little.

    speed: mechanical [rad/s], not negative, any shape
    Quadrant i_q >= 0. Torque and currents are NaN where no current keeps the voltage inside its limit. Raises a
    ValueError when the current limit leaves the machine's description, or the best current lies on its edge.
    """
    speed = np.asarray(speed, dtype=float)
    require(bool(np.all(speed >= 0)), "the motoring envelope needs speeds that are not negative", speed)
    ends = machine.direct_range(limits.current_peak)
    shape = np.broadcast_shapes(np.shape(speed), *(np.shape(end) for end in ends), np.shape(machine.resistance))
    low, high = (np.broadcast_to(np.asarray(end, dtype=float), shape) for end in ends)
    i_d = _golden_maximum(lambda i: _merit(machine, limits, speed, i), low, high)
    i_q, excess = _largest_i_q(machine, limits, speed, i_d)
    reached = excess <= LIMIT_SLACK * np.square(limits.voltage_peak)
    i_d, i_q = np.where(reached, i_d, np.nan)[()], np.where(reached, i_q, np.nan)[()]
    machine.check_best(i_d, limits.current_peak)
    return Envelope(speed, machine.torque(i_d, i_q), i_d, i_q, np.hypot(*machine.voltage(i_d, i_q, speed)))


def mtpv_currents(
    machine: DqMachine, voltage_peak: Values, speed: Values, largest_current: Values
) -> tuple[Values, Values]:
    """(i_d, i_q) [A] of the largest torque that voltage_peak [V] allows at each speed [rad/s], whatever the current.

    largest_current: how far is searched [A], for a map its ``reach``; NaN where the best current lies beyond.
    """
    envelope = torque_speed_envelope(machine, DriveLimits(largest_current, voltage_peak), speed)
    free = envelope.current_peak < (1 - 1e-6) * largest_current
    return np.where(free, envelope.i_d, np.nan), np.where(free, envelope.i_q, np.nan)


def maximum_power(
    machine: DqMachine, limits: DriveLimits, maximum_speed: float, *, samples: int = 25, zooms: int = 3
) -> PowerPoint:
    """Largest mechanical power up to maximum_speed [rad/s], mechanical; an ideal machine needs that bound.

    Samples the envelope between base speed and maximum speed, then resamples round the best one. Deep in the MTPV
    region the power hardly changes, so its speed is then the bound itself. A family of machines has its fields in
    arrays of shape (n, 1) and gets powers and speeds of shape (n,).
    """
    low = np.minimum(base_speed(machine, limits), maximum_speed)
    high = np.broadcast_to(float(maximum_speed), np.shape(low))
    for _ in range(zooms):
        speed = low + (high - low) * np.linspace(0.0, 1.0, samples)
        power = np.nan_to_num(torque_speed_envelope(machine, limits, speed).power, nan=-np.inf)
        best = np.argmax(power, axis=-1, keepdims=True)
        before, at, after = (np.clip(best + step, 0, samples - 1) for step in (-1, 0, 1))
        low, high = (np.take_along_axis(speed, index, -1)[..., :] for index in (before, after))
    found = [np.take_along_axis(values, best, -1)[..., 0][()] for values in (power, speed)]
    return PowerPoint(*found)


def _merit(machine: DqMachine, limits: DriveLimits, speed: np.ndarray, i_d: np.ndarray) -> np.ndarray:
    """Torque where i_d is allowed, minus the excess of |v|^2 elsewhere: one peak over the whole range of i_d."""
    i_q, excess = _largest_i_q(machine, limits, speed, i_d)
    return np.where(excess > 0, -excess, machine.torque(i_d, i_q))


def _largest_i_q(
    machine: DqMachine, limits: DriveLimits, speed: np.ndarray, i_d: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Largest i_q >= 0 inside both limits at this i_d, and by how much |v|^2 exceeds V^2 at best [V^2]."""

    def excess_at(i_q: np.ndarray) -> np.ndarray:
        v_d, v_q = machine.voltage(i_d, i_q, speed)
        return v_d**2 + v_q**2 - np.square(limits.voltage_peak)

    chord = np.sqrt(np.maximum(np.square(limits.current_peak) - i_d**2, 0.0))
    samples = chord * np.linspace(0.0, 1.0, _SAMPLES).reshape(-1, *[1] * np.ndim(chord))
    excess = excess_at(samples)
    last = _last_true(excess <= 0)
    ends = np.maximum(last, 0), np.minimum(last + 1, _SAMPLES - 1)
    (low, high), (at_low, at_high) = ([_picked(values, end) for end in ends] for values in (samples, excess))
    i_q = _root(excess_at, low, high, at_low, at_high)
    return np.where(last >= 0, i_q, 0.0), np.where(last >= 0, 0.0, excess.min(axis=0))


# ---- least current for a torque and a speed -------------------------------------------------------------------------


def operating_map(machine: DqMachine, limits: DriveLimits, torque: Values, speed: Values) -> OperatingMap:
    """Peak phase current and voltage needed for each torque and speed, with as little current as the voltage allows.

    On a line of constant torque the current is least on the MTPA curve and the voltage falls from there to the MTPV
    curve. The current sits on the MTPA point, or where the voltage meets its limit on the way. NaN where the torque
    needs more than the current or the voltage limit.

    torque [Nm] and speed [rad/s, mechanical], arrays that broadcast; any signs (all four quadrants): a braking torque
    at positive speed has the currents of the motoring one at the opposite speed, with the sign of i_q changed.
    One machine and one pair of limits, no family.
    """
    torque, speed = np.broadcast_arrays(np.asarray(torque, dtype=float), np.asarray(speed, dtype=float))
    sign = np.where(torque < 0, -1.0, 1.0)
    levels, which = np.unique(np.abs(torque), return_inverse=True)
    lines = _TorqueLines.of(machine, limits, levels)
    i_d = _least_weakening(lines, limits, which.ravel(), (sign * speed).ravel()).reshape(torque.shape)
    i_q = lines.quadrature(which.reshape(torque.shape), i_d)
    reached = i_d**2 + i_q**2 <= limits.current_peak**2 * (1 + LIMIT_SLACK)
    i_d, i_q = np.where(reached, i_d, np.nan)[()], np.where(reached, sign * i_q, np.nan)[()]
    return OperatingMap(torque, speed, i_d, i_q, np.hypot(*machine.voltage(i_d, i_q, speed)))


@dataclass(frozen=True, eq=False)
class _TorqueLines:
    """Lines of constant torque over i_d, at i_q >= 0; NaN beyond what the machine is described for.

    levels (t,) [Nm]; i_d (d,), evenly spaced [A]; i_q (t, d) [A]; best (t,): i_d of the least current [A]
    """

    machine: DqMachine
    levels: np.ndarray
    i_d: np.ndarray
    i_q: np.ndarray
    best: np.ndarray

    @classmethod
    def of(cls, machine: DqMachine, limits: DriveLimits, levels: np.ndarray) -> _TorqueLines:
        """Torque inverted on every line of constant i_d; then the point of least current on every line of torque.

        No torque takes no i_q, also where i_q makes none: on i_d = 0 of a machine without magnets.
        """
        i_d = np.linspace(*machine.direct_range(limits.current_peak), _DIRECT)
        samples = np.linspace(0.0, min(_BEYOND * limits.current_peak, machine.reach), _QUADRATURE)
        torque = machine.torque(i_d[:, None], samples)
        i_q = np.stack([np.interp(levels, row, samples, right=np.nan) for row in torque], axis=-1)
        i_q[levels == 0] = 0.0
        i_q = _on_torque(machine, levels[:, None], np.broadcast_to(i_d, i_q.shape), i_q, samples[-1])
        lines = cls(machine, levels, i_d, i_q, np.full(len(levels), np.nan))
        return cls(machine, levels, i_d, i_q, lines._least_current())

    def quadrature(self, which: np.ndarray, i_d: np.ndarray) -> np.ndarray:
        """i_q [A] at i_d [A] on the lines of these numbers; NaN where the line has ended."""
        step = self.i_d[1] - self.i_d[0]
        place = np.clip((np.nan_to_num(i_d, nan=self.i_d[0]) - self.i_d[0]) / step, 0, _DIRECT - 1)
        below = np.minimum(place.astype(int), _DIRECT - 2)
        left, right = self.i_q[which, below], self.i_q[which, below + 1]
        start = np.where(np.isnan(right), left, left + (place - below) * (right - left))
        return _on_torque(self.machine, self.levels[which], i_d, start, np.nanmax(self.i_q, initial=0.0))

    def _least_current(self) -> np.ndarray:
        """i_d of the least current on every line: the root of i_d dT/d i_q - i_q dT/d i_d between samples."""
        which = np.arange(len(self.levels))

        def rise(i_d: np.ndarray) -> np.ndarray:
            i_q = self.quadrature(which, i_d)
            along_d, along_q = _torque_slopes(self.machine, i_d, i_q)
            return i_d * along_q - i_q * along_d

        square = np.nan_to_num(self.i_d**2 + self.i_q**2, nan=np.inf)
        at = np.argmin(square, axis=1)
        low, high = self.i_d[np.maximum(at - 1, 0)], self.i_d[np.minimum(at + 1, _DIRECT - 1)]
        at_low, at_high = rise(low), rise(high)
        root = _root(rise, low, high, at_low, at_high)
        best = np.where((at_low <= 0) & (at_high > 0), root, self.i_d[at])
        return np.where(np.isfinite(square.min(axis=1)), best, np.nan)


def _on_torque(machine: DqMachine, torque: Values, i_d: Values, i_q: np.ndarray, most: float) -> np.ndarray:
    """i_q [A] between 0 and ``most`` at which the torque [Nm] is this, by Newton's method from i_q."""
    wanted = torque / (1.5 * machine.pole_pairs)
    for _ in range(_NEWTON_STEPS):
        psi_d, psi_q = machine.flux_linkage(i_d, i_q)
        _, (l_dq, l_qq) = np.swapaxes(machine.incremental_inductances(i_d, i_q), 0, 1)
        lack, slope = wanted - psi_d * i_q + psi_q * i_d, psi_d + l_dq * i_q - l_qq * i_d
        step = np.divide(lack, slope, out=np.zeros(np.shape(lack)), where=slope != 0)
        i_q = np.clip(i_q + step, 0.0, most)
    return i_q


def _least_weakening(lines: _TorqueLines, limits: DriveLimits, which: np.ndarray, speed: np.ndarray) -> np.ndarray:
    """i_d (n,) nearest to the least current at which |v| <= V on lines (n,) of torque at speeds (n,); NaN for none."""
    found = lines.best[which]
    above = np.flatnonzero(_excess_on(lines, limits, which, speed, found) > LIMIT_SLACK * limits.voltage_peak**2)
    for rows in np.array_split(above, max(1, -(-len(above) // _CHUNK))):
        found[rows] = _weakened(lines, limits, which[rows], speed[rows])
    return found


def _weakened(lines: _TorqueLines, limits: DriveLimits, which: np.ndarray, speed: np.ndarray) -> np.ndarray:
    """The same where the voltage is too high at the least current: its limit lies between two samples of the line."""
    best = lines.best[which]
    last = _last_true(_fitting(lines, limits, which, speed) & (lines.i_d[:, None] < best))
    low = lines.i_d[np.maximum(last, 0)]
    high = np.minimum(lines.i_d[np.minimum(last + 1, _DIRECT - 1)], best)

    def excess_at(i_d: np.ndarray) -> np.ndarray:
        return _excess_on(lines, limits, which, speed, i_d)

    return np.where(last >= 0, _root(excess_at, low, high, excess_at(low), excess_at(high)), np.nan)


def _excess_on(
    lines: _TorqueLines, limits: DriveLimits, which: np.ndarray, speed: np.ndarray, i_d: np.ndarray
) -> np.ndarray:
    """|v|^2 - V^2 [V^2] at i_d on lines (n,) of torque at speeds (n,)."""
    v_d, v_q = lines.machine.voltage(i_d, lines.quadrature(which, i_d), speed)
    return v_d**2 + v_q**2 - limits.voltage_peak**2


def _fitting(lines: _TorqueLines, limits: DriveLimits, which: np.ndarray, speed: np.ndarray) -> np.ndarray:
    """Which samples (d, n) of the lines keep the voltage:
    |v|^2 = omega^2 |psi|^2 + 2 R omega T / (1.5 p) + R^2 |i|^2."""
    machine = lines.machine
    omega = machine.pole_pairs * speed
    psi = machine.flux_linkage(lines.i_d, lines.i_q)
    flux, current = (psi[0] ** 2 + psi[1] ** 2).T, (lines.i_d**2 + lines.i_q**2).T
    cross = 2 * machine.resistance * omega * lines.levels[which] / (1.5 * machine.pole_pairs)
    square = omega**2 * flux[:, which] + cross + machine.resistance**2 * current[:, which]
    return square <= limits.voltage_peak**2


# ---- elementwise searches -------------------------------------------------------------------------------------------


def _golden_maximum(merit: Callable[[np.ndarray], np.ndarray], low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Position of the single maximum of ``merit`` between low and high, elementwise; one evaluation a step."""
    left, right = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
    at_left, at_right = merit(left), merit(right)
    for _ in range(GOLDEN_STEPS):
        go_left = at_left > at_right
        low, high = np.where(go_left, low, left), np.where(go_left, right, high)
        new = np.where(go_left, high - GOLDEN * (high - low), low + GOLDEN * (high - low))
        at_new = merit(new)
        left, right = np.where(go_left, new, right), np.where(go_left, left, new)
        at_left, at_right = np.where(go_left, at_new, at_right), np.where(go_left, at_left, at_new)
    return (low + high) / 2


def _root(
    function: Callable[[np.ndarray], np.ndarray],
    low: np.ndarray,
    high: np.ndarray,
    at_low: np.ndarray,
    at_high: np.ndarray,
) -> np.ndarray:
    """Root between low, where the function is not positive, and high, elementwise; low where both are one point.

    The Illinois rule: a chord, with the value at an end halved that two steps in turn have left where it is. What is
    returned is on the side of ``low``, to rounding: a chord that meets the root at once, from the other side, leaves
    the low end where it was.
    """
    side, before = np.zeros(np.shape(low)), low
    hardly = _ROUND_OFF * (np.abs(low) + np.abs(high))
    for _ in range(_ILLINOIS_STEPS):
        rise = at_high - at_low
        share = np.divide(-at_low, rise, out=np.zeros(np.shape(rise)), where=rise > 0)
        new = low + np.clip(share, 0, 1) * (high - low)
        at_new = function(new)
        if not np.any(np.abs(new - before) > hardly):
            return np.where(at_new <= 0, new, np.maximum(low, new - hardly))
        before, fits = new, at_new <= 0
        at_high = np.where(fits & (side > 0), at_high / 2, np.where(fits, at_high, at_new))
        at_low = np.where(~fits & (side < 0), at_low / 2, np.where(fits, at_new, at_low))
        low, high, side = np.where(fits, new, low), np.where(fits, high, new), np.where(fits, 1, -1)
    return low


def _last_true(found: np.ndarray) -> np.ndarray:
    """Index of the last True along the first axis, -1 without one."""
    last = found.shape[0] - 1 - found[::-1].argmax(axis=0)
    return np.where(found.any(axis=0), last, -1)


def _picked(values: np.ndarray, index: np.ndarray) -> np.ndarray:
    """values (k, ...) at one index (...) each along the first axis."""
    return np.take_along_axis(values, index[None], axis=0)[0]


def require(condition: bool, expectation: str, found: object) -> None:
    """Raises ValueError "expectation; found ..." where the condition does not hold."""
    if not condition:
        raise ValueError(f"{expectation}; found {found}")
