"""Noise that was put in is found again, and the whitener undoes exactly the covariance it is meant for."""

from dataclasses import replace

import numpy as np
import pytest

from tests.workbench.likelihood.tables import table
from tests.workbench.toy_bench import LIBRARY, SpringModel, written
from workbench.data.campaign import read_campaign
from workbench.data.repeats import matched_rows
from workbench.data.stack import part_of, rows_of, stacked, thinned
from workbench.likelihood.bench import bench_of
from workbench.likelihood.noise import MOST_SHUFFLED, ChannelNoise, Noise, measured_noise
from workbench.likelihood.whitening import Course, LawError, Whitener, whitener
from workbench.models.model import Model


def bench(folder):
    campaign = read_campaign(folder)
    return bench_of(Model(SpringModel(), SpringModel().design(campaign.device)), campaign, LIBRARY)


@pytest.mark.parametrize("repeats", [2, 3])
@pytest.mark.parametrize("scale, rho", [(1.0, 0.0), (1.7, 0.5), (0.6, 0.3)])
def test_size_and_correlation_are_found(tmp_path, scale, rho, repeats):
    found = bench(written(tmp_path, n=1300, scale=scale, rho=rho, seed=3, repeats=repeats)).noise.channels[0]
    assert found.scale == pytest.approx(scale, rel=0.06)  # three standard errors of 1300 correlated differences
    assert found.neighbours == pytest.approx(rho, abs=0.08)


def test_a_wrong_model_does_not_look_like_noise(tmp_path):
    quiet = bench(written(tmp_path / "a", n=400)).noise.channels[0]
    wrong = bench(written(tmp_path / "b", n=400, extra=lambda x: 50 * np.sin(3000 * x))).noise.channels[0]
    assert wrong.scale == pytest.approx(quiet.scale, rel=1e-5)  # readings are written to 1e-6


def test_a_wild_reading_counts_less_and_leaves_the_size_alone(tmp_path):
    folder = written(tmp_path, n=400)
    clean = bench(folder).noise.channels[0]
    lines = (folder / "pull.csv").read_text().splitlines()
    repeat, x, force = lines[50].split(",")
    lines[50] = f"{repeat},{x},{float(force) + 2.0}"  # 40 standard deviations
    (folder / "pull.csv").write_text("\n".join(lines))
    noise = bench(folder).noise
    assert noise.channels[0].scale == pytest.approx(clean.scale, rel=0.02)
    assert noise.inflation[49] > 8 and noise.channels[0].wild >= 1


def test_coarse_steps_of_a_converter_do_not_make_noise_vanish(tmp_path):
    folder = written(tmp_path, n=300, repeats=3, scale=0.8)
    lines = (folder / "pull.csv").read_text().splitlines()
    parts = [line.split(",") for line in lines[1:]]
    coarse = [f"{r},{x},{round(float(f) / 0.1) * 0.1:.3f}" for r, x, f in parts]
    (folder / "pull.csv").write_text("\n".join([lines[0], *coarse]))
    assert bench(folder).noise.channels[0].scale == pytest.approx(np.hypot(0.8, 0.1 / np.sqrt(12) / 0.05), rel=0.1)


@pytest.mark.parametrize("floor", [0.0, 0.4, 0.9])
def test_whitening_makes_wandering_noise_white_exactly(floor):
    n, rho, sigma = 6, 0.6, np.linspace(1, 3, 6)
    white = Whitener(sigma, Course(np.r_[0.0, np.full(n - 1, rho)], np.full(n, floor)))
    wanders = rho ** np.abs(np.subtract.outer(np.arange(n), np.arange(n)))
    covariance = np.outer(sigma, sigma) * ((1 - floor) * wanders + floor * np.eye(n))
    operator = white(np.eye(n))
    assert np.allclose(operator @ covariance @ operator.T, np.eye(n), atol=1e-12)


def test_the_error_of_a_law_is_whitened_exactly():
    random = np.random.default_rng(1)
    wrong = random.standard_normal((7, 3))
    directions, size, _ = np.linalg.svd(wrong, full_matrices=False)
    law = LawError(slice(0, 7), directions, size)
    operator = law.apply(np.eye(7))
    covariance = np.eye(7) + wrong @ wrong.T
    assert np.allclose(operator @ covariance @ operator.T, np.eye(7), atol=1e-12)
    assert law.half_log_det == pytest.approx(0.5 * np.linalg.slogdet(covariance)[1], rel=1e-12)


def test_repeats_are_matched_by_their_conditions_when_rows_are_lost(tmp_path):
    folder = written(tmp_path, n=50)
    lines = (folder / "pull.csv").read_text().splitlines()
    (folder / "pull.csv").write_text("\n".join(lines[:10] + lines[12:]))  # two rows of the first repeat are gone
    table = read_campaign(folder).tables[0]
    stations = matched_rows(table)
    x = table.conditions["displacement"]
    assert len(stations) >= 48 and np.allclose(x[stations[:, 0]], x[stations[:, 1]], atol=1e-12)


def test_thinning_does_not_keep_step_with_a_cycle(tmp_path):
    table = read_campaign(written(tmp_path, n=5000)).tables[0]
    few = thinned(table, 200)
    assert few.rows <= 200
    x = few.conditions["displacement"]
    rows = np.searchsorted(table.conditions["displacement"][:5000], x[few.repeat == 0])
    assert len(np.unique(rows % 5)) == 5
    assert np.array_equal(x[few.repeat == 0], x[few.repeat == 1])  # repeats can still be compared


# ---- scans, lost rows, logged temperatures ---------------------------------------------------------------------------


def scans(offset=0.0, slope=0.0, rho=0.0, repeats=40, rows=60, seed=0):
    """One channel of a model that answers zero; every repeat is a scan with an offset and a slope of its own."""
    random = np.random.default_rng(seed)
    error = random.standard_normal((repeats, rows))
    for k in range(1, rows):
        error[:, k] = rho * error[:, k - 1] + np.sqrt(1 - rho**2) * error[:, k]
    error += offset * random.standard_normal((repeats, 1))
    error += slope * random.standard_normal((repeats, 1)) * np.linspace(-0.5, 0.5, rows)
    number = np.repeat(np.arange(repeats), rows)
    place = np.tile(np.linspace(0, 1, rows), repeats)
    return stacked([table({"force": 0.2 * error.ravel()}, 0.2, number, number, displacement=place)])


def noise_of(stack):
    return measured_noise(stack, np.zeros(stack.size))


@pytest.mark.parametrize("offset, slope", [(2.0, 0.0), (0.0, 3.0), (1.0, 2.0)])
def test_what_a_scan_as_a_whole_is_off_by_is_found(offset, slope):
    found = noise_of(scans(offset, slope)).channels[0]
    common = np.sqrt((offset**2 + slope**2 / 12) / 2)  # of shapes of rms 1, a slope of one through a scan has 1/12
    assert found.scans == pytest.approx(common, rel=0.25)
    assert found.scale == pytest.approx(1.0, rel=0.05) and abs(found.neighbours) < 0.05


def test_the_next_scan_is_off_by_as_much_as_two_repeats_let_expect():
    """Four channels of two scans each, off by 1.5 of their noise; square of what the next one is off by, expected 1."""
    random, found = np.random.default_rng(2), []
    shapes = np.array([np.ones(40), np.sqrt(12) * np.linspace(-0.5, 0.5, 40)])
    for _ in range(100):
        off = 1.5 * random.standard_normal((4, 2, 2)) @ shapes
        number, place = np.repeat((0, 1), 40), np.tile(np.linspace(0, 1, 40), 2)
        errors = 0.2 * (off + random.standard_normal(off.shape)).reshape(4, 80)
        stack = stacked([table({"force": e}, 0.2, number, number, displacement=place) for e in errors])
        found += [1.5 / (channel.scans * channel.scale) for channel in noise_of(stack).channels]
    assert 0.9 < np.mean(np.square(found)) < 1.1


@pytest.mark.parametrize("rho", [0.0, 0.5])
def test_neighbours_that_go_together_are_no_remounting(rho):
    found = noise_of(scans(rho=rho)).channels[0]
    assert found.neighbours == pytest.approx(rho, abs=0.06)
    assert found.scans < 0.15


def test_of_repeats_in_random_order_some_are_asked():
    """Three times 2,000 places, each time in another order: all at once are a dense matrix of all places."""
    random, n = np.random.default_rng(4), 2000
    error = random.standard_normal((3, n))
    for k in range(1, n):
        error[:, k] = 0.5 * error[:, k - 1] + np.sqrt(0.75) * error[:, k]
    number, place = np.repeat((0, 1, 2), n), np.concatenate([random.permutation(n) for _ in range(3)]) / n
    stack = stacked([table({"force": 0.2 * error.ravel()}, 0.2, number, number, displacement=place)])
    found = noise_of(stack).channels[0]
    assert found.pairs == 2 * MOST_SHUFFLED
    assert found.scale == pytest.approx(1.0, rel=0.15)  # three standard errors of 500 correlated differences
    assert found.neighbours == pytest.approx(0.5, abs=0.15)


def test_whitening_knows_that_scans_are_off_as_a_whole():
    """Two scans, covariance by hand: independent noise, one reading wild, and an offset and a slope for each."""
    stack = scans(repeats=2, rows=7)
    wild = np.where(np.arange(14) == 3, 5.0, 1.0)
    noise = Noise((ChannelNoise(1.5, 0.0, 0.0, 0.8, "t.force", 20.0, 7, 0),), wild)
    operator = whitener(stack, noise)(np.eye(14))
    t = np.linspace(-0.5, 0.5, 7)
    one = 0.8**2 * (1 + np.outer(t, t) / np.mean(t**2))
    covariance = 0.3**2 * (np.diag(wild**2) + np.kron(np.eye(2), one))
    assert np.allclose(operator @ covariance @ operator.T, np.eye(14), atol=1e-10)


def test_whitening_knows_what_the_model_leaves_open():
    """One scan, covariance by hand: independent noise, and a wave of which the model says nothing."""
    stack = scans(repeats=1, rows=9)
    wave = 0.7 * np.cos(np.linspace(0, 3, 9))[:, None]
    noise = Noise((ChannelNoise(1.5, 0.0, 0.0, 0.0, "t.force", 20.0, 7, 0),), np.ones(9))
    operator = whitener(replace(stack, left_open=wave), noise)
    covariance = 0.3**2 * np.eye(9) + wave @ wave.T
    assert np.allclose(operator(np.eye(9)) @ covariance @ operator(np.eye(9)).T, np.eye(9), atol=1e-10)


def test_chosen_rows_keep_what_is_left_open_in_them():
    stack = scans(repeats=1, rows=9)
    stack = replace(stack, left_open=np.arange(18.0).reshape(9, 2))
    assert np.array_equal(part_of(stack, [np.arange(9) % 2 == 0]).left_open, stack.left_open[::2])


def resistances(lost=(), seed=0):
    """A damper at three shunts, one of them open, both ways; its temperature was logged, not set. Noise 1.8 N."""
    random = np.random.default_rng(seed)
    speed, shunt = (v.ravel() for v in np.meshgrid(np.linspace(-0.4, 0.4, 16), [0.3, 1.0, 1e6]))
    repeat = np.repeat([0, 1, 2], len(speed))
    speed, shunt = np.tile(speed, 3), np.tile(shunt, 3)
    force = 3600 * speed / (1.2 + shunt) + 20 * speed
    warm = 24 + 0.3 * random.standard_normal(len(speed))
    keep = ~np.isin(np.arange(len(speed)), lost)
    columns = {"velocity": speed[keep], "shunt": shunt[keep], "winding_T": warm[keep]}
    read = (force + 1.8 * random.standard_normal(len(speed)))[keep]
    return table({"force": read}, 1.8, repeat[keep], kind="damping_velocity", **columns), force[keep]


@pytest.mark.parametrize("lost", [(), (5,), (5, 60, 61)])
def test_a_lost_row_and_a_logged_temperature_do_not_inflate_the_noise(lost):
    """Rows matched to the wrong station would show forces that differ by hundreds of newtons."""
    one, _ = resistances(lost)
    stack = stacked([one])
    found = noise_of(stack).channels[0]  # of the readings themselves: no model levels the stations
    assert 1.8 * found.scale == pytest.approx(1.8, rel=0.2)
    assert found.pairs >= 2 * (48 - len(lost))


def test_an_open_circuit_leaves_the_other_shunts_apart():
    """1e6 ohm stands for open; 0.3 and 1 ohm stay two places, also where rows are lost."""
    one, _ = resistances(lost=(48 + 7,))  # of the second repeat, at 0.3 ohm
    stations = matched_rows(one)
    shunts = one.conditions["shunt"][stations]
    assert (shunts == shunts[:, :1]).all() and set(shunts[:, 0]) == {0.3, 1.0, 1e6}


def readings_of(errors):
    """Of a channel of the same ten stations in every repeat (repeats, 10), in u of 0.2, as a stack."""
    repeats, rows = errors.shape
    number, place = np.repeat(np.arange(repeats), rows), np.tile(np.linspace(0, 1, rows), repeats)
    return stacked([table({"force": 0.2 * errors.ravel()}, 0.2, number, number, displacement=place)])


def test_the_model_votes_which_of_two_readings_is_the_wild_one():
    errors = 0.1 * np.random.default_rng(1).standard_normal((2, 10))
    errors[1, 4] += 12.0
    found = noise_of(readings_of(errors)).inflation.reshape(2, 10)
    assert found[1, 4] > 3 and np.delete(found.ravel(), 14).max() < 1.5


def test_two_wild_readings_of_three_do_not_become_physics():
    errors = np.random.default_rng(2).standard_normal((3, 60))
    errors[1:, 20] = 4.5, 8.5
    stack = readings_of(errors)
    assert noise_of(stack).inflation.reshape(3, 60)[2, 20] > 2


def remounted(seed):
    """Two scans of 60 readings, every fifth known five times as well, the first scan 3 units off as a whole."""
    u = np.where(np.arange(60) % 5, 1.0, 0.2)
    errors = u * np.random.default_rng(seed).standard_normal((2, 60))
    errors[0] += 3.0
    return errors, np.tile(u, 2)


def in_two_scans(errors, u):
    number, place = np.repeat(np.arange(2), 60), np.tile(np.linspace(0, 1, 60), 2)
    return stacked([table({"force": errors.ravel()}, u, number, number, displacement=place)])


def test_an_offset_that_is_many_uncertainties_of_some_readings_makes_none_of_them_wild():
    found = noise_of(in_two_scans(*remounted(8)))
    assert found.inflation.max() < 1.5 and found.channels[0].wild == 0


@pytest.mark.parametrize("scan, wild", [(0, 2.5), (0, -2.5), (1, 2.5), (1, -2.5)])
def test_the_model_votes_on_scans_less_what_both_are_off_by(scan, wild):
    """Half of what the first is off by is common to both, 7 uncertainties of the readings that are known best."""
    errors, u = remounted(9)
    errors[scan, 20] += wild
    found = noise_of(in_two_scans(errors, u)).inflation
    assert np.argmax(found) == 60 * scan + 20 and found[60 * scan + 20] > 2
    assert np.delete(found, 60 * scan + 20).max() < 1.5


def test_what_all_repeats_show_is_not_wild():
    errors = np.random.default_rng(3).standard_normal((3, 60))
    errors[:, 20] += 10.0
    assert noise_of(readings_of(errors)).inflation.reshape(3, 60)[:, 20].max() < 1.5


def without(stack, *rows):
    """The stack without some rows of its one table, which were lost."""
    return stacked([rows_of(stack.tables[0], np.delete(np.arange(stack.size), rows))])


def test_a_reading_that_has_lost_a_partner_is_still_told_to_be_wild():
    errors = np.random.default_rng(4).standard_normal((3, 10))
    errors[2, 4] -= 14.0
    found = noise_of(without(readings_of(errors), 10 + 4)).inflation
    assert found[23] > 3 and np.delete(found, 23).max() < 1.5


def test_of_one_that_has_lost_all_partners_the_neighbours_tell():
    errors = np.random.default_rng(5).standard_normal((2, 10))
    errors[1, 4] += 12.0
    found = noise_of(without(readings_of(errors), 4)).inflation
    assert found[9 + 4] > 3 and np.delete(found, 9 + 4).max() < 1.5


@pytest.mark.parametrize("lost", (0, 4, 9))
def test_one_without_partners_that_reads_as_its_neighbours_do_is_not_wild(lost):
    """The model lacks 12 u in all of them."""
    errors = 12.0 + np.random.default_rng(6).standard_normal((2, 10))
    assert noise_of(without(readings_of(errors), lost)).inflation.max() < 1.5


def test_repeats_that_have_each_lost_another_row_are_not_out_of_step():
    """What the model lacks grows by 8 u a row: readings of neighbouring rows would look wild, or noisy."""
    errors = 0.5 * np.random.default_rng(7).standard_normal((2, 10)) + 8.0 * np.arange(10)
    stack = without(readings_of(errors), 3, 10 + 7)
    stations = matched_rows(stack.tables[0])
    place = stack.tables[0].conditions["displacement"]
    assert len(stations) == 8 and np.array_equal(place[stations[:, 0]], place[stations[:, 1]])
    assert noise_of(stack).channels[0].scale < 1.0
