"""What is drawn independently, what a tolerance means, and what the standards give."""

from dataclasses import replace
from math import sqrt

import pytest

from tests.magnetostatics.reference_machine import reference_machine
from uncertainty.deviations import (
    BackIron,
    BoreRadius,
    MagnetArc,
    MagnetLength,
    OpeningDepth,
    RotorRadius,
    StatorRadius,
    TaperDepth,
)
from uncertainty.general_tolerances import fine_tolerance, international_tolerance
from units import MILLIMETRE

D = 0.02 * MILLIMETRE


def test_a_tolerance_is_uniform():
    assert BoreRadius(0.03).standard_uncertainty == pytest.approx(0.03 / sqrt(3))


@pytest.mark.parametrize("kind, gap", ((BoreRadius, D), (RotorRadius, -D), (MagnetLength, -D), (BackIron, 0.0)))
def test_the_air_gap_is_what_bore_and_rotor_leave(kind, gap):
    assert kind(D).moved(reference_machine(), D).airgap - reference_machine().airgap == pytest.approx(gap)


def test_what_stays_stays():
    drawn = reference_machine()
    bore = BoreRadius(D).moved(drawn, D)
    assert bore.rotor_outer_radius == drawn.rotor_outer_radius
    assert bore.opening_top_radius == pytest.approx(drawn.opening_top_radius), "the slots stay where they are"
    rotor, magnet = RotorRadius(D).moved(drawn, D), MagnetLength(D).moved(drawn, D)
    assert rotor.stator_inner_radius == pytest.approx(drawn.stator_inner_radius)
    assert magnet.rotor_core_radius == pytest.approx(drawn.rotor_core_radius)
    assert StatorRadius(D).moved(drawn, D).slot_bottom_radius == pytest.approx(drawn.slot_bottom_radius)
    assert OpeningDepth(D).moved(drawn, D).shoe_top_radius == pytest.approx(drawn.shoe_top_radius)
    assert TaperDepth(D).moved(drawn, D).shoe_top_radius == pytest.approx(drawn.shoe_top_radius + D)


def test_magnets_that_touch_can_only_be_narrower():
    touching, apart = reference_machine(), replace(reference_machine(), magnet_arc_fraction=0.9)
    assert MagnetArc(D).centre(apart) == apart
    middle = MagnetArc(D).centre(touching)
    assert (1 - middle.magnet_arc_fraction) * middle.pole_pitch * middle.rotor_outer_radius == pytest.approx(D)


# Width of the tolerance in micrometres, ISO 286-1 Table 1
@pytest.mark.parametrize("diameter, grade, width", ((30.1, 8, 39), (25, 7, 21), (85, 8, 54), (600, 7, 70), (8, 7, 15)))
def test_grades_of_iso_286(diameter, grade, width):
    assert international_tolerance(diameter * MILLIMETRE, grade) == pytest.approx(width * 1e-6, rel=0.05), (
        "the table rounds"
    )


@pytest.mark.parametrize("length, half", ((2.0, 0.05), (6.0, 0.05), (6.1, 0.1), (100.0, 0.15)))
def test_class_f_of_iso_2768(length, half):
    assert fine_tolerance(length * MILLIMETRE) == pytest.approx(half * MILLIMETRE)
