"""What a study says about prices."""

from __future__ import annotations

from drivetrain.costs import PartPrices
from study.schema import Study

_NO_PRICES = PartPrices("", None, None, None, None)


def part_prices(study: Study) -> PartPrices:
    """Prices of the materials by mass [currency/kg], as far as they are stated."""
    section = study.prices
    if section is None:
        return _NO_PRICES
    return PartPrices(section.currency, section.lamination, section.magnet, section.copper, section.shaft)
