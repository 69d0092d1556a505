"""The virtual benches: nominal truths are the models, what is hidden is as told, readings are as noisy as meant."""

import ast
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import binom

from benchmarks.blind_metrics import bounds, confusion, is_named, right, score, wrong_name
from benchmarks.inverse_crime import committed
from benchmarks.virtual_benches import damper_bench, damper_truth, hiding
from benchmarks.virtual_benches.case import Answer
from benchmarks.virtual_benches.damper_bench import CATALOGUE as DAMPER
from benchmarks.virtual_benches.dq_bench import CATALOGUE as DQ
from benchmarks.virtual_benches.hiding import hide
from benchmarks.virtual_benches.instruments import Noise, readings
from effects.library import library
from effects.parameter import parameters_of
from workbench.data.campaign import read_campaign
from workbench.models.bases import nominal_model

BENCHES = {"damper": DAMPER, "dq": DQ}
LUMPED = Path(damper_truth.__file__).parent


@pytest.fixture(scope="module", params=BENCHES)
def bench(request):
    return BENCHES[request.param]


@pytest.fixture(scope="module")
def null(bench, tmp_path_factory):
    """Setup, campaign and nominal model of an empty bench."""
    folder = tmp_path_factory.mktemp("bench") / "null"
    campaign = read_campaign(hide(bench, "null", 10500)[0].write(folder))
    return campaign, nominal_model(campaign)


@pytest.fixture(scope="module")
def setup(bench):
    """Of the empty bench, drawn from the same numbers."""
    return bench.setup(np.random.default_rng([10500, 0, sum(bench.name.encode())]))


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
        assert all(np.array_equal(a.responses[name], b.responses[name]) for name in a.responses)
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


# The design's table of exact binomial tests: the claim holds when so many cases of so many are right.
@pytest.mark.parametrize(("claim", "n", "passes"), [(0.80, 82, 72), (0.90, 76, 73), (0.90, 179, 168), (0.95, 234, 228)])
def test_lower_bounds_are_exact(claim, n, passes):
    assert bounds(passes, n)[0] >= claim > bounds(passes - 1, n)[0]


@pytest.mark.parametrize(("claim", "n", "passes"), [(0.10, 179, 11), (0.05, 234, 6), (0.05, 124, 2), (0.02, 386, 3)])
def test_upper_bounds_are_exact(claim, n, passes):
    assert bounds(passes, n)[1] <= claim < bounds(passes + 1, n)[1]


@pytest.mark.parametrize(("hits", "n"), [(1, 10), (7, 9), (20, 40)])
def test_a_bound_is_where_the_tail_is_five_percent(hits, n):
    low, high = bounds(hits, n)
    assert binom.sf(hits - 1, n, low) == pytest.approx(0.05)
    assert binom.cdf(hits, n, high) == pytest.approx(0.05)


def case(group="single", effects=None, verdict="effect", names=("coulomb_friction",), chi2=100.0, **more):
    effects = {"coulomb_friction": 1.0} if effects is None else effects
    outside = "something" if group == "outside" else ""
    hidden = effects or ({outside: 0} if outside else {})
    values = dict(probability=0.97, first="coulomb_friction", intervals={"coulomb_friction": (0.5, 2.0)}, wall_s=1.0)
    values |= dict(held_out_before=3.0, held_out_after=1.0, held_out_noise=1.0)
    values |= dict(outside=outside, crime=False, alternatives={})
    return {"group": group, "effects": effects, "verdict": verdict, "names": list(names), **values,
            "visibility": dict.fromkeys(hidden, chi2), **more}  # fmt: skip


def test_what_counts_as_right():
    assert right(case()) and right(case(verdict="group", names=("coulomb_friction", "eddy_drag")))
    assert not right(case(names=("eddy_drag",))) and wrong_name(case(names=("eddy_drag",)))
    assert right(case("null", {}, "nothing_missing", ())) and not right(case("null", {}, "effect"))
    assert right(case("outside", {}, "partial")) and wrong_name(case("outside", {}, "effect"))
    assert not wrong_name(case("outside", {}, "none_of_these", ()))
    both = {"coulomb_friction": 1.0, "weak_magnets": 0.1}
    assert not right(case("pair", both)) and right(case("pair", both, "pair", tuple(both)))
    printed = ("hysteresis_drag", "weak_magnets")
    assert not right(case("pair", both, "pair", printed))
    assert right(case("pair", both, "pair", printed, alternatives={"hysteresis_drag": ["coulomb_friction"]}))
    assert not right(case("pair", both, "pair", printed, alternatives={"weak_magnets": ["coulomb_friction"]}))
    assert is_named("winding_temperature", ["contact_resistance"]) and not is_named("weak_magnets", ["diode_drop"])


def test_a_score_counts_and_excludes_what_could_not_be_seen():
    cases = [case()] * 9 + [case(names=("eddy_drag",), first="eddy_drag")] + [case(verdict="nothing_missing", chi2=2.0)]
    metrics = {metric.name: metric for metric in score(cases)}
    assert metrics["right name or group"].value == 0.9 and metrics["right name or group"].n == 10
    assert metrics["wrong name"].n == 11 and metrics["wrong name"].value == pytest.approx(1 / 11)
    assert metrics["90 % interval holds the size"].value == 1.0
    assert metrics["share of excess held-out chi2 removed"].value == 1.0
    assert metrics["false alarm"].n == 0 and metrics["false alarm"].passed is None


def test_confusion_shares_add_to_one():
    grouped = case(verdict="group", names=("coulomb_friction", "eddy_drag"))
    cases = [case(), grouped, case("null", {}, "nothing_missing", ())]
    truths, verdicts, table = confusion(cases)
    assert table.sum(axis=1) == pytest.approx(1.0)
    row = [truth.startswith("coulomb") for truth in truths].index(True)
    assert table[row, verdicts.index("coulomb_friction")] == 0.75


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
