"""The vehicle driven again with a designed actuator: limits, inertia and friction are felt, an ideal one is not."""

from dataclasses import replace

import numpy as np
import pytest

from actuator.errors import ActuatorError
from drivetrain.actuator_limits import ActuatorLimits
from vehicle.ride_again import ride_again_stage

STRONG = ActuatorLimits(np.array([0.0, 20.0]), np.array([1e5, 1e5]), 0.0, 0.0, 0.0)


@pytest.fixture
def weak(found):
    """An actuator that gives half of the force that the worst case asks for."""
    half = abs(found.demands.force_peak.value) / 2
    return replace(STRONG, force=np.array([half, half]))


def test_an_ideal_actuator_changes_nothing(case, found):
    again = ride_again_stage(case, found, STRONG)
    assert again.designed.force_peak == pytest.approx(again.ideal.force_peak, rel=1e-6)
    assert again.designed.time_saturated == 0
    for own, other in zip(again.road_designed, again.road_ideal, strict=True):
        assert own.damping == other.damping and own.comfort_rms == pytest.approx(other.comfort_rms, rel=1e-6)


def test_a_weak_actuator_is_held_back(case, found, weak):
    again = ride_again_stage(case, found, weak)
    assert again.set_by == found.demands.force_peak.set_by
    assert again.ideal.force_peak == pytest.approx(abs(found.demands.force_peak.value))
    assert again.ideal.time_saturated == 0 < again.designed.time_saturated < 0.5
    assert again.designed.force_peak == pytest.approx(weak.force[0])
    assert again.worst_traces.names == ("ideal", "designed")


def test_inertia_and_friction_reach_the_road(case, found):
    heavy = replace(STRONG, equivalent_mass=30.0, viscous_friction=500.0, coulomb_friction=20.0)
    again = ride_again_stage(case, found, heavy)
    assert again.designed.tyre_load_max != pytest.approx(again.ideal.tyre_load_max, rel=1e-3)
    assert again.road_designed[0].power_mean < again.road_ideal[0].power_mean


def test_a_worst_case_on_the_road_is_driven_with_its_own_seed(on_road, found_on_road, weak):
    again = ride_again_stage(on_road, found_on_road, STRONG)
    assert again.set_by.seed in (3, 4) and len(again.worst_traces.data.time) == 1001


def test_a_limit_that_is_no_curve_is_refused(case, found):
    with pytest.raises(ActuatorError, match="torque limit"):
        ride_again_stage(case, found, replace(STRONG, speed=np.array([1.0, 20.0])))
