"""Length curves of the constraints and the sentences of their violations."""

from dataclasses import replace
from math import inf

import numpy as np
import pytest

from drivetrain.constraints import (
    LengthLimit,
    NominalForce,
    OverloadForce,
    PlanetClearance,
    SpeedLimit,
    largest_stage_ratio,
)
from drivetrain.match import bound_constraints, damping_constraint, force_constraints, linear_overload
from drivetrain.output import Shaft, Wheel
from electrical.short_circuit import winding_damping
from units import MILLIMETRE

RATIO = 2.3 * MILLIMETRE
LENGTH = 36 * MILLIMETRE


@pytest.fixture
def damping(thesis):
    return damping_constraint(thesis.section, thesis.requirements, thesis.loading)


def test_lengths_at_the_printed_ratio(thesis, damping):
    nominal, overload = force_constraints(thesis.section, thesis.requirements)
    assert nominal.minimum_length(RATIO) == pytest.approx(13.8 * MILLIMETRE, rel=1e-9)
    assert overload.minimum_length(RATIO) == pytest.approx(36.1 * MILLIMETRE, abs=0.05 * MILLIMETRE)
    assert damping.minimum_length(RATIO) == pytest.approx(48.4 * MILLIMETRE, abs=0.1 * MILLIMETRE)


def test_damping_coefficient_of_the_thesis(damping):
    assert damping.alpha == pytest.approx(5.85, abs=0.01)
    assert damping.end_turn_length == pytest.approx(16.3 * MILLIMETRE, abs=0.05 * MILLIMETRE)


def test_damping_at_the_printed_optimum_is_not_the_required_one(damping):
    assert damping.capability(RATIO, LENGTH) == pytest.approx(27e3, abs=1e3)
    sentence = damping.violation(RATIO, LENGTH).words(Wheel())
    assert "regenerative damping 27.4 kNs/m is 12.6 kNs/m below the requirement of 40 kNs/m" in sentence
    assert "would need 48.4 mm" in sentence and "1.46 times" in sentence


@pytest.mark.parametrize("ratio", np.array([1.3, 2.3, 4.0]) * MILLIMETRE)
def test_minimum_length_gives_exactly_the_requirement(thesis, damping, ratio):
    for constraint, needed in (
        (damping, 40e3),
        *zip(force_constraints(thesis.section, thesis.requirements), (300.0, 2614.0)),
    ):
        length = constraint.minimum_length(ratio)
        assert constraint.capability(ratio, length) == pytest.approx(needed, rel=1e-12)
        assert constraint.violation(ratio, length) is None
        assert constraint.violation(ratio, 0.99 * length) is not None


def test_damping_curve_equals_the_machine_it_stands_for(thesis, damping):
    """Eq. 3.92 against eqs 3.75-3.82 of a machine with explicit turns."""
    turns, copper = 7, 0.3 * thesis.section.coil_side_area
    current = np.sqrt(2) * 6e6 * copper / turns
    torque_constant = 50.0 * LENGTH / current
    resistance = 2 * (LENGTH + damping.end_turn_length) * thesis.loading.resistivity * 4 * turns**2 / copper
    wound = winding_damping(torque_constant=torque_constant, phase_resistance=resistance, transmission_ratio=RATIO)
    assert wound == pytest.approx(damping.capability(RATIO, LENGTH), rel=1e-12)


@pytest.mark.parametrize("ratio, expected", [(2.3, 22.2e3), (2.21, 24.0e3)])
def test_damping_of_the_final_machine(ratio, expected):
    found = winding_damping(
        torque_constant=49.1e-3, phase_resistance=27.4e-3 / 2, transmission_ratio=ratio * MILLIMETRE
    )
    assert found == pytest.approx(expected, rel=0.005)


def test_curves_take_arrays(thesis, damping):
    ratio = np.linspace(1.3, 4, 5) * MILLIMETRE
    constraints = (damping, *force_constraints(thesis.section, thesis.requirements))
    for constraint in constraints + bound_constraints(thesis.requirements, thesis.limits):
        assert np.shape(constraint.minimum_length(ratio)) == (5,)
        assert np.all(np.diff(constraint.minimum_length(ratio)) >= 0)


def test_speed_limit_of_the_thesis(thesis):
    speed, _ = bound_constraints(thesis.requirements, thesis.limits)
    assert speed.minimum_ratio() == pytest.approx(1.299 * MILLIMETRE, abs=0.0005 * MILLIMETRE)
    assert speed.violation(1.3 * MILLIMETRE, LENGTH) is None
    assert "at least" in speed.violation(1.2 * MILLIMETRE, LENGTH).words(Wheel())


def test_speed_limit_takes_the_magnitude_of_a_signed_velocity():
    assert SpeedLimit(-3.4, 2618.0).minimum_ratio() == SpeedLimit(3.4, 2618.0).minimum_ratio()


def test_length_limit():
    limit = LengthLimit(70 * MILLIMETRE)
    assert limit.violation(RATIO, 70 * MILLIMETRE) is None
    assert limit.violation(RATIO, 71 * MILLIMETRE).words(Wheel()) == "active length 71 mm is above the limit of 70 mm"


def test_force_sentences_name_the_missing_newtons():
    said = NominalForce(300.0, 50.0).violation(2.5e-3, 10e-3).words(Wheel())
    assert "nominal force 200 N is 100 N below" in said and "at 2.5 mm/rad it would need 15.0 mm" in said
    assert "overload force" in OverloadForce(2614.0, 100.0).violation(RATIO, LENGTH).words(Wheel())


def test_on_a_shaft_the_same_numbers_are_a_torque_and_a_damping_in_its_units(damping):
    said = NominalForce(30.0, 50.0).violation(0.02, 10e-3).words(Shaft())
    assert said.startswith("nominal torque 25 Nm is 5 Nm below the requirement of 30 Nm; at 1:50 it would need 12.0 mm")
    said = damping.violation(RATIO, LENGTH).words(Shaft())
    assert "Nms/rad below the requirement of 40000 Nms/rad" in said and "kNs" not in said and "mm/rad" not in said
    assert "a transmission ratio of 1:5 at least" in SpeedLimit(100.0, 500.0).violation(0.1, LENGTH).words(Shaft())


def test_linear_overload_is_a_proportion():
    assert linear_overload(50.0, 6.0, 20.0) == pytest.approx(500 / 3)
    assert linear_overload(55.66, 6.0, 20.0) / 145.6 > 1.2  # field solution at 20 A/mm^2 RMS


def test_no_damping_asks_for_no_length(damping):
    none = replace(damping, damping=0.0)
    assert none.minimum_length(RATIO) == 0 and none.violation(RATIO, LENGTH) is None
    assert none.minimum_length(np.array([1e-3, 2e-3])).tolist() == [0.0, 0.0]
    assert none.capability(RATIO, LENGTH) == damping.capability(RATIO, LENGTH)


def test_planets_bound_the_ratio_of_a_stage():
    """Three clear each other below 14.93; two always do; the bound is where the pitch circles touch."""
    assert largest_stage_ratio(3) == pytest.approx(14.93, abs=0.005) and largest_stage_ratio(2) == inf
    one_stage = PlanetClearance(1, 3, 0.170)
    assert one_stage.minimum_ratio() == pytest.approx(0.170 / 14.93, rel=1e-3)
    assert PlanetClearance(2, 3, 0.170).minimum_ratio() == pytest.approx(0.170 / 14.93**2, rel=1e-3)
    said = one_stage.violation(4e-3, LENGTH).words(Wheel())
    assert "stage ratio 42.5 is above the limit of 14.9; above it 3 planets overlap" in said and "11.39 mm/rad" in said
    assert one_stage.violation(12e-3, LENGTH) is None
