"""The restricted likelihood of what repeats disagree by: against dense matrices, and where moments go wrong."""

from dataclasses import replace

import numpy as np
import pytest

from workbench.likelihood.restricted import (
    COURSES,
    DECLARED_WEIGHT,
    SPREADS,
    Repeated,
    Size,
    _likelihood,
    sizes_of,
)


def shapes(repeats, rows):
    """Offset and slope of every scan, of rms 1 (rows of all, 2 repeats)."""
    line = np.column_stack([np.ones(rows), np.linspace(-1, 1, rows)])
    return np.kron(np.eye(repeats), line / np.sqrt(np.mean(line**2, axis=0)))


def channel(repeats, rows, rho=0.0, off=0.0, seed=0, shuffled=False, floor=0.0):
    """Noise of size one about stations of any value, every repeat a scan that is off by an offset and a slope."""
    random = np.random.default_rng(seed)
    fresh = random.standard_normal((repeats, rows))
    for k in range(1, rows):
        fresh[:, k] = rho * fresh[:, k - 1] + np.sqrt(1 - rho**2) * fresh[:, k]
    fresh = np.sqrt(1 - floor) * fresh + np.sqrt(floor) * random.standard_normal(fresh.shape)
    form = shapes(repeats, rows)
    values = fresh.ravel() + off * form @ random.standard_normal(2 * repeats)
    order = [random.permutation(rows) if shuffled else np.arange(rows) for _ in range(repeats)]
    station = np.concatenate(order)
    follows = np.tile(np.arange(rows) > 0, repeats)
    return Repeated(values + 100 * random.standard_normal(rows)[station], station, follows, form)


@pytest.mark.parametrize("shuffled", [False, True])
@pytest.mark.parametrize("c, t", [(3, 0), (8, 6), (20, 11), (30, 0), (38, 6), (48, 11)])
def test_it_is_that_of_dense_matrices(shuffled, c, t):
    """ln p with the values of the stations projected out, by covariance and inverse, one row of a scan lost."""
    one = channel(3, 12, 0.4, 1.0, shuffled=shuffled)
    follows = one.follows & (np.arange(36) != 17)
    one = Repeated(one.values, one.station, follows, one.shapes)
    chain, lag = np.cumsum(~follows), np.abs(np.subtract.outer(np.arange(36), np.arange(36)))
    rho, floor = COURSES[c]
    covariance = np.where(chain[:, None] == chain, (1 - floor) * rho**lag, 0.0) + floor * np.eye(36)
    covariance = covariance + SPREADS[t] ** 2 * one.shapes @ one.shapes.T
    inverse, places = np.linalg.inv(covariance), np.eye(12)[one.station]
    within = places.T @ inverse @ places
    left = inverse - inverse @ places @ np.linalg.solve(within, places.T @ inverse)
    square = DECLARED_WEIGHT + one.values @ left @ one.values
    log_det = np.linalg.slogdet(covariance)[1] + np.linalg.slogdet(within)[1]
    found = _likelihood(one)
    assert found.log_p[c, t] == pytest.approx(-0.5 * ((DECLARED_WEIGHT + 24) * np.log(square) + log_det), abs=1e-6)
    assert found.variance[c, t] == pytest.approx(square / (DECLARED_WEIGHT + 24), rel=1e-8)


def test_short_scans_tell_the_correlation_without_bias():
    """Ten rows less a line have a correlation of neighbours 0.3 below the true one."""
    benches = [[channel(3, 10, 0.45, 1.5, seed * 8 + k) for k in range(8)] for seed in range(60)]
    found = [one.neighbours for bench in benches for one in sizes_of(bench)]
    assert np.mean(found) == pytest.approx(0.45, abs=0.04)  # three standard errors of 60 benches


def test_what_wanders_is_told_from_its_floor():
    """As one AR(1) noise the same readings would have a correlation of 0.4 to 0.5, and nothing left after four."""
    found = sizes_of([channel(3, 400, 0.85, 0.0, seed, floor=0.5) for seed in range(4)])
    assert np.mean([one.rho for one in found]) == pytest.approx(0.85, abs=0.05)
    assert np.mean([one.floor for one in found]) == pytest.approx(0.5, abs=0.08)


def test_noise_that_wanders_as_a_whole_has_no_floor():
    found = sizes_of([channel(3, 400, 0.85, 0.0, seed) for seed in range(4)])
    assert np.mean([one.rho for one in found]) == pytest.approx(0.85, abs=0.04)
    assert max(one.floor for one in found) < 0.05


def test_the_mean_of_a_scan_is_as_uncertain_as_repeats_let_expect():
    """The variance of a long mean is 1 + 2 (1 - w) rho / (1 - rho) of that of independent readings; at the means of rho
    and w it comes out at half of that in most benches of three repeats."""
    every = (channel(3, 40, 0.9, 0.0, seed, floor=0.7) for seed in range(180))
    free = [replace(one, shapes=np.zeros((len(one.values), 0))) for one in every]
    found = [one for k in range(60) for one in sizes_of(free[3 * k : 3 * k + 3])]
    means = [one.scale**2 * (1 + 2 * one.neighbours / (1 - one.rho)) for one in found]
    assert np.median(means) == pytest.approx(1 + 2 * 0.3 * 0.9 / 0.1, rel=0.2)
    assert 0 <= min(one.floor for one in found) and max(one.rho for one in found) < 1


def test_a_spread_that_few_scans_hardly_show_is_not_taken_for_none():
    """Two scans of four channels, off by half their noise: drift and offset would be told from zero by 0 / 0."""
    benches = [[channel(2, 40, 0.4, 0.5, seed * 8 + k) for k in range(4)] for seed in range(40)]
    found = np.array([one.scans for bench in benches for one in sizes_of(bench)])
    assert found.min() > 0.05 and np.median(found) == pytest.approx(0.5, abs=0.15)


def test_a_channel_without_repeats_takes_what_the_others_have_in_common():
    alone = channel(1, 20)
    others = [channel(3, 60, 0.6, 1.0, seed) for seed in range(4)]
    *known, found = sizes_of([*others, alone])
    assert found.scale == 1.0 and found.neighbours == pytest.approx(np.mean([k.neighbours for k in known]), abs=0.06)


def test_where_nothing_was_repeated_all_is_as_declared():
    assert sizes_of([channel(1, 20), channel(1, 5)]) == [Size(1.0, 0.0, 0.0, 0.0)] * 2
