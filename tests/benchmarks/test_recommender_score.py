"""The score of the advice on what to measure next: its arithmetic, and one case from end to end."""

import pytest

from benchmarks.recommender_score import MEASURED, PARTS, RecommenderScore, Tried, score


def case(after, advised, bench="damper", before=0.1):
    return Tried(bench, 12000, "coulomb_friction", before, after, advised)


def test_advice_is_measured_against_the_best_and_the_best_fixed_option():
    cases = [
        case({"a": 0.9, "b": 0.3}, {"a": 5.0, "b": 1.0}),
        case({"a": 0.2, "b": 0.8}, {"a": 0.1, "b": 0.2}),
        case({"a": 0.6, "b": 0.5}, {"a": 1.0, "b": 2.0}),
    ]
    found = score(cases)
    assert (found.cases, found.advised) == (3, pytest.approx((0.8 + 0.7 + 0.4) / 3))
    assert found.oracle == pytest.approx((0.8 + 0.7 + 0.5) / 3)
    assert found.fixed == pytest.approx((0.8 + 0.1 + 0.5) / 3), "a, in every case"
    assert found.blind == pytest.approx((0.5 + 0.4 + 0.45) / 3)
    assert found.share == pytest.approx(1.9 / 2.0) and found.passed


def test_the_fixed_option_is_one_of_each_bench():
    cases = [case({"a": 0.9, "b": 0.3}, {"a": 1.0, "b": 0.0}), case({"c": 0.5}, {"c": 1.0}, bench="dq")]
    assert score(cases).fixed == pytest.approx((0.8 + 0.4) / 2)
    assert not RecommenderScore(2, 0.6, 0.6, 0.6, 0.4).passed, "no better than always the same"


def test_what_is_measured_first_is_one_of_the_parts():
    assert all(first in PARTS[bench] and len(PARTS[bench]) > 2 for bench, first in MEASURED.items())
