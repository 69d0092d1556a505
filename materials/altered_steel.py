"""Steel that is not as measured: packed with insulation, harder to magnetise, saturating earlier, strained.

Every law here wraps another one and is as smooth as that one; at its null it returns the same numbers.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from materials.errors import MaterialError
from materials.reluctivity import Reluctivity
from units import MU_0, Values

_MOST_STEPS = 60  # of Newton's method for one flux density; it takes 2 to 5
_ROUNDING = 1e-13
LARGEST_FILL = 1.001  # a hair above the physical bound of 1, so that a derivative can be taken at 1


@dataclass(frozen=True)
class ScaledReluctivity(Reluctivity):
    """Another law with H multiplied by a factor (dimensionless) at every flux density."""

    law: Reluctivity
    factor: float

    def nu(self, b2: Values) -> np.ndarray:
        """Reluctivity [m/H] at b2 [T^2], of its shape."""
        return self.factor * self.law.nu(b2)

    def nu_and_derivative(self, b2: Values) -> tuple[np.ndarray, np.ndarray]:
        """Reluctivity [m/H] and its derivative [m/(H T^2)] at b2 [T^2], both of its shape."""
        nu, slope = self.law.nu_and_derivative(b2)
        return self.factor * nu, self.factor * slope

    def field_strength(self, b: Values) -> np.ndarray:
        """H [A/m] at b [T], of its shape."""
        return self.factor * self.law.field_strength(b)

    def flux_density(self, h: Values) -> np.ndarray:
        """B [T] at h [A/m], of its shape."""
        return self.law.flux_density(h / self.factor)

    def energy_density(self, b: Values) -> np.ndarray:
        """w(B) [J/m^3] at b [T], of its shape."""
        return self.factor * self.law.energy_density(b)


@dataclass(frozen=True)
class ScaledSaturation(Reluctivity):
    """Another law stretched along its line of constant permeability: J(H) = s J_s(H/s), so B = s B_s(H/s).

    The saturation polarisation is s times as large, the initial permeability and mu_0 far beyond saturation stay.
    """

    law: Reluctivity
    factor: float  # s, dimensionless

    def __post_init__(self) -> None:
        _check_positive("scale of the saturation polarisation", self.factor)

    def nu(self, b2: Values) -> np.ndarray:
        """Reluctivity [m/H] at b2 [T^2], of its shape."""
        return self.law.nu(b2 / self.factor**2)

    def nu_and_derivative(self, b2: Values) -> tuple[np.ndarray, np.ndarray]:
        """Reluctivity [m/H] and its derivative [m/(H T^2)] at b2 [T^2], both of its shape."""
        nu, slope = self.law.nu_and_derivative(b2 / self.factor**2)
        return nu, slope / self.factor**2

    def field_strength(self, b: Values) -> np.ndarray:
        """H [A/m] at b [T], of its shape."""
        return self.factor * self.law.field_strength(np.asarray(b, dtype=float) / self.factor)

    def flux_density(self, h: Values) -> np.ndarray:
        """B [T] at h [A/m], of its shape."""
        return self.factor * self.law.flux_density(np.asarray(h, dtype=float) / self.factor)

    def energy_density(self, b: Values) -> np.ndarray:
        """w(B) [J/m^3] at b [T], of its shape."""
        return self.factor**2 * self.law.energy_density(np.asarray(b, dtype=float) / self.factor)


@dataclass(frozen=True, eq=False)
class MixedReluctivity(Reluctivity):
    """Flux that steel and air share at field strengths in a fixed ratio:

        B = a B_s(H_s) + c mu_0 H_s,   H = k H_s

    With the flux density b of the steel and D = a + c mu_0 nu_s(b^2):  B = b D,  nu = k nu_s/D,
    dnu/d(B^2) = k a nu_s' / (D^2 (D^2 + 2 c mu_0 b^2 D nu_s')),  w(B) = k (a w_s(b) + c mu_0 H_s^2/2).
    b follows from B by Newton's method to rounding. Build it with ``stacked`` or ``hardened``.

    steel, air, ratio: a > 0, c, k > 0, dimensionless, scalar or arrays that match the flux densities
    """

    law: Reluctivity
    steel: float | np.ndarray
    air: float | np.ndarray
    ratio: float | np.ndarray

    def nu(self, b2: Values) -> np.ndarray:
        """Reluctivity [m/H] at b2 [T^2], of its shape."""
        return self.nu_and_derivative(b2)[0]

    def nu_and_derivative(self, b2: Values) -> tuple[np.ndarray, np.ndarray]:
        """Reluctivity [m/H] and its derivative [m/(H T^2)] at b2 [T^2], both of its shape."""
        b = self._in_steel(np.sqrt(np.asarray(b2, dtype=float)))
        nu, slope = self.law.nu_and_derivative(b * b)
        d, a, c, k = self.steel + self.air * MU_0 * nu, self.steel, self.air, self.ratio
        return k * nu / d, k * a * slope / (d**2 * (d**2 + 2 * c * MU_0 * b * b * d * slope))

    def field_strength(self, b: Values) -> np.ndarray:
        """H [A/m] at b [T], of its shape."""
        return self.ratio * self.law.field_strength(self._in_steel(b))

    def flux_density(self, h: Values) -> np.ndarray:
        """B [T] at h [A/m], of its shape."""
        inside = np.asarray(h, dtype=float) / self.ratio
        return self.steel * self.law.flux_density(inside) + self.air * MU_0 * inside

    def energy_density(self, b: Values) -> np.ndarray:
        """w(B) [J/m^3] at b [T], of its shape."""
        b = self._in_steel(b)
        air = MU_0 / 2 * self.law.field_strength(b) ** 2
        return self.ratio * (self.steel * self.law.energy_density(b) + self.air * air)

    def _in_steel(self, flux: Values) -> np.ndarray:
        """Flux density b of the steel [T] for the shared one: the root of a b + c mu_0 H_s(b) = B, odd in B."""
        flux = np.asarray(flux, dtype=float)
        size = np.abs(flux)
        b = size / self.steel
        for _ in range(_MOST_STEPS):
            nu, slope = self.law.nu_and_derivative(b * b)
            excess = b * (self.steel + self.air * MU_0 * nu) - size
            if np.all(np.abs(excess) <= _ROUNDING * (1 + size)):
                return np.copysign(b, flux)
            b = np.maximum(b - excess / (self.steel + self.air * MU_0 * (nu + 2 * b * b * slope)), 0.0)
        raise MaterialError(f"no flux density of the steel found for {size.max():g} T: is its curve monotone?")


def stacked(law: Reluctivity, fill: float) -> Reluctivity:
    """A stack of laminations with insulation between them, as one material: B = k B_s(H) + (1 - k) mu_0 H.

    H along the sheets is the same in steel and insulation, flux runs along the sheets, as in a 2-D field.
    fill: stacking factor k, share of the steel in the length of the stack; 0.95 to 0.98 for sheets of 0.35 to 0.5 mm
    """
    if not 0 < fill <= LARGEST_FILL:
        raise MaterialError(f"a stacking factor lies between 0 and 1, found {fill:g}")
    return law if fill == 1 else MixedReluctivity(law, fill, 1 - fill, 1.0)


def hardened(law: Reluctivity, hardness: float | np.ndarray) -> Reluctivity:
    """Steel that needs k times the field for the same polarisation, J(H) = J_s(H/k), and saturates at the same one.

    B = J_s(H/k) + mu_0 H: what strain by cutting or pressing does; the saturation polarisation belongs to the alloy.
    hardness: k, dimensionless, scalar or of a shape that matches the flux densities; 1 changes nothing
    """
    if not np.all(np.asarray(hardness) > 0):
        raise MaterialError(f"a hardness is positive, found {np.min(hardness):g}")
    return MixedReluctivity(law, 1.0, hardness - 1.0, hardness)


def _check_positive(what: str, value: float) -> None:
    if not value > 0:
        raise MaterialError(f"a {what} is positive, found {value:g}")
