"""What a free play in the mount changes in the impedance of a damper, by marching in time.

Implicit Euler over two periods, all rows at once; in the play the mass is free, at its ends it is carried along (by a
rigid mount, without rebound) or pressed by the mount's spring. Only the *change* against the same march without play is
used, so the error of the march, of first order in the step, falls out where the play is small, and the change ends at
zero with it.
"""

from __future__ import annotations

from dataclasses import replace
from math import isinf

import numpy as np

from effects.damper_design import Damper
from workbench.models.damper.harmonic_balance import Drive
from workbench.models.damper.steady_circuit import coupling_factor, voltage_left

STEPS = 160  # of a period
PERIODS = 2  # marched; the last one is read. Touching an end of the play makes the mass forget how it started


def change_by_play(design: Damper, drive: Drive) -> np.ndarray:
    """Impedance with the play less the impedance without [N s/m], complex (n,)."""
    return _marched(design, drive) - _marched(replace(design, mount_clearance=0.0), drive)


def _marched(design: Damper, drive: Drive) -> np.ndarray:
    theta = 2 * np.pi * np.arange(1, PERIODS * STEPS + 1) / STEPS
    march = _March(design, drive)
    force = np.array([march.step(angle) for angle in theta])[-STEPS:]
    middle = theta[-STEPS:] - np.pi / STEPS  # a backward difference belongs to the middle of its step
    return 2.0 / STEPS * (np.exp(-1j * middle) @ force) / drive.top_velocity[:, 0]


class _March:
    """State of the mass at one instant: position x, velocity v, current i, each (n,)."""

    def __init__(self, design: Damper, drive: Drive):
        self.design, self.drive = design, drive
        self.omega, self.amplitude = drive.omega[:, 0], drive.amplitude
        self.h = 2 * np.pi / STEPS / self.omega
        self.resistance = design.internal_resistance + drive.shunt
        self.inertia = design.inductance / self.h  # of the current, in ohm
        self.linear = not (design.forces or design.circuits or design.couplings)
        self.linear_loss = design.viscous_damping + design.force_constant**2 / (self.resistance + self.inertia)
        self.x, self.v = np.zeros_like(self.h), self.omega * self.amplitude
        self.i = design.force_constant * self.v / self.resistance

    def step(self, theta: float) -> np.ndarray:
        """Advance by one step to the driver's angle; returns the force at the driving point [N], (n,)."""
        d, h = self.design, self.h
        driver, driver_v = self.amplitude * np.sin(theta), self.omega * self.amplitude * np.cos(theta)
        loss, rest = self._force_at_next_velocity()
        inertia = d.moving_mass / h
        free = (inertia * self.v - rest) / (inertia + loss)  # velocity without the driver
        gap = driver - (self.x + h * free)
        side = np.sign(gap) * 0.5 * d.mount_clearance
        touches = np.abs(gap) > 0.5 * d.mount_clearance
        if isinf(d.mount_stiffness):
            v = np.where(touches, (driver - side - self.x) / h, free)
        else:
            pressed = inertia + loss + d.mount_stiffness * h + d.mount_damping
            push = d.mount_stiffness * (driver - side - self.x) + d.mount_damping * driver_v
            v = np.where(touches, (inertia * self.v - rest + push) / pressed, free)
        force = (inertia + loss) * (v - free)
        if self.inertia.any() or not self.linear:
            self.i = self._current(v)
        self.x, self.v = self.x + h * v, v
        return force

    def _force_at_next_velocity(self) -> tuple[np.ndarray, np.ndarray]:
        """Slope and rest of the force on the mass, linear in its next velocity: loss * v + rest."""
        if self.linear:
            remembered = self.design.force_constant * self.inertia * self.i / (self.resistance + self.inertia)
            return self.linear_loss, remembered
        step = 1e-6 * np.abs(self.v) + 1e-9
        here, there = self._force(self.v), self._force(self.v + step)
        slope = np.maximum((there - here) / step, 0.0)
        return slope, here - slope * self.v

    def _force(self, v: np.ndarray) -> np.ndarray:
        d, current = self.design, self._current(v)
        force = d.viscous_damping * v + d.force_constant * coupling_factor(d, self.x, current) * current
        for law in d.forces:
            force = force + law.force(self.x, v)
        return force

    def _current(self, v: np.ndarray) -> np.ndarray:
        """Current at the end of the step: i (R + L/h) = left(K g v + L i_old / h)."""
        d, resistance = self.design, self.resistance + self.inertia
        emf = d.force_constant * coupling_factor(d, self.x, self.i) * v + self.inertia * self.i
        return voltage_left(d, emf, resistance) / resistance
