"""Hand-made probabilities and the one verdict that each allows; every number printed is that of its sentence."""

from types import SimpleNamespace

import numpy as np
import pytest

from effects.mechanical.coulomb_friction import CoulombFriction
from effects.parameter import parameters_of
from workbench.explain.diagnosis import as_believed, leading
from workbench.explain.explore import Beliefs, Posterior, beside_the_unknown, posterior
from workbench.explain.sealed import with_sealed
from workbench.explain.verdict import Thresholds, Verdict, printed, verdict
from workbench.findings import Estimate, Sealed

SURE = Thresholds(sure=0.95, quiet=0.5, can_tell=True)
BLIND = Thresholds(sure=0.95, quiet=0.5, can_tell=False)


def p(alone, beside=None):
    """Sets written as "a+b", nothing as ""; beside: the same with an unknown function."""
    sets = [
        {frozenset(filter(None, names.split("+"))): share for names, share in part.items()}
        for part in (alone, beside or {})
    ]
    assert sum(sets[0].values()) + sum(sets[1].values()) == pytest.approx(1.0)
    return Posterior(*sets)


CASES = {
    "one name": (p({"a": 0.96, "": 0.02, "b": 0.02}), SURE, ("effect", ("a",), 0.96)),
    "in every explanation": (p({"a": 0.5, "a+b": 0.3, "a+c": 0.2}), SURE, ("effect", ("a",), 1.0)),
    "one of two": (p({"a": 0.6, "b": 0.38, "": 0.02}), SURE, ("group", ("a", "b"), 0.98)),
    "one of four": (p({"a": 0.3, "b": 0.26, "c": 0.22, "d": 0.2, "": 0.02}), SURE, ("group", tuple("abcd"), 0.98)),
    "one of five": (p({"a": 0.2, "b": 0.2, "c": 0.2, "d": 0.2, "e": 0.2}), SURE, ("cannot_tell", (), 1.0)),
    "two": (p({"a+b": 0.97, "a": 0.03}), SURE, ("pair", ("a", "b"), 0.97)),
    "three": (p({"a+b+c": 0.96, "a+b": 0.04}), SURE, ("several", ("a", "b", "c"), 0.96)),
    "four": (p({"a+b+c+d": 0.99, "": 0.01}), SURE, ("several", ("a", "b", "c", "d"), 0.99)),
    "two, one doubtful": (p({"a+b": 0.6, "a+c": 0.4}), SURE, ("partial", ("a",), 1.0)),
    "a name, and more": (p({"a": 0.4}, {"a": 0.6}), SURE, ("partial", ("a",), 1.0)),
    "no name, and more": (p({"": 0.1, "a": 0.1}, {"": 0.7, "a": 0.1}), SURE, ("none_of_these", (), 0.8)),
    "something": (p({"": 0.1, "a": 0.5}, {"": 0.4}), SURE, ("cannot_tell", (), 0.9)),
    "nothing": (p({"": 0.9, "a": 0.1}), SURE, ("nothing_missing", (), 0.93)),
    "nothing, of the blind": (p({"": 0.9, "a": 0.1}), BLIND, ("cannot_tell", (), 0.9)),
    "a name by the blind": (p({"a": 0.99, "": 0.01}), BLIND, ("cannot_tell", (), 0.99)),
}


@pytest.mark.parametrize("name", CASES)
def test_each_verdict(name):
    given, thresholds, expected = CASES[name]
    found = verdict(given, thresholds, plainly_nothing=0.93)
    assert (found.kind, found.names, found.probability) == (*expected[:2], pytest.approx(expected[2]))


def test_what_is_unlikely_is_no_verdict_though_no_alarm_was_raised():
    easy = Thresholds(sure=0.95, quiet=0.05, can_tell=True)
    found = verdict(p({"": 0.1, "a": 0.1}, {"": 0.8}), easy, plainly_nothing=0.4)
    assert (found.kind, found.names, found.probability) == ("cannot_tell", (), pytest.approx(0.9))


def test_what_a_doubtful_member_of_a_pair_may_be_is_said():
    found = verdict(CASES["two, one doubtful"][0], SURE, 0.0)
    assert found.alternatives == {"b": ("c",)}


def test_names_that_are_sure_but_not_together_keep_a_place_with_what_may_stand_for_one():
    """A stacking factor of 97.3 % beside a friction of 97.8 % was dropped, since both were there with 95 % only."""
    found = verdict(p({"a+b": 0.93, "a+c": 0.03, "b+d": 0.03, "": 0.01}), SURE, 0.0)
    assert (found.kind, found.names, found.alternatives) == ("partial", ("b",), {"a": ("d",)})
    groups = printed(p({"a+b": 0.93, "a+c": 0.03, "b+d": 0.03, "": 0.01}), SURE.sure)
    assert set(groups) == {frozenset("ad"), frozenset("b")}
    assert printed(p({"a+b": 0.92, "a": 0.05, "b": 0.03}), SURE.sure) == (frozenset("a"),), "nothing stands for b"


def test_two_doubtful_members_are_groups_and_no_name_stands_alone():
    found = verdict(p({"a+b": 0.5, "c+b": 0.2, "a+d": 0.2, "c+d": 0.1}), SURE, 0.0)
    assert (found.kind, set(found.names)) == ("group", {"a", "c"})
    assert found.alternatives == {"b": ("d",)} and found.probability == pytest.approx(1.0)


def test_something_unknown_lends_no_probability_to_a_name():
    found = verdict(p({"a": 0.5, "": 0.02}, {"": 0.48}), SURE, 0.0)
    assert found.names == () and found.kind == "cannot_tell"


def test_an_effect_stands_for_the_one_that_it_is_never_found_beside():
    """i in the place of b; beside g it is often found, and it cannot stand for both."""
    given = p({"b+g": 0.3, "i+g+e": 0.28, "i+g+f": 0.27, "i": 0.12, "b+h": 0.03})
    assert given.leading == {"b", "g"}
    assert printed(given, 0.95) == (frozenset("bi"),)


def test_two_of_the_leading_set_that_stand_for_one_another_are_said_to_be_one_of_two():
    """A dry friction of 82 % and iron losses of 55 %, most probably both, and surely one of them."""
    found = verdict(p({"a+b": 0.4, "a": 0.3, "b": 0.28, "": 0.02}), SURE, 0.0)
    assert (found.kind, found.names, found.probability) == ("group", ("a", "b"), pytest.approx(0.98))


def random_posterior(random):
    names = "abcdef"
    sets = list(dict.fromkeys(frozenset(n for n in names if random.random() < 0.3) for _ in range(12)))
    shares = random.dirichlet(np.full(2 * len(sets), random.choice([0.05, 0.3])))
    return Posterior(dict(zip(sets, shares)), dict(zip(sets, shares[len(sets) :])))


def test_no_name_is_printed_below_the_threshold_whatever_the_probabilities():
    random, kinds = np.random.default_rng(3), set()
    for _ in range(400):
        given = random_posterior(random)
        found = verdict(given, SURE, given.nothing)
        kinds.add(found.kind)
        if found.kind in ("effect", "pair", "several", "partial"):
            assert all(given.of(name) >= 0.95 - 1e-9 for name in found.names)
        if found.names:
            assert 0.95 - 1e-9 <= found.probability <= 1.0
            assert given.nothing <= 0.05 + 1e-9
    assert kinds >= {"effect", "group", "pair", "several", "partial", "none_of_these", "cannot_tell"}


def test_groups_do_not_share_a_member_and_hold_together():
    random = np.random.default_rng(4)
    for _ in range(200):
        given = random_posterior(random)
        groups = printed(given, 0.9)
        assert sum(map(len, groups)) == len(frozenset().union(*groups))
        assert not groups or given.all_of(groups) >= 0.9


def fits(*ranked):
    """A search in which these sets were fitted, the most probable first; a fit is its name."""
    sets = [frozenset(filter(None, names.split("+"))) for names in ranked]
    return SimpleNamespace(fitted=dict(zip(sets, ranked)), ranked=sets)


@pytest.mark.parametrize(
    ("kind", "names", "alternatives", "fit"),
    [
        ("nothing_missing", (), {}, ""),
        ("effect", ("a",), {}, "a"),
        ("group", ("a", "b"), {}, "a"),
        ("pair", ("a", "b"), {}, "a+b"),
        ("partial", ("a",), {"b": ("d",)}, "a+b"),
        ("group", ("b", "d"), {"a": ("c",)}, "a+b"),
        ("effect", ("c",), {}, "a+c"),
        ("effect", ("e",), {}, "a+c"),
        ("none_of_these", (), {}, "a+c"),
    ],
)
def test_the_fit_that_is_shown_is_that_of_the_verdict(kind, names, alternatives, fit):
    """Sealed rows were told not to hold, of a weak magnet that was named with "one of friction or iron loss" beside it:
    the fit they were held against had the magnet alone."""
    search = fits("a+c", "a+b", "a", "b", "")
    assert leading(search, Verdict(kind, names, 0.99, alternatives)) == fit


def test_sealed_rows_that_disagree_make_nothing_missing_impossible():
    nothing = Verdict("nothing_missing", (), 0.97, {})
    agree, disagree = (Sealed(20, 2.0, q, "speeds", q > 1e-3) for q in (0.3, 1e-9))
    assert with_sealed(nothing, agree) is nothing and with_sealed(nothing, None) is nothing
    found = with_sealed(nothing, disagree)
    assert found.kind == "none_of_these" and found.probability == pytest.approx(1.0)
    named = Verdict("effect", ("a",), 0.97, {})
    assert with_sealed(named, disagree) is named


def test_probabilities_from_evidences_by_hand():
    """Odds: base rates of a tenth each, an unknown function 0.03 to 0.97, ten nats for a."""
    odds = np.log(1 / 9)
    beliefs = Beliefs({"a": odds, "b": odds}, frozenset())
    none, a, both = frozenset(), frozenset("a"), frozenset("ab")
    found = posterior({none: 0.0, a: 10.0, both: 10.0}, {none: 8.0}, beliefs)
    weights = np.array([1.0, np.exp(10) / 9, np.exp(10) / 81, np.exp(8) * 0.03 / 0.97])
    shares = weights / weights.sum()
    assert [found.nothing, found.alone[a], found.alone[both], found.none_of_these] == pytest.approx(list(shares))
    assert found.of("a") == pytest.approx(shares[1] + shares[2]) and found.of("b") == pytest.approx(shares[2])
    assert found.any_of(both) == pytest.approx(found.of("a")) and found.leading == a


def test_rounding_carries_no_probability_beyond_one():
    found = Posterior({frozenset((f"n{k}", "a")): 0.1 for k in range(10)} | {frozenset("a"): 1e-15}, {})
    assert sum(found.alone.values()) <= 1.0 + 1e-14 and found.of("a") <= 1.0 and found.any_of(frozenset("a")) <= 1.0


USUAL = Beliefs({"usual": 0.0, **{f"n{k}": np.log(0.02 / 0.98) for k in range(49)}}, frozenset())  # 0.5 and 0.02


def nothing_stands_out(name, names):
    return False


def test_beside_something_unknown_a_rare_effect_may_be_what_its_shape_lacks_of_the_law():
    """Three of fifty effects are needed beside it: 0.06 each by chance, 0.02 and 0.5 by what is met."""
    shown = beside_the_unknown(p({}, {"usual+n1+n2": 1.0}), USUAL, nothing_stands_out)
    assert shown.of("n1") == pytest.approx(0.02 / 0.08) == shown.of("n2")
    assert shown.of("usual") == pytest.approx(0.5 / 0.56)
    assert shown.none_of_these == pytest.approx((0.06 / 0.08) ** 2 * 0.06 / 0.56)


def test_an_effect_that_is_needed_alone_is_believed_more_than_one_of_many():
    every = [p({}, {sets: 1.0}) for sets in ("n1", "n1+n2+n3+n4")]
    one, many = (beside_the_unknown(one, USUAL, nothing_stands_out).of("n1") for one in every)
    assert one == pytest.approx(0.02 / 0.04) and many == pytest.approx(0.02 / 0.1)


def test_what_is_there_without_something_unknown_and_that_it_is_stay_as_they_are():
    before = p({"": 0.01, "n1": 0.04}, {"": 0.15, "n1": 0.5, "usual+n2": 0.3})
    shown = beside_the_unknown(before, USUAL, nothing_stands_out)
    assert shown.alone == before.alone and shown.remains == pytest.approx(before.remains)
    assert sum(shown.sets.values()) == pytest.approx(1.0)
    assert shown.nothing == before.nothing and 0.04 < shown.of("n1") < before.of("n1")


@pytest.mark.parametrize("remains", (0.6, 0.97))
def test_beside_something_unknown_only_what_stands_out_is_named(remains):
    """A drag from a threshold speed on is followed by windage, which explains ten times as much as what that leaves."""
    given = p({"n1": 1 - remains}, {"n1": remains})
    found = verdict(beside_the_unknown(given, USUAL, nothing_stands_out), SURE, 0.0)
    assert (found.kind, found.names, found.probability) == ("none_of_these", (), pytest.approx(remains))
    plain = verdict(beside_the_unknown(given, USUAL, lambda name, names: name == "n1"), SURE, 0.0)
    assert (plain.kind, plain.names, plain.probability) == ("partial", ("n1",), pytest.approx(1.0))


def test_an_unknown_function_that_needs_no_effect_stays_alone():
    shown = beside_the_unknown(p({"n1": 0.02}, {"": 0.98}), USUAL, nothing_stands_out)
    assert shown.beside == {frozenset(): 0.98}


@pytest.mark.parametrize("spread, said", [(1.0, ("reversal",)), (0.5, ())])
def test_what_the_readings_tell_next_to_nothing_of_is_known(spread, said):
    """An interval as wide as what was believed before, and one of half its width."""
    prior = parameters_of(CoulombFriction)["reversal"].prior
    low, high = (prior.value(side * 1.645 * spread) for side in (-1, 1))
    sizes = {"level": Estimate(4.0, 0.1, 3.8, 4.2, "N"), "reversal": Estimate(1e-3, 1e-3, low, high, "m/s")}
    assert as_believed(CoulombFriction(), sizes) == said
