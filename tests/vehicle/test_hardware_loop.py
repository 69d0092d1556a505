"""The actuator on a bench in a loop with the vehicle: as one simulation, unstable and cured, and paced by the clock."""

from functools import cache
from time import perf_counter

import numpy as np
import pytest

from actuator.linear import tangent_plant
from actuator.observer import ForceObserver
from control.design import loop_for
from control.errors import ControlError
from control.force_loop import ForceLoop
from control.sampled_loop import SampledLoop
from tests.actuator.thesis import PEAK_TORQUE, RATIO, prototype
from tests.vehicle.thesis import CRUISE_SPEED, quarter_car
from vehicle.commands import Feedback
from vehicle.hardware_loop import (
    HydraulicAxis,
    LoadCellLoop,
    NoLoop,
    ObserverLoop,
    Platform,
    SimulatedDevice,
    run_loop,
)
from vehicle.indices import rms
from vehicle.real_time import Pace, Timing
from vehicle.ride import Run, Scenario, simulate
from vehicle.road import IsoRoad, roughness_of_class

pytestmark = pytest.mark.physics
SAMPLE, DEVICE, ROAD = 5e-4, prototype(), IsoRoad(roughness_of_class("B"), 0)


@cache
def force_loop():
    return loop_for(tangent_plant(DEVICE, 300.0), 100.0, np.radians(50.0))


def low_level(kind):
    loop = SampledLoop(force_loop(), SAMPLE, PEAK_TORQUE / RATIO)
    if kind is NoLoop:
        return NoLoop()
    return kind(loop) if kind is LoadCellLoop else kind(loop, ForceObserver(DEVICE, SAMPLE, 200.0))


def driven(kind, damping, axis=100.0, sample=SAMPLE, duration=0.8):
    time = np.arange(0.0, duration + sample / 2, sample)

    def law(told):
        return damping * (told.body_velocity - told.wheel_velocity)

    platform = Platform(quarter_car(), law, low_level(kind), sample)
    return run_loop(platform, SimulatedDevice(DEVICE, sample, 2**14), HydraulicAxis(axis),
                    ROAD.heights(time, CRUISE_SPEED)[:, None])  # fmt: skip


def test_with_a_fast_axis_the_loop_comes_near_one_simulation_of_all_of_it():
    scenario = Scenario("road", CRUISE_SPEED, 0.4, ROAD, time_step=2.5e-4)
    whole = simulate([Run(quarter_car(), Feedback((0.0, 0.0, 1000.0, -1000.0)), scenario, DEVICE)])[0]
    errors = []
    for sample in (1e-3, 2.5e-4):
        found = driven(NoLoop, 1000.0, axis=3000.0, sample=sample, duration=0.4)
        exact = np.interp(found.time, whole.time, whole.suspension_force)
        errors.append(rms(found.force - exact) / rms(exact))
    assert errors[1] < 0.1 and errors[1] < errors[0] / 2


def test_the_loop_swings_without_a_force_loop_and_not_with_one():
    """Section 5.5: a wanted damper whose force comes late drives what it should damp."""
    alone = driven(NoLoop, 4000.0)
    assert alone.force_error > 5 * rms(alone.wanted[alone.time < 0.2])
    for kind, bound in ((LoadCellLoop, 0.5), (ObserverLoop, 0.5)):
        found = driven(kind, 1000.0)
        assert not found.lost and found.force_error < bound * rms(found.wanted)
    assert driven(LoadCellLoop, 4000.0).force_error < 0.05 * alone.force_error


def test_the_axis_follows_exactly_and_late():
    axis, sample = HydraulicAxis(50.0), 1e-4
    moved = sum(sample * axis.follow(1.0, sample) for _ in range(100))
    w = 2 * np.pi * 50.0
    assert moved == pytest.approx(1 - np.exp(-w * 0.01) * (1 + w * 0.01)) == axis.stroke


def test_the_sampled_loop_is_the_continuous_one_and_rests_at_its_limit():
    loop, h = ForceLoop(2.0, 30.0, 1e-3, 500.0), 1e-5
    sampled = SampledLoop(loop, h, 1e9)
    found = [sampled.output(1.0) for _ in range(2000)][-1]
    assert found == pytest.approx(2.0 + 30.0 * 0.02 + 1e-3 * 500.0 * np.exp(-500.0 * 0.02), rel=1e-3)
    bounded = SampledLoop(loop, h, 1.5)
    assert [bounded.output(1.0) for _ in range(10)] == [1.5] * 10 and bounded.integral == 0.0
    with pytest.raises(ControlError, match="sample time must be above zero"):
        SampledLoop(loop, 0.0, 1.0)


def test_the_pace_keeps_the_clock_and_counts_what_is_late():
    pace, start = Pace(2e-3), perf_counter()
    for _ in range(50):
        pace.wait()
        pace.done()
    assert perf_counter() - start >= 49 * 2e-3
    assert min(pace.late) >= 0 and len(pace.spent) == 50
    timing = Timing(1e-3, np.array([0.0, 5e-4, 0.0]), np.array([5e-4, 6e-4, 1.1e-3]))
    assert timing.missed == 2 and timing.row()["jitter_worst_s"] == 5e-4
