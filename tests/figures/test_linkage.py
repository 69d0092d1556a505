"""Figures of the linkage: front, motion, side view."""

from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.patches import Rectangle
from matplotlib.text import Text

from figures.linkage import linkage_motion, linkage_side_view, pareto_front
from units import DEGREE

TRAVEL = np.linspace(-0.02, 0.14, 17)


def words(figure):
    return "\n".join(text.get_text() for text in figure.findobj(Text))


@pytest.fixture
def front():
    first = np.linspace(0.4, 1.0, 13)
    designs = np.column_stack([0.1 + 0.1 * first, np.full(13, 0.15), np.full(13, 0.05), np.full(13, 0.14)])
    problem = SimpleNamespace(bounds=(np.array([0, 0, 0.04, 0.11]), np.array([0.22, 0.17, 0.05, 0.14])))
    return SimpleNamespace(objectives=np.column_stack([first, 1 / first - 0.8]), designs=designs, problem=problem)


@pytest.fixture
def linkage():
    arm = SimpleNamespace(hardpoint_a=0.2 + 0j, wheel_axle=0.5 - 0.1j)
    return SimpleNamespace(arm=arm, hardpoint_c=0.05 + 0.14j)


@pytest.fixture
def motion():
    angle = TRAVEL / 0.5
    a = 0.2 * np.exp(1j * angle)
    return SimpleNamespace(
        travel=TRAVEL,
        a=a,
        b=0.1 + 0.15j + 0.2 * 1j * angle,
        transmission_ratio=0.17 + TRAVEL**2,
        gamma=np.full(17, 1.4),
        lambda_=np.full(17, 0.9),
    )


def test_front_shows_choice_and_what_it_dominates(front, assert_readable):
    level = {"first_at_same_second": 0.59, "second_at_same_first": 0.63}
    standing = SimpleNamespace(objectives=(0.7, 0.9), dominated=True, **level)
    figure = pareto_front(front, 4, others=[("printed", standing)])
    text = words(figure)
    assert "printed (dominated)" in text and "chosen" in text and "objective 2: transmission angles / rad²" in text
    star = [line for line in figure.axes[0].lines if line.get_marker() == "*"][0]
    assert star.get_xydata().tolist() == [pytest.approx(front.objectives[4].tolist())]
    shares = {line.get_label(): line.get_ydata() for line in figure.axes[1].lines}
    assert shares["x of C"] == pytest.approx(np.ones(13))
    assert shares["y of B"] == pytest.approx(np.full(13, 0.15 / 0.17))
    assert_readable(figure)


def test_motion_is_in_millimetres_and_degrees(motion, assert_readable):
    figure = linkage_motion({"chosen": motion, "printed": motion}, angle_window=50 * DEGREE)
    ratio = figure.axes[0].lines[0]
    assert ratio.get_xdata()[0] == pytest.approx(-20) and ratio.get_ydata()[0] == pytest.approx(170.4)
    levels = [line.get_ydata()[0] for line in figure.axes[1].lines if line.get_linestyle() == ":"]
    assert {round(level) for level in levels} == {40, 140}
    assert "γ at B, chosen" in words(figure) and "transmission ratio / (mm/rad)" in words(figure)
    assert_readable(figure)


def test_side_view_shows_links_boxes_and_the_ends_of_the_travel(linkage, motion, assert_readable):
    boxes = (SimpleNamespace(low=0j, high=0.22 + 0.17j, name="B"),)
    figure = linkage_side_view(linkage, motion, boxes=boxes)
    text, axis = words(figure), figure.axes[0]
    assert "\N{MINUS SIGN}20 to 140 mm" in text and all(name in text for name in ("O", "A", "B", "C", "W"))
    assert "box of B, nominal" in text and any(isinstance(patch, Rectangle) for patch in axis.patches)
    thick = [line for line in axis.lines if line.get_label() in ("swing arm", "coupler AB", "lever BC")]
    assert len(thick) == 3
    assert_readable(figure)
