"""What a fit by Gauss and Newton asks of the model, and where it ends."""

from dataclasses import dataclass, field, replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.special import logsumexp

from effects.base import DesignEffect
from effects.parameter import parameter
from effects.prior import Normal
from workbench.data.stack import Channel, Stack
from workbench.likelihood.fit import INEXACT, Problem, fitted, prior_cost
from workbench.likelihood.whitening import Course, Whitener

ROWS = 40
PLACES = np.linspace(-1.0, 1.0, ROWS)


@dataclass(frozen=True)
class Bent(DesignEffect):
    title = "a size"
    size: float = parameter(0.0, "1", prior=Normal(1.0), low=-10.0, high=10.0, source="made up")


@dataclass
class Readings:
    """Answers by a formula of x and the size; how often it was asked. No numerical error."""

    formula: object
    asked: int = 0
    shapes: np.ndarray = field(default_factory=lambda: np.zeros((ROWS, 0)))

    def predict(self, x, effects=()):
        self.asked += 1
        return self.formula(x[0], effects[0].size if effects else 0.0)


def problem(formula, true):
    predictor = Readings(formula)
    channels = (Channel("table.reading", 0, "reading", slice(0, ROWS), "1", 1.0),)
    stack = predictor.stack = Stack((), channels, formula(*true), np.full(ROWS, 1e-2), np.zeros((ROWS, 0)))
    white = Whitener(np.full(ROWS, 1e-2), Course.independent(ROWS))
    return Problem(predictor, stack, white, np.array([20.0]), np.zeros(1))


def fit(formula, true):
    asked = problem(formula, true)
    return fitted(asked, (Bent(),), np.zeros(1), np.zeros(1)), asked.predictor.asked


def test_a_linear_model_is_asked_eight_times():
    """Value, slopes by both, one step, a slope where it ends, and slopes by both once more: nothing is promised
    there, so that no other step is tried."""
    found, asked = fit(lambda x, size: x * PLACES + size * PLACES**2, (0.3, -0.8))
    assert_allclose((found.x[0], found.z[0]), (0.3, -0.8), atol=1e-3)
    assert asked <= 8


def test_a_model_bent_in_the_size_is_followed_to_its_maximum():
    found, asked = fit(lambda x, size: x * PLACES + np.exp(size * PLACES), (0.3, 1.4))
    assert_allclose((found.x[0], found.z[0]), (0.3, 1.4), atol=1e-3)
    assert asked <= 16


def test_a_fit_far_behind_what_leads_is_less_exact_by_no_more_than_a_share_of_that():
    ridge = lambda x, size: np.exp((x + size) * PLACES) + 0.05 * x * size * PLACES**2  # noqa: E731
    near, far = (replace(problem(ridge, (2.0, 1.0)), lead=lead) for lead in (np.inf, -1e3))
    exact, rough = (fitted(one, (Bent(),), np.zeros(1), np.zeros(1)) for one in (near, far))
    assert far.predictor.asked < near.predictor.asked
    assert 0.1 < rough.objective - exact.objective < INEXACT * 1e3


def test_a_model_bent_in_a_tolerance_gets_new_slopes_instead_of_short_steps():
    """With slopes of the drawing a step gains little of what it promises: they are taken anew where it ended."""
    found, asked = fit(lambda x, size: np.exp(2 * x * PLACES) + size * PLACES**2, (1.2, 0.5))
    assert_allclose((found.x[0], found.z[0]), (1.2, 0.5), atol=1e-3)
    assert asked <= 40


@dataclass(frozen=True)
class Limited(Bent):
    size: float = parameter(0.0, "1", prior=Normal(1.0), low=-0.5, high=0.5, source="made up")


@pytest.mark.parametrize("side", (1.0, -1.0))
@pytest.mark.parametrize("asked_for", (0.3, 0.498, 0.503, 0.52))
def test_what_is_not_possible_is_no_evidence(asked_for, side):
    """Inside, close to the end, and beyond it: against the integral over all that is possible, on a fine grid."""
    asked = problem(lambda x, size: x * PLACES + size * (PLACES + PLACES**2), (0.3, side * asked_for))
    found = fitted(asked, (Limited(),), np.zeros(1), np.zeros(1))
    assert_allclose(found.z, side * min(asked_for, 0.5), atol=1e-3)
    spread = np.sqrt(np.diag(found.covariance))
    step = spread[1] / 10
    sizes = np.arange(max(-0.5, found.z[0] - 8 * spread[1]), min(0.5, found.z[0] + 8 * spread[1]), step) + step / 2
    slope = found.covariance[0, 1] / found.covariance[1, 1]
    tolerances = 12 * spread[0] * np.linspace(-1.0, 1.0, 101)
    objective = [
        [asked.misfit(asked.residual(np.array([x]), (Limited(z),))) + x * x / 2 + prior_cost(np.array([z]))
         for x in found.x[0] + slope * (z - found.z[0]) + tolerances] for z in sizes
    ]  # fmt: skip
    cell = (tolerances[1] - tolerances[0]) * step
    assert found.log_evidence == pytest.approx(logsumexp(-np.array(objective)) + np.log(cell / (2 * np.pi)), abs=0.1)
