"""An electromagnetic damper as the effects see it: constants, and lists of laws to which an effect may add its own.

Everything is seen at the driving point, in a straight line. A rotary device is brought there by its transmission ratio.

    driving point --mount (k_m, c_m, clearance)-- mass m --F_em + F_law-- ground
    F_em = K g(x, i) i,   K g(x, i) v = L di/dt + u,   i = left(u) / (R + R_shunt)
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from math import inf
from typing import Protocol

import numpy as np


class ForceLaw(Protocol):
    """A force between the mass and the ground."""

    def force(self, position: np.ndarray, velocity: np.ndarray) -> np.ndarray:
        """Force against the motion [N], positive with the velocity.

        position, velocity: of the mass [m], [m/s], any equal shape; at a sine the last axis is one period in equal
        steps. At constant velocity the position is zero: readings are taken in the middle of the stroke.
        """


class CircuitLaw(Protocol):
    """Something in series with the winding that keeps a part of the voltage to itself."""

    def left(self, voltage: np.ndarray, resistance: np.ndarray) -> np.ndarray:
        """Voltage left for the resistances [V] of the voltage that drives the circuit [V]; they broadcast."""


class CouplingLaw(Protocol):
    """A force constant that is not one."""

    def coupling(self, position: np.ndarray, current: np.ndarray) -> np.ndarray:
        """K over the nominal K [1]; force and back-EMF take the same factor, so that no energy is lost in it."""


@dataclass(frozen=True)
class Damper:
    """A linear electromagnetic damper with a shunt resistor at its terminals.

    force_constant: K [N/A = V s/m];  internal_resistance: R [ohm];  inductance: L [H]
    moving_mass: m [kg];  viscous_damping: c [N s/m]
    mount_stiffness: k_m [N/m], infinite for a rigid mount;  mount_damping: c_m [N s/m]
    mount_clearance: free play of the mount, stop to stop [m]
    test_velocity: top velocity of the straight line that ``damping_shunt`` fits [m/s]; zero when not known
    """

    force_constant: float
    internal_resistance: float
    moving_mass: float
    viscous_damping: float
    inductance: float = 0.0
    mount_stiffness: float = inf
    mount_damping: float = 0.0
    mount_clearance: float = 0.0
    test_velocity: float = 0.0
    forces: tuple[ForceLaw, ...] = field(default=())
    circuits: tuple[CircuitLaw, ...] = field(default=())
    couplings: tuple[CouplingLaw, ...] = field(default=())

    def with_force(self, law: ForceLaw) -> Damper:
        return replace(self, forces=self.forces + (law,))

    def with_circuit(self, law: CircuitLaw) -> Damper:
        return replace(self, circuits=self.circuits + (law,))

    def with_coupling(self, law: CouplingLaw) -> Damper:
        return replace(self, couplings=self.couplings + (law,))
