"""What a campaign taught is kept whole: effects, fitted inputs, covariance, and where it was learned."""

from dataclasses import replace

import numpy as np
import pytest

from effects.library import package_effects
from tests.workbench.toy_bench import LIBRARY, Bump, Hardening, Spring, SpringModel, written
from workbench.data.campaign import read_campaign
from workbench.errors import WorkbenchError
from workbench.ledger.learned import learned_from, outside, span
from workbench.ledger.model_file import learned_text, read_model, with_effects_of, write_model
from workbench.likelihood.bench import bench_of
from workbench.models.model import Model

NOMINAL = Model(SpringModel(), Spring(1000.0))


@pytest.fixture(scope="module")
def bench(tmp_path_factory):
    campaign = read_campaign(written(tmp_path_factory.mktemp("c"), lambda x: 2e5 * x**3, stiffness=1012.0))
    return bench_of(NOMINAL + Hardening(1.5e5), campaign, LIBRARY)


@pytest.fixture(scope="module")
def learned(bench):
    return learned_from(bench)


def test_the_fitted_values_stand_in_si(learned):
    """Those of the truth within three of their own standard deviations, none of which is wide."""
    (stiffness,), (zero,), (hardening,) = learned.inputs, learned.calibrations, learned.effects
    found, sd = np.array([stiffness.shift, zero.shift, hardening.cubic]), np.sqrt(np.diag(learned.covariance))
    assert np.abs((found - [0.012, 0.01, 2e5]) / sd).max() < 3 and hardening.cubic != 1.5e5
    assert (sd < [0.006, 0.012, 1e5]).all()


def test_the_covariance_is_that_of_least_squares(learned, bench):
    """F = k x + c x^3 + o with normal noise, an offset and a slope of the scan as far as two scans leave them open, and
    normal priors of k and o; c is free over its broad prior."""
    assert learned.names == ("stiffness", "force_offset", "hardening.cubic")
    x = bench.fit.stack.tables[0].conditions["displacement"]
    slopes = np.column_stack([1000.0 * x, np.ones_like(x), x**3])
    line, off = np.column_stack([np.ones_like(x), x / np.sqrt(np.mean(x**2))]), bench.noise.channels[0].scans
    noise = 0.05**2 * (np.eye(len(x)) + off**2 * line @ line.T)
    information = slopes.T @ np.linalg.solve(noise, slopes) + np.diag([0.01**-2, 0.02**-2, 0.0])
    assert off < 0.2, "no scan was moved"
    expected, found = np.linalg.inv(information), learned.covariance
    sd = np.sqrt(np.diag(expected))
    assert np.sqrt(np.diag(found)) == pytest.approx(sd, rel=0.35), "the size of the noise is measured"
    assert found[0, 2] / np.sqrt(found[0, 0] * found[2, 2]) == pytest.approx(expected[0, 2] / sd[0] / sd[2], abs=0.1)


def test_where_it_was_learned(learned, bench):
    (where,) = learned.source.ranges
    assert (where.kind, where.response, where.rows) == ("generic", "force", bench.fit.stack.size)
    assert where.conditions == {"displacement": (-0.01, 0.01)} and 0.5 < where.chi2_per_n < 1.6
    assert learned.source.campaign == "spring" and set(learned.source.data_sha256) == {"pull.csv"}


def test_what_is_read_is_what_was_written(learned, tmp_path):
    write_model(tmp_path / "m.toml", learned)
    again = read_model(tmp_path / "m.toml", LIBRARY)
    assert (again.inputs, again.calibrations, again.effects) == (learned.inputs, learned.calibrations, learned.effects)
    assert again.device == {"stiffness_N_per_m": 1000.0} and again.source.data_sha256 == learned.source.data_sha256
    assert again.covariance == pytest.approx(learned.covariance, rel=1e-8)
    assert learned_text(again) == learned_text(learned)


def test_a_file_of_before_is_read(learned, tmp_path):
    (tmp_path / "old.toml").write_text('[model]\nbase = "spring"\n[[effect]]\nname = "bump"\nsize = 0.5\n')
    old = read_model(tmp_path / "old.toml", LIBRARY)
    assert old.effects == (Bump(0.5),) and old.source is None and old.inputs == ()
    assert with_effects_of(tmp_path / "old.toml", NOMINAL, LIBRARY).effects == (Bump(0.5),)


def test_texts_lists_and_odd_keys_of_a_device_come_back(learned, tmp_path):
    device = {"note": 'a "b"\n\\ c', "coils": [[0, 1], [2, 3]], "a key": {"b": True, "c": 1e-7}}
    odd = replace(learned, device=device, source=None, covariance=np.zeros((0, 0)))
    write_model(tmp_path / "m.toml", odd)
    assert read_model(tmp_path / "m.toml", LIBRARY).device == device


@pytest.mark.parametrize(
    "old, new, says",
    [
        ("stiffness_N_per_m = 1000.0", "stiffness_N_per_m = 1001.0", r"\[device\] is not the one"),
        ('names = ["stiffness"', 'names = ["stifness"', "names must be stiffness"),
        ("  [", "  [1.0, ", "must be 3 rows of 3"),
        ("  [", "  [-", "no covariance"),
        ("sigma = 0.01", "sigma = -0.01", r"input.1.sigma = -0.01 cannot be used: input should be greater than 0"),
        ("sigma = 0.01", 'sigma = "0.01"', r"input.1.sigma = 0.01 cannot be used: input should be a valid number"),
        ("sigma = 0.01", "sigma = nan", "cannot be used: input should be a finite number"),
        ("relative = true", "relativ = true", "input.1.relative is missing"),
        ("rows = 60", "rows = 60\nlow = 3", r"learned.range.1.low is no key"),
        ("[-0.01, 0.01]", "[-0.01]", "at least 2 items"),
        ('kind = "offset"', 'kind = "ofset"', "calibration.1.kind = ofset cannot be used"),
        ("[covariance]", "[covarianc]", "covarianc is no key"),
        ("[[effect]]", '[[effect]]\nname = "hardening"\ncubic = 1.0\n\n[[effect]]', "'hardening' stands there twice"),
    ],
)  # fmt: skip
def test_a_wrong_file_is_refused_in_one_sentence(learned, tmp_path, old, new, says):
    text = learned_text(learned)
    assert old in text
    (tmp_path / "m.toml").write_text(text.replace(old, new, 1))
    with pytest.raises(WorkbenchError, match=says) as refused:
        read_model(tmp_path / "m.toml", LIBRARY)
    assert "\n" not in str(refused.value)


def test_without_its_covariance_a_file_is_refused(learned, tmp_path):
    text = learned_text(learned)
    (tmp_path / "m.toml").write_text(text[: text.index("[covariance]")])
    with pytest.raises(WorkbenchError, match="have no uncertainty"):
        read_model(tmp_path / "m.toml", LIBRARY)


def test_an_angle_range_is_the_shortest_arc():
    degrees = np.radians([350.0, 355.0, 0.0, 10.0])
    low, high = span("angle_mech", degrees)
    assert np.degrees([low, high]) == pytest.approx([350.0, 370.0])
    out = outside("angle_mech", np.radians([-5.0, 5.0, 365.0, 20.0, 180.0]), (low, high))
    assert out.tolist() == [False, False, False, False, True] or out.tolist() == [False, False, False, True, True]


def test_a_full_turn_has_no_outside():
    around = np.radians(np.arange(0.3, 360.0, 2.25))
    assert not outside("angle_mech", np.radians(np.linspace(-400.0, 800.0, 999)), span("angle_mech", around)).any()


def test_a_setting_read_a_little_differently_is_not_outside():
    learned = span("speed", np.array([100.0, 500.0]))
    assert outside("speed", np.array([99.0, 501.0, 520.0, -100.0]), learned).tolist() == [False, False, True, True]
    assert outside("magnet_T", np.array([27.0, 60.0]), (25.0, 25.0)).tolist() == [False, True]


def test_the_form_of_an_effect_is_of_its_kind(tmp_path):
    text = '[model]\nbase = "damper"\n[[effect]]\nname = "sensor_lag"\nlag = 1e-4\npoles = 4\n'
    (tmp_path / "m.toml").write_text(text)
    (lag,) = read_model(tmp_path / "m.toml", package_effects()).effects
    assert (lag.lag, lag.poles) == (1e-4, 4)
    (tmp_path / "m.toml").write_text(text.replace("poles = 4", 'poles = "four"'))
    with pytest.raises(WorkbenchError, match="sensor_lag.poles must be of the kind of 1, found 'four'"):
        read_model(tmp_path / "m.toml", package_effects())
