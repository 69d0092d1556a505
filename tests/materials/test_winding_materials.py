"""Wires and insulation classes: the tables against what must be true of any of their rows."""

import numpy as np
import pytest

from materials.enamelled_wire import DIAMETERS, gauge
from materials.errors import MaterialError
from materials.insulation import LETTERS, insulation_class
from units import MILLIMETRE


def builds(grade):
    """What the enamel adds to the diameter [m], over the table."""
    return np.array([gauge(d, grade).outer_diameter - d for d in DIAMETERS])


def test_diameters_rise_by_the_twentieth_root_of_ten():
    """R 20: 10^(1/20) from one to the next, rounded to two or three digits."""
    steps = np.array(DIAMETERS[1:]) / np.array(DIAMETERS[:-1])
    assert steps == pytest.approx(np.full(len(steps), 10 ** (1 / 20)), rel=0.02)


@pytest.mark.parametrize("grade", [1, 2])
def test_thicker_wires_have_more_enamel_but_a_smaller_share_of_it(grade):
    """Monotone to the rounding of a micrometre."""
    build, diameter = builds(grade), np.array(DIAMETERS)
    assert np.all(np.diff(build) > -0.5e-6)
    assert np.all(build[1:] - 1e-6 < build[:-1] * diameter[1:] / diameter[:-1])


def test_grade_2_has_more_enamel_up_to_twice_that_of_grade_1():
    ratio = builds(2) / builds(1)
    assert np.all((1.4 < ratio) & (ratio < 2.0))


def test_known_sizes():
    """A maker's table has 0.117 mm for 0.1 mm of grade 1; the thesis has 44 um on its 0.5 mm."""
    assert gauge(0.1 * MILLIMETRE, 1).outer_diameter == pytest.approx(0.117e-3)
    assert gauge(0.5 * MILLIMETRE, 1).outer_diameter - 0.5e-3 == pytest.approx(44e-6)


def test_what_is_not_sold_is_refused_with_its_neighbours():
    with pytest.raises(MaterialError, match="take 0.5 or 0.56 mm"):
        gauge(0.52 * MILLIMETRE, 1)
    with pytest.raises(MaterialError, match="1 or 2"):
        gauge(0.5 * MILLIMETRE, 3)


def test_classes_rise_and_their_mean_stays_below_their_hottest_place():
    classes = [insulation_class(letter) for letter in LETTERS]
    assert [one.hottest for one in classes] == [105, 120, 130, 155, 180, 200]  # degC, the names of IEC 60085
    assert all(5 <= one.hottest - one.mean <= 15 for one in classes)
    assert np.all(np.diff([one.mean for one in classes]) > 0)
    with pytest.raises(MaterialError, match="A, E, B, F, H, N"):
        insulation_class("Z")
