"""The road as the aim of the search over all stages: against full rides, what the search finds, what is refused."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import vehicle.road_aims
from control.force_loop import ForceLoop
from drivetrain.whole_design import RequirementAims
from study.errors import StudyError
from study.read import read_study
from tasks import InThisProcess
from tests.actuator.thesis import prototype
from tests.drivetrain.test_whole_search import search
from tests.vehicle.conftest import small_case
from tests.vehicle.test_judged_designs import MACHINE, OWN, design
from vehicle.designed import DesignedActuator
from vehicle.errors import VehicleError
from vehicle.judged_designs import judged_stage
from vehicle.road_aims import RoadAims, road_costs, road_response_stage

CASE = small_case(bumps=())
INPUTS = SimpleNamespace(scales=SimpleNamespace(equivalent_mass=15.0))


@pytest.fixture(scope="module")
def response():
    return road_response_stage(CASE, OWN, INPUTS, InThisProcess())


@pytest.mark.physics
def test_a_design_between_the_driven_masses_rides_as_it_does_in_full(response):
    """Other mass, ratio and copper than any that was driven, a torque that does not bind: comfort and road holding to
    0.3 %, power to 0.1 W."""
    others = (design(3.0, 6.16), design(2.0, 9.0, ratio=1.8e-3), design(2.0, 4.0, ratio=1e-3))
    strong = replace(MACHINE, peak_torque=9.0)
    machines = (MACHINE, strong, replace(strong, copper=18.0))
    driven = judged_stage(
        SimpleNamespace(solved=[], front=others, machines=machines), CASE, OWN, InThisProcess()
    ).designs
    for one, machine, full in zip(others, machines, driven, strict=True):
        mass, ratio = one.values.objectives[1], one.design.transmission_ratio
        comfort, holding, recovered = response.indices(mass, ratio, machine)
        assert (comfort, holding) == pytest.approx((full.comfort, full.road_holding), rel=3e-3)
        assert recovered == pytest.approx(full.recovered, abs=0.1)


def test_beyond_the_driven_masses_nothing_is_said(response):
    assert response.indices(20.0, 1e-3, MACHINE) == (np.inf, np.inf, -np.inf)
    assert road_costs(2.0, np.inf, np.inf, -np.inf) == (2.0, np.inf, np.inf, np.inf)
    assert road_costs(2.0, 1.0, 0.1, 7.0) == road_costs(2.0, 1.003, 0.1, 7.0) != road_costs(2.0, 1.02, 0.1, 7.0)


def test_the_search_finds_what_the_road_asks_for(response):
    """The same small search for both aims: that for the road recovers more, and its front is one by its own costs."""
    aims = RoadAims(response)
    for_road, for_requirements = (search(aims=one) for one in (aims, RequirementAims()))
    problem = SimpleNamespace(machine_of=dict(zip((one.design for one in for_road.front), for_road.machines[-len(
        for_road.front):], strict=True)).__getitem__)  # fmt: skip
    costs = np.array([aims.costs(problem, one) for one in for_road.front])
    for one in costs:
        assert not ((costs <= one).all(axis=1) & (costs < one).any(axis=1)).any()
    power = [best_power(aims.response, one) for one in (for_road, for_requirements)]
    assert power[0] > power[1]
    assert "recovered power" in aims.words


def best_power(response, found):
    pairs = zip(found.front, found.machines[-len(found.front) :], strict=True)
    return max(
        response.indices(one.values.objectives[1], one.design.transmission_ratio, machine)[2] for one, machine in pairs
    )


def test_masses_that_cannot_be_driven_are_left_out_and_said_where_none_remains(monkeypatch):
    monkeypatch.setattr(vehicle.road_aims, "_COUNT", 2)
    unstable = DesignedActuator(prototype(), ForceLoop(200.0, 1e3, 0.0, 0.0))
    with pytest.raises(VehicleError, match="fewer than two equivalent masses can be driven.*force loop: unstable"):
        road_response_stage(CASE, unstable, INPUTS, InThisProcess())


def test_a_study_asks_for_it_and_needs_a_vehicle():
    assert read_study("motorcycle", ["optimise.judged_by=road"]).optimise.judged_by == "road"
    with pytest.raises(StudyError, match='optimise.judged_by = "road" needs a vehicle that is driven'):
        read_study("pump", ["optimise.judged_by=road"])
