"""Probabilities add up, twins are mutual, and each kind of verdict is reached by the situation it is meant for."""

import numpy as np
import pytest

from tests.workbench.toy_bench import Bump, Hardening
from workbench.explain.hypotheses import Hypothesis
from workbench.explain.verdict import Evidences, Posterior, Signs, leaders, posterior, separation, twins_of, verdict
from workbench.likelihood.fit import Fit

QUIET, LOUD = Signs(False, 1.0), Signs(True, 1.0)


def test_probabilities_add_up_to_one_and_priors_are_recovered_without_data():
    names = [f"e{k}" for k in range(5)]
    pairs = {(a, b): 0.0 for k, a in enumerate(names) for b in names[k + 1 :]}
    p = posterior(Evidences(0.0, dict.fromkeys(names, 0.0), pairs, 0.0, dict.fromkeys(names, 0.0)))
    total = p.nothing + p.unknown + sum(p.singles.values()) + sum(p.pairs.values()) + sum(p.rest.values())
    assert total == pytest.approx(1.0)
    assert p.nothing == pytest.approx(0.5) and sum(p.singles.values()) == pytest.approx(0.35)
    assert p.unknown == pytest.approx(0.05) and sum(p.rest.values()) == pytest.approx(0.05)


def test_an_evidence_of_ten_nats_outweighs_the_prior_of_nothing():
    p = posterior(Evidences(0.0, {"a": 10.0, "b": 0.0}, {}, 0.0, {}))
    assert p.singles["a"] / p.nothing == pytest.approx(np.exp(10) * 0.175 / 0.5)


def hypothesis(effect, slopes):
    nothing = np.zeros(len(slopes))
    return Hypothesis(Fit((effect,), np.zeros(1), np.zeros(1), nothing, slopes, 0.0, 0.0, np.eye(2)), None, 0.0)


def test_separation_is_the_gain_in_chi2_that_is_left_and_twins_are_mutual():
    random = np.random.default_rng(2)
    nuisance, first = random.standard_normal((2, 30))
    second = first + 0.3 * random.standard_normal(30)
    one = hypothesis(Hardening(), np.column_stack([1e4 * nuisance, first]))
    two = hypothesis(Bump(), np.column_stack([1e4 * nuisance, second]))
    changes = {"hardening": 2 * first, "bump": 2 * second}
    nats = separation(one, two, 1, changes)
    basis = np.column_stack([nuisance, second])  # a nuisance without bounds is fitted freely
    left = 2 * first - basis @ np.linalg.lstsq(basis, 2 * first, rcond=None)[0]
    assert nats == pytest.approx(0.5 * left @ left, rel=1e-4)
    both = {("hardening", "bump"): 1.0, ("bump", "hardening"): 50.0}
    assert twins_of("hardening", both) == ("bump",) and twins_of("bump", both) == ("hardening",)


def said(p, signs=LOUD, twins=None):
    found = verdict(p, twins or {}, signs)
    return found.kind, found.names


def singles(**shares):
    return Posterior(1 - sum(shares.values()), shares, {}, 0.0, {})


def test_each_verdict():
    sure = singles(a=0.97, b=0.01)
    assert said(sure) == ("effect", ("a",))
    assert said(sure, twins={"a": ("b",)}) == ("group", ("a", "b"))
    assert said(singles(a=0.5, b=0.45)) == ("group", ("a", "b"))
    assert said(sure, QUIET) == ("nothing_missing", ())
    assert said(sure, Signs(False, 0.2)) == ("cannot_tell", ())
    assert said(sure, Signs(True, 0.2)) == ("cannot_tell", ())
    assert said(sure, Signs(True, 1.0, left=True)) == ("partial", ("a",))
    assert said(sure, Signs(False, 1.0, left_by_nothing=True)) == ("none_of_these", ())
    assert said(Posterior(0.0, {"a": 0.1}, {("a", "b"): 0.9}, 0.0, {})) == ("pair", ("a", "b"))
    bent = Posterior(0.0, {"a": 0.02, "b": 0.08}, {("a", "b"): 0.9}, 0.0, {})
    assert said(bent, Signs(True, 1.0, bendable=True)) == ("partial", ("b",))
    assert said(Posterior(0.0, {"a": 0.1}, {}, 0.9, {})) == ("none_of_these", ())
    assert said(Posterior(0.0, {"a": 0.1}, {}, 0.0, {"a": 0.9})) == ("partial", ("a",))
    assert said(singles(a=0.2, b=0.2, c=0.2, d=0.2, e=0.2)) == ("cannot_tell", ())


def test_something_left_speaks_before_a_name_and_the_leader_is_named():
    sure = singles(a=0.97, b=0.01)
    assert said(sure, Signs(True, 1.0, left=True, idle=True)) == ("none_of_these", ())
    other = Posterior(0.0, {"a": 0.3, "b": 0.01}, {}, 0.0, {"b": 0.69})
    assert said(other) == ("partial", ("a",))  # the unknown function stands beside b, but a explains more by itself


def test_a_pair_is_named_where_only_twins_can_replace_its_members():
    unsure = Posterior(0.0, {"a": 0.0}, {("a", "b"): 0.6, ("a", "c"): 0.4}, 0.0, {})
    assert said(unsure) == ("partial", ("a",))
    assert said(unsure, twins={"b": ("c",)}) == ("pair", ("a", "b"))
    assert said(unsure, Signs(True, 1.0, mended="b")) == ("effect", ("b",))


def test_the_leader_is_known_where_all_probabilities_of_effects_vanish():
    """2000 nats behind an effect beside the unknown function every single probability is zero to a computer."""
    p = posterior(Evidences(0.0, {"a": 10.0, "b": 4000.0}, {("a", "c"): 12.0}, 0.0, {"a": 6000.0}))
    assert p.singles["b"] == 0.0 and leaders(p) == ("b",)
    assert said(p) == ("partial", ("b",))
