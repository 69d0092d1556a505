"""Strength of what a rotor is made of: shafts by their diameter, sleeves, laminations."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

from materials.errors import MaterialError
from units import MILLIMETRE

MPA, GPA = 1e6, 1e9  # Pa
STEEL_YOUNGS_MODULUS, STEEL_POISSON_RATIO = 210 * GPA, 0.3  # Pa and dimensionless, of all steels, EN 1993-1-1


@dataclass(frozen=True)
class StrengthBySection:
    """Yield or tensile strength of a bar, less in a thick one: it is hardened less deeply.

    rows: (largest diameter [m], strength [Pa]), by rising diameter
    """

    name: str
    rows: tuple[tuple[float, float], ...]

    @classmethod
    def stated(cls, strength: float) -> StrengthBySection:
        """One strength [Pa] for every diameter."""
        return cls("stated", ((inf, strength),))

    def at(self, diameter: float) -> float:
        """Strength [Pa] at a diameter [m]. Raises MaterialError beyond the table."""
        for largest, strength in self.rows:
            if diameter <= largest:
                return strength
        raise MaterialError(
            f"{self.name} has no strength for a shaft of {diameter / MILLIMETRE:.0f} mm, its table ends at "
            f"{self.rows[-1][0] / MILLIMETRE:.0f} mm: state mechanics.shaft_yield_MPa or mechanics.sun_yield_MPa"
        )


# Quenched and tempered, least yield and tensile strength, EN 10083-3:2006, Table 8 (numbers from memory).
SHAFT_STEEL = StrengthBySection(
    "42CrMo4+QT",
    ((16e-3, 900 * MPA), (40e-3, 750 * MPA), (100e-3, 650 * MPA), (160e-3, 550 * MPA), (250e-3, 500 * MPA)),
)
SHAFT_TENSILE = StrengthBySection(
    "42CrMo4+QT",
    ((16e-3, 1100 * MPA), (40e-3, 1000 * MPA), (100e-3, 900 * MPA), (160e-3, 800 * MPA), (250e-3, 750 * MPA)),
)
# Core of a case-hardened pinion. EN 10084 gives no strength of the core; these are of its predecessor 17CrNiMo6, for
# bars of 11, 30 and 63 mm, of the withdrawn DIN 17210.
GEAR_STEEL = StrengthBySection("18CrNiMo7-6, core", ((11e-3, 835 * MPA), (30e-3, 785 * MPA), (63e-3, 685 * MPA)))
GEAR_TENSILE = StrengthBySection(
    "18CrNiMo7-6, core", ((11e-3, 1180 * MPA), (30e-3, 1080 * MPA), (63e-3, 980 * MPA))
)  # fmt: skip
# Reversed amplitude of normal stress that is endured over the tensile strength: FKM guideline.
ENDURED_SHARE, ENDURED_SHARE_CASE_HARDENED = 0.45, 0.40


@dataclass(frozen=True)
class SleeveMaterial:
    """What a sleeve over the magnets is wound or turned of: density [kg/m^3] and strength in hoop direction [Pa]."""

    name: str
    density: float
    strength: float


# Wound, 60 % of high-strength fibres: estimates between makers' data for laminates (hoop strength 1400 to 2000 MPa,
# short term) with a reduction for the winding of a thin ring.
CARBON_SLEEVE = SleeveMaterial("carbon fibre", 1580.0, 1100 * MPA)
STEEL_SLEEVE = SleeveMaterial("nickel alloy 718", 8190.0, 1030 * MPA)  # aged, least yield strength of AMS 5663
