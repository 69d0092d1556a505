"""Null position, aligned teeth and the reading of the saturation limit."""

from math import gcd, pi

import pytest

from geometry.winding import star_of_slots
from magnetostatics.positions import aligned_teeth, null_angle, null_current_angle, q_axis_angle
from optimisation.states import READINGS
from study.inputs_field import machine_family
from study.read import read_study
from tests.optimisation.machines import machine_of

DEGREE = pi / 180
FAMILY = machine_family(read_study("motorcycle").machine)


def machine(slots):
    return machine_of(FAMILY, slots, 42.5e-3, 3.3e-3, 15.7e-3)


def test_null_position_of_12_slots_and_10_poles():
    m, layout = machine(12), star_of_slots(12, 5)
    assert q_axis_angle(m, layout) / DEGREE == pytest.approx(-21)
    assert null_angle(m, layout) / DEGREE == pytest.approx(-24)
    assert null_current_angle(m, layout) / DEGREE == pytest.approx(15)


@pytest.mark.parametrize("slots", (9, 12, 15, 24))
def test_a_magnet_stands_on_a_tooth_in_the_null_position(slots):
    m, layout = machine(slots), star_of_slots(slots, 5)
    teeth = aligned_teeth(m, null_angle(m, layout))
    assert len(teeth) == gcd(slots, 10)
    assert not aligned_teeth(m, null_angle(m, layout) + 0.4 * 2 * pi / (slots * 10))


@pytest.mark.parametrize("slots", (9, 12))
def test_phase_a_has_its_peak_in_the_null_position(slots):
    m, layout = machine(slots), star_of_slots(slots, 5)
    (point,) = READINGS["aligned_tooth"].states(m, layout, 1.0, 0.3)
    assert point.phase_densities(5, layout.phase_axis) == pytest.approx([1.0, -0.5, -0.5])


def test_the_readings_limit_different_flux_densities():
    values = {name: reading.limited(1.0, 2.0, 3.0) for name, reading in READINGS.items()}
    assert values == {"aligned_tooth": 1.0, "every_tooth": 2.0, "every_tooth_and_back_iron_over_period": 3.0}
