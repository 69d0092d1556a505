"""The best cross-sections as functions of the stator radius: second-order polynomials through the optima, in SI."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

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


QUANTITIES = tuple(f.name for f in fields(FittedSection))


@dataclass(frozen=True)
class SlotFits:
    """The polynomials of one slot count over the stator radius [m], one for each of ``QUANTITIES``."""

    slots: int
    fits: tuple[PolynomialFit, ...]

    def of(self, quantity: str) -> PolynomialFit:
        """The polynomial of a quantity of ``FittedSection``."""
        return self.fits[QUANTITIES.index(quantity)]


@dataclass(frozen=True)
class SectionFits:
    """The polynomials of every slot count that has optima."""

    by_slots: tuple[SlotFits, ...]

    @property
    def slots(self) -> tuple[int, ...]:
        """Slot counts that are fitted."""
        return tuple(one.slots for one in self.by_slots)

    @property
    def usable(self) -> tuple[int, ...]:
        """Slot counts of which no fit is refused."""
        return tuple(one.slots for one in self.by_slots if not any(fit.refused for fit in one.fits))

    def of(self, slots: int) -> SlotFits:
        """The polynomials of one slot count. Raises FitRefused where it has none."""
        found = next((one for one in self.by_slots if one.slots == slots), None)
        if found is None:
            known = ", ".join(map(str, self.slots))
            raise FitRefused(f"no optima of {slots} slots are fitted, but of {known}: add {slots} to sweep.slots")
        return found

    def range(self, slots: int) -> tuple[float, float]:
        """Smallest and largest stator radius [m] that is fitted. Raises FitRefused."""
        return self.of(slots).fits[0].x_range

    def at(self, slots: int, radius: float) -> FittedSection:
        """The best cross-section at a stator radius [m]. Raises FitRefused outside the range or for a refused fit."""
        return FittedSection(*(float(fit(radius)) for fit in self.of(slots).fits))


def fits_stage(optima: Optima) -> SectionFits:
    """Fit every quantity of every slot count; a bad fit is kept with the reason why it is refused."""
    return SectionFits(tuple(SlotFits(slots, _fits(optima, slots)) for slots in optima.slots))


def _fits(optima: Optima, slots: int) -> tuple[PolynomialFit, ...]:
    own = optima.of(slots)
    radii = np.array([optimum.stator_outer_radius for optimum in own])
    return tuple(
        fit_polynomial(f"{name} ({slots} slots)", radii, [getattr(optimum, name) for optimum in own])
        for name in QUANTITIES
    )
