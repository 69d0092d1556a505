"""The whole walk on the toy: compare, diagnose, add, refuse; the same to the digit; a user's effect from a folder."""

from dataclasses import replace

import numpy as np
import pytest

from effects.library import effects_of_file, library, package_effects
from tests.workbench.toy_bench import LIBRARY, Bump, Hardening, Spring, SpringModel, written
from workbench.compare.comparison import compare
from workbench.data.campaign import read_campaign
from workbench.errors import WorkbenchError
from workbench.explain.diagnosis import diagnose
from workbench.explain.verdict import GROUP, PAIR
from workbench.ledger.model_file import model_text, read_model, with_effects_of
from workbench.ledger.step import COLUMNS, read_ledger, try_effect
from workbench.ledger.walk import add_effect, by_evidence, walk
from workbench.models.model import Model


def cubic(x):
    return 1.0 * (x / 0.01) ** 3  # 1 N at full stroke, 20 standard deviations


def even(x):
    return 0.4 * (x / 0.01) ** 2


def root(x):
    return 0.4 * np.sign(x) * np.sqrt(np.abs(x) / 0.01)  # a law that the library does not have


def of(folder):
    campaign = read_campaign(folder)
    return Model(SpringModel(), SpringModel().design(campaign.device)), campaign


@pytest.fixture(scope="module")
def hidden(tmp_path_factory):
    return of(written(tmp_path_factory.mktemp("hidden") / "c", cubic))


@pytest.fixture(scope="module")
def diagnosed(hidden):
    return diagnose(*hidden, LIBRARY)


@pytest.fixture(scope="module")
def added(hidden, tmp_path_factory):
    """An effect that is refused, then one that is accepted, in one ledger; the bytes of the file after the first."""
    out = tmp_path_factory.mktemp("ledger")
    refused = add_effect(*hidden, LIBRARY, "bump", out)
    assert not (out / "model.toml").exists()
    first = (out / "ledger.csv").read_bytes()
    return refused, add_effect(*hidden, LIBRARY, "hardening", out), first, out


def test_compare_finds_the_channel_and_the_noise(hidden):
    found = compare(*hidden, LIBRARY)
    assert found.failing == "pull.force" and found.chi2_per_n > 3
    (score,) = found.scoreboard
    assert score.noise_floor == pytest.approx(0.05, rel=0.2)
    assert found.signatures[0].name == "hardening"
    all_but_noise = np.sqrt(1 - 1 / found.chi2_per_n)
    assert found.signatures[0].cosine == pytest.approx(all_but_noise, abs=0.05)  # tolerances take some of the noise


def test_diagnose_names_the_effect_with_its_size(diagnosed):
    assert (diagnosed.verdict, diagnosed.names) == ("effect", ("hardening",))
    best = diagnosed.ranking[0]
    found = best.parameters["cubic"]
    assert abs(found.value - 1e6) < 3 * found.std and found.std < 0.1 * found.value
    assert best.held_out_chi2_per_n_after < 1.4 < best.held_out_chi2_per_n_before


def test_every_probability_that_is_printed_has_one_meaning(diagnosed):
    """The name, the sets and what remains are sums over the same explanations."""
    sets, sure = diagnosed.p_sets, diagnosed.ranking[0].probability
    assert diagnosed.probability == sure >= diagnosed.sure >= 0.95
    assert sum(sets.values()) == pytest.approx(1.0, abs=1e-3)
    assert sum(p for words, p in sets.items() if "hardening" in words) == pytest.approx(sure, abs=1e-3)
    unknown = sum(p for words, p in sets.items() if words.endswith("something unknown"))
    assert unknown == pytest.approx(diagnosed.p_something_remains, abs=1e-3)
    assert sets.get("nothing", 0.0) == pytest.approx(diagnosed.p_nothing_missing, abs=1e-3)


def test_same_file_and_seed_same_verdict_to_the_digit(hidden, diagnosed):
    again = diagnose(*hidden, LIBRARY)
    for name in ("p_sets", "ranking", "probability", "sure", "abstention_power", "detection_limits",
                 "next_measurements", "residual_signature", "sealed", "p_something_remains"):  # fmt: skip
        assert repr(getattr(again, name)) == repr(getattr(diagnosed, name)), name


def test_nothing_is_missing_where_nothing_is(tmp_path):
    found = diagnose(*of(written(tmp_path / "c")), LIBRARY)
    assert found.verdict == "nothing_missing" and found.p_nothing_missing > 0.6 and found.sealed.holds


class Brittle(Bump):
    """Beyond 12 mm its spring is broken."""

    def on_response(self, response, conditions, kind, design):
        if np.abs(conditions["displacement"]).max() > 0.012:
            raise WorkbenchError("broken")
        return super().on_response(response, conditions, kind, design)


def test_what_one_explanation_has_no_answer_to_may_still_separate_others(tmp_path):
    """A hardening too small to be seen so far would show at twice the stroke, where the leader has no answer."""
    model, campaign = of(written(tmp_path / "c", even))
    found = diagnose(model, campaign, {n: c for n, c in LIBRARY.items() if n != "bump"} | {"brittle": Brittle})
    assert found.names == ("brittle",)
    assert any(m.conditions["displacement / m"][0] < -0.019 for m in found.next_measurements)


def test_what_no_effect_explains_is_none_of_these_and_its_law_is_said(tmp_path):
    found = diagnose(*of(written(tmp_path / "c", root)), LIBRARY)
    assert (found.verdict, found.names) == ("none_of_these", ()) and found.probability > 0.95
    assert found.residual_signature["law"].endswith("displacement to the power 0.5")


def test_beside_an_unknown_law_that_is_sure_an_effect_is_listed_and_not_named(tmp_path):
    found = diagnose(*of(written(tmp_path / "c", lambda x: 2 * even(x) + root(x))), LIBRARY)
    assert (found.verdict, found.names) == ("none_of_these", ()) and found.p_something_remains > 0.95
    bump = next(ranked for ranked in found.ranking if ranked.name == "bump")
    assert bump == found.ranking[0] and bump.parameters, "it helps most"
    assert 0.1 < bump.probability < 0.9, "and may only be what the unknown function lacks of the law"
    assert found.p_sets["bump + something unknown"] == pytest.approx(bump.probability, rel=0.2)
    assert found.p_none_of_these == pytest.approx(1 - bump.probability, rel=0.2)


def test_two_effects_are_found_together(tmp_path):
    found = diagnose(*of(written(tmp_path / "c", lambda x: cubic(x) + even(x))), LIBRARY)
    assert (found.verdict, set(found.names)) == ("pair", {"hardening", "bump"})


def test_a_tolerance_that_hides_an_effect_shows_by_its_pull(tmp_path):
    model, campaign = of(written(tmp_path / "c", stiffness=900.0))
    found = compare(model, campaign, LIBRARY)
    assert found.chi2_per_n < 1.5 and abs(found.pulls[0].pull) > 8 and found.failing == "pull.force"
    assert diagnose(model, campaign, LIBRARY).names == ("soft_spring",)


def test_sealed_rows_that_disagree_forbid_that_nothing_is_missing(tmp_path):
    """A step at displacements that no fit has seen: what was fitted is well, and yet the sentence is not said."""
    model, campaign = of(written(tmp_path / "c", lambda x: np.where(np.abs(x) > 0.007, 1.0, 0.0)))
    (table,) = campaign.tables
    sealed = replace(table, held_out=np.abs(table.conditions["displacement"]) > 0.007)
    found = diagnose(model, replace(campaign, tables=(sealed,)), LIBRARY)
    assert found.p_nothing_missing > 0.8 and not found.sealed.holds and "prediction" in found.sealed.tests
    assert (found.verdict, found.names) == ("none_of_these", ()) and found.probability > 0.99


def test_add_lowers_the_error_and_refuses_what_does_not(hidden, added):
    refused, accepted, _, out = added
    assert refused.step.decision == "refused" and refused.model == hidden[0]
    assert accepted.step.decision == "accepted" and accepted.diagnosis.verdict == "nothing_missing"
    assert accepted.step.held_out_chi2_per_n < 1.2 * 1.2 < refused.step.held_out_chi2_per_n
    assert [s.decision for s in accepted.ledger.steps] == ["start", "refused", "accepted"]
    lines = (out / "ledger.csv").read_text().splitlines()
    assert lines[0].split(",") == list(COLUMNS) and len(lines) == 4
    read = read_ledger(out / "ledger.csv", "spring", "spring")
    assert read.steps == accepted.ledger.steps


def test_the_ledger_only_grows(added):
    _, _, first, out = added
    assert (out / "ledger.csv").read_bytes().startswith(first) and first.count(b"\n") == 3


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


def test_without_repeats_it_still_answers_and_says_what_it_lacks(tmp_path):
    model, campaign = of(written(tmp_path / "c", cubic, repeats=1))
    found = diagnose(model, campaign, LIBRARY)
    assert found.names == ("hardening",) and any("one repeat only" in words for words in found.complaints)


def test_the_walk_tries_the_next_name_where_one_is_refused(tmp_path):
    model, campaign = of(written(tmp_path / "c", lambda x: cubic(x) + even(x)))
    ledger, last = walk(model, campaign, LIBRARY, tmp_path)
    assert {s.effect for s in ledger.steps if s.decision == "accepted"} == {"hardening", "bump"}
    assert last.verdict == "nothing_missing"
    judged = [s.held_out_chi2_per_n for s in ledger.steps if s.decision != "refused"]
    assert judged == sorted(judged, reverse=True) and judged[-1] < 1.4


def test_a_name_that_has_no_answer_alone_is_refused_and_the_walk_goes_on(tmp_path, monkeypatch):
    """As saturation of a motor that its supply cannot hold without what else is missing."""

    asked = []

    def tried(model, campaign, library, name, *more, **said):
        asked.append(name)
        if len(asked) == 1:
            raise WorkbenchError("no steady state")
        return try_effect(model, campaign, library, name, *more, **said)

    monkeypatch.setattr("workbench.ledger.walk.try_effect", tried)
    model, campaign = of(written(tmp_path / "c", lambda x: cubic(x) + even(x)))
    ledger, _ = walk(model, campaign, LIBRARY, tmp_path)
    start, refused, *rest = ledger.steps
    assert (refused.effect, refused.decision) == (asked[0], "refused") and start.decision == "start"
    assert "cannot be added: no steady state" in refused.reason
    assert [step.step for step in ledger.steps] == list(range(len(ledger.steps)))
    assert {step.effect for step in rest if step.decision == "accepted"} == {"hardening", "bump"}


def test_a_walk_that_adds_nothing_says_what_was_learned_from_these_data(tmp_path):
    """A model file of other data, or of fewer of them, is not handed on as what was learned here."""
    model, campaign = of(written(tmp_path / "fewer", n=40))
    walk(model, campaign, LIBRARY, tmp_path / "out")
    model, campaign = of(written(tmp_path / "more", n=60))
    walk(model, campaign, LIBRARY, tmp_path / "out")
    said = read_model(tmp_path / "out" / "model.toml", LIBRARY).source
    assert dict(said.data_sha256) == dict(campaign.file_hashes)


def test_an_error_after_a_step_was_accepted_is_no_refusal(tmp_path, monkeypatch):
    """What ends the next diagnosis ends the walk and says so; the effect is not called one without an answer."""
    model, campaign = of(written(tmp_path / "c", cubic))
    first = diagnose(model, campaign, LIBRARY)

    def ends(model, *more, **said):
        if model.effects:
            raise WorkbenchError("no answer in a sealed row")
        return first

    monkeypatch.setattr("workbench.ledger.walk.diagnose", ends)
    with pytest.raises(WorkbenchError, match="no answer in a sealed row"):
        walk(model, campaign, LIBRARY, tmp_path)
    assert not any(step.decision == "refused" for step in read_ledger(tmp_path / "ledger.csv", "", "").steps)


def test_what_is_refused_one_by_one_is_tried_together(tmp_path, monkeypatch):
    """Each alone has no answer; both at once, from the sizes of the diagnosis, are accepted as one step."""

    def never(model, campaign, library, name, *more, **said):
        raise WorkbenchError("no steady state")

    monkeypatch.setattr("workbench.ledger.walk.try_effect", never)
    model, campaign = of(written(tmp_path / "c", lambda x: cubic(x) + even(x)))
    ledger, last = walk(model, campaign, LIBRARY, tmp_path)
    *refused, together = ledger.steps
    assert set(together.effect.split(" + ")) == {"hardening", "bump"} and together.decision == "accepted"
    assert {step.decision for step in refused} == {"start", "refused"} and last.verdict == "nothing_missing"
    assert {name.split(".")[0] for name in together.parameters} == {"hardening", "bump"}
    assert together.chi2_per_n < 1.4 < refused[0].chi2_per_n
    learned = (tmp_path / "model.toml").read_text()
    assert 'name = "hardening"' in learned and 'name = "bump"' in learned


def test_names_are_tried_by_the_evidence_of_each_alone(diagnosed):
    one, other = diagnosed.ranking[0].name, diagnosed.ranking[1].name
    assert by_evidence(replace(diagnosed, names=(other, one))) == (one, other)


def test_of_a_group_the_most_probable_name_is_tried_first(diagnosed):
    """Its evidence may be that of an explanation with another beside it, which is much less probable."""
    first, second, *rest = diagnosed.ranking
    weighed = (replace(first, probability=0.04), replace(second, probability=0.95), *rest)
    group = replace(diagnosed, verdict=GROUP, names=(first.name, second.name), ranking=weighed)
    assert by_evidence(group) == (second.name, first.name)
    assert by_evidence(replace(group, verdict=PAIR)) == (first.name, second.name)


def test_what_a_name_was_not_told_from_stands_beside_it_in_the_ledger(hidden, diagnosed, tmp_path):
    group = replace(diagnosed, verdict=GROUP, names=("bump", "hardening"))
    step = add_effect(*hidden, LIBRARY, "hardening", tmp_path, before=group).step
    assert step.reason.endswith("; these data cannot tell it from bump") and step.decision == "accepted"
    assert "cannot tell" not in add_effect(*hidden, LIBRARY, "hardening", tmp_path, before=diagnosed).step.reason


def test_the_first_of_names_that_cannot_be_told_apart_is_tried_last(diagnosed):
    one, other = diagnosed.ranking[0].name, diagnosed.ranking[1].name
    unsure = replace(diagnosed, names=(one,), alternatives={other: ("twin",)})
    assert by_evidence(unsure) == (one, other)


def test_what_ends_on_a_bound_is_tried_after_what_may_stand_for_it(diagnosed):
    """Its size is not to be believed: a friction of the largest bearing there is stands for a loss of the iron."""
    first, second, *rest = diagnosed.ranking
    held = (replace(first, probability=0.95, at_bound=("size",)), replace(second, probability=0.04, at_bound=()), *rest)
    group = replace(diagnosed, verdict=GROUP, names=(first.name, second.name), ranking=held)
    assert by_evidence(group) == (second.name, first.name)
    assert by_evidence(replace(group, names=(), alternatives={first.name: (second.name,)}))[0] == second.name


def test_what_is_likelier_there_than_not_is_tried_last_and_only_beside_names(diagnosed):
    first, second, *rest = diagnosed.ranking
    likely = (replace(first, probability=0.99), replace(second, probability=0.6), *rest)
    assert by_evidence(replace(diagnosed, names=(first.name,), ranking=likely)) == (first.name, second.name)
    assert by_evidence(replace(diagnosed, names=(), ranking=likely)) == ()


def test_what_was_refused_by_itself_is_tried_again_where_it_is_likely_though_no_name_is_sure(diagnosed):
    first, second, *rest = diagnosed.ranking
    unsure = replace(diagnosed, names=(), ranking=(replace(first, probability=0.96), replace(second, probability=0.4)))
    assert by_evidence(unsure, {first.name, second.name}) == (first.name,)
    assert by_evidence(unsure, {second.name}) == ()


def test_a_step_tells_the_error_of_each_channel_in_percent(hidden):
    step = try_effect(*hidden, LIBRARY, "hardening").step
    assert step.rms_error["pull.force"] < 1.2 * step.noise_floor["pull.force"]
    size = step.rms_error["pull.force"] / step.rms_error_percent["pull.force"] * 100
    assert size == pytest.approx(5.8, rel=0.1), "rms of 1000 N/m over 10 mm either way"


def test_five_stations_name_no_effect(tmp_path):
    found = diagnose(*of(written(tmp_path / "c", lambda x: 0.3 * np.sin(400 * x), n=5)), LIBRARY)
    assert any("only 10 rows" in words for words in found.complaints)
    assert found.verdict in ("none_of_these", "cannot_tell") and found.names == ()
    assert found.abstention_power[3.0] < 0.5
