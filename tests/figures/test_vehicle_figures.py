"""Figures of the vehicle: every part drawn, at its place, readable."""

from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.text import Text

from figures.vehicle import force_velocity_cloud, obstacle_peaks, requirement_bars, time_histories


def words(figure):
    """All texts of a figure in one string."""
    return "\n".join(text.get_text() for text in figure.findobj(Text))


def history(gain=1.0, wheels=2, road=0.01):
    """A decaying oscillation."""
    time = np.linspace(0, 2, 2001)
    stroke = 0.02 * gain * np.exp(-time) * np.sin(10 * time)
    velocity = np.gradient(stroke, time)
    heights = np.stack([road * np.sin(3 * time - wheel) for wheel in range(wheels)])
    loads = np.full((wheels, len(time)), 1300.0) + 5e4 * stroke
    parts = {"time": time, "stroke": stroke, "velocity": velocity, "actuator_force": 1500 * velocity}
    return SimpleNamespace(**parts, road=heights, tyre_loads=loads)


@pytest.mark.parametrize("wheels", [1, 2])
def test_histories_show_every_quantity_with_its_unit(wheels, assert_readable):
    figure = time_histories({"ideal": history(1.0, wheels), "saturated": history(0.8, wheels)}, span=(0.0, 1.5))
    text = words(figure)
    for part in ("road / mm", "stroke / mm", "force / N", "velocity / (m/s)", "tyre load / kN", "time / s"):
        assert part in text
    assert len(figure.axes) == 5 and figure.axes[-1].get_xlim() == (0, 1.5)
    first = figure.axes[1].lines[0]
    assert np.max(first.get_ydata()) == pytest.approx(1e3 * history().stroke.max())
    assert_readable(figure)


def test_a_flat_road_is_left_out(assert_readable):
    figure = time_histories({"acceleration": history(road=0.0)})
    assert len(figure.axes) == 4 and "road" not in words(figure)
    assert_readable(figure)


def test_cloud_with_limit_and_required_points(assert_readable):

    def limit(speed):
        return np.interp(speed, (0, 0.1, 0.3), (200, 200, 50))

    figure = force_velocity_cloud({"ideal": history()}, limit=limit, required=[("peak force", 280.0, 0.19)])
    axis = figure.axes[0]
    dashed = [line for line in axis.lines if line.get_linestyle() == "--"]
    assert len(dashed) == 4, "all quadrants"
    assert max(np.max(np.abs(line.get_ydata())) for line in dashed) == pytest.approx(0.2)
    marked = next(line for line in axis.lines if line.get_label() == "peak force")
    assert marked.get_xydata().tolist() == [[0.19, 0.28]]
    assert "actuator force / kN" in words(figure) and "limit of the actuator" in words(figure)
    assert_readable(figure)


def test_obstacles_have_a_line_each(assert_readable):
    speeds = np.array([20, 40, 60]) / 3.6
    peaks = {a: [(1e4 * abs(a) + 10 * v, 0.1 * v) for v in speeds] for a in (-0.05, -0.02, 0.02, 0.05)}
    figure = obstacle_peaks(speeds, peaks)
    assert len(figure.axes[0].lines) == 4 and len(figure.axes[1].lines) == 4
    assert figure.axes[0].lines[0].get_xdata() == pytest.approx([20, 40, 60])
    assert "pothole 50 mm" in words(figure) and "speed / (km/h)" in words(figure)
    assert_readable(figure)


def test_requirement_bars_are_scaled_and_carry_numbers_and_scenarios(assert_readable):
    rows = [
        ("RMS force / N", 313.0, 300.0, "random road, mixed damping"),
        ("peak velocity / (m/s)", -3.57, -3.4, "pothole 50 mm at 50 km/h, minimum damping"),
        ("peak power / W", 4756.0, None, "pothole 50 mm at 50 km/h, maximum damping"),
    ]
    figure = requirement_bars(rows)
    widths = [bar.get_width() for bar in figure.axes[0].patches]
    assert widths == pytest.approx([313 / 300, 3.57 / 3.4, 1.0])
    text = words(figure)
    assert "313 (300)" in text and "minimum damping" in text and "peak power / W" in text
    assert_readable(figure)
