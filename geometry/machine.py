"""The machine as drawn: dimensions of a surface-magnet machine with straight teeth, and whether they can be built.

All lengths in metres, angles in radians, x axis through the centre of tooth 0, counter-clockwise positive.
"""

from __future__ import annotations

from cmath import phase, rect
from dataclasses import dataclass
from math import acos, asin, gcd, pi

import numpy as np


class GeometryError(ValueError):
    """A machine that cannot be drawn; the message says what is wrong and which parameter to move."""


class Magnetisation:
    """Direction of the remanence inside one magnet; the concrete patterns are below."""

    def direction_angle(self, position_angle: np.ndarray, centre_angle: float) -> np.ndarray:
        """Angle of the magnetisation vector of an outward magnet [rad], of the shape of the positions.

        position_angle: polar angle of the point [rad], array of any shape
        centre_angle: polar angle of the magnet's centre line [rad]
        """
        raise NotImplementedError


@dataclass(frozen=True)
class ParallelMagnetisation(Magnetisation):
    """Every point of a magnet is magnetised along the magnet's centre line."""

    def direction_angle(self, position_angle: np.ndarray, centre_angle: float) -> np.ndarray:
        """The angle of the centre line [rad], of the shape of position_angle [rad], any shape."""
        return 0.0 * position_angle + centre_angle


@dataclass(frozen=True)
class RadialMagnetisation(Magnetisation):
    """Every point of a magnet is magnetised along its own radius."""

    def direction_angle(self, position_angle: np.ndarray, centre_angle: float) -> np.ndarray:
        """The polar angle of the point [rad], of the shape of position_angle [rad], any shape."""
        return position_angle + 0.0 * centre_angle


@dataclass(frozen=True)
class Machine:
    """Cross-section of an inner-rotor surface-magnet machine (thesis Fig. 3.16), SI units.

    The slot has a parallel-sided opening of depth ``shoe_d1``, a straight taper to the tooth flank over ``shoe_d2``
    (see ``taper_angle``), straight tooth flanks and an arc bottom. ``hanselman_machine`` derives tooth width and shoe
    from the back iron.
    """

    slots: int
    pole_pairs: int
    stator_outer_radius: float  # R_so
    rotor_outer_radius: float  # R_ro, over the magnets
    back_iron_width: float  # w_bi
    tooth_width: float  # w_tb
    magnet_length: float  # l_m, radial
    airgap: float  # g
    slot_opening: float  # w_s
    shoe_d1: float  # depth of the parallel-sided opening [m]
    shoe_d2: float  # depth of the taper [m]
    shaft_radius: float
    magnet_arc_fraction: float = 1.0  # of the pole pitch
    magnetisation: Magnetisation = ParallelMagnetisation()

    @property
    def poles(self) -> int:
        return 2 * self.pole_pairs

    @property
    def stator_inner_radius(self) -> float:
        """R_si = R_ro + g."""
        return self.rotor_outer_radius + self.airgap

    @property
    def mid_gap_radius(self) -> float:
        return self.rotor_outer_radius + self.airgap / 2

    @property
    def slot_bottom_radius(self) -> float:
        """R_sb = R_so - w_bi (eq. 3.56)."""
        return self.stator_outer_radius - self.back_iron_width

    @property
    def opening_width(self) -> float:
        """Distance between neighbouring shoes at the bore: tau_s - w_t, w_t = max(tau_s - w_s, w_tb) (eq. 3.54)."""
        return min(self.slot_opening, self.slot_pitch * self.stator_inner_radius - self.tooth_width)

    @property
    def opening_top_radius(self) -> float:
        """Radius at which the parallel-sided opening ends and the taper begins, R_si + d_1 [m]."""
        return self.stator_inner_radius + self.shoe_d1

    @property
    def opening_top_angle(self) -> float:
        """Angle of that end from the tooth axis [rad]."""
        return self.slot_pitch / 2 - asin(self.opening_width / 2 / self.opening_top_radius)

    @property
    def taper_angle(self) -> float:
        """Angle from the tooth axis at which the straight taper leaves the shoe [rad].

        That is the end of the opening, unless the shoe spans so wide an angle (few slots) that a straight line from
        there would cut through it, or through the bore: then the shoe keeps its depth d_1 up to the line that touches
        it.
        """
        flank = asin(self.tooth_width / 2 / self.shoe_top_radius)
        touching = flank + acos(self.opening_top_radius / self.shoe_top_radius)
        return min(touching, self.opening_top_angle)

    @property
    def taper_touches_shoe(self) -> bool:
        """Whether a straight taper from the end of the opening would cut through the shoe; see ``taper_angle``."""
        return self.taper_angle < self.opening_top_angle

    @property
    def shoe_top_radius(self) -> float:
        """Radius at which the taper meets the tooth flank, R_si + d_1 + d_2."""
        return self.stator_inner_radius + self.shoe_d1 + self.shoe_d2

    @property
    def half_slot_area(self) -> float:
        """Area that one coil side may fill, from the axis of the slot to the tooth and down to its opening [m^2].

        A = (r_sb^2 (t/2 - f_sb) - r_op^2 (t/2 - f_t) - P_sb x P_1 - P_1 x P_t)/2, Green's theorem around the half slot;
        t: slot pitch; f_sb, f_t: angles at which the flank ends and the taper begins, at P_sb and P_t; P_1: between.
        """
        flank_end, flank_start = self._flank(self.slot_bottom_radius), self._flank(self.shoe_top_radius)
        taper = rect(self.opening_top_radius, self.taper_angle)
        arcs = self.slot_bottom_radius**2 * (self.slot_pitch / 2 - phase(flank_end))
        arcs -= self.opening_top_radius**2 * (self.slot_pitch / 2 - self.taper_angle)
        return (arcs - _cross(flank_end, flank_start) - _cross(flank_start, taper)) / 2

    def _flank(self, radius: float) -> complex:
        """Point x + jy of the flank of tooth 0 at this radius [m]."""
        return rect(radius, asin(self.tooth_width / 2 / radius))

    @property
    def rotor_core_radius(self) -> float:
        return self.rotor_outer_radius - self.magnet_length

    @property
    def slot_pitch(self) -> float:
        """Angle between two teeth [rad]."""
        return 2 * pi / self.slots

    @property
    def pole_pitch(self) -> float:
        """Angle between two magnets [rad]."""
        return pi / self.pole_pairs

    @property
    def sectors(self) -> int:
        """How many times the smallest (anti)periodic sector fits into the machine: gcd(slots, poles)."""
        return gcd(self.slots, self.poles)

    @property
    def is_antiperiodic(self) -> bool:
        """True when the field changes sign from one sector to the next (odd number of poles per sector)."""
        return (self.poles // self.sectors) % 2 == 1


def _cross(p: complex, q: complex) -> float:
    return (p.conjugate() * q).imag


def hanselman_machine(
    *,
    slots: int,
    pole_pairs: int,
    stator_outer_radius: float,
    rotor_outer_radius: float,
    back_iron_width: float,
    magnet_length: float,
    airgap: float,
    slot_opening: float,
    shoe_depth_fraction: float,
    shoe_aspect_ratio: float,
    shaft_radius: float,
    magnet_arc_fraction: float = 1.0,
    magnetisation: Magnetisation = ParallelMagnetisation(),
) -> Machine:
    """Machine whose tooth and shoe follow from the back iron.

    w_tb = 2 w_bi / (N_s / 2p)            (3.53): a tooth carries the flux of two back-iron widths per slot and pole
    d_1 = alpha_sd w_tb / (1 + alpha_d)   (3.57)
    d_2 = d_1 / alpha_d                   (3.58)

    shoe_depth_fraction: alpha_sd; shoe_aspect_ratio: alpha_d, dimensionless; magnet_arc_fraction: of the pole pitch
    Lengths in m. Source: thesis eqs 3.53-3.58 after Hanselman, Brushless Permanent Magnet Motor Design.
    """
    slots_per_pole = slots / (2 * pole_pairs)
    tooth_width = 2 * back_iron_width / slots_per_pole
    shoe_d1 = shoe_depth_fraction * tooth_width / (1 + shoe_aspect_ratio)
    return Machine(
        slots=slots,
        pole_pairs=pole_pairs,
        stator_outer_radius=stator_outer_radius,
        rotor_outer_radius=rotor_outer_radius,
        back_iron_width=back_iron_width,
        tooth_width=tooth_width,
        magnet_length=magnet_length,
        airgap=airgap,
        slot_opening=slot_opening,
        shoe_d1=shoe_d1,
        shoe_d2=shoe_d1 / shoe_aspect_ratio,
        shaft_radius=shaft_radius,
        magnet_arc_fraction=magnet_arc_fraction,
        magnetisation=magnetisation,
    )
