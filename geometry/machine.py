"""The machine as drawn: dimensions of a surface-magnet machine with straight teeth, and whether they can be built.

All lengths in metres, angles in radians, x axis through the centre of tooth 0, counter-clockwise positive.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from geometry.errors import GeometryError
from geometry.magnetisation import PARALLEL, Magnetisation
from geometry.parts import DrawnMachine, Pitches
from geometry.rotors.surface_magnets import SurfaceMagnets
from geometry.stators.straight_teeth import StraightTeeth


@dataclass(frozen=True)
class Machine(Pitches):
    """Cross-section of an inner-rotor surface-magnet machine (thesis Fig. 3.16), SI units.

    The list of its dimensions, as they are stated and varied; ``stator`` and ``rotor`` draw it. ``hanselman_machine``
    derives tooth width and shoe from the back iron.
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
    magnetisation: Magnetisation = PARALLEL

    @property
    def stator_inner_radius(self) -> float:
        """R_si = R_ro + g."""
        return self.rotor_outer_radius + self.airgap

    @property
    def mid_gap_radius(self) -> float:
        return self.rotor_outer_radius + self.airgap / 2

    @cached_property
    def stator(self) -> StraightTeeth:
        """The stator as it is drawn."""
        return StraightTeeth(
            self.slots, self.stator_outer_radius, self.stator_inner_radius, self.back_iron_width, self.tooth_width,
            self.slot_opening, self.shoe_d1, self.shoe_d2,
        )  # fmt: skip

    @cached_property
    def rotor(self) -> SurfaceMagnets:
        """The rotor as it is drawn."""
        return SurfaceMagnets(
            self.poles, self.rotor_outer_radius, self.magnet_length, self.shaft_radius, self.magnet_arc_fraction,
            self.magnetisation,
        )  # fmt: skip

    @property
    def slot_bottom_radius(self) -> float:
        """R_sb = R_so - w_bi (eq. 3.56)."""
        return self.stator.slot_bottom_radius

    @property
    def opening_width(self) -> float:
        """Distance between neighbouring shoes at the bore: tau_s - w_t, w_t = max(tau_s - w_s, w_tb) (eq. 3.54)."""
        return self.stator.opening_width

    @property
    def opening_top_radius(self) -> float:
        """Radius at which the parallel-sided opening ends and the taper begins, R_si + d_1 [m]."""
        return self.stator.opening_top_radius

    @property
    def opening_top_angle(self) -> float:
        """Angle of that end from the tooth axis [rad]."""
        return self.stator.opening_top_angle

    @property
    def taper_angle(self) -> float:
        """Angle from the tooth axis at which the straight taper leaves the shoe [rad]."""
        return self.stator.taper_angle

    @property
    def taper_touches_shoe(self) -> bool:
        """Whether a straight taper from the end of the opening would cut through the shoe; see ``taper_angle``."""
        return self.stator.taper_touches_shoe

    @property
    def shoe_top_radius(self) -> float:
        """Radius at which the taper meets the tooth flank, R_si + d_1 + d_2."""
        return self.stator.shoe_top_radius

    @property
    def half_slot_area(self) -> float:
        """Area that one coil side may fill, from the axis of the slot to the tooth and down to its opening [m^2]."""
        return self.stator.half_slot_area

    @property
    def rotor_core_radius(self) -> float:
        return self.rotor_outer_radius - self.magnet_length


def dimensions_of(machine: DrawnMachine) -> Machine:
    """The list of dimensions of an inner-rotor surface-magnet machine.

    Raises GeometryError for another kind: who asks knows that kind alone.
    """
    if not isinstance(machine, Machine):
        raise GeometryError(
            "this needs a machine with magnets on the surface of an inner rotor, found "
            f"{type(machine.stator).__name__} with {type(machine.rotor).__name__}"
        )
    return machine


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
    magnetisation: Magnetisation = PARALLEL,
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
