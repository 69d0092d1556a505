"""Cost by part: mass times price, nothing where a price is missing."""

from dataclasses import replace

import pytest

from drivetrain.costs import PartPrices, part_costs
from drivetrain.masses import PartMasses

MASSES = PartMasses(stator_laminations=2.0, rotor_laminations=1.0, magnets=0.3, shaft=0.2, copper=1.5,
                    rotor_laminations_inertia=1e-4, magnets_inertia=2e-5, shaft_inertia=1e-6)  # fmt: skip
PRICES = PartPrices("EUR", lamination=3.0, magnet=80.0, copper=12.0, shaft=2.0)


def test_mass_times_price_and_their_sum():
    *parts, whole = part_costs(MASSES, PRICES)
    costs = {"stator laminations": 6.0, "rotor laminations": 3.0, "magnets": 24.0, "shaft": 0.4}
    assert {one.part: one.cost for one in parts} == pytest.approx(costs | {"copper with end turns": 18.0})
    assert (whole.cost, whole.mass, whole.inertia) == pytest.approx((51.4, MASSES.total, MASSES.rotor_inertia))


def test_a_missing_price_is_not_guessed():
    found = {one.part: one.cost for one in part_costs(MASSES, replace(PRICES, magnet=None))}
    assert found["magnets"] is None and found["active parts"] is None and found["shaft"] == pytest.approx(0.4)
