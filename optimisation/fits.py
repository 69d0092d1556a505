"""The best cross-sections as functions of the stator radius: second-order polynomials through the optima, in SI."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from geometry.family import Combination
from optimisation.optima import Optima
from optimisation.polynomial_fits import FitRefused, PolynomialFit, fit_polynomial


@dataclass(frozen=True)
class FittedSection:
    """The best cross-section at one stator radius, see ``Optimum``; lengths in m, area in m^2.

    torque_nominal, torque_overload, torque_overload_linear: [Nm/m]
    """

    back_iron_width: float
    rotor_outer_radius: float
    half_slot_area: float
    torque_nominal: float
    torque_overload: float
    torque_overload_linear: float

    @property
    def dimensions(self) -> dict[str, float]:
        """What the machine is drawn with [m], by the names of ``MachineFamily``."""
        return {"back_iron_width": self.back_iron_width, "rotor_outer_radius": self.rotor_outer_radius}


QUANTITIES = tuple(f.name for f in fields(FittedSection))


@dataclass(frozen=True)
class CombinationFits:
    """The polynomials of one slot-pole combination over the stator radius [m], one for each of ``QUANTITIES``."""

    combination: Combination
    fits: tuple[PolynomialFit, ...]

    def of(self, quantity: str) -> PolynomialFit:
        """The polynomial of a quantity of ``FittedSection``."""
        return self.fits[QUANTITIES.index(quantity)]


@dataclass(frozen=True)
class SectionFits:
    """The polynomials of every slot-pole combination that has optima."""

    each: tuple[CombinationFits, ...]

    @property
    def combinations(self) -> tuple[Combination, ...]:
        """Those that are fitted."""
        return tuple(one.combination for one in self.each)

    @property
    def usable(self) -> tuple[Combination, ...]:
        """Those of which no fit is refused."""
        return tuple(one.combination for one in self.each if not any(fit.refused for fit in one.fits))

    def of(self, combination: Combination) -> CombinationFits:
        """The polynomials of one combination. Raises FitRefused where it has none."""
        found = next((one for one in self.each if one.combination == combination), None)
        if found is None:
            known = "; ".join(one.words for one in self.combinations)
            raise FitRefused(
                f"no optima of {combination.words} are fitted, but of {known}: add {combination.slots} to sweep.slots "
                f"and {combination.poles} to sweep.poles"
            )
        return found

    def range(self, combination: Combination) -> tuple[float, float]:
        """Smallest and largest stator radius [m] that is fitted. Raises FitRefused."""
        return self.of(combination).fits[0].x_range

    def at(self, combination: Combination, radius: float) -> FittedSection:
        """The best cross-section at a stator radius [m]. Raises FitRefused outside the range or for a refused fit."""
        return FittedSection(*(float(fit(radius)) for fit in self.of(combination).fits))


def fits_stage(optima: Optima) -> SectionFits:
    """Fit every quantity of every combination; a bad fit is kept with the reason why it is refused."""
    return SectionFits(tuple(CombinationFits(one, _fits(optima, one)) for one in optima.combinations))


def _fits(optima: Optima, combination: Combination) -> tuple[PolynomialFit, ...]:
    own = optima.of(combination)
    radii = np.array([optimum.stator_outer_radius for optimum in own])
    return tuple(
        fit_polynomial(f"{name} ({combination.words})", radii, [getattr(optimum, name) for optimum in own])
        for name in QUANTITIES
    )
