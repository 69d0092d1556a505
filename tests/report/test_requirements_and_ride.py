"""Report of the vehicle: tables in drawing units, one picture a figure, stated values beside, zero damping."""

from dataclasses import replace

import numpy as np
import pytest

from drivetrain.actuator_limits import ActuatorLimits
from drivetrain.output import Wheel
from drivetrain.requirements import Requirements, StatedRequirements
from figures.report import Picture, Table
from report import requirements as report
from report import ride
from tasks import InThisProcess
from tests.vehicle.thesis import CRUISE_SPEED, obstacle_shape, quarter_car, quarter_car_damping
from vehicle.demands import RideCase, required, requirements_stage
from vehicle.ride_again import ride_again_stage
from vehicle.road import roughness_of_class
from vehicle.scenarios import acceleration_scenario, obstacle_scenarios, road_scenarios

FIGURES = {"ride_road", "ride_worst", "ride_points", "requirements"}
LIMITS = ActuatorLimits(np.array([0.0, 20.0]), np.array([400.0, 400.0]), 5.0, 0.0, 250.0)


@pytest.fixture(scope="module")
def case():
    road = road_scenarios(roughness_of_class("B"), CRUISE_SPEED, 1.0, [3])
    amplitudes = [0.005 * k for k in (-4, -3, -2, -1, 1, 2, 3, 4, 5)]
    overload = obstacle_scenarios(obstacle_shape(), [4.0, 8.0], amplitudes, 0.2)
    return RideCase(quarter_car(), quarter_car_damping(), tuple(road), tuple(overload), 6e3)


@pytest.fixture(scope="module")
def found(case):
    return requirements_stage(case, InThisProcess())


@pytest.fixture
def stated(found):
    """Every value half of what was found."""
    return StatedRequirements(Requirements(**{name: value / 2 for name, value in vars(required(found)).items()}))


def names(files):
    return {file.name.removeprefix("figures/").removesuffix(".png") for file in files}


def words(section):
    return " ".join(part for part in section.content if isinstance(part, str))


def tables(section):
    return [part.frame for part in section.content if isinstance(part, Table)]


def test_the_files_of_the_requirements(found, case, stated, tmp_path):
    files = list(report.files(found, case, stated))
    assert names(files) == {report.RUNS, *FIGURES, "ride_obstacles"}
    for file in files:
        file.write(tmp_path / "one")
        assert (tmp_path / "one").stat().st_size > 0


def test_pictures_of_the_section_are_files(found, case, stated):
    section = report.section(found, case, stated)
    shown = {part.image for part in section.content if isinstance(part, Picture)}
    assert shown == {file.name for file in report.files(found, case, stated)} - {report.RUNS}


def test_the_table_of_runs_is_in_drawing_units(found):
    table = report.runs_table(found)
    assert len(table) == 2 + 36 and table.part.value_counts().to_dict() == {"overload": 36, "road": 2}
    assert table.stroke_peak_mm[0] == pytest.approx(found.road[0].stroke_peak * 1e3)
    assert table.at_power_peak_power_W[0] == pytest.approx(found.road[0].at_power_peak.power)
    assert table.seed[0] == 3 and table.seed.isna().sum() == 36


def test_the_section_says_what_set_each_value(found, case, stated):
    shown = tables(report.section(found, case, stated))[1].set_index("requirement")
    assert shown.loc["maximum damping /\N{NO-BREAK SPACE}(kNs/m)"].tolist() == [6.0, 3.0, "given"]
    force = shown.loc["force peak /\N{NO-BREAK SPACE}N"]
    assert force["value"] == pytest.approx(2 * force["stated"])
    assert force["set by"] == found.demands.force_peak.set_by.words
    text = words(report.section(found, case, stated))
    assert "2 runs on the random road and 36 over" in text and "regenerative damping of 6 kNs/m" in text
    assert "what the stated ones would give is shown beside" in text


def test_without_stated_values_nothing_is_compared(found, case):
    section = report.section(found, case, None)
    assert "stated" not in tables(section)[1].columns and "states none of its own" in words(section)


def test_without_obstacles_there_is_no_figure_of_them(case):
    bare = replace(case, overload=())
    found = requirements_stage(bare, InThisProcess())
    assert names(report.files(found, bare, None)) == {report.RUNS, *FIGURES}
    assert "the peaks come from the random road" in words(report.section(found, bare, None))


def test_a_manoeuvre_is_no_obstacle(case):
    still = replace(case, overload=(acceleration_scenario(1.0, 0.1),))
    found = requirements_stage(still, InThisProcess())
    assert "ride_obstacles" not in " ".join(str(part) for part in report.section(found, still, None).content)


def test_no_regenerative_damping_can_be_shown(case):
    free = replace(case, maximum_damping=0.0)
    found = requirements_stage(free, InThisProcess())
    zero = StatedRequirements(required(found))
    assert "no regenerative damping is asked for" in words(report.section(found, free, zero))
    assert names(report.files(found, free, zero)) >= FIGURES


def test_stated_requirements_have_a_section_of_their_own():
    numbers = Requirements(0.0, 300.0, 0.1, 37.4, 3.4, 2614.0, 1.6, 4253.0, 1343.0, 3.2)
    (table,) = tables(report.stated_section(numbers, Wheel()))
    assert table.value.tolist() == [0.0, 300.0, 0.1, 37.4, 3.4, 2614.0, 1.6, 4253.0, 1343.0, 3.2]


def test_a_road_is_shown_around_its_largest_force(found):
    trace = found.worst_traces.by_name["maximum"]
    long = replace(trace, time=np.linspace(0, 20, len(trace.time)))
    force = np.zeros(len(trace.time))
    force[len(force) // 2] = -5.0
    shown = report.span_shown({"one": replace(long, actuator_force=force)}, on_road=True)
    assert shown == pytest.approx((7, 13), abs=0.02)
    assert report.span_shown({"one": long}, on_road=False) == (0.0, 1.0)


def test_the_ride_with_the_designed_actuator(found, case):
    again = ride_again_stage(case, found, LIMITS)
    assert names(ride.files(again, LIMITS, required(found))) == {"outcome_points", "outcome_histories"}
    section = ride.section(again, LIMITS)
    worst, road = tables(section)
    assert worst.actuator.tolist() == ["ideal", "designed"] and worst.force_peak_N[1] == pytest.approx(400.0)
    assert worst.time_saturated_ms[1] == pytest.approx(1e3 * again.designed.time_saturated)
    assert road[["damping", "actuator"]].values.tolist() == [
        ["maximum", "ideal"], ["maximum", "designed"], ["minimum", "ideal"], ["minimum", "designed"]
    ]  # fmt: skip
    assert "5.0 kg of equivalent inertia and 250 Ns/m" in words(section)
    assert f"holds it back for {1e3 * again.designed.time_saturated:.0f} ms" in words(section)
