"""The whole walk on the toy: compare, diagnose, add, refuse; the same to the digit; a user's effect from a folder."""

import json
from dataclasses import replace

import numpy as np
import pytest

from effects.library import effects_of_file, library, package_effects
from tests.workbench.toy_bench import LIBRARY, Bump, Hardening, Spring, SpringModel, written
from workbench.compare.comparison import compare
from workbench.data.campaign import read_campaign
from workbench.errors import WorkbenchError
from workbench.explain.agreement import NOTHING_LEFT, PREDICTED, agreement, left_over, repeats_itself
from workbench.explain.calibration import FALSE_ALARM_RATE, alarm_threshold, empty_campaigns
from workbench.explain.diagnosis import candidates, diagnose, screen_of
from workbench.ledger.model_file import model_text, with_effects_of
from workbench.ledger.step import COLUMNS, read_ledger, try_effect
from workbench.ledger.walk import add_effect, by_evidence, walk
from workbench.likelihood.bench import bench_of
from workbench.models.model import Model
from workbench.report.as_json import comparison_json, diagnosis_json


def cubic(x):
    return 1.0 * (x / 0.01) ** 3  # 1 N at full stroke, 20 standard deviations


def even(x):
    return 0.4 * (x / 0.01) ** 2


def of(folder):
    campaign = read_campaign(folder)
    return Model(SpringModel(), SpringModel().design(campaign.device)), campaign


@pytest.fixture(scope="module")
def hidden(tmp_path_factory):
    return of(written(tmp_path_factory.mktemp("hidden") / "c", cubic))


@pytest.fixture(scope="module")
def diagnosed(hidden):
    return diagnose(*hidden, LIBRARY)


def test_compare_finds_the_channel_and_the_noise(hidden):
    found = compare(*hidden, LIBRARY)
    assert found.failing == "pull.force" and found.chi2_per_n > 3
    (score,) = found.scoreboard
    assert score.noise_floor == pytest.approx(0.05, rel=0.2)
    assert found.signatures[0].name == "hardening" and found.signatures[0].cosine > 0.95
    content = json.loads(comparison_json(found))
    assert {"channels", "tolerance_pulls", "model", "views"} <= set(content)
    assert {
        "channel",
        "unit",
        "n",
        "rms_error",
        "rms_error_percent",
        "bias",
        "chi2_per_n",
        "held_out_chi2_per_n",
        "noise_floor",
    } <= set(content["channels"][0])


def test_diagnose_names_the_effect_with_its_size(diagnosed):
    assert (diagnosed.verdict, diagnosed.names) == ("effect", ("hardening",))
    best = diagnosed.ranking[0]
    found = best.parameters["cubic"]
    assert abs(found.value - 1e6) < 3 * found.std and found.std < 0.1 * found.value
    assert best.held_out_chi2_per_n_after < 1.4 < best.held_out_chi2_per_n_before
    total = diagnosed.p_nothing_missing + diagnosed.p_none_of_these + sum(r.probability for r in diagnosed.ranking)
    assert total + sum(diagnosed.p_pairs.values()) + sum(diagnosed.p_partial.values()) == pytest.approx(1.0, abs=1e-6)


def test_diagnosis_has_the_agreed_keys(diagnosed):
    content = json.loads(diagnosis_json(diagnosed))
    assert {
        "verdict", "names", "probability", "ranking", "p_nothing_missing", "p_none_of_these", "abstention_power",
        "detection_limits", "next_measurements", "residual_signature", "seed", "wall_s",
    } <= set(content)  # fmt: skip
    assert 0.0 <= content["abstention_power"] <= 1.0
    assert {"value", "std", "low90", "high90", "unit"} == set(content["ranking"][0]["parameters"]["cubic"])
    assert {"channel", "regime", "orders", "exponents", "parity"} <= set(content["residual_signature"])


def test_same_file_and_seed_same_verdict_to_the_digit(hidden, diagnosed):
    again = diagnose(*hidden, LIBRARY)
    strip = lambda d: {k: v for k, v in json.loads(diagnosis_json(d)).items() if k != "wall_s"}  # noqa: E731
    assert strip(again) == strip(diagnosed)


def test_nothing_is_missing_where_nothing_is(tmp_path):
    found = diagnose(*of(written(tmp_path / "c")), LIBRARY)
    assert found.verdict == "nothing_missing" and found.p_nothing_missing > 0.6


def test_what_no_effect_explains_is_none_of_these(tmp_path):
    found = diagnose(*of(written(tmp_path / "c", lambda x: 0.5 * np.sin(900 * x))), LIBRARY)
    assert found.verdict in ("none_of_these", "partial")


def test_two_effects_are_found_together(tmp_path):
    found = diagnose(*of(written(tmp_path / "c", lambda x: cubic(x) + even(x))), LIBRARY)
    assert (found.verdict, set(found.names)) == ("pair", {"hardening", "bump"})


def test_a_tolerance_that_hides_an_effect_shows_by_its_pull(tmp_path):
    model, campaign = of(written(tmp_path / "c", stiffness=900.0))
    found = compare(model, campaign, LIBRARY)
    assert found.chi2_per_n < 1.5 and abs(found.pulls[0].pull) > 8 and found.failing == "pull.force"
    assert diagnose(model, campaign, LIBRARY).names == ("soft_spring",)


def test_add_lowers_the_error_and_refuses_what_does_not(hidden, tmp_path):
    model, campaign = hidden
    refused = add_effect(model, campaign, LIBRARY, "bump", tmp_path)
    assert refused.step.decision == "refused" and not (tmp_path / "model.toml").exists()
    assert refused.model == model
    added = add_effect(model, campaign, LIBRARY, "hardening", tmp_path)
    assert added.step.decision == "accepted" and added.diagnosis.verdict == "nothing_missing"
    assert added.step.held_out_chi2_per_n < 1.2 * 1.2 < refused.step.held_out_chi2_per_n
    assert [s.decision for s in added.ledger.steps] == ["start", "refused", "accepted"]
    lines = (tmp_path / "ledger.csv").read_text().splitlines()
    assert lines[0].split(",") == list(COLUMNS) and len(lines) == 4
    read = read_ledger(tmp_path / "ledger.csv", "spring", "spring")
    assert read.steps == added.ledger.steps


def test_the_ledger_only_grows(hidden, tmp_path):
    model, campaign = hidden
    add_effect(model, campaign, LIBRARY, "bump", tmp_path)
    before = (tmp_path / "ledger.csv").read_bytes()
    add_effect(model, campaign, LIBRARY, "bump", tmp_path)
    assert (tmp_path / "ledger.csv").read_bytes().startswith(before)


def test_model_file_round_trip_bit_for_bit(tmp_path):
    model = Model(SpringModel(), Spring(1000.0)) + Hardening(12345.6789012345) + Bump(-0.1)
    (tmp_path / "m.toml").write_text(model_text(model), encoding="utf-8")
    again = with_effects_of(tmp_path / "m.toml", Model(model.base, model.design), LIBRARY)
    assert again == model and model_text(again) == model_text(model)


@pytest.mark.parametrize(
    "old, new, says",
    [("hardening", "hardning", "is not known"), ("cubic", "cube", "no parameter"), ("12.0", '"12"', "must be a number"),
     ("12", "-12", "must be a number from 0"), ('"spring"', '"damper"', "needs 'spring'"),
     ("[model]", "[mod", "cannot be read")],
)  # fmt: skip
def test_a_wrong_model_file_is_said(tmp_path, old, new, says):
    model = Model(SpringModel(), Spring(1000.0))
    (tmp_path / "m.toml").write_text(model_text(model + Hardening(12.0)).replace(old, new), encoding="utf-8")
    with pytest.raises(WorkbenchError, match=says):
        with_effects_of(tmp_path / "m.toml", model, LIBRARY)


def test_an_effect_that_is_unknown_or_unseen_cannot_be_added(hidden, tmp_path):
    model, campaign = hidden
    with pytest.raises(WorkbenchError, match="there is no effect 'hard'"):
        add_effect(model, campaign, LIBRARY, "hard", tmp_path)
    with pytest.raises(WorkbenchError, match="already has"):
        add_effect(model + Hardening(1.0), campaign, LIBRARY, "hardening", tmp_path)


OWN = '''
from dataclasses import dataclass
from effects.base import ResponseEffect
from effects.parameter import parameter
from effects.prior import Normal

@dataclass(frozen=True)
class Wave(ResponseEffect):
    """F = k x + size sin(900 x)."""
    title = "a wave"
    looks_like = "a wave over the displacement"
    size: float = parameter(0.0, "N", prior=Normal(0.3), low=-9.0, high=9.0, source="seen")

    def on_response(self, response, conditions, kind, design):
        import numpy as np
        return {**response, "force": response["force"] + self.size * np.sin(900 * conditions["displacement"])}
'''


def test_an_effect_of_ones_own_takes_part_from_its_folder(tmp_path):
    (tmp_path / "own").mkdir()
    (tmp_path / "own" / "wave.py").write_text(OWN, encoding="utf-8")
    effects = LIBRARY | effects_of_file(tmp_path / "own" / "wave.py")
    found = diagnose(*of(written(tmp_path / "c", lambda x: 0.5 * np.sin(900 * x))), effects)
    assert (found.verdict, found.names) == ("effect", ("wave",))
    assert "wave" in library([tmp_path / "own"]) and "wave" not in package_effects()


def test_a_campaign_is_never_executed(tmp_path):
    trap = tmp_path / "ran"
    folder = written(tmp_path / "c")
    (folder / "effect.py").write_text(f"open({str(trap)!r}, 'w')", encoding="utf-8")
    (folder / "campaign.py").write_text(f"open({str(trap)!r}, 'w')", encoding="utf-8")
    diagnose(*of(folder), LIBRARY)
    assert not trap.exists()


def test_an_effect_with_too_many_parameters_is_said_and_left_out(hidden):
    from workbench.explain.bank import grid

    with pytest.raises(WorkbenchError, match="one to 4 parameters, found 5"):
        grid(5)


def test_false_alarms_come_at_the_wanted_rate(tmp_path):
    model, campaign = of(written(tmp_path / "c", n=30))
    bench = bench_of(model, campaign, LIBRARY)
    screen, _ = screen_of(bench, candidates(bench, LIBRARY), lambda words: None)
    threshold = alarm_threshold(screen, bench, np.random.default_rng(1), 2000)
    fresh = empty_campaigns(bench.fit.stack, bench.noise, bench.nuisances, np.random.default_rng(2), 2000)
    rate = np.mean(screen.alarm(fresh) > threshold)
    assert rate == pytest.approx(FALSE_ALARM_RATE, abs=0.011)  # three binomial standard errors of both


def test_rows_held_out_agree_on_what_the_model_misses(tmp_path, hidden):
    quiet = bench_of(*of(written(tmp_path / "c", n=200)), LIBRARY)
    rough = bench_of(*of(written(tmp_path / "d", lambda x: 0.05 * np.sign(np.sin(1e5 * x)), n=200)), LIBRARY)
    t = [agreement(b, b.null.residual, b.held_out.residual(b.null.x)) for b in (quiet, rough)]
    assert abs(t[0]) < NOTHING_LEFT < t[1]
    assert t[1] == pytest.approx(0.5 * np.sqrt(200), rel=0.3)  # half of the variance of either is common


def test_what_one_scan_shows_alone_does_not_repeat_itself(tmp_path):
    bench = bench_of(*of(written(tmp_path / "c", n=200)), LIBRARY)
    held = bench.held_out.residual(bench.null.x)
    wave = 2 * np.sin(np.linspace(0, 9, 200))
    assert repeats_itself(bench, wave, held + wave) and not repeats_itself(bench, wave, held)


def test_noise_confirms_an_expectation_no_more_often_than_the_bound(tmp_path):
    """A likelihood ratio has mean one under noise, so that it exceeds exp(G) with probability below exp(-G)."""
    bench = bench_of(*of(written(tmp_path / "c", n=200)), LIBRARY)
    shape = np.sin(np.linspace(0, 9, 200))
    unit = shape / np.linalg.norm(shape)
    assert left_over(bench, 5 * unit, 5 * unit) == pytest.approx(5.0, rel=0.01)
    assert left_over(bench, 3 * unit, 3 * unit) == 0.0 and PREDICTED == 6.0
    noise = np.random.default_rng(5).standard_normal((2000, 200))
    assert sum(repeats_itself(bench, 3.5 * unit, held) for held in noise) <= 9  # bound 5, 95 % point 9


def test_one_station_alone_confirms_nothing(tmp_path):
    bench = bench_of(*of(written(tmp_path / "c", n=200)), LIBRARY)
    spike = np.where(np.arange(200) == 77, 13.0, 0.0)
    random = np.random.default_rng(3)
    noise = random.standard_normal((2, 200))
    assert not repeats_itself(bench, spike, spike + noise[0])
    assert agreement(bench, spike + noise[0], spike + noise[1]) < NOTHING_LEFT


def test_without_repeats_it_still_answers_and_says_what_it_lacks(tmp_path):
    model, campaign = of(written(tmp_path / "c", cubic, repeats=1))
    found = diagnose(model, campaign, LIBRARY)
    assert found.names == ("hardening",) and any("one repeat only" in words for words in found.complaints)


def test_ten_points_cannot_abstain(tmp_path):
    model, campaign = of(written(tmp_path / "c", lambda x: 0.3 * np.sin(400 * x), n=5))
    found = diagnose(model, campaign, LIBRARY)
    assert any("only 10 rows" in words for words in found.complaints)
    assert found.verdict == "cannot_tell" and set(found.abstention_power.values()) == {0.0}


def test_the_walk_tries_the_next_name_where_one_is_refused(tmp_path):
    model, campaign = of(written(tmp_path / "c", lambda x: cubic(x) + even(x)))
    ledger, last = walk(model, campaign, LIBRARY, tmp_path)
    assert {s.effect for s in ledger.steps if s.decision == "accepted"} == {"hardening", "bump"}
    assert last.verdict == "nothing_missing"
    judged = [s.held_out_chi2_per_n for s in ledger.steps if s.decision != "refused"]
    assert judged == sorted(judged, reverse=True) and judged[-1] < 1.4


def test_names_are_tried_by_the_evidence_of_each_alone(diagnosed):
    one, other = diagnosed.ranking[0].name, diagnosed.ranking[1].name
    assert by_evidence(replace(diagnosed, names=(other, one))) == (one, other)


def test_a_step_tells_the_error_of_each_channel_in_percent_and_on_unseen_rows(hidden):
    step = try_effect(*hidden, LIBRARY, "hardening").step
    assert step.rms_error["pull.force"] < 1.2 * step.noise_floor["pull.force"]
    assert step.held_out_rms_error["pull.force"] == pytest.approx(step.rms_error["pull.force"], rel=0.3)
    size = step.rms_error["pull.force"] / step.rms_error_percent["pull.force"] * 100
    assert size == pytest.approx(5.8, rel=0.1), "rms of 1000 N/m over 10 mm either way"
