"""What a machine with freed dimensions must hold beside its drawing, as a room that an optimum keeps open."""

from __future__ import annotations

from cmath import exp
from dataclasses import dataclass
from math import pi
from typing import Protocol

from geometry.machine import Machine
from geometry.winding import WindingLayout
from units import MILLIMETRE, MU_0


class BuildRule(Protocol):
    """A rule that a machine must hold."""

    def room(self, machine: Machine, layout: WindingLayout) -> float:
        """Room that is left, relative (dimensionless): zero or more where the rule holds."""

    def words(self, machine: Machine, layout: WindingLayout) -> str:
        """What the rule asks of this machine."""


@dataclass(frozen=True)
class MagnetStands:
    """The magnets must be long enough for the overload current to leave them above their knee.

    Along a field line through one magnet, the gap and the tooth with the largest magnetic potential U, all of it
    against the magnet, with flux density B in gap and magnet alike,

        B g / mu_0 + (B - B_r) l_m / (mu_0 mu_r) = -U,   B >= B_knee
        l_m >= mu_r (mu_0 U + B_knee g) / (B_r - B_knee)

    remanence: B_r [T], knee: B_knee [T], both at the worst temperature; recoil_permeability: mu_r, dimensionless
    slot_density: amplitude of the overload current density over the whole slot, k_cp J [A/m^2]
    Standard magnetic circuit without leakage and curvature, an estimate; the field decides later, over all of the
    magnet, in ``electrical.magnets_stage``.
    """

    remanence: float
    knee: float
    recoil_permeability: float
    slot_density: float

    def least_length(self, machine: Machine, layout: WindingLayout) -> float:
        """Shortest magnet that stands the overload [m]; negative where the knee lies below any field."""
        potential = self.slot_density * 2 * machine.half_slot_area / layout.layers * largest_tooth_potential(layout)
        driven = MU_0 * potential + self.knee * machine.airgap
        return self.recoil_permeability * driven / (self.remanence - self.knee)

    def room(self, machine: Machine, layout: WindingLayout) -> float:
        """Of the magnet length, dimensionless, see ``BuildRule``."""
        return 1 - self.least_length(machine, layout) / machine.magnet_length

    def words(self, machine: Machine, layout: WindingLayout) -> str:
        least = self.least_length(machine, layout) / MILLIMETRE
        return f"magnets of {least:.2f} mm at least, which stand the overload current"


@dataclass(frozen=True)
class WireEnters:
    """The slot opening must let a wire pass; diameter: of the wire over its insulation [m]."""

    diameter: float

    def room(self, machine: Machine, layout: WindingLayout) -> float:
        """Of the slot opening, dimensionless, see ``BuildRule``."""
        return 1 - self.diameter / machine.opening_width

    def words(self, machine: Machine, layout: WindingLayout) -> str:
        return f"a slot opening of {self.diameter / MILLIMETRE:.2f} mm at least, through which the wire passes"


def largest_tooth_potential(layout: WindingLayout) -> float:
    """Largest magnetic potential of a tooth against their mean, over the ampere-turns of a coil side, dimensionless.

    With balanced currents of amplitude 1, tooth j has the phasor c_j = sum_k s_k exp(-i 2 pi phase_k / 3) over the
    coils k around it, and the largest of |c_j - mean c| is returned, dimensionless; 1 for coils on every single tooth.
    """
    teeth = [0j] * layout.slots
    for coil in layout.coils:
        for step in range(layout.coil_pitch):  # the coil goes in slot k and comes back in slot k - y
            teeth[(coil.index - step) % layout.slots] += coil.sign * exp(-2j * pi * coil.phase / 3)
    mean = sum(teeth) / layout.slots
    return max(abs(tooth - mean) for tooth in teeth)
