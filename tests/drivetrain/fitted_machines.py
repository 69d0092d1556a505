"""Cross-sections in the place of a study's fits: polynomials of the motorcycle's optima, and a field case for them."""

from dataclasses import dataclass
from math import sqrt

import numpy as np

from geometry.family import Combination, MachineFamily
from geometry.half_cell import MeshDensity
from geometry.magnetisation import ParallelMagnetisation
from magnetostatics.case import FamilyCase
from magnetostatics.model import MachineMaterials
from materials.library import load_steel
from materials.magnet import Magnet
from optimisation.fits import FittedSection
from optimisation.polynomial_fits import FitRefused
from units import MILLIMETRE, SQUARE_MILLIMETRE

# p2, p1, p0 over the stator radius in mm: fits of the motorcycle's optima at a limit of 1.2 T in the aligned tooth.
NINE, TWELVE = Combination(9, 10), Combination(12, 10)
POLYNOMIALS = {
    NINE: {
        "torque_nominal": (0.1045025168906, -4.190048760751, 55.28498087695),
        "torque_overload": (0.1360616278844, -2.086689495144, 0.3627691969257),
        "torque_overload_linear": (0.3483417229685, -13.9668292025, 184.2832695898),
        "back_iron_width": (-0.0003506457148266, 0.09676507890389, -0.8898331548552),
        "rotor_outer_radius": (0.00493255418996, 0.1123861942167, 3.243309009166),
        "half_slot_area": (0.05456489766455, 1.823351669469, -22.9153445777),
    },
    TWELVE: {
        "torque_nominal": (0.1115522349661, -5.290158373764, 78.80029600023),
        "torque_overload": (0.2047253302608, -9.102123832912, 146.1248561109),
        "torque_overload_linear": (0.3718407832205, -17.63386124588, 262.6676533341),
        "back_iron_width": (0.0006293799388423, 0.01954171737923, 0.7303997906443),
        "rotor_outer_radius": (0.004992330105067, -0.01822935988283, 5.708500503154),
        "half_slot_area": (0.02130334703899, 3.400023519172, -62.31896482071),
    },
}


@dataclass(frozen=True)
class MotorcycleFits:
    """What ``optimisation.fits.SectionFits`` offers; refused: combinations whose fits are not to be used."""

    refused: tuple[Combination, ...] = ()

    def range(self, combination: Combination) -> tuple[float, float]:
        """Stator radii [m]."""
        return 35 * MILLIMETRE, 57.5 * MILLIMETRE

    def at(self, combination: Combination, radius: float) -> FittedSection:
        """The cross-section at a stator radius [m]."""
        if combination in self.refused:
            raise FitRefused(f"the fit of {combination.words} is refused: a point is far away from the curve")
        found = {name: float(np.polyval(row, radius / MILLIMETRE)) for name, row in POLYNOMIALS[combination].items()}
        return FittedSection(
            back_iron_width=found["back_iron_width"] * MILLIMETRE,
            rotor_outer_radius=found["rotor_outer_radius"] * MILLIMETRE,
            half_slot_area=found["half_slot_area"] * SQUARE_MILLIMETRE,
            torque_nominal=found["torque_nominal"],
            torque_overload=found["torque_overload"],
            torque_overload_linear=found["torque_overload_linear"],
        )


STEEL = load_steel("35PN270")
FAMILY = MachineFamily(
    slots=12, pole_pairs=5, stator_outer_radius=42.5 * MILLIMETRE, rotor_outer_radius=15.7 * MILLIMETRE,
    back_iron_width=3.3 * MILLIMETRE, magnet_length=2.5 * MILLIMETRE, airgap=0.5 * MILLIMETRE,
    slot_opening=2.0 * MILLIMETRE, shoe_depth_fraction=0.52, shoe_aspect_ratio=1.0, shaft_radius=5.0 * MILLIMETRE,
    magnet_arc_fraction=1.0, magnetisation=ParallelMagnetisation(),
)  # fmt: skip
CASE = FamilyCase(
    family=FAMILY, materials=MachineMaterials(STEEL, STEEL, Magnet(1.3, 1.0)), layers=2, coil_pitch=None, packing=0.3,
    density=MeshDensity(), detail=MeshDensity(), nominal_density=6e6 * sqrt(2), overload_density=20e6 * sqrt(2),
)  # fmt: skip
