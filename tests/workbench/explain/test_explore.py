"""Sets of effects by linear algebra against trying every one of them."""

from dataclasses import replace

import numpy as np
import pytest

from tests.workbench.explain.linear_bench import beliefs, by_force, names_of
from workbench.believed import MOST
from workbench.explain.explore import explored


def explained(names, residual, **more):
    believed = more.pop("beliefs", beliefs(names))
    (found,) = explored(names, names.catalogue.readings(residual[:, None]), believed, **more)
    return found, believed


def leader(found, believed):
    return max(found, key=lambda n: found[n].gain + believed.log_prior(n))


@pytest.mark.parametrize("truth", [(1,), (0, 3), (0, 2, 4), (1, 3, 5, 6)])
def test_up_to_four_effects_at_once_are_found(truth):
    random = np.random.default_rng(len(truth))
    shapes = 2.0 * random.standard_normal((60, 8))
    residual = 1.3 * shapes[:, list(truth)].sum(axis=1) + random.standard_normal(60)
    found, believed = explained(names_of(shapes), residual)
    assert leader(found, believed) == {f"e{k}" for k in truth}


def test_the_leading_set_and_its_gain_are_those_of_trying_all():
    """The gain of a set is made of one effect after the other, each at the best size of those before: good to a nat."""
    random = np.random.default_rng(5)
    shapes = 1.5 * random.standard_normal((40, 5))
    for seed in range(6):
        noise = np.random.default_rng(seed).standard_normal(40)
        names = names_of(shapes)
        residual = shapes[:, [seed % 5, (seed + 2) % 5]] @ [1.2, -1.6] + noise
        found, believed = explained(names, residual, most=2)
        force = by_force(names, residual, 2)
        best = max(force, key=lambda n: force[n] + believed.log_prior(n))
        assert leader(found, believed) == best
        assert found[best].gain == pytest.approx(force[best], abs=1.0)


def test_two_effects_that_hide_one_another_are_found():
    """Each alone leaves all as it is, as they almost cancel; together they explain everything."""
    random = np.random.default_rng(1)
    common, own = random.standard_normal((2, 80))
    shapes = np.column_stack([3.0 * common + 0.6 * own, -3.0 * common + 0.6 * own, *random.standard_normal((4, 80))])
    residual = shapes[:, 0] + shapes[:, 1] + 0.3 * random.standard_normal(80)
    names = names_of(shapes)
    found, believed = explained(names, residual)
    alone = max(found[frozenset((name,))].gain for name in ("e0", "e1"))
    assert alone < -believed.log_prior(frozenset(("e0",))), "neither is believed alone"
    assert leader(found, believed) == {"e0", "e1"}


def test_a_special_case_never_stands_beside_what_contains_it():
    random = np.random.default_rng(2)
    shapes = 2.0 * random.standard_normal((50, 4))
    residual = shapes[:, 0] + shapes[:, 1] + random.standard_normal(50)
    names = names_of(shapes)
    found, believed = explained(names, residual, beliefs=beliefs(names, excluded=[("e0", "e1")]))
    assert not any({"e0", "e1"} <= have for have in found)
    free, _ = explained(names, residual)
    assert any({"e0", "e1"} <= have for have in free)


def test_effects_of_the_background_count_among_the_most_and_exclude_too():
    random = np.random.default_rng(3)
    names = names_of(random.standard_normal((30, 5)))
    have = frozenset(("a", "b", "c"))
    believed = beliefs(names, excluded=[("a", "e2")])
    believed = replace(believed, log_odds={**believed.log_odds, **dict.fromkeys(have, -4.0)})
    found, _ = explained(names, random.standard_normal(30), beliefs=believed, already=have, most=MOST)
    assert max(map(len, found)) == 1 and frozenset(("e2",)) not in found and len(found) == 5


def test_many_readings_together_are_explained_as_each_alone():
    random = np.random.default_rng(4)
    names = names_of(random.standard_normal((30, 4)))
    residuals = random.standard_normal((30, 6)) + names.catalogue.terms[3].shift[:, None]
    together = explored(names, names.catalogue.readings(residuals), beliefs(names), most=3, beam=(1, 3, 2))
    for found, residual in zip(together, residuals.T):
        alone, _ = explained(names, residual, most=3, beam=(1, 3, 2))
        assert {n: e.terms for n, e in found.items()} == {n: e.terms for n, e in alone.items()}
        assert {n: e.gain for n, e in found.items()} == pytest.approx({n: e.gain for n, e in alone.items()})


def test_what_every_other_bench_shows_is_not_counted():
    """Five at once where one of them is usual; not five unusual ones."""
    random = np.random.default_rng(8)
    shapes = 2.0 * random.standard_normal((80, 8))
    names = names_of(shapes)
    rare = beliefs(names)
    usual = replace(rare, log_odds={**rare.log_odds, "e6": 0.0})
    residual = 1.3 * shapes[:, [0, 1, 3, 5, 6]].sum(axis=1) + random.standard_normal(80)
    found, _ = explained(names, residual, most=5, beam=(1, 8, 6, 4, 2), beliefs=usual)
    assert leader(found, usual) == {"e0", "e1", "e3", "e5", "e6"}
    assert max(map(len, explained(names, residual, most=5, beam=(1, 8, 6, 4, 2), beliefs=rare)[0])) == MOST
    assert usual.leaves_room(frozenset(("e0", "e1", "e3", "e5")))
    assert not usual.leaves_room(frozenset(("e0", "e1", "e3", "e5", "e6")))
