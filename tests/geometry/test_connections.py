"""The connection table, followed lead by lead, is the winding of the field; every coil is connected once."""

from cmath import exp
from math import pi

import pytest

from geometry.connections import connections
from geometry.winding import star_of_slots

WINDINGS = {"12/10": (12, 5), "9/8": (9, 4), "18/4": (18, 2), "single layer": (12, 5, 1),
            "pitch 2": (12, 5, 2, 2)}  # fmt: skip


@pytest.fixture(params=WINDINGS, name="layout")
def _layout(request):
    return star_of_slots(*WINDINGS[request.param])


def followed(layout, phase):
    """Coils from the terminal of a phase to the star point, by what each row says of the next."""
    rows = {one.coil: one for one in connections(layout, 1) if one.phase == phase}
    (here,) = [one for one in rows.values() if one.previous is None]
    chain = [here]
    while here.following is not None:
        assert rows[here.following].previous == here.coil
        here = rows[here.following]
        chain.append(here)
    return chain


def test_every_coil_is_passed_once(layout):
    chains = [followed(layout, phase) for phase in range(3)]
    assert sorted(one.coil for chain in chains for one in chain) == [coil.index for coil in layout.coils]
    assert {len(chain) for chain in chains} == {layout.coils_in_series}


def test_currents_in_the_slots_are_those_of_the_field(layout):
    """Down is -z, up is +z, as ``coil_side`` gives them to the field solution."""
    for phase in range(3):
        here = [0] * layout.slots
        for one in followed(layout, phase):
            here[one.from_slot] -= layout.layers % 2 + 1  # a side of a single layer fills both halves
            here[one.to_slot] += layout.layers % 2 + 1
        field = [
            sum(sign for side in "RL" for of, sign in [layout.coil_side(slot, side)] if of == phase)
            for slot in range(layout.slots)
        ]
        assert here == field


def test_phases_have_the_winding_factor_and_are_120_degrees_apart(layout):
    """Voltages of the conductors added along the current, without any use of the star of slots."""
    step = 2 * pi * layout.pole_pairs / layout.slots
    sums = [sum(exp(1j * step * one.to_slot) - exp(1j * step * one.from_slot) for one in followed(layout, phase))
            for phase in range(3)]  # fmt: skip
    factor = layout.winding_factor()
    for one in sums:
        assert abs(one) / (2 * layout.coils_in_series) == pytest.approx(factor, rel=1e-12)
    assert sums[1] / sums[0] == pytest.approx(exp(2j * pi / 3), rel=1e-12)
    assert sums[2] / sums[1] == pytest.approx(exp(2j * pi / 3), rel=1e-12)


def test_teeth_lie_between_the_sides(layout):
    for one in connections(layout, 1):
        assert len(one.teeth) == layout.coil_pitch
        low = one.to_slot if one.reversed else one.from_slot
        assert one.teeth[0] == (low + 1) % layout.slots
    if layout.coil_pitch == 1:
        assert all(one.teeth == (one.coil,) for one in connections(layout, 1))
