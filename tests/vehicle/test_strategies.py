"""Control laws over their settings: the printed ones are found again, responses by another route, what people read."""

from dataclasses import replace

import numpy as np
import pytest

from report.strategies import best_table, files, lqr_table, section
from tasks import InThisProcess
from tests.vehicle.thesis import motorcycle
from vehicle import strategies
from vehicle.damping import linear_damper
from vehicle.demands import RideCase
from vehicle.errors import VehicleError
from vehicle.printed_car import HANDLING, PRINTED_CAR, TRADE_OFF, printed_case, printed_road
from vehicle.quarter_car import TO_STROKE_STATES, lqr, state_space
from vehicle.ride import Scenario
from vehicle.strategies import corner, response, strategies_stage, weights_for


@pytest.fixture(scope="module")
def found():
    """On every seventh node of the grids, which holds both ends."""
    with pytest.MonkeyPatch.context() as patch:
        laws = [replace(law, grids=_coarse(law.grids)) for law in strategies.LAWS]
        for place in ("vehicle.strategies.LAWS", "report.strategies.LAWS", "figures.strategies.LAWS"):
            patch.setattr(place, tuple(laws))
        yield strategies_stage(printed_case([0]), InThisProcess())


def _coarse(grids):
    return lambda car: tuple(one[::7] for one in grids(car))


@pytest.mark.reference
def test_the_printed_settings_are_those_of_the_printed_car(found):
    """Table 4.1, and the best comfort of skyhook and LQR at the ends of their grids."""
    settings = {one.name: one for one in found.settings}
    assert settings["handling-oriented"].weights == HANDLING and settings["trade-off"].weights == TRADE_OFF
    assert settings["handling-oriented"].indices.road_holding == pytest.approx(0.057, rel=0.05)
    assert settings["trade-off"].stroke_peak == pytest.approx(71e-3, rel=0.15)
    table = best_table(found).set_index(["law", "best"])
    assert table.loc[("skyhook", "comfort"), "here"].endswith("2e+04")
    assert table.loc[("LQR", "comfort"), "here"] == "1, 1"


@pytest.mark.physics
def test_responses_are_those_of_the_state_space():
    """Section 4.2.2 in its own matrices, F_s = -K T z."""
    law, frequency = lqr(PRINTED_CAR, TRADE_OFF), np.array([0.7, 4.0, 11.0])
    a, b, c, d = state_space(PRINTED_CAR)
    row = -(np.array(law.row) + [PRINTED_CAR.spring_stiffness, 0, 0, 0]) @ TO_STROKE_STATES
    closed, output = a + np.outer(b[:, 1], row), c + np.outer(d[:, 1], row)
    for f, tyre in zip(frequency, response(PRINTED_CAR, law, frequency)[1], strict=True):
        z = np.linalg.solve(2j * np.pi * f * np.eye(4) - closed, b[:, 0])
        assert (output @ z + d[:, 0])[5] == pytest.approx(tyre, rel=1e-9)


def test_another_car_weighs_the_acceleration_alike():
    car = corner(motorcycle())
    assert car.sprung_mass == pytest.approx(motorcycle().rear.sprung_mass)
    weights = weights_for(car, TRADE_OFF)
    assert weights.stroke / car.sprung_mass == pytest.approx(TRADE_OFF.stroke / PRINTED_CAR.sprung_mass)


def test_what_people_read(found):
    assert len(lqr_table(found)) == 3 and len(best_table(found)) == 8
    assert section(found).title == "Control laws over their settings"
    assert {one.name for one in files(found)} >= {"strategies.csv", "figures/strategies_carpets.png"}


def test_without_a_random_road_there_is_nothing_to_judge_by():
    case = RideCase(PRINTED_CAR, (linear_damper(1e3, "one"),), (Scenario("flat", 0.0, 1.0),), (), 0.0)
    with pytest.raises(VehicleError, match="judged on a random road, found none"):
        strategies_stage(case, InThisProcess())
    assert printed_road(3).road.seed == 3
