"""A quarter car that is driven for moments: a road of one second, two seeds, a bump."""

from dataclasses import dataclass, field

import pytest

from tasks import InThisProcess
from tests.vehicle.thesis import CRUISE_SPEED, obstacle_shape, quarter_car, quarter_car_damping
from vehicle.damping import linear_damper
from vehicle.demands import RideCase, requirements_stage
from vehicle.road import roughness_of_class
from vehicle.scenarios import obstacle_scenarios, road_scenarios


@dataclass
class CountingWorkers:
    """Workers in this process that remember the names of their tasks."""

    asked: dict = field(default_factory=dict)

    def map(self, what, function, tasks):
        self.asked[what] = list(tasks)
        return InThisProcess().map(what, function, tasks)


@pytest.fixture
def workers():
    return CountingWorkers()


BOTH = quarter_car_damping()


def small_case(maximum_damping=6e3, bumps=(0.03,), curves=BOTH):
    road = road_scenarios(roughness_of_class("B"), CRUISE_SPEED, 1.0, [3, 4])
    overload = obstacle_scenarios(obstacle_shape(), [8.0], bumps, 0.5)
    return RideCase(quarter_car(), tuple(curves), tuple(road), tuple(overload), maximum_damping)


@pytest.fixture(scope="session")
def case():
    """Two dampings, two seeds, one bump."""
    return small_case()


@pytest.fixture(scope="session")
def on_road():
    """The same without the bump."""
    return small_case(bumps=())


@pytest.fixture(scope="session")
def unbounded():
    """No regenerative damping is asked for."""
    return small_case(maximum_damping=0.0, curves=(linear_damper(3e3, "only"),))


@pytest.fixture(scope="session")
def found(case):
    return requirements_stage(case, InThisProcess())


@pytest.fixture(scope="session")
def found_on_road(on_road):
    return requirements_stage(on_road, InThisProcess())
