"""End turns and phase resistance of the 85 mm, 12-slot machine: derivation and printed numbers."""

from math import asin, log, pi

import pytest

from electrical.end_turn import CoilSeat, Lap, ToothCoil, Wave, coil_seat, usual_end_turn
from electrical.resistance import (
    COPPER_RESISTIVITY_20,
    copper_resistivity,
    phase_resistance,
    phase_resistance_of_filled_slot,
)
from study.machine_file import read_machine
from units import MILLIMETRE, MILLIOHM, MU_0, SQUARE_MILLIMETRE

SLOT = dict(
    slots=12,
    pole_pairs=1,
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


def tooth_coil(**changes):
    return ToothCoil().length(CoilSeat(**TOOTH_COIL | changes))


def test_end_turn_keeps_the_shoe():
    assert tooth_coil() == pytest.approx(16.30 * MILLIMETRE, abs=0.01 * MILLIMETRE)


def test_end_turn_without_the_shoe_is_the_printed_equation():
    bare = tooth_coil(slot_inner_radius=(15.7 + 0.5) * MILLIMETRE)
    assert bare == pytest.approx(15.72 * MILLIMETRE, abs=0.01 * MILLIMETRE)


def test_a_lap_coil_round_one_tooth_would_be_a_tooth_coil_and_grows_by_its_overlength():
    """45.8 mm of arc over three slots at mid slot, of which two are longer by the factor of the quoted source."""
    bend, arc = tooth_coil(), 2 * pi * (SLOT["slot_inner_radius"] + SLOT["slot_outer_radius"]) / 2 / 4
    lap = Lap().length(CoilSeat(**SLOT, coil_pitch=3))
    assert lap == pytest.approx(bend + 1.8 * arc * 2 / 3, rel=1e-14)
    assert Lap(1.0).length(CoilSeat(**SLOT, coil_pitch=3)) == pytest.approx(bend + arc * 2 / 3, rel=1e-14)


@pytest.mark.physics
def test_the_measured_resistance_of_the_prius():
    """0.069 ohm of a phase at 21 degC, 72 turns of 13 wires of 0.912 mm in series, 83.82 mm of stack (ORNL/TM-2004/247
    as given beside its drawing); half circles over the pitch would leave 12.6 % out, the estimate 8.5 %."""
    read = read_machine("prius_2004")
    seat = coil_seat(read.machine, 6)
    wires = dict(turns=4.5, coils_in_series=16, strands=13, wire_area=pi / 4 * 0.912**2 * SQUARE_MILLIMETRE,
                 active_length=83.82 * MILLIMETRE, resistivity=1.7241e-8 * (1 + 0.00393))  # fmt: skip
    found = phase_resistance(**wires, end_turn_length=read.end_turn.length(seat))
    assert found / 0.069 - 1 == pytest.approx(-0.085, abs=0.005)
    assert phase_resistance(**wires, end_turn_length=pi / 2 * seat.span) / 0.069 - 1 == pytest.approx(-0.126, abs=0.005)
    assert phase_resistance(**wires, end_turn_length=Lap(2.11).length(seat)) == pytest.approx(0.069, rel=2e-3)


@pytest.mark.parametrize(("name", "pitch", "low", "high"), (("prius_2004", 6, 0.2, 0.3), ("synrm_48_4", 11, 0.2, 0.3)))
def test_the_leakage_of_lap_coils_lies_where_that_of_built_machines_does(name, pitch, low, high):
    """Vogt, Berechnung elektrischer Maschinen: L = 2 mu_0 N^2/p lambda l_et, lambda 0.2 to 0.3 for two layers."""
    read = read_machine(name)
    seat, n = coil_seat(read.machine, pitch), 7.0 * read.layout.coils_in_series
    found = Lap().inductance(seat, 7.0, read.layout.coils_in_series, 1e-6)
    share = found / (2 * MU_0 * n**2 / read.machine.pole_pairs * Lap().length(seat))
    assert low < share < high


def test_one_layer_leaks_more_than_two():
    two, one = (CoilSeat(**SLOT, coil_pitch=5, layers=layers) for layers in (2, 1))
    assert Lap().inductance(one, 10, 4, 1e-6) > 1.5 * Lap().inductance(two, 10, 4, 1e-6)


def test_tooth_coils_leak_like_rings_in_air():
    """Both half circles of a coil are a ring of 10.4 mm across; Rosa and Grover's ring by numbers."""
    radius, bundle = tooth_coil() / pi, (50 * SQUARE_MILLIMETRE / pi) ** 0.5
    ring = MU_0 * radius * (log(8 * radius / bundle) - 1.75)
    found = ToothCoil().inductance(CoilSeat(**TOOTH_COIL), 7.0, 4, 50 * SQUARE_MILLIMETRE)
    assert found == pytest.approx(4 * 49 * ring, rel=1e-12)


def test_a_full_pitched_wave_is_as_long_as_a_lap():
    seat = CoilSeat(**SLOT, coil_pitch=6)
    assert Wave().length(seat) == Lap().length(seat)
    assert Wave().inductance(seat, 4, 4, 1e-6) == Lap().inductance(seat, 4, 4, 1e-6)


@pytest.mark.parametrize(
    ("kind", "pitch", "words"),
    (
        (ToothCoil(), 3, "spans one slot pitch, found 3"),
        (Lap(), 1, 'take "tooth_coil"'),
        (Lap(0.9), 3, "no shorter than its arc"),
        (Wave(), 5, "different spans at both ends"),
        (Lap(), 7, "longer than a pole of 6"),
    ),
)
def test_a_kind_refuses_what_it_does_not_know(kind, pitch, words):
    with pytest.raises(ValueError, match=words):
        kind.inductance(CoilSeat(**SLOT, coil_pitch=pitch), 1, 4, 1e-6)


def test_the_usual_kind_follows_from_the_pitch():
    assert (usual_end_turn(1), usual_end_turn(5)) == (ToothCoil(), Lap())


def test_a_coil_without_pitch_is_refused():
    with pytest.raises(ValueError, match="one slot pitch or more"):
        CoilSeat(**SLOT, coil_pitch=0)


def test_centre_distance_spans_the_tooth_and_half_a_slot():
    mean = (SLOT["slot_inner_radius"] + SLOT["slot_outer_radius"]) / 2
    tooth_angle = 2 * asin(SLOT["tooth_width"] / (2 * mean))
    slot_angle = 2 * pi / 12 - tooth_angle
    assert CoilSeat(**TOOTH_COIL).tooth_coil_distance == pytest.approx(mean * (tooth_angle + slot_angle / 2), rel=1e-14)


def test_a_slot_without_depth_is_refused():
    with pytest.raises(ValueError, match="no depth"):
        tooth_coil(slot_outer_radius=19 * MILLIMETRE)


@pytest.mark.parametrize("tooth_width", [0.0, 20 * MILLIMETRE])
def test_a_tooth_that_does_not_fit_is_refused(tooth_width):
    with pytest.raises(ValueError, match="tooth width"):
        tooth_coil(tooth_width=tooth_width)


def test_phase_to_phase_resistance_of_the_printed_winding():
    resistance = phase_resistance(**PRINTED_WINDING, end_turn_length=tooth_coil())
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
    resistance = phase_resistance(**warm, end_turn_length=tooth_coil())
    assert 2 * resistance == pytest.approx(27.4e-3, rel=0.01)


def test_copper_resistivity():
    assert copper_resistivity() == 1.68e-8
    assert copper_resistivity(120.0) == pytest.approx(1.68e-8 * 1.393, rel=1e-12)


def test_copper_far_outside_the_linear_law_is_refused():
    with pytest.raises(ValueError, match="between -100 and 250"):
        copper_resistivity(400.0)
