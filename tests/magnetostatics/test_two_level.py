"""Steps of quadratic elements over the tangent of linear ones: against the direct factor, and when it is renewed."""

from __future__ import annotations

from math import sqrt

import numpy as np
import pytest
from numpy.testing import assert_allclose

from magnetostatics import model as of_models
from magnetostatics.cholesky import SymmetricSystem
from magnetostatics.model import OperatingPoint
from magnetostatics.newton import NewtonSettings
from magnetostatics.two_level import Lower, response
from tests.magnetostatics.reference_machine import model_of, reference_machine
from units import DEGREE

POINT = OperatingPoint(-20.7 * DEGREE, 6e6 * sqrt(2))
OTHER = OperatingPoint(0.0, 40e6 * sqrt(2))


class Seen:
    """What ``response`` is given, and how many iterations it takes."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.calls: list[tuple] = []
        self.iterations: list[int] = []
        monkeypatch.setattr(of_models, "response", self.watched)

    def watched(self, *given: object) -> tuple[np.ndarray, int]:
        found = response(*given)
        self.calls.append(given)
        self.iterations.append(found[1])
        return found


@pytest.fixture
def seen(monkeypatch):
    return Seen(monkeypatch)


def direct(matrix: Lower) -> SymmetricSystem:
    columns = np.repeat(np.arange(len(matrix.starts) - 1), np.diff(matrix.starts.astype(int)))
    system = SymmetricSystem(matrix.rows.astype(int), columns, len(matrix.starts) - 1)
    system.factorise(matrix.values)
    return system


@pytest.fixture
def last(seen):
    """Matrix, refinement, coarse factor and load of the last step at the reference machine's operating point."""
    model_of(reference_machine()).solve(POINT)
    return seen.calls[-1][:4]


def test_answers_as_the_direct_factor(last):
    matrix, refinement, coarse, load = last
    exact = direct(matrix).solve(load)
    assert_allclose(response(matrix, refinement, coarse, load, 1e-12)[0], exact, atol=1e-10 * np.abs(exact).max())


@pytest.mark.parametrize("share", (1e-2, 1e-6, 1e-10))
def test_leaves_no_more_of_the_load_than_wanted(last, share):
    matrix, refinement, coarse, load = last
    found, iterations = response(matrix, refinement, coarse, load, share)
    assert np.linalg.norm(load - lower_times(matrix, found)) <= 1.001 * share * np.linalg.norm(load)
    assert iterations <= 2 + np.log(share) / np.log(0.4)


def test_a_load_of_zero_is_answered_with_zero(last):
    matrix, refinement, coarse, load = last
    found, iterations = response(matrix, refinement, coarse, 0.0 * load, 1e-3)
    assert iterations == 0
    assert_allclose(found, 0.0, atol=0.0)


def test_the_coarse_matrix_is_the_fine_one_on_linear_functions(seen, monkeypatch):
    """P^T K P is what is factorised below where both are taken at one field."""
    monkeypatch.setattr(of_models, "_FEW", 0)  # renewed before every step but the first
    model_of(reference_machine()).solve(POINT)
    matrix, refinement, coarse, load = seen.calls[-1][:4]
    nodes = len(load) - refinement.ends.shape[1]
    some = np.random.default_rng(3).standard_normal(nodes)
    ends = refinement.shares * some[refinement.ends]
    fine = lower_times(matrix, np.append(some, ends.sum(axis=0)))
    below = fine[:nodes].copy()
    np.add.at(below, refinement.ends, refinement.shares * fine[nodes:])
    assert_allclose(coarse.solve(below), some, atol=1e-9 * np.abs(some).max())


def lower_times(matrix: Lower, x: np.ndarray) -> np.ndarray:
    """K x of the symmetric matrix."""
    columns = np.repeat(np.arange(len(x)), np.diff(matrix.starts.astype(int)))
    below = matrix.rows != columns
    product = np.bincount(matrix.rows, matrix.values * x[columns], len(x))
    return product + np.bincount(columns[below], (matrix.values * x[matrix.rows])[below], len(x))


def test_few_iterations_a_step(seen):
    """Rough where the step is long, and never many."""
    model = model_of(reference_machine())
    model.solve(POINT)
    assert len(seen.iterations) <= 4
    assert max(seen.iterations) <= 8


def test_a_tangent_from_another_field_is_renewed(seen, monkeypatch):
    """From the field at another place and nearly seven times the current, down to the last digits."""
    model = model_of(reference_machine(), settings=NewtonSettings(tolerance=1e-10))
    start = model.solve(POINT)

    def iterations() -> int:
        before = len(seen.iterations)
        model.solve(OTHER, start)
        return sum(seen.iterations[before:])

    renewed = iterations()
    monkeypatch.setattr(of_models, "_FEW", 1000)
    assert renewed < 0.9 * iterations()


def test_a_matrix_that_is_not_positive_definite_is_told(last):
    matrix, refinement, coarse, load = last
    with pytest.raises(ArithmeticError, match="not positive definite"):
        response(Lower(matrix.starts, matrix.rows, -matrix.values), refinement, coarse, load, 1e-6)
