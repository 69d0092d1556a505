"""Bicubic splines looked up by compiled code, against scipy's, which follow de Boor's recurrence."""

import numpy as np
from numpy.testing import assert_allclose
from scipy.interpolate import RectBivariateSpline

from electrical.bicubic import Bicubics

X, Y = np.array([-80.0, -55.0, -30.0, -12.0, 0.0]), np.linspace(-70.0, 70.0, 12) ** 3 / 70.0**2
POINTS = (np.sin(X[:, None] / 50) * np.cos(Y / 70), np.exp(X[:, None] / 60) * Y, X[:, None] ** 2 + Y)
FUNCTIONS = Bicubics.through(X, Y, POINTS)
SCIPY = [RectBivariateSpline(X, Y, one, s=0) for one in POINTS]
INSIDE = np.random.default_rng(1).uniform((X[0], Y[0]), (X[-1], Y[-1]), (500, 2)).T


def test_values_and_slopes_are_those_of_scipy():
    assert_allclose(FUNCTIONS(*INSIDE), [one.ev(*INSIDE) for one in SCIPY], rtol=1e-12, atol=1e-12)
    along = [[one.ev(*INSIDE, dx=1), one.ev(*INSIDE, dy=1)] for one in SCIPY]
    assert_allclose(FUNCTIONS.slopes(*INSIDE), along, rtol=1e-10, atol=1e-10)


def test_the_points_themselves():
    assert_allclose(FUNCTIONS(*np.meshgrid(X, Y, indexing="ij")), POINTS, rtol=1e-13, atol=1e-13)


def test_beyond_the_grid_they_are_what_they_are_at_its_edge():
    assert_allclose(FUNCTIONS([-90.0, 3.0], [-75.0, 80.0]), FUNCTIONS([-80.0, 0.0], [-70.0, 70.0]), rtol=0)


def test_nothing_is_nothing():
    assert np.isnan(FUNCTIONS(np.nan, 1.0)).all() and np.isnan(FUNCTIONS.slopes(-1.0, np.nan)).all()


def test_shapes_broadcast():
    assert FUNCTIONS(np.zeros((3, 1)), np.zeros(4)).shape == (3, 3, 4)
    assert FUNCTIONS.slopes(np.zeros((3, 1)), np.zeros(4)).shape == (3, 2, 3, 4)
