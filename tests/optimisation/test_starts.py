"""Weights of a polynomial through values at some places."""

import numpy as np
import pytest

from optimisation.starts import weights_at_origin

RANDOM = np.random.default_rng(7)
PLACES = RANDOM.uniform(-0.2, 0.2, (8, 2))


def quadratic(x):
    return 3.0 + x @ [0.5, -1.2] + x[:, 0] ** 2 - 4.0 * x[:, 0] * x[:, 1] + 2.0 * x[:, 1] ** 2


def linear(x):
    return 3.0 + x @ [0.5, -1.2]


@pytest.mark.parametrize(("count", "values"), ((8, quadratic), (4, linear), (3, linear)))
def test_polynomials_are_met(count, values):
    """Of as high an order as there are places for, at a place between them."""
    places = np.array([[0.1, 0.0], [-0.1, 0.02], [0.01, 0.1], [0.02, -0.1], [0.1, 0.11], [-0.1, -0.09], *PLACES[:2]])
    assert weights_at_origin(places[:count]) @ values(places[:count]) == pytest.approx(3.0, abs=1e-9)


def test_a_direction_without_differences_does_not_count():
    along = np.column_stack([[0.1, -0.1, 0.2], np.zeros(3)])
    assert weights_at_origin(along) @ quadratic(along) == pytest.approx(3.0, abs=1e-9)


@pytest.mark.parametrize("places", ([[0.1, 0.1]], [[0.1, 0.0], [0.11, 0.0]]))
def test_the_nearest_alone_where_a_polynomial_goes_too_far(places):
    assert weights_at_origin(np.array(places)).tolist() == np.eye(len(places))[0].tolist()
