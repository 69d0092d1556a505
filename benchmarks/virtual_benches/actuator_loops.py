"""Force-displacement loops of an actuator, made by another integrator and another statement of the same equations.

    m x'' = F_m - c_l x' - K_t i / tau,   F = F_m = s(l) (k (|d| - b) + c |d|') sgn d + c_m d',   d = z - x
    l = clip((|d| - b) / w, 0, 1),  s = 3 l^2 - 2 l^3

z is the imposed stroke, i the q-axis current that a damping logic asks for (thesis 4.3.1): K_t,nom i = tau c z'.
Integrated by LSODA (or Radau's method) with its own choice of steps: no step, order or event is shared with a model
that is fitted, only the names of what is sought.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import copysign, cos, pi, sin

import numpy as np
from scipy.integrate import solve_ivp

from bench.force_loops import (
    CONTACT,
    LOSS,
    MASS,
    MOUNT_DAMPING,
    PLAY,
    STIFFNESS,
    TORQUE_CONSTANT,
    TRANSITION,
)  # fmt: skip

SAMPLING = 4000.0  # Hz, thesis section 4.3.1
RAMP = 0.15  # s in which the amplitude grows, so that a loop starts at rest
NOMINAL_TORQUE_CONSTANT = 49.3e-3  # Nm/A, thesis table B.1
TRANSMISSION = 0.115 / 87.3  # m/rad, thesis table A.1


@dataclass(frozen=True)
class Truth:
    """SI: mass, half play, contact stiffness and damping, transition, loss, mount damping, torque constant.

    The values of thesis table 4.2, nominal value times identified gain.
    """

    mass: float = 5.6 * 1.100
    play: float = 2e-4 * 0.046
    stiffness: float = 5e5 * 1.352
    contact_damping: float = 100 * 5.452
    transition: float = 1.5e-3 * 2.558
    loss: float = 70 * 1.519
    mount_damping: float = 500 * 0.590
    torque_constant: float = 49.3e-3 * 0.866

    @property
    def sought(self) -> dict[str, float]:
        """What an identification should find, SI by the names of ``bench.force_loops``."""
        return {
            MASS: self.mass, PLAY: self.play, STIFFNESS: self.stiffness, CONTACT: self.contact_damping,
            TRANSITION: self.transition, LOSS: self.loss, MOUNT_DAMPING: self.mount_damping,
            TORQUE_CONSTANT: self.torque_constant,
        }  # fmt: skip

    def mount_force(self, deformation: float, rate: float) -> float:
        """F_m [N]."""
        depth = abs(deformation) - self.play
        inside = min(max(depth / self.transition, 0.0), 1.0)
        contact = copysign(self.stiffness * depth, deformation) + self.contact_damping * rate
        return inside * inside * (3.0 - 2.0 * inside) * contact + self.mount_damping * rate


@dataclass(frozen=True)
class Drive:
    """One test: frequency [Hz], amplitude [m] and damping of the control [Ns/m]; duration [s]."""

    frequency: float
    amplitude: float
    damping: float
    duration: float = 1.0

    def motion(self, time: float) -> tuple[float, float]:
        """Stroke [m] and velocity [m/s]: a sine whose amplitude grows smoothly from rest."""
        omega, part = 2 * pi * self.frequency, min(time / RAMP, 1.0)
        grown, growth = part**3 * (10 - 15 * part + 6 * part**2), 30 * part**2 * (1 - part) ** 2 / RAMP
        sine, cosine = sin(omega * time), cos(omega * time)
        return self.amplitude * grown * sine, self.amplitude * (growth * sine + grown * omega * cosine)

    def current(self, velocity: float) -> float:
        """q-axis current that the damping logic asks for at a velocity of the driver [A]."""
        return self.damping * velocity * TRANSMISSION / NOMINAL_TORQUE_CONSTANT


@dataclass(frozen=True, eq=False)
class Loop:
    """What the bench records: time [s], stroke [m], velocity [m/s], q-axis current [A] and force [N], each (n,)."""

    time: np.ndarray
    stroke: np.ndarray
    velocity: np.ndarray
    current: np.ndarray
    force: np.ndarray


def loop_of(truth: Truth, drive: Drive, noise: float, rng: np.random.Generator, method: str = "LSODA") -> Loop:
    """The loop with white noise of this standard deviation [N] on the force."""
    time = np.arange(0.0, drive.duration, 1 / SAMPLING)

    def rates(t: float, state: np.ndarray) -> tuple[float, float]:
        stroke, velocity = drive.motion(t)
        place, speed = float(state[0]), float(state[1])
        force = truth.mount_force(stroke - place, velocity - speed)
        machine = truth.torque_constant * drive.current(velocity) / TRANSMISSION
        return speed, (force - truth.loss * speed - machine) / truth.mass

    solved = solve_ivp(rates, (0.0, time[-1]), [0.0, 0.0], method, time, rtol=1e-9, atol=[1e-11, 1e-8], max_step=2e-3)
    if not solved.success:
        raise RuntimeError(f"the truth of {drive} was not integrated: {solved.message}")
    stroke, velocity = np.array([drive.motion(t) for t in time]).T
    states = zip(stroke, velocity, *solved.y.tolist())
    force = np.array([truth.mount_force(z - x, v - dx) for z, v, x, dx in states])
    current = np.array([drive.current(v) for v in velocity])
    return Loop(time, stroke, velocity, current, force + noise * rng.standard_normal(len(time)))
