"""Regions left out, against fits that were really made without them."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.stats import multivariate_normal

from tests.workbench.likelihood.tables import table, whitened
from workbench.ledger.step import ACCEPTED, REFUSED, decide
from workbench.likelihood.fit import Problem, fitted
from workbench.likelihood.prediction import predicted, regions

ROWS = 60
SPEED = np.linspace(0.1, 6.0, ROWS)


class Linear:
    """Readings that are linear in the nuisances, shapes (n, m)."""

    def __init__(self, stack, slopes):
        self.stack, self.slopes, self.shapes = stack, slopes, np.zeros((len(slopes), 0))
        self.names, self.centre = tuple("abcdefgh"[: slopes.shape[1]]), np.zeros(slopes.shape[1])

    def predict(self, x, effects=()):
        return self.slopes @ x


def problem(slopes, y, dof=1e12, **conditions):
    stack, white = whitened(table({"force": y}, 0.5, **(conditions or {"speed": SPEED})))
    return Problem(Linear(stack, slopes), stack, white, np.array([dof]), np.zeros(slopes.shape[1]))


def of_polynomial(order, y):
    return problem(np.vander(SPEED / 6, order, increasing=True)[:, ::-1] * 2.0, y)


def readings(seed, extra=0.0):
    return 3 * SPEED / 6 + 0.5 * np.random.default_rng(seed).standard_normal(ROWS) + extra


def fit(one):
    return fitted(one, (), one.start, np.zeros(0))


@pytest.mark.parametrize("order", [1, 3])
def test_errors_are_those_of_fits_without_the_rows(order):
    one = of_polynomial(order, readings(1))
    found, squares, scores = predicted(one, fit(one)), 0.0, 0.0
    x, y = one.predictor.slopes / 0.5, one.stack.y / 0.5
    blocks = list(regions(one))
    for rows in blocks:
        rest = np.setdiff1d(np.arange(ROWS), rows)
        augmented = np.vstack([x[rest], np.eye(order)])
        weights = np.linalg.lstsq(augmented, np.r_[y[rest], np.zeros(order)], rcond=None)[0]
        squares += np.sum((y[rows] - x[rows] @ weights) ** 2)
        scores += multivariate_normal(np.zeros(ROWS), np.eye(ROWS) + x @ x.T).logpdf(y)
        scores -= multivariate_normal(np.zeros(len(rest)), np.eye(len(rest)) + x[rest] @ x[rest].T).logpdf(y[rest])
    assert (found.blocks, found.n) == (len(blocks), ROWS) and len(blocks) == 5
    assert found.chi2_per_n == pytest.approx(squares / ROWS, rel=1e-6)
    assert found.log_score == pytest.approx(scores + 0.5 * ROWS * np.log(2 * np.pi), abs=1e-6)


def test_every_row_is_left_out_once_with_all_its_channels():
    y = readings(2)
    stack, white = whitened(
        table({"force": y, "torque": y}, 0.5, speed=SPEED), table({"voltage": y}, 0.5, speed=SPEED, file="u.csv")
    )
    one = Problem(Linear(stack, np.ones((3 * ROWS, 1))), stack, white, np.ones(3), np.zeros(1))
    found = list(regions(one))
    assert sorted(np.concatenate(found)) == list(range(3 * ROWS))
    assert all(((rows + ROWS) % (2 * ROWS))[0] in rows for rows in found if rows[0] < ROWS)


def test_without_regions_nothing_is_predicted():
    turn = np.linspace(0, 6, ROWS)
    one = problem(np.ones((ROWS, 1)), readings(3), angle_mech=turn)
    assert predicted(one, fit(one)).blocks == 0


def bench(one):
    return SimpleNamespace(fit=one, null=fit(one))


def test_a_step_that_raises_the_error_of_prediction_is_refused():
    """A wave at the highest speeds: a free polynomial bends to it and errs by more where it was not fitted."""
    wave = np.where(SPEED > 4.5, 3 * np.sin(4 * SPEED), 0.0)
    plain, bent = (bench(of_polynomial(order, readings(4, wave))) for order in (2, 7))
    old, new = (predicted(b.fit, b.null).chi2_per_n for b in (plain, bent))
    assert new > old and np.mean(bent.null.residual**2) < np.mean(plain.null.residual**2)
    decision, words = decide(plain, bent, 50.0)
    assert decision == REFUSED and words.endswith("it rises") and f"{new:.3g}" in words
    assert decide(bent, plain, 50.0)[0] == ACCEPTED


def test_a_gain_below_the_base_rate_is_refused_and_chance_does_not_refuse():
    """Below what a model without a fault gives no rise says anything."""
    plain, more = (bench(of_polynomial(order, readings(5))) for order in (2, 3))
    old, new = (predicted(b.fit, b.null) for b in (plain, more))
    assert max(old.chi2_per_n, new.chi2_per_n) < min(old.without_fault, new.without_fault)
    assert old.chi2_per_n != new.chi2_per_n
    for before, after in ((plain, more), (more, plain)):
        assert decide(before, after, 0.8)[0] == ACCEPTED
        assert decide(before, after, -0.2)[0] == REFUSED


@pytest.mark.parametrize("order", [1, 4])
def test_a_model_without_a_fault_stays_below_its_level_in_nineteen_of_twenty(order):
    """Tolerances and noise drawn as they are declared."""
    random, shapes = np.random.default_rng(6), of_polynomial(order, readings(1)).predictor.slopes
    below = []
    for _ in range(800):
        drawn = shapes @ random.standard_normal(order) + 0.5 * random.standard_normal(ROWS)
        one = of_polynomial(order, drawn)
        found = predicted(one, fit(one))
        below.append(found.chi2_per_n < found.without_fault)
    assert np.mean(below) == pytest.approx(0.95, abs=0.023)  # three standard errors


@pytest.mark.parametrize("seed", [16, 17, 18])
def test_a_rise_that_the_uncertainty_of_the_size_lets_expect_refuses_nothing(seed):
    """A slope from some speed on, which the last but one region tells little of: draws where its error rises."""
    slope = 4.0 * np.maximum(SPEED - 4.2, 0.0)
    y = 0.5 * np.random.default_rng(seed).standard_normal(ROWS) + 0.15 * slope
    plain, more = (bench(problem(shapes, y)) for shapes in (np.zeros((ROWS, 1)), slope[:, None]))
    old, new = (predicted(b.fit, b.null) for b in (plain, more))
    assert max(old.chi2_per_n, old.without_fault) < new.chi2_per_n < new.without_fault
    assert decide(plain, more, 5.0)[0] == ACCEPTED


def test_what_stands_where_all_rows_have_put_it_is_not_known_where_a_region_is_left_out():
    """A step of 4 at the highest speeds, that nothing else tells of, as a tolerance of one about zero, and as a
    parameter of an effect that was fitted: it stands at 4, the centre of its prior lies four deviations below."""
    high, noise = np.zeros(ROWS), readings(6) - 3 * SPEED / 6
    *_, last = regions(of_polynomial(2, noise))
    high[last] = 1.0
    fresh, learned = problem(high[:, None], 4.0 * high + noise), problem(high[:, None], noise)
    assert predicted(learned, fit(learned)).chi2_per_n < 1.4, "as if zero, where it stands, were the centre"
    learned.predictor.centre = np.array([-4.0])
    old, new = (predicted(one, fit(one)).chi2_per_n for one in (fresh, learned))
    assert old > 5 and new == pytest.approx(old, rel=0.05)


def test_it_is_said_where_prediction_was_not_tested():
    turn = np.linspace(0, 6, ROWS)
    one = bench(problem(np.ones((ROWS, 1)), readings(3), angle_mech=turn))
    decision, words = decide(one, one, 50.0)
    assert decision == ACCEPTED and "was not tested" in words
