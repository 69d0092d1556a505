"""Permanent magnets on their straight recoil line B = B_r + mu_0 mu_r H, with the remanence falling as they warm up."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import isfinite

from materials.errors import MaterialError
from units import MU_0

# Reversible temperature coefficient of the remanence of sintered NdFeB: -0.11 to -0.12 %/K (makers' data sheets).
NDFEB_REMANENCE_COEFFICIENT = -0.0011  # 1/K
# A hair below the physical bound of 1, so that a derivative can be taken at 1.
SMALLEST_RECOIL = 0.999
ROOM_TEMPERATURE = 20.0  # degC, at which data sheets state the remanence


@dataclass(frozen=True)
class Magnet:
    """B = B_r(T) + mu_0 mu_r H,   B_r(T) = B_r (1 + alpha (T - T_ref)).

    Valid between about -40 degC and the maker's working temperature, and above the knee of the demagnetisation curve:
    irreversible loss is not in this law. A remanence of zero is a magnet that has lost it, or was never magnetised.
    """

    remanence: float  # B_r at the reference temperature [T]
    recoil_permeability: float = 1.05  # mu_r, dimensionless; 1.05 for NdFeB, the thesis's field model takes 1.0
    temperature_coefficient: float = NDFEB_REMANENCE_COEFFICIENT  # alpha [1/K]
    reference_temperature: float = ROOM_TEMPERATURE  # T_ref [degC]
    axis_error: float = 0.0  # of the direction of magnetisation, counter-clockwise from the drawn one [rad]

    def __post_init__(self) -> None:
        if not (isfinite(self.remanence) and self.remanence >= 0):
            raise MaterialError(f"a magnet's remanence must be zero or more, found {self.remanence:g} T")
        if not self.recoil_permeability >= SMALLEST_RECOIL:
            raise MaterialError(f"a recoil permeability is 1 or more, found {self.recoil_permeability:g}")

    def at(self, temperature: float) -> Magnet:
        """The same magnet with this temperature [degC] as its reference; ``at`` may be applied again.

        Raises MaterialError where the straight law has used up the remanence.
        """
        factor = self.remanence_share(temperature)
        if not factor > 0:
            raise MaterialError(f"no remanence left at {temperature:g} degC: beyond the range of the linear law")
        return replace(
            self,
            remanence=self.remanence * factor,
            temperature_coefficient=self.temperature_coefficient / factor,
            reference_temperature=temperature,
        )

    def remanence_share(self, temperature: float) -> float:
        """B_r(T)/B_r at the reference, dimensionless; temperature [degC]."""
        return 1.0 + self.temperature_coefficient * (temperature - self.reference_temperature)

    @property
    def coercive_field(self) -> float:
        """H_c = B_r/(mu_0 mu_r) [A/m], where the recoil line meets B = 0."""
        return self.remanence / (MU_0 * self.recoil_permeability)
