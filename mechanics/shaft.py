"""Shafts: torsion and bending against yield, and the first critical speed with the pull of an eccentric rotor.

The rotor is a mass in the middle of a shaft on two rigid, simple supports (Jeffcott). The laminations do not stiffen
the shaft, which is on the safe side. Off centre the stator pulls the rotor further out: a negative stiffness.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, inf, pi, sqrt


@dataclass(frozen=True)
class BentShaft:
    """A round shaft with the rotor in the middle between two bearings.

    diameter, span: between the bearings [m]; youngs_modulus [Pa]; rotor_mass: that bends it [kg]
    magnetic_stiffness: pull per shift of the rotor [N/m]
    """

    diameter: float
    span: float
    youngs_modulus: float
    rotor_mass: float
    magnetic_stiffness: float

    @property
    def stiffness(self) -> float:
        """Load in the middle per deflection there [N/m], 48 E I/L^3 with I = pi d^4/64."""
        return 48 * self.youngs_modulus * pi * self.diameter**4 / 64 / self.span**3

    @property
    def critical_speed(self) -> float:
        """sqrt((k - k_m)/m) [rad/s]; 0 where the magnetic pull is stiffer than the shaft."""
        return sqrt(max(self.stiffness - self.magnetic_stiffness, 0.0) / self.rotor_mass)

    def deflection(self, load: float, eccentricity: float) -> float:
        """y of the rotor [m] under a load [N] and the pull at an eccentricity e [m] that the deflection adds to.

        k y = F + k_m (e + y); infinite where the magnetic pull is stiffer than the shaft.
        """
        left = self.stiffness - self.magnetic_stiffness
        return (load + self.magnetic_stiffness * eccentricity) / left if left > 0 else inf

    def bearing_load(self, load: float, eccentricity: float) -> float:
        """Radial load of either bearing [N], for arguments as in ``deflection`` [N], [m]."""
        return self.stiffness * self.deflection(load, eccentricity) / 2

    def bending_stress(self, load: float, eccentricity: float) -> float:
        """In the middle [Pa], 32 M/(pi d^3) with M = F L/4; arguments as in ``deflection`` [N], [m]."""
        moment = self.stiffness * self.deflection(load, eccentricity) * self.span / 4
        return 32 * moment / (pi * self.diameter**3)


def torsion_stress(torque: float, diameter: float) -> float:
    """Shear at the surface of a solid round shaft [Pa], 16 T/(pi d^3); torque [Nm], diameter [m]."""
    return 16 * torque / (pi * diameter**3)


def equivalent_stress(bending: float, shear: float) -> float:
    """Von Mises, sqrt(sigma^2 + 3 tau^2) [Pa]; bending, shear: [Pa]."""
    return hypot(bending, sqrt(3) * shear)
