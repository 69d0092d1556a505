"""End turns and phase resistance of the 85 mm, 12-slot machine: derivation and printed numbers."""

from math import asin, pi

import pytest

from electrical.end_turn import end_turn_length, slot_centre_distance
from electrical.resistance import (
    COPPER_RESISTIVITY_20,
    copper_resistivity,
    phase_resistance,
    phase_resistance_of_filled_slot,
)
from units import MILLIMETRE, MILLIOHM, SQUARE_MILLIMETRE

SLOT = dict(
    slots=12,
    slot_inner_radius=(15.7 + 0.5 + 2 * 1.43) * MILLIMETRE,
    slot_outer_radius=(42.5 - 3.3) * MILLIMETRE,
    tooth_width=5.5 * MILLIMETRE,
)
TOOTH_COIL = SLOT | {"coil_pitch": 1}
WIRE_AREA = pi * 0.25**2 * SQUARE_MILLIMETRE
PRINTED_WINDING = dict(
    turns=7,
    strands=22,
    wire_area=WIRE_AREA,
    active_length=41 * MILLIMETRE,
    coils_in_series=4,
    resistivity=COPPER_RESISTIVITY_20,
)


def test_end_turn_keeps_the_shoe():
    assert end_turn_length(**TOOTH_COIL) == pytest.approx(16.30 * MILLIMETRE, abs=0.01 * MILLIMETRE)


def test_end_turn_without_the_shoe_is_the_printed_equation():
    bare = TOOTH_COIL | {"slot_inner_radius": (15.7 + 0.5) * MILLIMETRE}
    assert end_turn_length(**bare) == pytest.approx(15.72 * MILLIMETRE, abs=0.01 * MILLIMETRE)


@pytest.mark.physics
def test_a_distributed_coil_has_the_end_turn_over_its_slots():
    """Two poles in 12 slots: a pitch of three is a quarter of the circumference at mid slot, 45.8 mm, and half a circle
    over it 71.9 mm, where a tooth coil has 16.3 mm."""
    quarter = 2 * pi * (SLOT["slot_inner_radius"] + SLOT["slot_outer_radius"]) / 2 / 4
    assert end_turn_length(**SLOT, coil_pitch=3) == pytest.approx(pi / 2 * quarter, rel=1e-14)
    assert end_turn_length(**SLOT, coil_pitch=3) == pytest.approx(71.9 * MILLIMETRE, abs=0.1 * MILLIMETRE)


def test_the_end_turn_of_a_distributed_coil_grows_with_its_pitch():
    one, two, three = (end_turn_length(**SLOT, coil_pitch=pitch) for pitch in (1, 2, 3))
    assert one < two < three
    assert three - two == pytest.approx(two / 2, rel=1e-14)


def test_a_coil_without_pitch_is_refused():
    with pytest.raises(ValueError, match="one slot pitch or more"):
        end_turn_length(**SLOT, coil_pitch=0)


def test_centre_distance_spans_the_tooth_and_half_a_slot():
    mean = (SLOT["slot_inner_radius"] + SLOT["slot_outer_radius"]) / 2
    tooth_angle = 2 * asin(SLOT["tooth_width"] / (2 * mean))
    slot_angle = 2 * pi / 12 - tooth_angle
    assert slot_centre_distance(**SLOT) == pytest.approx(mean * (tooth_angle + slot_angle / 2), rel=1e-14)


def test_a_slot_without_depth_is_refused():
    with pytest.raises(ValueError, match="no depth"):
        end_turn_length(**TOOTH_COIL | {"slot_outer_radius": 19 * MILLIMETRE})


@pytest.mark.parametrize("tooth_width", [0.0, 20 * MILLIMETRE])
def test_a_tooth_that_does_not_fit_is_refused(tooth_width):
    with pytest.raises(ValueError, match="tooth width"):
        end_turn_length(**TOOTH_COIL | {"tooth_width": tooth_width})


def test_phase_to_phase_resistance_of_the_printed_winding():
    resistance = phase_resistance(**PRINTED_WINDING, end_turn_length=end_turn_length(**TOOTH_COIL))
    assert 2 * resistance == pytest.approx(25.0 * MILLIOHM, abs=0.2 * MILLIOHM)


def test_resistance_is_that_of_one_long_wire():
    end_turn = 16 * MILLIMETRE
    wire_length = 4 * 7 * 2 * (41 * MILLIMETRE + end_turn)
    expected = COPPER_RESISTIVITY_20 * wire_length / (22 * WIRE_AREA)
    assert phase_resistance(**PRINTED_WINDING, end_turn_length=end_turn) == pytest.approx(expected, rel=1e-14)


def test_both_forms_of_the_resistance_agree_with_a_single_resistivity():
    area = 100 * SQUARE_MILLIMETRE
    filled = phase_resistance_of_filled_slot(
        turns=7,
        packing=7 * 22 * WIRE_AREA / area,
        half_slot_area=area,
        active_length=41 * MILLIMETRE,
        end_turn_length=16 * MILLIMETRE,
        coils_in_series=4,
        resistivity=COPPER_RESISTIVITY_20,
    )
    assert filled == pytest.approx(phase_resistance(**PRINTED_WINDING, end_turn_length=16 * MILLIMETRE), rel=1e-14)


def test_warm_copper_closes_the_gap_to_the_printed_resistance():
    warm = PRINTED_WINDING | {"resistivity": copper_resistivity(45.0)}
    resistance = phase_resistance(**warm, end_turn_length=end_turn_length(**TOOTH_COIL))
    assert 2 * resistance == pytest.approx(27.4e-3, rel=0.01)


def test_copper_resistivity():
    assert copper_resistivity() == 1.68e-8
    assert copper_resistivity(120.0) == pytest.approx(1.68e-8 * 1.393, rel=1e-12)


def test_copper_far_outside_the_linear_law_is_refused():
    with pytest.raises(ValueError, match="between -100 and 250"):
        copper_resistivity(400.0)
