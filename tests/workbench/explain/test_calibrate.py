"""Stated probabilities against how often they are true, in campaigns drawn from what is believed before the data."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.random import default_rng
from scipy.special import logsumexp
from scipy.stats import multivariate_t

from tests.workbench.toy_bench import LIBRARY, SpringModel, written
from workbench.believed import FALSE_ALARMS, LIKELY, NAMED, UNKNOWN_RATE
from workbench.data.campaign import read_campaign
from workbench.explain.calibrate import Simulated, Simulator, detection_limits, lowest, thresholds_of
from workbench.explain.explore import beliefs_of
from workbench.explain.verdict import verdict
from workbench.likelihood.bench import bench_of
from workbench.likelihood.noise import drawn_noise
from workbench.likelihood.signatures import candidates, signatures_of
from workbench.likelihood.unknown import SIZES, Beside, shapes_of
from workbench.models.model import Model

CAMPAIGNS = 500


def simulator_of(folder, seed=1, **more):
    campaign = read_campaign(written(folder, **more))
    bench = bench_of(Model(SpringModel(), SpringModel().design(campaign.device)), campaign, LIBRARY)
    signatures = signatures_of(bench, candidates(bench, LIBRARY))
    shapes = shapes_of(bench.fit.stack, bench.fit.white, bench.fit.predictor.predict(bench.null.x))
    return Simulator(bench, signatures, beliefs_of(LIBRARY, signatures.names), shapes, default_rng(seed))


@pytest.fixture(scope="module")
def simulator(tmp_path_factory):
    return simulator_of(tmp_path_factory.mktemp("c"), n=30)


@pytest.fixture(scope="module")
def campaigns(simulator):
    """Drawn as the beliefs say: each effect at its base rate, an unknown function beside nothing at its own."""
    random, found = default_rng(7), []
    while len(found) < CAMPAIGNS:
        truth = frozenset(n for n in simulator.names.order if random.random() < LIBRARY[n].base_rate)
        unknown = bool(random.random() < UNKNOWN_RATE)
        if (truth and unknown) or len(truth) > 2:  # simulated posteriors look at pairs, and at unknown functions alone
            continue
        jacobian = simulator.bench.centre.jacobian
        residual = jacobian @ random.standard_normal(jacobian.shape[1]) + random.standard_normal(len(jacobian))
        residual = residual + sum(simulator._effect(name) for name in truth)
        if unknown:
            residual = residual + drawn_function(simulator, random)
        readings = simulator.names.catalogue.readings(residual[:, None])[0]
        found.append(Simulated(readings, residual, truth, unknown))
    return found


def drawn_function(simulator, random):
    shares = np.exp([shape.log_prior for shape in simulator.shapes])
    shape = simulator.shapes[random.choice(len(shares), p=shares)]
    change = np.zeros(simulator.bench.fit.stack.size)
    change[shape.rows] = random.choice(SIZES) * shape.columns @ random.standard_normal(shape.columns.shape[1])
    return change


@pytest.fixture(scope="module")
def posteriors(simulator, campaigns):
    return simulator.posteriors(campaigns, 2)


def in_bins(stated, true):
    """Of every bin of stated probabilities: how many are true more than stated, in standard deviations."""
    stated, true = np.array(stated), np.array(true, dtype=float)
    bins = np.digitize(stated, [0.02, 0.1, 0.3, 0.7, 0.9, 0.98])
    return {
        k: (true[bins == k].sum() - stated[bins == k].sum())
        / np.sqrt(np.sum(stated[bins == k] * (1 - stated[bins == k])) + 0.25)
        for k in np.unique(bins)
    }


def test_effects_are_there_as_often_as_is_said(posteriors, campaigns):
    pairs = [(p.of(n), n in c.truth) for p, c in zip(posteriors, campaigns) for n in LIBRARY]
    off = in_bins(*zip(*pairs))
    assert len(off) == 7 and max(map(abs, off.values())) < 3.0, off


def test_nothing_is_missing_as_often_as_is_said(posteriors, campaigns):
    off = in_bins([p.nothing for p in posteriors], [not c.truth and not c.unknown for c in campaigns])
    assert len(off) >= 5 and max(map(abs, off.values())) < 3.0, off


def test_something_unknown_is_there_as_often_as_is_said(posteriors, campaigns):
    off = in_bins([p.remains for p in posteriors], [c.unknown for c in campaigns])
    assert len(off) >= 4 and max(map(abs, off.values())) < 3.0, off


def test_a_printed_sentence_is_true_as_often_as_its_probability(simulator, posteriors, campaigns):
    thresholds, _ = thresholds_of(simulator)
    said = [(verdict(p, thresholds, p.nothing), c) for p, c in zip(posteriors, campaigns)]
    named = [(v, c) for v, c in said if v.names]
    true = [bool(set(v.names) & c.truth) if v.kind == "group" else set(v.names) <= c.truth for v, c in named]
    stated = [v.probability for v, _ in named]
    assert len(named) > 50 and np.mean(true) >= 0.95
    spread = np.sqrt(np.sum(np.array(stated) * (1 - np.array(stated))) + 0.25)
    assert sum(true) - sum(stated) == pytest.approx(0.0, abs=3 * spread)


def test_thresholds_keep_false_alarms_and_false_names_rare(simulator):
    thresholds, power = thresholds_of(simulator)
    assert thresholds.sure >= NAMED and 0 < thresholds.quiet <= LIKELY and thresholds.can_tell
    assert power[10.0] >= power[3.0] > 0.0
    empty = simulator.posteriors(simulator.empty(1000), 1)
    alarms = np.mean([p.nothing < thresholds.quiet for p in empty])
    assert alarms <= FALSE_ALARMS + 3 * np.sqrt(FALSE_ALARMS / 1000) + 1 / 100  # the place among 100 is coarse


@pytest.mark.parametrize("count", (50, 100, 120, 175))
def test_a_new_value_falls_below_the_lowest_with_at_most_the_probability_asked_for(count):
    """Of values from one distribution: the place is counted over them and the new one together."""
    random = default_rng(3)
    below = [random.random() < lowest(list(random.random(count)), FALSE_ALARMS) for _ in range(20_000)]
    assert FALSE_ALARMS / 2 < np.mean(below) < FALSE_ALARMS + 3 * np.sqrt(FALSE_ALARMS / 20_000)


def test_ten_rows_see_less_than_sixty(tmp_path, simulator):
    few = simulator_of(tmp_path, n=5)
    assert thresholds_of(few)[1][3.0] < thresholds_of(simulator)[1][3.0]


def test_detection_limits_are_sizes_that_nine_of_ten_campaigns_show(simulator):
    """An offset at its limit raises an alarm in nine of ten campaigns, at a third of it in few."""
    thresholds, _ = thresholds_of(simulator)
    limit = next(d for d in detection_limits(simulator, thresholds) if d.name == "bump")
    bump, null = LIBRARY["bump"], simulator.bench.fit.residual(np.zeros(2))
    change = null - simulator.bench.fit.residual(np.zeros(2), (bump(abs(limit.value)),))
    seen = []
    for size in (1.0, 0.33):
        residuals = simulator.noise(300) + size * change[:, None]
        found = simulator.posteriors(simulator._as_simulated(residuals, [(frozenset(), False)] * 300), 1)
        seen.append(np.mean([p.nothing < thresholds.quiet for p in found]))
    assert 0.8 <= seen[0] <= 0.99 and seen[1] < 0.4


def test_the_same_seed_gives_the_same_thresholds(tmp_path):
    one, again, other = (thresholds_of(simulator_of(tmp_path / "c", seed, n=20)) for seed in (3, 3, 4))
    assert one == again and one != other


def test_noise_larger_than_expected_is_no_discovery(tmp_path):
    """ln p that unknown functions gain in campaigns that hide nothing, against dense Student densities: with a noise
    that 26 differences tell."""
    simulator = simulator_of(tmp_path, n=26)
    bench, count = simulator.bench, 400
    jacobian, random = bench.centre.jacobian, default_rng(5)
    tolerances = jacobian @ random.standard_normal((jacobian.shape[1], count))
    drawn = tolerances + drawn_noise(bench.fit.stack, bench.noise, random, count)
    null = np.eye(len(jacobian)) + jacobian @ jacobian.T

    def student(covariance):
        return multivariate_t(np.zeros(len(null)), covariance, df=bench.fit.dof[0]).logpdf(drawn.T)

    shares = [
        student(null + a * a * shape.columns @ shape.columns.T) + shape.log_prior - np.log(len(SIZES))
        for shape in simulator.shapes
        for a in SIZES
    ]
    exact = logsumexp(shares, axis=0) - student(null)
    beside = Beside(simulator.shapes, jacobian)
    ours = beside.log_evidences(replace(simulator, random=default_rng(5)).noise(count))
    gaussian = beside.log_evidences(drawn)
    off, was_off = (np.sqrt(np.mean((found - exact) ** 2)) for found in (ours, gaussian))
    assert off < 0.15 and was_off > 0.3
