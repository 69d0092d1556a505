"""The best cross-sections as functions of the stator radius: second-order polynomials through the optima, in SI."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from geometry.family import Combination
from geometry.variables import Variable
from optimisation.optima import Optima
from optimisation.polynomial_fits import FitRefused, PolynomialFit, fit_polynomial


@dataclass(frozen=True)
class FittedSection:
    """The best cross-section at one stator radius, see ``Optimum``; lengths in m, area in m^2.

    torque_nominal, torque_overload, torque_overload_linear: [Nm/m]
    further: what the optima chose beside back iron and rotor radius: names of ``MachineFamily`` and values [m or 1]
    """

    back_iron_width: float
    rotor_outer_radius: float
    half_slot_area: float
    torque_nominal: float
    torque_overload: float
    torque_overload_linear: float
    further: tuple[tuple[str, float], ...] = ()

    @property
    def dimensions(self) -> dict[str, float]:
        """What the machine is drawn with [m or 1], by the names of ``MachineFamily``."""
        swept = {"back_iron_width": self.back_iron_width, "rotor_outer_radius": self.rotor_outer_radius}
        return swept | dict(self.further)


QUANTITIES = tuple(f.name for f in fields(FittedSection) if f.name != "further")


@dataclass(frozen=True)
class VariableFit:
    """The polynomial of a dimension that the optima chose, held within its bounds."""

    variable: Variable
    fit: PolynomialFit

    def __call__(self, radius: float) -> float:
        """Its value [m or 1] at a stator radius [m]. Raises FitRefused."""
        return self.variable.inside(float(self.fit(radius)))


@dataclass(frozen=True)
class CombinationFits:
    """The polynomials of one slot-pole combination over the stator radius [m], one for each of ``QUANTITIES``.

    further: of what the optima chose beside back iron and rotor radius
    """

    combination: Combination
    fits: tuple[PolynomialFit, ...]
    further: tuple[VariableFit, ...] = ()

    @property
    def every(self) -> tuple[PolynomialFit, ...]:
        """All polynomials."""
        return (*self.fits, *(one.fit for one in self.further))

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
        return tuple(one.combination for one in self.each if not any(fit.refused for fit in one.every))

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
        own = self.of(combination)
        further = tuple((one.variable.name, one(radius)) for one in own.further)
        values = {name: float(fit(radius)) for name, fit in zip(QUANTITIES, own.fits, strict=True)}
        return FittedSection(**values, further=further)


def fits_stage(optima: Optima) -> SectionFits:
    """Fit every quantity of every combination; a bad fit is kept with the reason why it is refused."""
    return SectionFits(
        tuple(CombinationFits(one, _fits(optima, one), _further(optima, one)) for one in optima.combinations)
    )


def _further(optima: Optima, combination: Combination) -> tuple[VariableFit, ...]:
    own = optima.of(combination)
    radii = np.array([optimum.stator_outer_radius for optimum in own])
    columns = zip(optima.freedom.further, zip(*(optimum.further for optimum in own)))
    return tuple(
        VariableFit(variable, fit_polynomial(f"{variable.name} ({combination.words})", radii, np.array(values)))
        for variable, values in columns
    )


def _fits(optima: Optima, combination: Combination) -> tuple[PolynomialFit, ...]:
    own = optima.of(combination)
    radii = np.array([optimum.stator_outer_radius for optimum in own])
    return tuple(
        fit_polynomial(f"{name} ({combination.words})", radii, [getattr(optimum, name) for optimum in own])
        for name in QUANTITIES
    )
