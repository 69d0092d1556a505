"""Magnet grades by name: what a data sheet says, and the knee under which a magnet loses remanence for good.

B and H are counted along the magnetisation, so that a field against the magnet is a negative H. The polarisation stays
on its straight recoil line down to the knee and collapses beyond it, at -H_cJ to zero:

    B = B_r(T) + mu_0 mu_r H               for H >= -H_k(T),    H_k = s H_cJ
    B_knee(T) = B_r(T) - mu_0 mu_r H_k(T)
    B_r(T) = B_r (1 + alpha (T - 20 degC)),   H_cJ(T) = H_cJ (1 + beta (T - 20 degC))

s is the squareness of the curve. B_knee is negative where the magnet stands more than its own remanence (a cold NdFeB
magnet). Where the knee of the data sheet is H_k with 90 % of the remanence left, some per cent of it are lost there
already; a field component across the magnetisation is left out. Both straight laws hold from about -40 degC to the
largest working temperature of the grade. Standard textbook formulas; the first check of a magnet, not its hysteresis.
"""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from materials.errors import MaterialError
from materials.magnet import ROOM_TEMPERATURE, Magnet
from units import MU_0, to_si

GRADES = Path(__file__).parent / "magnets" / "grades.toml"


@dataclass(frozen=True)
class MagnetGrade:
    """A grade at 20 degC.

    material: in words; remanence: B_r [T]; coercivity: intrinsic, H_cJ [A/m]
    remanence_coefficient: alpha [1/K]; coercivity_coefficient: beta [1/K], positive for ferrites
    recoil_permeability: mu_r, dimensionless; knee_share: s, share of H_cJ at the knee
    density [kg/m^3]; resistivity [ohm m]; largest_temperature: that the maker allows [degC]
    source: where the numbers come from, and which are typical
    """

    name: str
    material: str
    remanence: float
    coercivity: float
    remanence_coefficient: float
    coercivity_coefficient: float
    recoil_permeability: float
    knee_share: float
    density: float
    resistivity: float
    largest_temperature: float
    source: str

    def remanence_at(self, temperature: float) -> float:
        """B_r(T) [T] at a temperature [degC]. Raises MaterialError where the straight law has used it up."""
        return self._changed("remanence", self.remanence, self.remanence_coefficient, temperature)

    def coercivity_at(self, temperature: float) -> float:
        """Intrinsic H_cJ(T) [A/m] at a temperature [degC]. Raises MaterialError where the straight law has used it
        up."""
        return self._changed("coercivity", self.coercivity, self.coercivity_coefficient, temperature)

    def knee_at(self, temperature: float) -> float:
        """B_knee(T) [T] at a temperature [degC]: flux density along the magnetisation under which remanence is lost."""
        field = self.knee_share * self.coercivity_at(temperature)
        return self.remanence_at(temperature) - MU_0 * self.recoil_permeability * field

    def magnet_at(self, temperature: float) -> Magnet:
        """The magnet on its recoil line at a temperature [degC]."""
        return Magnet(
            self.remanence, self.recoil_permeability, self.remanence_coefficient, ROOM_TEMPERATURE
        ).at(temperature)  # fmt: skip

    def weaker_of(self, cold: float, hot: float) -> float:
        """Which of two temperatures [degC] has the smaller coercivity: the hot one, but the cold one for ferrites."""
        return min((hot, cold), key=self.coercivity_at)

    def _changed(self, what: str, value: float, coefficient: float, temperature: float) -> float:
        factor = 1.0 + coefficient * (temperature - ROOM_TEMPERATURE)
        if not factor > 0:
            raise MaterialError(
                f"magnet grade {self.name} has no {what} left at {temperature:g} degC: it works up to "
                f"{self.largest_temperature:g} degC, take another grade or a lower temperature"
            )
        return value * factor


def known_grades() -> list[str]:
    """Names of the grades shipped with the package."""
    return list(_grades())


def load_grade(name: str) -> MagnetGrade:
    """The grade of a name. Raises MaterialError for an unknown one, with the known ones."""
    if name not in _grades():
        raise MaterialError(f"unknown magnet grade '{name}': known are {', '.join(known_grades())}")
    return _grades()[name]


@cache
def _grades() -> dict[str, MagnetGrade]:
    with open(GRADES, "rb") as file:
        rows = tomllib.load(file)
    return {name: _grade(name, row) for name, row in rows.items()}


def _grade(name: str, row: dict[str, float | str]) -> MagnetGrade:
    quantities = dict(to_si(key, value) for key, value in row.items())
    return MagnetGrade(name, **quantities)
