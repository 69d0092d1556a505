"""The true synchronous machine, seen in its three phases over one electrical period.

Flux linkages of the phases are turned round with the rotor and differentiated in time by their Fourier series; torque
is the power of the induced voltages over the speed. Park's frame is only the border: d on magnet 0, q leading by 90
degrees, amplitude-invariant, motor signs.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import fsolve

ANGLES = 2 * np.pi * np.arange(48) / 48  # electrical, of one period
PHASES = np.array([0.0, 2 * np.pi / 3, 4 * np.pi / 3])
RATED = 25.0  # A, peak; where laws are scaled
WINDAGE_SPEED = 300.0  # rad/s, at which the windage of the truth is that of a quadratic law
REVERSAL = 0.3  # rad/s, rounds dry friction


@dataclass(frozen=True)
class TrueMachine:
    """All SI; what is zero is not there. Fields below the line belong to truths outside the library."""

    pole_pairs: float
    psi_m: float
    inductance_d: float
    inductance_q: float
    resistance: float
    saturation: float = 0.0
    cross: float = 0.0
    iron: float = 0.0
    dead_time: float = 0.0  # voltage of a switched phase against its current
    friction: float = 0.0
    viscous: float = 0.0
    windage: float = 0.0
    load_share: float = 0.0
    # outside the library
    d_knee: float = 0.0  # share by which positive i_d finds a saturated d axis at RATED
    speed_bump: float = 0.0  # Nm, a drive-train resonance at 190 rad/s
    drag_power: float = 0.0  # Nm at 100 rad/s, with speed^1.5
    divider_pole: float = 0.0  # s, low-pass of the voltage dividers
    heating: float = 0.0  # rise of the resistance over a table, relative
    torque_dead_band: float = 0.0  # Nm below which the cell shows less
    proximity: float = 0.0  # extra resistance at 1000 rad/s electrical, relative
    demagnetisation: float = 0.0  # share of psi_m lost at i_d = -RATED, with its square
    one_sided_friction: float = 0.0  # Nm when turning backwards
    tacho_bend: float = 0.0  # share by which the speed is higher than read, at 300 rad/s, with its square
    root_drag: float = 0.0  # Nm at 100 rad/s, with the root of the speed
    grease: float = 0.0  # Nm asinh(speed / 20 rad/s), a shear-thinning lubricant
    relief: float = 0.0  # Nm s/rad beyond 130 rad/s, a seal that lifts
    soft_knee: float = 0.0  # V of the switches, reached with exp(-|i| / 6 A)
    range_step: float = 0.0  # share by which the torque amplifier reads more above 5 Nm
    shunt_bend: float = 0.0  # share by which the current is larger than read at RATED, with its square
    bridges: float = 0.0  # Vs/A of the d axis lost to |i_q|, in proportion
    shielding: float = 0.0  # share of psi_m that eddy currents in the magnets keep out at 1000 rad/s electrical
    pulled_bearing: float = 0.0  # Nm of friction at RATED, in proportion to the current


def _to_dq(phases):
    """(n, 3, angles) -> d, q averaged over the period."""
    turned = ANGLES[None, :] - PHASES[:, None]
    d = 2.0 / 3.0 * (phases * np.cos(turned)).sum(axis=1)
    q = -2.0 / 3.0 * (phases * np.sin(turned)).sum(axis=1)
    return d.mean(axis=1), q.mean(axis=1)


def _to_phases(d, q):
    turned = ANGLES[None, :] - PHASES[:, None]
    return d[:, None, None] * np.cos(turned) - q[:, None, None] * np.sin(turned)


def _flux_linkage(m: TrueMachine, i_d, i_q):
    psi_m = m.psi_m * (1.0 - m.demagnetisation * (np.minimum(i_d, 0.0) / RATED) ** 2)
    psi_d = psi_m + m.inductance_d * i_d * (1.0 - m.d_knee * 0.5 * (1 + np.tanh(i_d / 5.0)) * np.abs(i_d) / RATED)
    psi_q = m.inductance_q * i_q
    if m.saturation:
        s = 2.0 * m.saturation
        psi_q = m.inductance_q / s * np.sign(i_q) * np.log1p(s * np.abs(i_q))
    bend = 1.0 + 0.05 * (i_q / RATED) ** 2
    psi_d = psi_d - m.bridges * (np.sqrt(i_q**2 + 1.0) - 1.0)
    return psi_d - m.cross * i_q**2 / bend, psi_q - 2.0 * m.cross * i_d * i_q / bend


def _induced(m: TrueMachine, i_d, i_q, omega):
    """Voltages of the three phases from d(psi)/dt (n, 3, angles)."""
    psi_d, psi_q = _flux_linkage(m, i_d, i_q)
    kept_out = m.shielding * 2.0 * omega**2 / (omega**2 + 1e6)
    psi = _to_phases(psi_d - m.psi_m * kept_out, psi_q)
    order = np.fft.rfftfreq(len(ANGLES), 1.0 / len(ANGLES))
    slope = np.fft.irfft(1j * order * np.fft.rfft(psi, axis=2), len(ANGLES), axis=2)
    return omega[:, None, None] * slope


def _iron_conductance(m: TrueMachine, omega):
    """Nine tenths eddy current, one tenth hysteresis at 800 rad/s."""
    return m.iron * (0.9 + 0.1 * 800.0 / np.maximum(np.abs(omega), 20.0))


def _magnetising(m: TrueMachine, i_d, i_q, omega):
    m_d, m_q = i_d, i_q
    for _ in range(25 if m.iron else 0):
        e_d, e_q = _to_dq(_induced(m, m_d, m_q, omega))
        g = _iron_conductance(m, omega)
        m_d, m_q = i_d - g * e_d, i_q - g * e_q
    return m_d, m_q


def _air_gap(m: TrueMachine, i_d, i_q, speed):
    """Induced voltages d, q and air-gap torque at terminal currents."""
    omega = m.pole_pairs * speed
    m_d, m_q = _magnetising(m, i_d, i_q, omega)
    e = _induced(m, m_d, m_q, omega)
    power = (e * _to_phases(m_d, m_q)).sum(axis=1).mean(axis=1)
    return *_to_dq(e), power / speed


def _shaft(m: TrueMachine, torque, speed):
    direction = speed / np.sqrt(speed**2 + REVERSAL**2)
    lost = m.friction * direction + m.viscous * speed + m.windage * speed * np.abs(speed) ** 0.97 * WINDAGE_SPEED**0.03
    lost = lost + m.load_share * np.abs(torque) * direction
    lost = lost + m.speed_bump * direction / (1.0 + ((np.abs(speed) - 190.0) / 25.0) ** 2)
    lost = lost + m.drag_power * direction * (np.abs(speed) / 100.0) ** 1.5
    lost = lost - m.one_sided_friction * (speed < 0)
    lost = lost + m.root_drag * direction * np.sqrt(np.abs(speed) / 100.0) + m.grease * np.arcsinh(speed / 20.0)
    lost = lost + m.relief * direction * np.maximum(np.abs(speed) - 130.0, 0.0)
    return torque - lost


def _cell(m: TrueMachine, torque):
    torque = torque * (1.0 + m.range_step * 0.5 * (1.0 + np.tanh((np.abs(torque) - 5.0) / 0.1)))
    return torque * np.abs(torque) / (np.abs(torque) + m.torque_dead_band + 1e-30)


def operation(m: TrueMachine, i_d, i_q, speed):
    """v_d, v_q at the drive and torque at the cell."""
    speed = _true_speed(m, speed)
    more = 1.0 + m.shunt_bend * (np.hypot(i_d, i_q) / RATED) ** 2
    i_d, i_q = i_d * more, i_q * more
    omega = m.pole_pairs * speed
    e_d, e_q, torque = _air_gap(m, i_d, i_q, speed)
    warm = m.resistance * (1.0 + m.heating * np.linspace(0.0, 1.0, len(speed)))
    warm = warm * (1.0 + m.proximity * (omega / 1000.0) ** 2)
    phases = _to_phases(i_d, i_q)
    knee = m.soft_knee * np.sign(phases) * -np.expm1(-np.abs(phases) / 6.0)
    switched = _to_dq(m.dead_time * np.tanh(phases / 0.3) + knee)
    v = (warm * i_d + e_d + switched[0]) + 1j * (warm * i_q + e_q + switched[1])
    v = v / (1.0 + 1j * omega * m.divider_pole)
    pulled = m.pulled_bearing * np.hypot(i_d, i_q) / RATED * np.sign(speed)
    return v.real, v.imag, _cell(m, _shaft(m, torque, speed) - pulled)


def _true_speed(m: TrueMachine, speed):
    return speed * (1.0 + m.tacho_bend * (speed / 300.0) ** 2)


def back_emf(m: TrueMachine, speed):
    """RMS voltage, line to line, at open terminals."""
    speed = _true_speed(m, speed)
    none = np.zeros_like(speed)
    e_d, e_q, _ = _air_gap(m, none, none, speed)
    fundamental = np.hypot(e_d, e_q) / np.sqrt(1.0 + (m.pole_pairs * speed * m.divider_pole) ** 2)
    return fundamental * np.sqrt(1.5)


def drag(m: TrueMachine, speed):
    """Torque that brakes at open terminals."""
    speed = _true_speed(m, speed)
    none = np.zeros_like(speed)
    return -_cell(m, _shaft(m, _air_gap(m, none, none, speed)[2], speed))


def short_circuit(m: TrueMachine, speed):
    """Torque that brakes and RMS current with the terminals short-circuited."""
    speed = _true_speed(m, speed)
    omega = m.pole_pairs * speed

    def voltages(currents):
        i_d, i_q = np.split(currents, 2)
        e_d, e_q, _ = _air_gap(m, i_d, i_q, speed)
        warm = m.resistance * (1.0 + m.proximity * (omega / 1000.0) ** 2)
        return np.concatenate([warm * i_d + e_d, warm * i_q + e_q])

    start = np.concatenate([np.full_like(speed, -m.psi_m / m.inductance_d), np.zeros_like(speed)])
    i_d, i_q = np.split(fsolve(voltages, start, xtol=1e-10), 2)
    torque = _air_gap(m, i_d, i_q, speed)[2]
    size = np.hypot(i_d, i_q)
    torque = _shaft(m, torque, speed) - m.pulled_bearing * size / RATED * np.sign(speed)
    return -_cell(m, torque), size / (1.0 + m.shunt_bend * (size / RATED) ** 2) / np.sqrt(2.0)
