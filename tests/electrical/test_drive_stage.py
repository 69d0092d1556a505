"""The wound machine over speed, on a flux map in closed form."""

import numpy as np
import pytest

from electrical.drive_stage import drive_stage
from electrical.driven_machine import driven_machine
from electrical.winding_stage import winding_stage
from tests.electrical.analytic_map import DEMAND, GOOD, INPUTS, MATCHED, Saturating, flux_map


def driven(machine_map):
    winding = winding_stage(machine_map, MATCHED, DEMAND, INPUTS, GOOD)
    return winding, drive_stage(machine_map, winding, driven_machine(winding, INPUTS), INPUTS)


@pytest.fixture(scope="module")
def linear():
    return driven(flux_map())


@pytest.fixture(scope="module")
def saturating():
    return driven(flux_map(Saturating()))


def test_on_a_linear_map_both_models_say_the_same(linear):
    _, found = linear
    assert found.field.envelope.torque == pytest.approx(found.constant.envelope.torque, rel=1e-5)
    assert found.field.full.base_speed == pytest.approx(found.constant.full.base_speed, rel=1e-6)
    constant = found.constant.plane.current_peak
    assert found.field.plane.current_peak == pytest.approx(constant, abs=0.02, nan_ok=True)
    for pair in found.neighbours:
        assert pair.field.maximum_power == pytest.approx(pair.constant.maximum_power, rel=1e-4)


def test_the_choice_is_that_of_the_rule(linear):
    winding, found = linear
    assert (found.by_constant.turns, found.by_constant.strands) == (winding.chosen.turns, winding.chosen.strands)


def test_torque_at_rest_is_the_peak_torque(saturating):
    winding, found = saturating
    for torque in (found.field.full.torque, found.field.envelope.torque[0], found.field.plane.torque[-1, 0]):
        assert torque == pytest.approx(winding.peak_torque, rel=1e-9)
    assert found.field.full.base_speed == pytest.approx(winding.chosen.base_speed, rel=1e-9)
    assert found.neighbour(winding.chosen.design).envelope.torque == pytest.approx(found.field.envelope.torque)


def test_saturation_separates_the_models(saturating):
    _, found = saturating
    assert abs(found.constant.full.torque / found.field.full.torque - 1) > 0.005


def test_the_best_currents_end_at_the_limit_and_pass_to_mtpv(saturating):
    winding, found = saturating
    limit = winding.limits.current_peak
    assert np.hypot(found.field.mtpa_direct, found.field.mtpa_quadrature)[-1] == pytest.approx(limit)
    assert found.field.mtpa_direct[-1] == pytest.approx(winding.direct_current)
    beyond = np.hypot(found.field.mtpv_direct, found.field.mtpv_quadrature) <= limit
    assert found.field.envelope.i_d[beyond] == pytest.approx(found.field.mtpv_direct[beyond], rel=2e-3)
