"""The requirements stage on a quarter car that is driven for moments: what is asked, by which run, and what is kept."""

import pickle
from dataclasses import replace

import numpy as np
import pytest

from tasks import InThisProcess
from vehicle.damping import DamperCurve, linear_damper
from vehicle.demands import RunsTask, required, requirements_stage, summed_up
from vehicle.errors import VehicleError
from vehicle.most_demanding import SetBy
from vehicle.ride import simulate
from vehicle.scenarios import summaries
from vehicle.traces import traces


def test_the_nominal_point_is_the_mean_of_the_damping_with_the_largest_rms_force(found):
    by_damping = {one.damping: one for one in found.ride}
    worst = max(by_damping.values(), key=lambda one: one.force_rms)
    demands = found.demands
    assert demands.force_rms.set_by == SetBy("random road", worst.damping, runs=2)
    assert (demands.force_rms.value, demands.velocity_rms.value) == (worst.force_rms, worst.velocity_rms)
    own = [run.force_rms for run in found.road if run.damping == worst.damping]
    assert len(own) == 2 and worst.force_rms == pytest.approx(np.mean(own))


def test_peaks_are_those_of_the_overload_and_belong_together(found):
    demands = found.demands
    forces = [abs(run.at_force_peak.force) for run in found.overload]
    assert abs(demands.force_peak.value) == max(forces)
    product = demands.force_at_power_peak.value * demands.velocity_at_power_peak.value
    assert demands.power_peak.value == pytest.approx(product)
    assert demands.force_peak.set_by == demands.velocity_at_force_peak.set_by
    assert demands.force_peak.set_by.scenario == "bump 30 mm at 28.8 km/h" and demands.force_peak.set_by.seed is None


def test_without_overload_the_road_gives_the_peaks(found_on_road, on_road):
    set_by = found_on_road.demands.force_peak.set_by
    assert found_on_road.overload == () and set_by.scenario == "random road" and set_by.seed in (3, 4)
    assert on_road.run(set_by).scenario.road.seed == set_by.seed
    (own,) = summaries([on_road.run(set_by)])
    assert own.at_force_peak.force == pytest.approx(found_on_road.demands.force_peak.value, rel=1e-9)
    assert f"seed {set_by.seed}" in set_by.words


def test_what_stages_behind_read_are_magnitudes(found):
    asked = required(found)
    assert asked.maximum_damping == 6e3
    assert asked.velocity_peak == abs(found.demands.velocity_peak.value)
    assert asked.power_peak == pytest.approx(asked.force_at_power_peak * asked.velocity_at_power_peak)
    assert all(value > 0 for value in vars(asked).values())


def test_histories_for_the_gears_are_those_of_the_nominal_point(found, case):
    data, damping = found.nominal, found.demands.force_rms.set_by.damping
    assert dict(data.sizes) == {"seed": 2, "time": 1001} and data.seed.values.tolist() == [3, 4]
    assert np.sqrt((data.force**2).mean("time")).mean() == pytest.approx(found.demands.force_rms.value)
    (again,) = simulate([run for run in case.road_runs if run.command.name == damping][:1])
    assert data.stroke.values[0] == pytest.approx(again.stroke)
    assert data.velocity.values[0] == pytest.approx(again.velocity)


def test_traces_hold_every_damping_on_one_road(found):
    assert set(found.worst_traces.names) == {"maximum", "minimum"}
    worst = found.worst_traces.by_name[found.demands.force_peak.set_by.damping]
    assert np.abs(worst.actuator_force).max() == pytest.approx(abs(found.demands.force_peak.value))
    assert worst.road.shape == worst.tyre_loads.shape == (1, len(worst.time))
    assert worst.road.max() == pytest.approx(0.03, rel=1e-2)


def test_energy_error_and_frequencies(found, case):
    assert found.energy_error == max(run.energy_error for run in (*found.road, *found.overload)) < 5e-3
    assert found.natural_frequencies.tolist() == case.vehicle.natural_frequencies.tolist()


def test_no_regenerative_damping_leaves_the_curves_as_they_are(unbounded):
    assert unbounded.damping == unbounded.curves
    found = requirements_stage(unbounded, InThisProcess())
    asked = required(found)
    assert asked.maximum_damping == 0 and asked.force_rms > 0 and asked.power_peak > 0


def test_curves_are_bounded_by_the_damping_that_is_asked_for(case):
    assert [curve.largest_damping for curve in case.damping] == pytest.approx([6e3, 2.6e3])


def test_runs_are_handed_out_in_handfuls(case, workers):
    many = replace(case, road=case.road * 5)
    requirements_stage(replace(many, overload=()), workers)
    assert workers.asked == {"road": ["road, from run 0", "road, from run 9", "road, from run 18"], "overload": []}


def test_a_task_travels(case):
    task = RunsTask(tuple(case.road_runs[:2]))
    again = pickle.loads(pickle.dumps(task))
    assert again == task and summed_up(again) == summed_up(task)


def test_a_damper_that_is_not_known_far_enough(case):
    short = DamperCurve("short", (-0.01, 0.0, 0.01), (-20.0, 0.0, 20.0), "made up")
    with pytest.raises(VehicleError, match="'random road, seed 3'.* 'short' is known from -0.01 .* extend the curve"):
        requirements_stage(replace(case, curves=(short,)), InThisProcess())


def test_a_case_needs_damping_and_road(case):
    with pytest.raises(VehicleError, match="expected at least one damping and one random road, found 2 and 0"):
        replace(case, road=())
    with pytest.raises(VehicleError, match="maximum damping must not be negative"):
        replace(case, maximum_damping=-1.0)
    with pytest.raises(VehicleError, match="a name of its own, found one, one"):
        replace(case, curves=(linear_damper(1e3, "one"), linear_damper(2e3, "one")))


def test_traces_may_end_early(case):
    histories = simulate(case.road_runs[:2])
    kept = traces(["maximum", "minimum"], histories, until=0.25)
    assert dict(kept.data.sizes) == {"run": 2, "wheel": 1, "time": 251}
    assert kept.by_name["minimum"].stroke == pytest.approx(histories[1].stroke[:251])


def test_only_a_random_road_has_a_seed(case):
    assert [scenario.road.random_seed for scenario in (*case.road, *case.overload)] == [3, 4, None]
    assert [scenario.title for scenario in case.road] == ["random road, seed 3", "random road, seed 4"]
    assert case.overload[0].title == case.overload[0].name
