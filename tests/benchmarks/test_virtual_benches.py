"""The virtual benches: nominal truths are the models, what is hidden is as told, readings are as noisy as meant."""

import ast
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from benchmarks.foreign import left_by_library
from benchmarks.inverse_crime import committed
from benchmarks.virtual_benches import damper_bench, damper_truth, hiding
from benchmarks.virtual_benches.case import VISIBLE, Answer
from benchmarks.virtual_benches.damper_bench import CATALOGUE as DAMPER
from benchmarks.virtual_benches.dq_bench import CATALOGUE as DQ
from benchmarks.virtual_benches.hiding import bare, hide
from benchmarks.virtual_benches.instruments import Noise, _correlated, readings, remounting, white
from effects.library import library
from effects.parameter import parameters_of
from workbench.data.campaign import read_campaign
from workbench.models.bases import nominal_model

BENCHES = {"damper": DAMPER, "dq": DQ}
LUMPED = Path(damper_truth.__file__).parent
SYSTEMATICS = ("force_gain", "force_offset")


@pytest.fixture(scope="module", params=BENCHES)
def bench(request):
    return BENCHES[request.param]


@pytest.fixture(scope="module")
def null(bench, tmp_path_factory):
    """Setup, campaign and nominal model of an empty bench."""
    folder = tmp_path_factory.mktemp("bench") / "null"
    campaign = read_campaign(hide(bench, "null", seed_without_gaps(bench))[0].write(folder))
    return campaign, nominal_model(campaign)


@cache
def seed_without_gaps(bench):
    """Of the first empty campaign in which no reading is missing, so that its rows are those that were planned."""
    return next(seed for seed in range(10500, 10600) if not gaps(hide(bench, "null", seed)[0]))


def gaps(bench):
    return sum(int(np.isnan(values).sum()) for table in bench.tables for values in table.responses.values())


@pytest.fixture(scope="module")
def setup(bench):
    """Of the empty bench, drawn from the same numbers."""
    return bench.setup(np.random.default_rng([seed_without_gaps(bench), 0, sum(bench.name.encode())]))


def worst(setup, true, model, campaign):
    """Largest difference between simulated truth and model, over the declared uncertainty."""
    differences = []
    for layout, values, table in zip(setup.layouts, true, campaign.tables):
        answers, declared = model.answers(table), layout.declared(values)
        for column, response in zip(values, table.responses):
            ours = answers[response][: len(values[column])]
            differences.append(np.max(np.abs(values[column] - ours) / declared[column]))
    return max(differences)


def test_truth_without_anything_hidden_is_the_model(bench, setup, null):
    campaign, model = null
    assert worst(setup, bench.simulate(setup, setup.state), model, campaign) < 0.01


def test_every_hidden_effect_is_the_one_of_that_name(bench, setup, null):
    """At a middling size the library's effect takes three quarters of what the truth of that name does."""
    campaign, model = null
    for name, hidden in bench.effects.items():
        cls = library()[name]
        if "drift" in name:
            continue  # made while the readings are taken, not by ``simulate``
        size = float(np.sqrt(hidden.low * hidden.high))
        true = bench.simulate(setup, hidden.apply(setup.state, size))
        without = worst(setup, true, model, campaign)
        remains = worst(setup, true, model + _matching(cls, size), campaign)
        assert remains < 0.25 * without + 0.1, name


def _matching(cls, size):
    """The effect at the size, and at what the truths give the other parameters."""
    others = {"eddy_drag": {"corner": 0.25}, "stribeck_friction": {"excess": 0.8, "stribeck_velocity": 0.06}}
    return cls(**{next(iter(parameters_of(cls))): size}, **others.get(cls.name(), {}))


@pytest.mark.parametrize("group", ["single", "pair"])
def test_the_same_seed_hides_the_same(group):
    (one, answer), (two, again) = hide(DQ, group, 10007), hide(DQ, group, 10007)
    assert answer == again
    for a, b in zip(one.tables, two.tables):
        assert all(np.array_equal(a.responses[name], b.responses[name], equal_nan=True) for name in a.responses)
    assert hide(DQ, group, 10008)[1] != answer


def test_answers_name_what_was_hidden(bench):
    name, other = list(bench.effects)[:2]
    _, answer = hide(bench, "pair", 10001, wanted=(name, other))
    assert list(answer.effects) == [name, other] and set(answer.visibility) == {name, other}


def test_a_truth_outside_the_library_matters_beyond_the_best_effect():
    strange = next(iter(DQ.outside))
    answer = hide(DQ, "outside", 10001, wanted=(strange,))[1]
    assert answer.outside == strange and 20 < answer.visibility[strange] < 1500


def test_visibility_grows_with_the_square_of_a_small_size():
    quiet = replace(DQ.effects["torque_offset"], low=0.1, high=0.1)
    loud = replace(quiet, low=0.2, high=0.2)
    chi2 = []
    for hidden in (quiet, loud):
        bench = type("Only", (type(DQ),), {"effects": {"torque_offset": hidden}})()
        chi2.append(hide(bench, "single", 10002)[1].visibility["torque_offset"])
    assert chi2[1] == pytest.approx(4 * chi2[0], rel=0.01)


def test_the_lumped_truths_know_neither_library_nor_model():
    for path in LUMPED.glob("*.py"):
        if path.name.startswith("machine"):
            continue
        tree = ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        modules = {node.module.split(".")[0] for node in tree if isinstance(node, ast.ImportFrom) and node.module}
        assert not modules & {"effects", "workbench"}, path.name


def test_noise_has_its_size_correlation_and_wild_readings():
    rng = np.random.default_rng(1)
    n = 200_000
    read = readings(np.zeros(n), np.ones(n), np.zeros(n, int), Noise(1.3, 0.4, 0.1, 0.5), False, rng)
    tame = np.abs(read) < 7.5
    both = tame[:-1] & tame[1:]
    assert np.std(read[tame]) == pytest.approx(1.3, rel=0.05)
    assert np.corrcoef(read[:-1][both], read[1:][both])[0, 1] == pytest.approx(0.4, abs=0.04)
    assert np.mean(np.abs(read) > 7.5) > 0.004  # a normal law has none
    assert np.allclose(read / 0.1, np.round(read / 0.1))


def test_a_noise_over_a_floor_has_the_covariance_that_it_is_freed_of():
    """Scans of twelve rows, freed of their course, are independent and of size one."""
    noise, n = Noise(1.0, 0.9, 1e-6, 0.0, floor=0.4), 12
    rng = np.random.default_rng(2)
    scans = np.array([white(_correlated(n, noise, rng), noise) for _ in range(20_000)])
    assert np.allclose(np.cov(scans.T), np.eye(n), atol=0.08)  # four standard errors of t4 noise


def test_every_scan_is_mounted_anew():
    """Offset and slope of a scan scatter from scan to scan by what is told, in the root mean square over its rows."""
    repeat, u = np.repeat(np.arange(4000), 20), np.tile(np.geomspace(0.5, 2.0, 20), 4000)
    added = remounting(u, repeat, Noise(1.0, 0.0, 0.1, 0.5, remount=1.5), np.random.default_rng(3)).reshape(4000, 20)
    per_row = np.mean((added / u[:20]) ** 2)
    assert per_row == pytest.approx(2 * 1.5**2, rel=0.05), "an offset and a slope"
    assert np.allclose(np.diff(added, n=2, axis=1), 0.0, atol=1e-9), "a straight line over each scan"


def test_a_reading_that_is_missing_is_an_empty_cell(tmp_path):
    bench = next(made for made in (hide(DQ, "null", seed)[0] for seed in range(10000, 10020)) if gaps(made))
    campaign = read_campaign(bench.write(tmp_path / "gaps"))
    assert any("gap" in complaint for complaint in campaign.complaints)
    assert all(np.isfinite(r.values).all() for table in campaign.tables for r in table.responses.values())


@pytest.mark.parametrize("catalogue", BENCHES.values(), ids=BENCHES)
def test_kinds_for_tuning_and_for_the_score_are_different(catalogue):
    tuning, scored = catalogue.tuning_kinds, set(catalogue.outside) - catalogue.tuning_kinds
    assert len(tuning) >= 6 and len(scored) >= 6 and tuning < set(catalogue.outside)
    assert hide(catalogue, "outside", 3, kinds=sorted(scored)[:2])[1].outside in scored


def test_several_effects_can_all_be_seen_beside_the_others():
    answer = hide(DQ, "several", 10001)[1]
    assert 3 <= len(answer.effects) <= 4 and min(answer.visibility.values()) >= VISIBLE


def test_an_effect_that_another_imitates_is_not_visible_beside_it():
    """Winding temperature beside contact resistance adds nothing, though each alone stands out."""
    alone = hide(DAMPER, "single", 10003, wanted=("contact_resistance",))[1].visibility["contact_resistance"]
    both = hide(DAMPER, "pair", 10003, wanted=("contact_resistance", "winding_temperature"))[1].visibility
    assert alone > 20 and max(both.values()) < 5


def test_a_truth_of_the_library_is_not_outside_of_it(tmp_path):
    """The library takes one of its own effects up; a law that it does not have stays."""
    left = {}
    for group, name in (("single", "quadratic_drag"), ("outside", "resonance of the rig")):
        benches = bare(DAMPER, group, 10005, wanted=(name,))
        without, changed = (read_campaign(b.write(tmp_path / f"{name}{k}")) for k, b in enumerate(benches))
        small = {name: library()[name] for name in ("quadratic_drag", "excess_viscous", *SYSTEMATICS)}
        left[name] = left_by_library(without, changed, small, {"declared": 1.0, "remount": 0.0, "fitted": 2.0})
    assert left["quadratic_drag"].best == "quadratic_drag" and left["quadratic_drag"].chi2 < 20
    assert left["resonance of the rig"].chi2 > 30


def test_drift_is_in_one_scan_only():
    repeat = np.repeat([0, 1], 5000)
    noise = Noise(1.0, 0.0, 0.01, 3.0)
    read = readings(np.zeros(10000), np.ones(10000), repeat, noise, True, np.random.default_rng(2))
    trend = [np.polyfit(np.linspace(0, 1, 5000), read[repeat == k], 1)[0] for k in (0, 1)]
    assert trend[0] == pytest.approx(3.0, abs=0.3) and abs(trend[1]) < 0.3


def test_inverse_crime_is_model_plus_white_noise(null):
    campaign, _ = null
    clean, answer = committed(campaign, library(), (), Answer("x", "null", 3))
    assert not answer.effects
    spreads = []
    for table in clean.tables:
        for response in table.responses.values():
            first, second = (response.values[table.repeat == k] for k in (0, 1))
            spreads.append((first - second) / response.random[table.repeat == 0])
    assert np.std(np.concatenate(spreads)) == pytest.approx(np.sqrt(2), rel=0.1)


def test_a_truth_gets_the_visibility_that_is_told_also_where_it_has_a_threshold():
    """chi2 = 1e4 (size - 1)^2 from size 1 on, as of a dead band: chi2 over the square of the size is no constant."""
    band = hiding.Hidden(3.0, 3.0, lambda state, size: state + size)
    for wanted in (0.4, 2.9, 500.0):
        changed, chi2 = hiding._sized(band, 0.0, wanted, lambda size: 1e4 * max(size - 1.0, 0.0) ** 2)
        assert chi2 == pytest.approx(wanted, rel=0.25) and chi2 == pytest.approx(1e4 * (changed - 1.0) ** 2)


def test_what_a_second_parameter_of_an_effect_explains_is_not_foreign():
    """Stribeck friction of another velocity is no truth outside the library: its signatures take it up."""
    setup = DAMPER.setup(np.random.default_rng(4))
    judge = hiding._Judge(DAMPER, setup, setup.state, Noise.ideal())
    base = judge.stacked(setup.state)
    taken = dict(zip(DAMPER.effects, judge.signatures(base)))["stribeck_friction"]
    other = judge.stacked(damper_bench._stribeck(setup.state, 1.0, velocity=0.08)) - base
    alone, all_forms = (other - s @ np.linalg.lstsq(s, other, rcond=None)[0] for s in (taken[:, :1], taken))
    assert np.sum(all_forms**2) < 0.2 * np.sum(alone**2)


def test_what_a_tolerance_does_by_far_more_than_itself_adds_no_more_than_its_penalty():
    setup = DQ.setup(np.random.default_rng(4))
    judge = hiding._Judge(DQ, setup, setup.state, Noise.ideal())
    base = judge.stacked(setup.state)
    sensitivities = judge.sensitivities(base)
    linear, followed = [], []
    for name in setup.tolerance:
        far = DQ.moved(setup, setup.state, name, 6.0)
        linear.append(judge.visibility(far, sensitivities, base))
        followed.append(judge.beyond_tolerances(far, sensitivities, base))
    assert max(followed) <= 36.0 * 1.01
    assert max(linear) > 2 * 36.0  # where the bench is taken to be linear
