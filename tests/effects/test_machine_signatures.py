"""What effects of a machine claim to do to the readings of its bench, held against the surrogate of the machine."""

from __future__ import annotations

from fnmatch import fnmatch

import numpy as np
import pytest

from effects.base import DesignEffect
from effects.library import package_effects
from effects.signature import NOTHING, names
from tests.effects.contract import SMALL, first, sized, vanishing
from tests.effects.machine_bench import TURN, machine_bench_case
from tests.workbench.models.machine_case import drawn

OWN = {
    name: cls
    for name, cls in package_effects().items()
    if cls.__module__.startswith("effects.machine.") and cls.can_act_on(drawn())
}
SLOTS, POLES, NATIVE = 12, 10, 60


@pytest.mark.parametrize("name", OWN)
def test_readings_change_where_an_effect_claims_it_and_nowhere_else(name):
    case, cls = machine_bench_case(), OWN[name]
    base, effect = case.places(), sized(first(cls, case))
    seen, small = case.places(effect), case.places(vanishing(effect, SMALL))
    for place, readings in base.items():
        scale = max(np.abs(readings).max(), np.abs(seen[place]).max())
        touched = np.abs(seen[place] - readings).max() > NOTHING * scale
        assert touched == names(cls.signature, place), f"{place} changes: {touched}, claimed otherwise"
        for claim in (c for c in cls.signature if fnmatch(place, c.place)):
            error = claim.error(case.conditions(place), small[place] - base[place])
            assert error <= claim.within, f"{claim} at {place} is off by {error:.3g}"


def orders_of(cls) -> set[int]:
    """Mechanical orders above a hundredth of the largest in what an effect adds to the cogging."""
    case = machine_bench_case()
    change = case.places(sized(first(cls, case)))["cogging.torque"] - case.places()["cogging.torque"]
    amplitude = np.abs(np.fft.rfft(change))[1 : len(TURN) // 2]
    return set((np.flatnonzero(amplitude > 0.01 * amplitude.max()) + 1).tolist())


@pytest.mark.parametrize(
    "name, base",
    (
        ("weak_magnet", SLOTS),
        ("magnet_position", SLOTS),
        ("magnet_strength_scatter", SLOTS),
        ("magnet_position_scatter", SLOTS),
        ("rotor_ovality", SLOTS),
        ("dynamic_eccentricity", SLOTS),
        ("wide_slot", POLES),
        ("slot_opening_scatter", POLES),
        ("static_eccentricity", POLES),
        ("magnet_grinding", NATIVE),
        ("bore_grinding", NATIVE),
        ("glue_gap", NATIVE),
        ("knee_demagnetisation", NATIVE),
        ("stepped_skew", NATIVE),
        ("press_fit_stress", NATIVE),
        ("steel_grade", NATIVE),
    ),
)
def test_orders_that_an_effect_adds_to_the_cogging(name, base):
    """A difference between magnets makes multiples of the slots, one between teeth of the poles, none the native."""
    found = orders_of(OWN[name])
    assert found and all(order % base == 0 for order in found)


def test_all_effects_of_the_field_are_held_against_it():
    field = [name for name, cls in OWN.items() if issubclass(cls, DesignEffect)]
    assert len(field) == len(OWN) >= 30
