"""The star of slots against printed windings, textbook winding factors and a current sheet summed side by side."""

from cmath import exp, phase
from math import pi, radians

import pytest

from geometry.errors import GeometryError
from geometry.winding import LEFT, RIGHT, WindingLayout, _layout, is_feasible, sector_symmetric, star_of_slots

COMBINATIONS = [
    (12, 5, 2), (12, 5, 1), (9, 5, 2), (9, 4, 2), (12, 4, 2), (12, 4, 1), (3, 1, 2), (3, 2, 2), (24, 2, 2), (24, 2, 1),
    (36, 3, 2), (12, 7, 2), (15, 4, 2), (27, 12, 2), (24, 11, 1), (18, 7, 2), (12, 2, 1), (30, 14, 1), (9, 3, 2),
]  # fmt: skip


def names(layout, phase_index):
    return {f"{'+' if coil.sign > 0 else '-'}{coil.index}" for coil in layout.coils_of(phase_index)}


def current_sheet(layout, phase_index, order=1):
    """Sum over the coil sides, at the slot centres, of direction times exp(j order p theta)."""
    total = 0
    for slot in range(layout.slots):
        for side in (RIGHT, LEFT):
            owner, direction = layout.coil_side(slot, side)
            if owner == phase_index:
                total += direction * exp(1j * order * layout.pole_pairs * (slot + 0.5) * 2 * pi / layout.slots)
    return total


def test_the_12_slot_10_pole_winding_of_the_field_model():
    layout = star_of_slots(12, 5)
    assert names(layout, 0) == {"+0", "-1", "-6", "+7"}
    assert names(layout, 1) == {"+8", "-9", "-2", "+3"}
    assert names(layout, 2) == {"+4", "-5", "-10", "+11"}
    assert layout.coils_in_series == 4
    assert layout.phase_axis == pytest.approx(radians(-15), rel=1e-14)


def test_the_9_slot_10_pole_winding():
    layout = star_of_slots(9, 5)
    assert names(layout, 0) == {"+0", "-1", "-8"}
    assert layout.coils_in_series == 3
    assert layout.phase_axis == 0


def test_coil_on_tooth_k_makes_outward_flux():
    """+z in (slot k, R), the counter-clockwise side of tooth k, and -z in (slot k-1, L)."""
    coil = star_of_slots(12, 5).coils[0]
    assert (coil.go, coil.back) == ((0, "R"), (11, "L"))
    layout = star_of_slots(12, 5)
    assert layout.coil_side(0, "R") == (0, 1) and layout.coil_side(11, "L") == (0, -1)
    assert layout.coil_side(0, "L") == (0, 1) and layout.coil_side(1, "R") == (0, -1)  # coil 1 is -A
    assert layout.coil_side(12, "R") == layout.coil_side(0, "R")


def test_half_open_sectors_at_their_edges():
    """24/4 with pitch 5: axes at 30 k - 60 degrees, every second one exactly on an edge of two sectors."""
    layout = star_of_slots(24, 2, coil_pitch=5)
    assert names(layout, 0) == {"+1", "+2", "-7", "-8", "+13", "+14", "-19", "-20"}  # -30 and 0 in, 30 out
    assert "-3" in names(layout, 2)
    assert layout.phase_axis == pytest.approx(radians(-15), rel=1e-14)


@pytest.mark.parametrize(
    ("slots", "poles", "layers", "factor"),
    [
        (12, 10, 2, 0.933), (12, 10, 1, 0.966), (12, 14, 2, 0.933), (12, 14, 1, 0.966), (24, 20, 2, 0.933),
        (9, 10, 2, 0.945), (9, 8, 2, 0.945), (18, 16, 2, 0.945), (27, 24, 2, 0.945),
        (12, 8, 2, 0.866), (3, 2, 2, 0.866), (6, 4, 2, 0.866), (9, 6, 2, 0.866), (9, 12, 2, 0.866),
        (15, 14, 2, 0.951), (18, 14, 2, 0.902), (24, 22, 2, 0.949), (24, 22, 1, 0.958),
        (24, 4, 2, 0.966), (36, 6, 2, 0.966), (36, 4, 2, 0.960), (12, 4, 1, 1.000), (24, 4, 1, 0.966),
    ],
)  # fmt: skip
def test_textbook_winding_factors(slots, poles, layers, factor):
    """Tables of fractional-slot windings (Bianchi and others) and q = 1, 2, 3 full-pitch distributed windings."""
    assert star_of_slots(slots, poles // 2, layers).winding_factor() == pytest.approx(factor, abs=6e-4)


def test_harmonic_winding_factors():
    """q = 2, full pitch: third 0.707, fifth 0.259, seventh 0.259; chorded by one slot: fifth 0.067."""
    full, chorded = star_of_slots(24, 2, coil_pitch=6), star_of_slots(24, 2, coil_pitch=5)
    assert [round(full.winding_factor(nu), 3) for nu in (1, 3, 5, 7)] == [0.966, 0.707, 0.259, 0.259]
    assert [round(chorded.winding_factor(nu), 3) for nu in (1, 5, 7)] == [0.933, 0.067, 0.067]


@pytest.mark.parametrize(("slots", "pole_pairs", "layers"), COMBINATIONS)
def test_winding_factor_and_axis_from_the_current_sheet(slots, pole_pairs, layers):
    """Current in +z a quarter turn ahead makes outward flux: the axis is the sheet's angle less 90 degrees."""
    layout = star_of_slots(slots, pole_pairs, layers)
    sides = 2 * slots // 3
    for order in (1, 5, 7, 1 / pole_pairs):
        assert layout.winding_factor(order) == pytest.approx(abs(current_sheet(layout, 0, order)) / sides, abs=1e-12)
    axis = current_sheet(layout, 0) * exp(-1j * (pi / 2 + layout.phase_axis))
    assert phase(axis) == pytest.approx(0.0, abs=1e-12)


def test_every_feasible_winding_is_balanced_and_every_other_is_not():
    """Up to 36 slots and 32 poles, both layers: equal counts and sums 120 degrees apart exactly when feasible."""
    for slots in range(3, 37):
        for pole_pairs in range(1, 17):
            for layers in (1, 2) if slots % 2 == 0 else (2,):
                assert is_feasible(slots, pole_pairs, layers) == balanced(slots, pole_pairs, layers)


def balanced(slots, pole_pairs, layers):
    layout = _layout(slots, pole_pairs, layers, coil_pitch=1)
    counts = {len(layout.coils_of(i)) for i in range(3)}
    a, b, c = (current_sheet(layout, i) for i in range(3))
    third = exp(2j * pi / 3)
    return len(counts) == 1 and abs(a) > 1e-6 and abs(a * third - b) < 1e-9 and abs(b * third - c) < 1e-9


@pytest.mark.parametrize(("slots", "pole_pairs", "layers"), COMBINATIONS)
def test_every_half_slot_carries_exactly_one_coil_side(slots, pole_pairs, layers):
    layout = star_of_slots(slots, pole_pairs, layers)
    halves = [(slot, half) for coil in layout.coils for slot, sides in (coil.go, coil.back) for half in sides]
    assert len(halves) == len(set(halves)) == 2 * slots
    directions = [layout.coil_side(*half)[1] for half in halves]
    assert sum(directions) == 0


def test_single_layer_fills_a_slot_with_one_coil_side():
    layout = star_of_slots(12, 5, layers=1)
    assert [coil.index for coil in layout.coils] == [0, 2, 4, 6, 8, 10]
    assert layout.coils_in_series == 2
    assert all(layout.coil_side(slot, "R") == layout.coil_side(slot, "L") for slot in range(12))


def test_default_pitch_takes_the_larger_winding_factor():
    """15/8 has 1.9 slots to the pole: two slots of pitch. 12/8 has 1.5, and the shorter of two equals is taken."""
    assert star_of_slots(15, 4).coil_pitch == 2
    assert star_of_slots(12, 4).coil_pitch == 1
    assert star_of_slots(12, 7).coil_pitch == 1


@pytest.mark.parametrize(
    ("slots", "pole_pairs", "layers", "pitch", "words"),
    [
        (10, 4, 2, None, "10 coils do not divide into three phases; take 9 or 12 slots"),
        (12, 6, 2, None, "only 2 electrical directions.*take 9 or 18 slots"),
        (12, 3, 2, None, "only 4 electrical directions"),
        (9, 5, 1, None, "even number of slots; take 6 or 12 slots"),
        (12, 5, 1, 2, "odd coil pitch, found 2"),
        (24, 4, 2, 6, "spans whole pole pairs and links no flux; .*coil pitch"),
        (2, 1, 2, None, "3 slots"),
        (12, 0, 2, None, "pole pair"),
        (12, 5, 3, None, "one or two layers, found 3"),
        (12, 5, 2, 12, "between 1 and 11 slots"),
    ],
)
def test_impossible_windings_say_why(slots, pole_pairs, layers, pitch, words):
    with pytest.raises(GeometryError, match=words):
        star_of_slots(slots, pole_pairs, layers, pitch)


def test_unknown_side_is_refused():
    with pytest.raises(GeometryError, match="'R' and 'L'"):
        star_of_slots(12, 5).coil_side(0, "l")


def test_sector_symmetry():
    twelve_ten, nine_ten, twelve_eight = star_of_slots(12, 5), star_of_slots(9, 5), star_of_slots(12, 4)
    assert sector_symmetric(twelve_ten, 2, antiperiodic=True)
    assert not sector_symmetric(twelve_ten, 2, antiperiodic=False)
    assert sector_symmetric(nine_ten, 1, antiperiodic=False)
    assert not sector_symmetric(nine_ten, 1, antiperiodic=True)
    assert sector_symmetric(twelve_eight, 4, antiperiodic=False)
    assert not sector_symmetric(twelve_ten, 5, antiperiodic=True)
    assert not sector_symmetric(nine_ten, 3, antiperiodic=False)
    assert not sector_symmetric(star_of_slots(24, 8), 7, antiperiodic=False)  # 24 slots do not divide by 7


def test_layout_is_a_value():
    assert star_of_slots(12, 5) == star_of_slots(12, 5)
    assert isinstance(hash(star_of_slots(12, 5)), int)
    assert WindingLayout.phases == 3
