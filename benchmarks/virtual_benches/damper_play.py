"""Motion of a damper's mass in a joint with free play, piece by piece in closed form, contacts without rebound.

Pushed: the mass goes with the driver while m a + c v + F_c presses. Free: m dv/dt = -c v - F_c sign(v), an exponential.
The two halves of a period mirror each other. Viscous damping, circuit and dry friction only.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

SAMPLES = 2048


def with_play(d, frequency, amplitude, shunt):
    """Angles, driver velocity and driving force over a period; the blow at contact is spread over one sample."""
    theta = 2 * np.pi * np.arange(SAMPLES) / SAMPLES
    force = np.array([_row(d, *values, theta) for values in zip(2 * np.pi * frequency, amplitude, shunt)])
    return theta, (2 * np.pi * frequency * amplitude)[:, None] * np.cos(theta), force


def _row(d, omega, amplitude, shunt, theta):
    damping = d.viscous + d.force_constant**2 / (d.resistance + shunt)
    top = omega * amplitude

    def pressing(angle):
        return -d.mass * omega * top * np.sin(angle) + damping * top * np.cos(angle) + d.coulomb

    leaves = brentq(pressing, 0.0, np.pi)
    flight = _Flight(d.mass, damping, d.coulomb, top * np.cos(leaves), omega)

    def ahead(angle):
        return flight.travel(angle - leaves) - amplitude * (np.sin(angle) - np.sin(leaves)) - d.play

    meets = brentq(ahead, leaves, leaves + np.pi) if ahead(leaves + np.pi) > 0 else leaves + np.pi
    angle = np.mod(theta - meets, 2 * np.pi) + meets  # from contact on the far side, one period on
    far = angle < leaves + np.pi
    near = (angle >= meets + np.pi) & (angle < leaves + 2 * np.pi)
    mirrored = np.where(far, pressing(angle + np.pi), 0.0)
    force = np.where(near, pressing(angle), 0.0) - mirrored
    blow = d.mass * (top * np.cos(meets) - flight.velocity(meets - leaves)) * omega * SAMPLES / (2 * np.pi)
    first = int(np.argmin(angle))
    force[first] += blow
    force[(first + SAMPLES // 2) % SAMPLES] -= blow
    return force


class _Flight:
    """The free mass: velocity and travel over the angle since it left the driver."""

    def __init__(self, mass, damping, coulomb, start, omega):
        self.rate, self.rest = damping / mass / omega, coulomb / damping
        self.start, self.omega = max(start, 0.0), omega
        self.stops = np.log1p(self.start / self.rest) / self.rate if self.rest else np.inf

    def velocity(self, angle):
        angle = min(angle, self.stops)
        return (self.start + self.rest) * np.exp(-self.rate * angle) - self.rest

    def travel(self, angle):
        angle = min(angle, self.stops)
        gone = (self.start + self.rest) * -np.expm1(-self.rate * angle) / self.rate - self.rest * angle
        return gone / self.omega
