"""The low-rank likelihood against the dense multivariate normal it stands for, on random small problems."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import multivariate_normal

from workbench.likelihood.gains import Gains
from workbench.likelihood.marginal import Carried, Catalogue, Term, Terms
from workbench.likelihood.whitening import law_error

ROWS = 13
CHANNELS = (slice(0, 6), slice(6, ROWS))


def problem(seed):
    """A background of two columns, terms of one, two and three, and two residuals."""
    random = np.random.default_rng(seed)
    draw = lambda *shape: random.standard_normal(shape)  # noqa: E731
    terms = tuple(Term(f"e{k}", draw(ROWS), draw(ROWS, k), 0.0, np.tile([-1e3, 1e3], (k, 1))) for k in (1, 2, 3, 1))
    return Catalogue(draw(ROWS, 2), Terms(terms, ROWS)), 3 * draw(ROWS, 2)


def dense(catalogue, chosen, residual):
    """ln p of the residual by the covariance of the whole, over that of the same rows of white noise at zero."""
    terms = [catalogue.terms[t] for t in chosen]
    columns = np.hstack([catalogue.background, *(t.columns for t in terms)])
    mean = sum((t.shift for t in terms), np.zeros(ROWS))
    covariance = np.eye(ROWS) + columns @ columns.T
    return multivariate_normal(mean, covariance).logpdf(residual) + 0.5 * ROWS * np.log(2 * np.pi)


@pytest.mark.parametrize("chosen", [(), (1,), (0, 2), (3, 1, 0), (0, 1, 2, 3)])
@pytest.mark.parametrize("seed", range(3))
def test_the_likelihood_of_any_set_is_that_of_its_covariance(seed, chosen):
    catalogue, residuals = problem(seed)
    found = catalogue.given(chosen).log_marginal(catalogue.readings(residuals)[1])
    assert found == pytest.approx(dense(catalogue, chosen, residuals[:, 1]), abs=1e-9)


@pytest.mark.parametrize("chosen", [(), (1,), (3, 2)])
def test_the_gain_of_one_term_more_is_a_difference_of_likelihoods(chosen):
    catalogue, residuals = problem(7)
    gains = catalogue.gains(chosen, catalogue.readings(residuals))[:, 0]
    for t in set(range(4)) - set(chosen):
        more = dense(catalogue, (*chosen, t), residuals[:, 0]) - dense(catalogue, chosen, residuals[:, 0])
        assert gains[t] == pytest.approx(more, abs=1e-9)


@pytest.mark.parametrize("chosen", [(), (1,)])
def test_gains_of_many_residuals_are_those_of_each(chosen):
    catalogue, residuals = problem(3)
    gains = catalogue.gains(chosen, catalogue.readings(residuals))
    for gain, residual in zip(gains[2], residuals.T):
        assert gain == pytest.approx(dense(catalogue, (*chosen, 2), residual) - dense(catalogue, chosen, residual))


def test_linear_algebra_ends_at_the_weights_of_ridge_regression():
    """With the errors of laws felt once by the terms, as the background feels them already."""
    catalogue, residuals = problem(5)
    random = np.random.default_rng(5)
    laws = tuple(law_error(rows, random.standard_normal((rows.stop - rows.start, 2))) for rows in CHANNELS)
    catalogue = replace(catalogue, laws=laws)
    felt = lambda z: np.concatenate([law.apply(z[law.rows]) for law in laws])  # noqa: E731
    chosen = (2, 0)
    terms = [catalogue.terms[t] for t in chosen]
    x = np.hstack([catalogue.background, *(felt(t.columns) for t in terms)])
    left = residuals[:, 0] - felt(terms[0].shift) - felt(terms[1].shift)
    augmented, target = np.vstack([x, np.eye(x.shape[1])]), np.r_[left, np.zeros(x.shape[1])]
    ridge = np.linalg.lstsq(augmented, target, rcond=None)[0]
    gains = Gains(None, None, residuals[:, 0], catalogue)
    found = gains.end(chosen)
    assert np.allclose(np.r_[gains.of_background(found, found.weights), found.weights], ridge, atol=1e-10)
    assert found.least == pytest.approx(0.5 * np.sum((target - augmented @ ridge) ** 2), abs=1e-9)
    marginal = catalogue.given(chosen).log_marginal(catalogue.readings(residuals)[0])
    assert -found.least - found.spread == pytest.approx(marginal, abs=1e-9)


@pytest.mark.parametrize("seed", range(8))
def test_columns_a_hundred_million_deviations_long_leave_no_less_than_nothing(seed):
    """Beside others that do the same, so that all but round-off is taken from them."""
    catalogue, residuals = problem(seed)
    one, two, *others = catalogue.terms
    long = replace(one, columns=1e8 * one.columns)
    again = replace(two, columns=np.column_stack([long.columns, long.columns * (1 + 1e-9)]))
    catalogue = replace(catalogue, whole=Terms((long, again, *others), ROWS))
    assert np.isfinite(catalogue.gains((0,), catalogue.readings(residuals))).all()
    assert np.isfinite(Gains(None, None, residuals[:, 0], catalogue).end((0, 1)).least)


def test_a_background_of_nothing_is_no_hindrance():
    catalogue, residuals = problem(1)
    bare = Catalogue(np.zeros((ROWS, 0)), catalogue.whole)
    found = bare.given((1,)).log_marginal(bare.readings(residuals)[0])
    assert found == pytest.approx(dense(bare, (1,), residuals[:, 0]), abs=1e-9)


def test_what_feels_the_errors_of_laws_is_as_if_it_were_whitened_with_them():
    """Two channels, each with an error of a law, and a term that is left out."""
    catalogue, residuals = problem(2)
    random = np.random.default_rng(2)
    laws = tuple(law_error(rows, random.standard_normal((rows.stop - rows.start, 3))) for rows in CHANNELS)
    felt = lambda z: np.concatenate([law.apply(z[law.rows]) for law in laws])  # noqa: E731
    left = [t for t in catalogue.terms if t.name != "e2"]
    whitened = tuple(replace(t, shift=felt(t.shift), columns=felt(t.columns)) for t in left)
    other = Catalogue(catalogue.background, Terms(whitened, ROWS))
    found = Catalogue(catalogue.background, catalogue.whole, laws, frozenset(("e2",)))
    every = np.arange(other.first[-1])
    assert np.allclose(found.products(every), other.products(every), atol=1e-10)
    assert all(np.allclose(found.blocks[k], other.blocks[k], atol=1e-10) for k in other.blocks)
    for one, same in zip(found.readings(residuals), other.readings(residuals)):
        assert np.allclose(one.on, same.on, atol=1e-10) and one.square == same.square
    without = Catalogue(catalogue.background, Terms(tuple(left), ROWS))
    assert np.abs(found.products(every) - without.products(every)).max() > 0.5


def test_terms_of_another_place_are_as_if_they_were_made_beside_the_background():
    """Their columns with the share of tolerances in each changed, an error of a law besides, and a term left out."""
    catalogue, residuals = problem(4)
    random = np.random.default_rng(4)
    carried = Carried(random.standard_normal((ROWS, 2)), random.standard_normal((2, catalogue.first[-1])))
    moved = carried.change @ carried.shares
    there = tuple(
        replace(t, shift=t.shift + moved[:, k], columns=t.columns + moved[:, k + 1 : k + 1 + t.columns.shape[1]])
        for t, k in zip(catalogue.terms, catalogue.first)
    )
    laws = tuple(law_error(rows, random.standard_normal((rows.stop - rows.start, 3))) for rows in CHANNELS)
    other = Catalogue(catalogue.background, Terms(there, ROWS), laws, frozenset(("e2",)))
    found = Catalogue(catalogue.background, catalogue.whole, laws, frozenset(("e2",)), carried)
    every = np.arange(other.first[-1])
    assert np.allclose(found.products(every), other.products(every), atol=1e-10)
    assert all(np.allclose(found.blocks[k], other.blocks[k], atol=1e-10) for k in other.blocks)
    assert np.allclose(found.readings(residuals)[0].on, other.readings(residuals)[0].on, atol=1e-10)
    assert np.allclose(found.felt(2), other.felt(2), atol=1e-12)
    bare = Catalogue(catalogue.background, catalogue.whole, laws, frozenset(("e2",)))
    assert np.abs(found.products(every) - bare.products(every)).max() > 0.5
