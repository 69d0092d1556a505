"""Roads: level, spectrum and delay; the comfort filter against the standard's table."""

import numpy as np
import pytest
from scipy.signal import welch

from tests.vehicle.thesis import CRUISE_SPEED, motorcycle, obstacle_shape
from vehicle.comfort import weighted_acceleration, weighting_gain
from vehicle.errors import VehicleError
from vehicle.ride import Scenario
from vehicle.road import DISPLACEMENT_PSD, FlatRoad, IsoRoad, Obstacle, ObstacleShape, roughness_of_class

CLASS_B = roughness_of_class("B")


def test_roughness_of_the_classes():
    assert CLASS_B == pytest.approx(6.4e-7)  # Table 3.3; the printed quotient of 3.21 would give 6.4e-3
    psd = list(DISPLACEMENT_PSD.values())
    assert np.allclose(np.divide(psd[1:], psd[:-1]), 4.0)
    with pytest.raises(VehicleError, match="one of A, B, C, D, E, found 'F'"):
        roughness_of_class("F")


def test_level_of_a_class_b_road():
    road = IsoRoad(CLASS_B, seed=0)
    assert road.stationary_rms == pytest.approx(10.03e-3, rel=1e-3)
    time = np.arange(0, 400, 0.01)
    roads = [IsoRoad(CLASS_B, seed, sample_time=0.01).heights(time, CRUISE_SPEED) for seed in range(40)]
    squares = [np.mean(heights[3000:] ** 2) for heights in roads]
    assert np.sqrt(np.mean(squares)) == pytest.approx(road.stationary_rms, rel=0.03)


def test_thirty_second_roads_scatter_as_they_should():
    """The mean square of a first-order process of time constant tau over T has a deviation of sqrt(2 tau / T)."""
    time = np.arange(0, 30, 0.01)
    roads = [IsoRoad(CLASS_B, seed, sample_time=0.01) for seed in range(400)]
    squares = [np.mean(road.heights(time, CRUISE_SPEED) ** 2) / road.stationary_rms**2 for road in roads]
    tau = 1 / roads[0].cutoff(CRUISE_SPEED)
    assert np.std(squares) == pytest.approx(np.sqrt(2 * tau / 30), rel=0.1)
    assert np.mean(squares) == pytest.approx(1 - tau / (2 * 30), abs=0.04)  # it begins at rest
    low, high = 1e3 * roads[0].stationary_rms * np.percentile(np.sqrt(squares), (5, 95))
    assert low == pytest.approx(8.0, abs=0.4) and high == pytest.approx(11.7, abs=0.5)


@pytest.mark.parametrize("speed", [10.0, CRUISE_SPEED])
def test_spectrum_is_that_of_the_roughness_one_sided(speed):
    """Above the cut-off G(f) = (2 pi)^2 G_r v / (2 pi f)^2 = G_r v / f^2 for positive frequencies alone."""
    step = 2e-3
    time = np.arange(0, 2000, step)
    heights = IsoRoad(CLASS_B, seed=3, sample_time=step).heights(time, speed)
    frequency, density = welch(heights, 1 / step, nperseg=8192)
    band = (frequency > 2) & (frequency < 20)
    assert np.mean((density * frequency**2)[band]) == pytest.approx(CLASS_B * speed, rel=0.03)


def test_road_starts_flat_and_repeats_with_its_seed():
    time = np.linspace(-1, 1, 501)
    road = IsoRoad(CLASS_B, seed=5)
    heights = road.heights(time, 20.0)
    assert not heights[time <= 0].any() and heights[-1] != 0
    assert (heights == IsoRoad(CLASS_B, seed=5).heights(time, 20.0)).all()
    assert (heights != IsoRoad(CLASS_B, seed=6).heights(time, 20.0))[-1]


def test_rear_wheel_meets_the_road_later():
    """1.4502 m wheelbase at 14.502 m/s are 0.1 s."""
    delays = motorcycle().delays(14.502)
    assert delays == pytest.approx((0.0, 0.1))


def test_obstacle_is_the_scaled_shape_at_speed():
    shape = ObstacleShape((0.0, 1.0, 3.0), (0.0, 1.0, 0.0), "test")
    heights = Obstacle(shape, -0.05).heights(np.array([-0.1, 0.0, 0.05, 0.1, 0.2, 0.3, 9.0]), 10.0)
    assert heights == pytest.approx([0, 0, -0.025, -0.05, -0.025, 0, 0])


def test_wrong_roads_are_refused_in_a_sentence():
    with pytest.raises(VehicleError, match="needs an amplitude other than zero, found 0"):
        Obstacle(obstacle_shape(), 0.0)
    with pytest.raises(VehicleError, match="amplitude other than zero, found nan"):
        Obstacle(obstacle_shape(), float("nan"))
    with pytest.raises(VehicleError, match="begin and end at 0"):
        ObstacleShape((0.0, 1.0, 2.0), (0.0, 1.0, 0.5), "test")
    with pytest.raises(VehicleError, match="roughness must be above zero"):
        IsoRoad(-1e-7, seed=0)


def test_wrong_scenarios_are_refused_in_a_sentence():
    with pytest.raises(VehicleError, match="speed must not be negative, found -3"):
        Scenario("back", -3.0, 1.0)
    with pytest.raises(VehicleError, match="needs a speed above zero"):
        Scenario("standing", 0.0, 1.0, IsoRoad(CLASS_B, 0))
    with pytest.raises(VehicleError, match="duration must be above zero"):
        Scenario("short", 1.0, 0.0)
    assert not FlatRoad().heights(np.arange(3.0), 1.0).any()


# ISO 2631-1:1997, Table 3, principal weighting W_k in thousandths over the third-octave frequencies [Hz].
W_K = {0.5: 418, 0.63: 459, 0.8: 477, 1.0: 482, 1.25: 484, 1.6: 494, 2.0: 531, 4.0: 967, 8.0: 1036, 16.0: 768}


def test_comfort_filter_follows_the_standard():
    gain = {f: float(weighting_gain(f)) for f in W_K}
    assert all(abs(gain[f] / (W_K[f] / 1e3) - 1) < 0.15 for f in W_K if f <= 2)
    assert all(abs(gain[f] / (W_K[f] / 1e3) - 1) < 0.30 for f in W_K)  # W_k itself is of higher order


@pytest.mark.parametrize("frequency", [1.0, 5.0, 12.0])
def test_filtered_sine_has_the_gain_of_the_filter(frequency):
    time = np.arange(0, 20, 1e-3)
    felt = weighted_acceleration(np.sin(2 * np.pi * frequency * time), 1e-3)[10_000:]
    assert np.sqrt(2 * np.mean(felt**2)) == pytest.approx(float(weighting_gain(frequency)), rel=2e-3)
