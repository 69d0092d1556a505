"""The torque of a design: the mean over one electrical period whatever the reading, and how close its quick form is."""

from dataclasses import replace

import numpy as np
import pytest

from magnetostatics.positions import period_points
from magnetostatics.torque import maxwell_torque
from optimisation.design import Judge
from optimisation.states import READINGS, AlignedTooth
from optimisation.torque import MeanTorque, NullTorque, QuickMeanTorque
from study.inputs_field import field_case
from study.read import read_study
from tests.optimisation.machines import machine_of

CASE = field_case(read_study("motorcycle"))
# (slots, stator radius [m], back iron and rotor radius as shares of it): two optima, a corner of the sweep, a large one
DESIGNS = (
    (12, 42.5e-3, 0.0692, 0.3426),
    (9, 42.5e-3, 0.0631, 0.4053),
    (12, 42.5e-3, 0.05, 0.44),
    (9, 57.5e-3, 0.061, 0.4525),
)


def machine(slots, outer, width, rotor):
    return machine_of(CASE.family, slots, outer, width * outer, rotor * outer)


def mean_of_many(one, density):
    model, case, values, solution = CASE.model(one), CASE, [], None
    for point in period_points(one, case.layout(one), density, case.packing, 24):
        solution = model.solve(point, start=solution)
        values.append(maxwell_torque(solution))
    return float(np.mean(values))


def judged(one, objective, density=CASE.nominal_density):
    return Judge(CASE, AlignedTooth(), density, objective).judge(one)


@pytest.mark.parametrize("design", DESIGNS)
def test_six_positions_are_the_mean_of_many_and_the_quick_mean_is_close(design):
    one = machine(*design)
    mean = mean_of_many(one, CASE.nominal_density)
    assert judged(one, MeanTorque()).torque == pytest.approx(mean, rel=2e-4)
    assert judged(one, QuickMeanTorque()).torque == pytest.approx(mean, rel=3e-3)


@pytest.mark.parametrize("design", DESIGNS[:2])
def test_at_optima_the_quick_mean_holds_a_thousandth(design):
    one = machine(*design)
    assert judged(one, QuickMeanTorque()).torque == pytest.approx(judged(one, MeanTorque()).torque, rel=1e-3)


@pytest.mark.parametrize("design", DESIGNS[:2])
def test_six_positions_hold_at_the_overload(design):
    one = machine(*design)
    mean = mean_of_many(one, CASE.overload_density)
    assert judged(one, MeanTorque(), CASE.overload_density).torque == pytest.approx(mean, rel=5e-4)


def test_the_reading_changes_the_limit_and_not_the_torque():
    one = machine(*DESIGNS[0])
    judge = Judge(CASE, AlignedTooth(), CASE.nominal_density)
    designs = [replace(judge, reading=reading).judge(one) for reading in READINGS.values()]
    assert [design.torque for design in designs] == pytest.approx([designs[0].torque] * 3, rel=1e-4)
    assert designs[0].limited < designs[1].limited < designs[2].limited


def test_the_torque_of_the_null_state_is_named_and_only_where_it_was_solved():
    one = machine(*DESIGNS[0])
    by_name = {name: Judge(CASE, reading, CASE.nominal_density).judge(one) for name, reading in READINGS.items()}
    null = judged(one, NullTorque())
    assert null.torque == null.torque_null == pytest.approx(by_name["aligned_tooth"].torque_null, rel=1e-5)
    assert np.isnan(by_name["every_tooth_and_back_iron_over_period"].torque_null)
    assert abs(null.torque / by_name["aligned_tooth"].torque - 1) > 3e-3, "the two are different quantities"
