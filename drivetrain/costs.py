"""What the material of the active parts costs, as far as a study states prices; none is assumed."""

from __future__ import annotations

from dataclasses import dataclass

from drivetrain.masses import PartMasses


@dataclass(frozen=True)
class PartPrices:
    """Prices of the materials in the study's currency, None where the study states none.

    currency: as it is to be printed
    lamination, magnet, copper, shaft: price for each mass [currency/kg]
    """

    currency: str
    lamination: float | None
    magnet: float | None
    copper: float | None
    shaft: float | None


@dataclass(frozen=True)
class PartCost:
    """One part: mass [kg], inertia about the axis [kg m^2], cost of its material [currency], None without a price."""

    part: str
    mass: float
    inertia: float
    cost: float | None


def part_costs(masses: PartMasses, prices: PartPrices) -> tuple[PartCost, ...]:
    """Cost of the material that is in each part, mass times price, and the sum; no waste, no tools and no work.

    The sum is None unless every part has a price.
    """
    stator, copper, rotor, magnets, shaft, whole = masses.rows
    priced = ((stator, prices.lamination), (copper, prices.copper), (rotor, prices.lamination),
              (magnets, prices.magnet), (shaft, prices.shaft))  # fmt: skip
    rows = tuple(
        PartCost(name, mass, inertia, None if price is None else mass * price)
        for (name, mass, inertia), price in priced
    )
    known = [one.cost for one in rows if one.cost is not None]
    return (*rows, PartCost(*whole, sum(known) if len(known) == len(rows) else None))
