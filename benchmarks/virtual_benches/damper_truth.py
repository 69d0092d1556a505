"""The true damper: laws with rounded corners, and its motion by integration in time where it is not imposed.

m dv/dt + F(x, v, ...) + K(x, i) i = F_mount,   L di/dt + (R + R_shunt) i + U(i) = K(x, i) v
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from benchmarks.virtual_benches.damper_play import with_play

OPEN = 1e5  # ohm, from here the circuit counts as open
SAMPLES = 512  # of a period, imposed motion
STEPS, PERIODS = 360, 3  # of a period and periods of the integration; the last one is read
MOUNT_LOSS = 2.4e-4  # s, damping over stiffness of the mount (thesis table B.1: 50 N s/m at 2e5 N/m)
RELAXATION = 0.03  # s, of ``spring_arm``
CREEP, STRAP_TIME = 0.02, 0.01  # s, of ``creep`` and ``strap``
GAMMA = 1.0 - 1.0 / np.sqrt(2.0)  # of the two-stage Rosenbrock method, which damps stiff parts (Verwer et al. 1999)


@dataclass(frozen=True)
class TrueDamper:
    """All SI; what is zero is not there. ``extra`` fields below the line belong to truths outside the library."""

    force_constant: float
    resistance: float
    mass: float
    viscous: float
    coulomb: float = 0.0
    reversal: float = 1.5e-3  # velocity that rounds dry friction
    static_excess: float = 0.0
    stribeck_velocity: float = 0.05
    quadratic: float = 0.0
    eddy: float = 0.0
    eddy_corner: float = 0.6
    hysteresis: float = 0.0
    hysteresis_distance: float = 1e-3
    misalignment: float = 0.0
    diode: float = 0.0
    diode_knee: float = 0.04
    inductance: float = 0.0
    saturation_current: float = np.inf
    mount_compliance: float = 0.0
    play: float = 0.0
    rig_share: float = 0.0
    force_lag: float = 0.0
    # outside the library
    cubic_stiffness: float = 0.0
    three_halves: float = 0.0
    heating: float = 0.0  # rise of the resistance over a table, relative
    magnet_pitch: float = 0.0  # share of K lost two millimetres from mid-stroke
    root_drag: float = 0.0  # drag with sqrt(v), at 0.1 m/s [N]
    grease: float = 0.0  # drag of a shear-thinning lubricant, F asinh(v / 15 mm/s) [N]
    relief: float = 0.0  # drag that sets in beyond 0.18 m/s [N s/m]
    spring_arm: float = 0.0  # a spring of so much [N/m] in series with a dashpot, relaxing in 30 ms
    bush: float = 0.0  # stiffness of a rubber bush at small travel [N/m], half of it at a millimetre, loss factor 0.2
    bump: float = 0.0  # stiffness of a stop from 1.6 mm of travel on [N/m]
    history: float = 0.0  # drag of the fluid's boundary layer, with sqrt(j omega) [N s^1.5/m]
    range_step: float = 0.0  # share by which the force amplifier reads more above 12 N
    load_friction: float = 0.0  # dry friction in proportion to the current's force, only when it brakes forwards
    rig_resonance: float = 0.0  # share by which a rig mode at 17 Hz adds to the force
    dead_band: float = 0.0  # force below which the cell shows nothing
    stick_ripple: float = 0.0  # force ripple over velocity, amplitude
    pole_split: float = 0.0  # a second circuit in the iron: transformer-coupled winding, N s/m at high frequency
    asymmetry: float = 0.0  # viscous damping more in one direction than in the other
    thinning: float = 0.0  # drag of a fluid after Cross, F (v / 30 mm/s) / (1 + |v / 30 mm/s|^0.7) [N]
    slip: float = 0.0  # drag that stays as it is beyond 0.12 m/s [N s/m]
    creep: float = 0.0  # compliance of a mount of which 60 % come late, after 20 ms [m/N]
    strap: float = 0.0  # a part between spring and dashpot, k / s (s 10 ms)^0.35 [N/m]
    compression: float = 0.0  # share of large forces that the amplifier leaves out, half of it at 60 N


def steady(d: TrueDamper, velocity: np.ndarray, shunt: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Force [N] and terminal voltage [V] at constant velocity in mid-stroke, rows in order of acquisition."""
    warm = d.resistance * (1.0 + d.heating * np.linspace(0.0, 1.0, len(velocity)))
    x = np.zeros_like(velocity)
    current = _current(d, x, velocity, warm + shunt)
    force = _mechanical(d, x, velocity, d.hysteresis * _sign(d, velocity)) + _factor(d, x, current) * current
    force = force + _coupled(d, velocity, _factor(d, x, current) * current)
    force = force + d.rig_share * np.abs(force) * _sign(d, velocity)
    force = force + d.spring_arm * RELAXATION * velocity  # the spring stands still, its dashpot drags
    return _through_cell(d, force), current * shunt


def impedance(d: TrueDamper, frequency: np.ndarray, amplitude: np.ndarray, shunt: np.ndarray) -> np.ndarray:
    """Fundamental of force over velocity at the driving point [N s/m], complex (n,)."""
    theta, v, force = _motion_of(d)(d, frequency, amplitude, shunt)
    force = force + d.rig_share * np.abs(force) * np.tanh(v / d.reversal)
    force = _through_cell(d, force)
    top = 2 * np.pi * frequency * amplitude
    z = 2.0 / len(theta) * (force @ np.exp(-1j * theta)) / top
    s = 2j * np.pi * frequency
    z = z / (1 + np.sqrt(2) * (s * d.force_lag / np.sqrt(2)) + (s * d.force_lag / np.sqrt(2)) ** 2)
    split = d.pole_split * s / (s + 2 * np.pi * 12.0) + _beside(d, s, amplitude)
    mode = 1.0 + d.rig_resonance / (1.0 - (frequency / 17.0) ** 2 + 0.2j * frequency / 17.0)
    return _on_its_mount(d, s, z + split) * (mode if d.rig_resonance else 1.0)


def _beside(d: TrueDamper, s, amplitude):
    """What acts beside the damper at a harmonic travel: an arm that relaxes, a bush, a boundary layer [N s/m]."""
    arm = d.spring_arm * RELAXATION / (1 + s * RELAXATION)
    bush = d.bush * (1 + 0.2j) / (1 + amplitude / 1e-3) / s
    strap = d.strap / s * (s * STRAP_TIME) ** 0.35
    return arm + bush + strap + d.history * np.sqrt(s)


def _on_its_mount(d: TrueDamper, s, z):
    """A mount that creeps, in series with all the rest [N s/m]."""
    compliance = d.creep * (0.4 + 0.6 / (1 + s * CREEP))
    return z / (1 + z * s * compliance)


def _motion_of(d: TrueDamper):
    if d.play:
        return with_play
    return _integrated if d.mount_compliance or d.inductance else _imposed


def _sign(d: TrueDamper, velocity):
    return velocity / np.sqrt(velocity**2 + d.reversal**2)


def _mechanical(d: TrueDamper, x, v, hysteresis):
    direction = _sign(d, v)
    creeping = 1.0 / (1.0 + (v / d.stribeck_velocity) ** 2)
    force = d.viscous * v * (1.0 + d.asymmetry * direction)
    force = force + (d.coulomb + d.static_excess * creeping) * direction
    force = force + d.quadratic * np.abs(v) ** 0.97 * v + d.three_halves * np.sqrt(np.abs(v)) * v
    force = force + d.eddy * v / (1.0 + np.abs(v / d.eddy_corner) ** 1.8)
    force = force + d.misalignment * np.sqrt(x**2 + 2.5e-9) * direction
    force = force + d.cubic_stiffness * x**3
    force = force + d.stick_ripple * np.sin(2 * np.pi * v / 0.13)
    force = force + d.root_drag * np.sqrt(np.abs(v) / 0.1) * direction + d.grease * np.arcsinh(v / 0.015)
    force = force + d.relief * np.maximum(np.abs(v) - 0.18, 0.0) * direction
    force = force + d.thinning * (v / 0.03) / (1.0 + np.abs(v / 0.03) ** 0.7)
    force = force + d.slip * np.clip(v, -0.12, 0.12)
    force = force + d.bump * np.maximum(np.abs(x) - 1.6e-3, 0.0) * np.sign(x)
    return force + hysteresis


def _coupled(d: TrueDamper, v, electric):
    """Dry friction that the braking force presses on, in one direction of travel only."""
    return d.load_friction * np.abs(electric) * np.exp(-np.abs(v) / 0.15) * _sign(d, v)


def _through_cell(d: TrueDamper, force):
    force = force * (1.0 + d.range_step * 0.5 * (1.0 + np.tanh((np.abs(force) - 12.0) / 0.2)))
    force = force * (1.0 - d.compression * force**2 / (force**2 + 3600.0))
    if not d.dead_band:
        return force
    return np.sign(force) * np.sqrt(np.maximum(force**2 - d.dead_band**2, 0.0))


def _factor(d: TrueDamper, x, current):
    """K(x, i)."""
    k = d.force_constant * (1.0 - d.magnet_pitch * (x / 2e-3) ** 2)
    if np.isfinite(d.saturation_current):
        k = k / np.sqrt(1.0 + (current / d.saturation_current) ** 2)
    return k


def _blocked(d: TrueDamper, voltage):
    """Voltage that a bridge lets through: softplus on both sides."""
    if not d.diode:
        return voltage
    knee = d.diode_knee
    return knee * (np.logaddexp(0, (voltage - d.diode) / knee) - np.logaddexp(0, (-voltage - d.diode) / knee))


def _current(d: TrueDamper, x, v, resistance):
    """Current without inductance, by repeated substitution with damping."""
    current = _blocked(d, d.force_constant * v) / resistance
    if not np.isfinite(d.saturation_current) and not d.magnet_pitch:
        return current
    for _ in range(80):
        current = 0.5 * current + 0.5 * _blocked(d, _factor(d, x, current) * v) / resistance
    return current


def _imposed(d: TrueDamper, frequency, amplitude, shunt):
    theta = 2 * np.pi * np.arange(SAMPLES) / SAMPLES
    omega = 2 * np.pi * frequency[:, None]
    x, v = amplitude[:, None] * np.sin(theta), omega * amplitude[:, None] * np.cos(theta)
    warm = d.resistance * (1.0 + d.heating * np.linspace(0.0, 1.0, len(frequency)))[:, None]
    current = _current(d, x, v, warm + shunt[:, None])
    electric = _factor(d, x, current) * current
    inertia = -d.mass * omega**2 * x
    force = inertia + _mechanical(d, x, v, _loop(d, x)) + electric + _coupled(d, v, electric)
    return theta, v, force


def _loop(d: TrueDamper, x):
    """Hysteresis over the travel: steps of dF/dx = (level - F sign(dx)) / distance, two periods, the last one kept."""
    if not d.hysteresis:
        return 0.0
    f, out = np.zeros(len(x)), np.empty_like(x)
    for k in list(range(SAMPLES)) * 2:
        dx = x[:, k] - x[:, k - 1]
        decay = np.exp(-np.abs(dx) / d.hysteresis_distance)
        f = d.hysteresis * np.sign(dx) + (f - d.hysteresis * np.sign(dx)) * decay
        out[:, k] = f
    return out


def _integrated(d: TrueDamper, frequency, amplitude, shunt):
    """Angles, driver velocity and driving force of the last period, Rosenbrock's method of two stages."""
    omega = 2 * np.pi * frequency
    h = 2 * np.pi / STEPS / omega
    rig = _Rig(d, amplitude, omega, d.resistance + shunt)
    y = rig.start()
    velocity, on_mass = [], []
    for k in range(PERIODS * STEPS):
        y = rig.step(y, k * h, h)
        if k >= (PERIODS - 1) * STEPS:
            velocity.append(rig.motion(y, (k + 1) * h)[1])
            on_mass.append(rig.on_mass(y, (k + 1) * h))
    theta = 2 * np.pi * np.arange(1, STEPS + 1) / STEPS
    v = np.array(velocity).T
    acceleration = (np.roll(v, -1, axis=1) - np.roll(v, 1, axis=1)) / (2 * h[:, None])
    force = d.mass * acceleration + np.array(on_mass).T  # what drives the mass, whatever carries it there
    return theta, (omega * amplitude)[:, None] * np.cos(theta), force


def _solve(matrices, right):
    return np.linalg.solve(matrices, right[:, :, None])[:, :, 0]


class _Rig:
    """State y = (x, v, i) of every row, (n, 3). A rigid mount imposes x, v; an open circuit or L = 0 has no state i."""

    def __init__(self, d: TrueDamper, amplitude, omega, resistance):
        self.d, self.amplitude, self.omega, self.resistance = d, amplitude, omega, resistance
        self.closed = resistance < OPEN
        self.moves = d.mount_compliance > 0
        self.stiffness = 1.0 / d.mount_compliance if self.moves else np.inf

    def start(self):
        v = self.omega * self.amplitude
        return np.stack([np.zeros_like(v), v, self._quasi_static(np.zeros_like(v), v)], axis=1)

    def _quasi_static(self, x, v):
        return _current(self.d, x, v, self.resistance)

    def motion(self, y, t):
        if self.moves:
            return y[:, 0], y[:, 1]
        return self.amplitude * np.sin(self.omega * t), self.omega * self.amplitude * np.cos(self.omega * t)

    def _electric_current(self, y, x, v):
        slow = self._quasi_static(x, v)
        return np.where(self.closed, y[:, 2], slow) if self.d.inductance else slow

    def _mount(self, x, v, t):
        stretch = self.amplitude * np.sin(self.omega * t) - x
        speed = self.omega * self.amplitude * np.cos(self.omega * t) - v
        hardening = 1.0 + 0.02 * np.tanh((stretch / 5e-4) ** 2)
        return self.stiffness * (hardening * stretch + MOUNT_LOSS * speed)

    def on_mass(self, y, t):
        x, v = self.motion(y, t)
        i = self._electric_current(y, x, v)
        electric = _factor(self.d, x, i) * i
        level = self.d.hysteresis * _sign(self.d, v)
        return _mechanical(self.d, x, v, level) + electric + _coupled(self.d, v, electric)

    def rate(self, y, t):
        d = self.d
        x, v = self.motion(y, t)
        out = np.zeros_like(y)
        if self.moves:
            out[:, 0] = v
            out[:, 1] = (self._mount(x, v, t) - self.on_mass(y, t)) / d.mass
        if d.inductance:
            i = y[:, 2]
            drop = _factor(d, x, i) * v - i * self.resistance
            if d.diode:
                drop = drop - d.diode * np.tanh(i * 50.0)
            out[:, 2] = np.where(self.closed, drop / d.inductance, 0.0)
        return out

    def step(self, y, t, h):
        here, ahead = self.rate(y, t), self.rate(y, t + h)
        jacobian = np.empty((len(y), 3, 3))
        for k, size in enumerate((1e-7, 1e-5, 1e-5)):
            moved = y.copy()
            moved[:, k] += size
            jacobian[:, :, k] = (self.rate(moved, t + h) - ahead) / size
        left = np.eye(3) - GAMMA * h[:, None, None] * jacobian
        column = h[:, None]
        moving = (ahead - here) / column  # slope over time at fixed state
        first = _solve(left, here + GAMMA * column * moving)
        there = self.rate(y + column * first, t + h)
        second = _solve(left, there - 2.0 * first - GAMMA * column * moving)
        return y + 1.5 * column * first + 0.5 * column * second
