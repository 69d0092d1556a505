"""The wound machine over speed, on a flux map in closed form."""

import numpy as np
import pytest

from electrical.drive_stage import drive_stage
from electrical.winding_stage import winding_stage
from tests.electrical.analytic_map import DEMAND, GOOD, INPUTS, MATCHED, Saturating, flux_map


def driven(machine_map):
    winding = winding_stage(machine_map, MATCHED, DEMAND, INPUTS, GOOD)
    return winding, drive_stage(machine_map, winding, INPUTS)


@pytest.fixture(scope="module")
def linear():
    return driven(flux_map())


@pytest.fixture(scope="module")
def saturating():
    return driven(flux_map(Saturating()))


def test_on_a_linear_map_both_models_say_the_same(linear):
    _, found = linear
    assert found.envelope.torque == pytest.approx(found.constant_envelope.torque, rel=1e-5)
    assert found.field.base_speed == pytest.approx(found.constant.base_speed, rel=1e-6)
    constant = found.plane_of_constant_parameters.current_peak
    assert found.plane.current_peak == pytest.approx(constant, abs=0.02, nan_ok=True)
    for pair in found.neighbours:
        assert pair.field.maximum_power == pytest.approx(pair.constant.maximum_power, rel=1e-4)


def test_the_choice_is_that_of_the_rule(linear):
    winding, found = linear
    assert (found.by_constant.turns, found.by_constant.strands) == (winding.chosen.turns, winding.chosen.strands)


def test_torque_at_rest_is_the_peak_torque(saturating):
    winding, found = saturating
    for torque in (found.field.torque, found.envelope.torque[0], found.plane.torque[-1, 0]):
        assert torque == pytest.approx(winding.peak_torque, rel=1e-9)
    assert found.field.base_speed == pytest.approx(winding.chosen.base_speed, rel=1e-9)
    assert found.neighbour(winding.chosen.design).envelope.torque == pytest.approx(found.envelope.torque)


def test_saturation_separates_the_models(saturating):
    _, found = saturating
    assert abs(found.constant.torque / found.field.torque - 1) > 0.005


def test_the_best_currents_end_at_the_limit_and_pass_to_mtpv(saturating):
    winding, found = saturating
    limit = winding.limits.current_peak
    assert np.hypot(found.mtpa_direct, found.mtpa_quadrature)[-1] == pytest.approx(limit)
    assert found.mtpa_direct[-1] == pytest.approx(winding.direct_current)
    beyond = np.hypot(found.mtpv_direct, found.mtpv_quadrature) <= limit
    assert found.envelope.i_d[beyond] == pytest.approx(found.mtpv_direct[beyond], rel=2e-3)
