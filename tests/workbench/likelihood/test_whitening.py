"""Residuals turned into independent ones: channel by channel, and all at once."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from workbench.likelihood.whitening import Course, Whitener, law_error

SIZES = (7, 5, 9)


def channels():
    ends = np.cumsum((0, *SIZES))
    return [slice(int(a), int(b)) for a, b in zip(ends[:-1], ends[1:])]


@pytest.fixture
def white():
    """Correlated inside channels, not across, two laws in the first and one in the last."""
    random, (first, _, last) = np.random.default_rng(3), channels()
    rho = random.uniform(0.0, 0.8, sum(SIZES))
    rho[[rows.start for rows in channels()]] = 0.0
    floor = random.choice([0.0, 0.4], sum(SIZES))
    laws = [law_error(rows, random.standard_normal((rows.stop - rows.start, 3))) for rows in (first, last, first)]
    return Whitener(random.uniform(0.5, 2.0, sum(SIZES)), Course(rho, floor), tuple(laws))


@pytest.mark.parametrize("which", [(0,), (1,), (2,), (0, 2), (2, 0)])
def test_some_channels_alone_are_whitened_as_among_all(white, which):
    rows = np.concatenate([np.arange(sum(SIZES))[channels()[k]] for k in which])
    residual = np.random.default_rng(4).standard_normal((sum(SIZES), 2))
    assert_allclose(white.of(rows)(residual[rows]), white(residual)[rows], rtol=1e-12, atol=1e-12)


def test_a_law_is_integrated_out(white):
    """The whitened rows have the identity as covariance, where the wrong shapes of a channel have weights of one."""
    random, rows = np.random.default_rng(5), channels()[1]
    wrong = np.zeros((sum(SIZES), 3))
    wrong[rows] = random.standard_normal((rows.stop - rows.start, 3))
    plain = Whitener(white.sigma, white.course)
    back = np.linalg.inv(plain(np.eye(sum(SIZES))))
    with_law = Whitener(white.sigma, white.course, (law_error(rows, plain(wrong)[rows]),))
    half = with_law(back @ back.T + wrong @ wrong.T)
    assert_allclose(with_law(half.T), np.eye(sum(SIZES)), atol=1e-9)


def test_errors_of_laws_that_are_none_are_left_out(white):
    _, middle, last = channels()
    nothing = law_error(middle, np.zeros((middle.stop - middle.start, 2)))
    further = law_error(last, np.ones((last.stop - last.start, 1)))
    found = white.with_laws([nothing, further])
    assert found.laws == (*white.laws, further)
    assert nothing.half_log_det == 0.0
    residual = np.random.default_rng(6).standard_normal(sum(SIZES))
    everything = Whitener(white.sigma, white.course, (*white.laws, nothing, further))
    assert_allclose(found(residual), everything(residual), rtol=1e-12)
