"""Gear materials: allowable stress numbers and S-N lines after ISO 6336-5, -2 and -3."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gearbox.batch import Batch

MPA = 1e6  # Pa


@dataclass(frozen=True)
class LifeLine:
    """S-N line in double logarithms: ``strength`` times the endurance limit at ``first`` cycles, 1 at ``knee``, and
    beyond the knee down to ``last_strength`` at ``last`` cycles. Constant before the first and after the last.

    first, knee, last: number of cycles; strength, last_strength: relative to the endurance limit

    In ISO 6336 it is Z_NT (flank) or Y_NT (root). A line whose last strength is 1 is horizontal beyond the knee.
    """

    first: float
    strength: float
    knee: float
    last: float
    last_strength: float

    def factor(self, cycles: Batch) -> Batch:
        """Strength relative to the endurance limit after load cycles; cycles: number of them."""
        logs = np.log([self.first, self.knee, self.last]), np.log([self.strength, 1.0, self.last_strength])
        return np.exp(np.interp(np.log(np.maximum(cycles, 1e-30)), *logs))

    def cycles(self, stress_ratio: Batch) -> Batch:
        """Life under a constant stress [cycles]; 0 above the static strength, inf below the line.

        stress_ratio: stress relative to the endurance limit

        The damage of the stress is the cycles endured over this.
        """
        ratio = np.maximum(stress_ratio, 1e-30)
        logs = np.log([self.last_strength, 1.0, self.strength]), np.log([self.last, self.knee, self.first])
        if self.last_strength == 1.0:
            logs = logs[0][1:], logs[1][1:]
        life = np.exp(np.interp(np.log(ratio), *logs))
        life = np.where(ratio < self.last_strength, np.inf, life)
        return np.where(ratio > self.strength * (1 + 1e-12), 0.0, life)


@dataclass(frozen=True)
class GearMaterial:
    """Steel and heat treatment of a gear.

    contact_limit sigma_Hlim, root_limit sigma_Flim [Pa]; flank_life, root_life: S-N lines; youngs_modulus [Pa],
    poisson_ratio, density [kg/m^3]; slip_layer rho' of the root's support factor [m]
    """

    name: str
    contact_limit: float
    root_limit: float
    flank_life: LifeLine
    root_life: LifeLine
    youngs_modulus: float = 206e9  # ISO 6336-2, steel
    poisson_ratio: float = 0.3
    density: float = 7800.0  # thesis below eq. 3.101
    slip_layer: float = 3e-6  # ISO 6336-3, case-hardened steel

    @property
    def elasticity_factor(self) -> float:
        """Z_E of two gears of this steel [sqrt(Pa)]: sqrt(E / (2 pi (1 - nu^2))), 189.8 sqrt(MPa)."""
        return float(np.sqrt(self.youngs_modulus / (2 * np.pi * (1 - self.poisson_ratio**2))))


# ISO 6336-2 and -3, case-hardened steel, no pitting permitted; the lower of the lines beyond the knee (0.85 at 1e10).
CASE_HARDENED_FLANK = LifeLine(first=1e5, strength=1.6, knee=5e7, last=1e10, last_strength=0.85)
CASE_HARDENED_ROOT = LifeLine(first=1e3, strength=2.5, knee=3e6, last=1e10, last_strength=0.85)

# 18CrNiMo7-6, which the thesis uses in the same gearbox. ISO 6336-5:2003, case-hardened wrought steel, quality MQ:
# sigma_Hlim 1500 MPa; sigma_Flim 425, 461 or 500 MPa as the core hardness is guaranteed, the middle line taken here.
CASE_HARDENED_MQ = GearMaterial(
    "case-hardened steel, ISO 6336-5 quality MQ (18CrNiMo7-6)",
    1500 * MPA,
    461 * MPA,
    CASE_HARDENED_FLANK,
    CASE_HARDENED_ROOT,
)
# The same steel in the best quality, ME; the nearest ISO quality to the AGMA 2001-C95 grade 3 that the thesis names.
CASE_HARDENED_ME = GearMaterial(
    "case-hardened steel, ISO 6336-5 quality ME (18CrNiMo7-6)",
    1650 * MPA,
    525 * MPA,
    CASE_HARDENED_FLANK,
    CASE_HARDENED_ROOT,
)
MATERIALS = {"case_hardened_MQ": CASE_HARDENED_MQ, "case_hardened_ME": CASE_HARDENED_ME}
