"""Conventions that show only beside an effect.

How large a sine is, a linear damper does not feel, but friction does: peak to peak in the place of an amplitude looks
like guides that rub beside friction, beyond doubt. What ``conventions`` cannot see in the nominal device is weighed
here as effects are, by ln p of the rows to fit, beside what leads and beside its parts; one that turns signs and
brings a set of them much has a search of its own.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import chain

import numpy as np
from scipy.special import expit

from effects.base import Effect
from workbench.data.conventions import Fix, InvertedColumns, applied, pole_pairs, stated_factors
from workbench.data.stack import stacked
from workbench.data.table import Campaign
from workbench.explain.conventions import ALIKE, SETTLED, Conventions, Found, said_of
from workbench.explain.hypotheses import Hypothesis
from workbench.explain.misfit import ALLOWANCE, TINY
from workbench.explain.mistakes import power_flow, scales
from workbench.explain.search import searched
from workbench.explain.tried import NO_FIT, Progress, Search, Set
from workbench.likelihood.bench import bench_of
from workbench.likelihood.fit import Problem, promised, refitted

LEADERS = 8  # fitted sets beside which a convention is tried, and those of them with an effect less
REFITTED = 3  # of these, which promise most
SHARE = 0.3  # of what was explained, from which on a convention is worth a search of its own


@dataclass(frozen=True, eq=False)
class _Habit:
    """The same mistake in all tables that can have it. cost: minus ln of what is believed of it [nats]"""

    fixes: tuple[Fix, ...]
    cost: float

    @property
    def turns(self) -> bool:
        """Whether it turns signs: effects are others then, while a factor changes their sizes, which fits follow."""
        return any(isinstance(fix, InvertedColumns) for fix in self.fixes)

    def on(self, problem: Problem) -> Problem:
        """The same rows as they were meant."""
        tables = problem.stack.tables
        for fix in self.fixes:
            tables = tuple(fix.apply(table) if table.file == fix.file else table for table in tables)
        stack = replace(problem.stack, tables=tables, y=stacked(tables).y)
        return replace(problem, stack=stack, predictor=problem.predictor.on(stack))


def misread(
    search: Search, library: Mapping[str, type[Effect]], progress: Progress = lambda words: None
) -> Conventions | None:
    """The convention that is more likely than all that effects and unknown functions explain without it; None where
    none is. An expansion about a drawing is not asked: it knows the conditions of its tables only."""
    if search.bench.model.base.is_expansion or not (search.ranked[0] or search.is_beaten):
        return None
    best = _best(search)
    weighed = [_weighed(search, habit) for habit in _unseen(search)]
    odds = {one.habit: one.log_posterior - best for one in weighed}
    least = SHARE * (best - search.log_posterior(frozenset()))
    for habit in (one.habit for one in weighed if one.habit.turns and one.gain > least and odds[one.habit] <= 0):
        odds[habit] = _best_again(search, habit, library, progress) - habit.cost - best
    found = _said(search.bench.campaign, odds) if odds else None
    return found if found is not None and found.probability >= SETTLED else None


def _best(search: Search) -> float:
    """ln posterior of what explains most [nats]."""
    return max(search.log_posterior(search.ranked[0]), search.best_beside)


def _best_again(search: Search, habit: _Habit, library: Mapping[str, type[Effect]], progress: Progress) -> float:
    """The same of a search with the readings as they would have been meant."""
    progress("effects beside another convention")
    campaign = applied(search.bench.campaign, habit.fixes)
    try:
        return _best(searched(bench_of(search.bench.model, campaign, library), library, progress))
    except NO_FIT:
        return -np.inf


def _said(campaign: Campaign, odds: Mapping[_Habit, float]) -> Conventions:
    """odds: over all that needs no habit [nats]"""
    first, *others = sorted(odds, key=lambda habit: -odds[habit])
    likely = float(np.logaddexp.reduce(list(odds.values())))
    found = [Found(fix, odds[first], float(expit(odds[first]))) for fix in first.fixes]
    alike = [habit.fixes for habit in others if odds[habit] > odds[first] - ALIKE]
    return said_of(campaign, found, float(expit(likely)), alike, alike)


def _unseen(search: Search) -> Iterator[_Habit]:
    """Those with which the nominal device misses its readings no more than without, but for what any device may."""
    problem = search.bench.fit
    missed = _missed(problem)
    for habit in _doubted(search):
        try:
            more = _missed(habit.on(problem)) - missed
        except NO_FIT:
            continue
        if np.all(more <= ALLOWANCE):
            yield habit


def _missed(problem: Problem) -> np.ndarray:
    """By how much the nominal device misses every channel, relative to its readings (channels,)."""
    y, stack = problem.stack.y, problem.stack
    with np.errstate(all="ignore"):  # a wrong reading may ask for what no machine does
        off = y - problem.predictor.predict(problem.start)
    return np.sqrt(stack.by_channel(off**2) / np.maximum(stack.by_channel(y**2), TINY))


def _doubted(search: Search) -> list[_Habit]:
    """Factors on conditions that nothing is stated of, and power that counts the other way round."""
    campaign, found = search.bench.campaign, dict[Fix, _Habit]()
    for table in search.bench.fit.stack.tables:
        stated = stated_factors(campaign, table.file)
        factors = ((f, cost) for f, cost in scales(table, pole_pairs(campaign)) if stated.isdisjoint(f.columns))
        for fix, cost in chain(factors, power_flow(table)):
            before = found.get(fix.anywhere, _Habit((), cost))
            found[fix.anywhere] = replace(before, fixes=(*before.fixes, fix))
    return list(found.values())


@dataclass(frozen=True, eq=False)
class _Weighed:
    """log_posterior: of the best set of effects beside a habit;  gain: what it brought one of them most [nats]"""

    habit: _Habit
    log_posterior: float
    gain: float


def _weighed(search: Search, habit: _Habit) -> _Weighed:
    """Beside nothing, what leads and its parts, and what promises."""
    near = (names for leading in search.ranked[:LEADERS] for names in _parts(leading))
    sets = [names for names in near if names in search.fitted]
    promises = {names: search.log_posterior(names) + _gain(habit, search.fitted[names]) for names in sets}
    best = sorted(promises, key=lambda names: -promises[names])[:REFITTED]
    parts = (names for names in (frozenset[str](), *_parts(search.ranked[0])) if names in search.fitted)
    gains = {names: _refitted_gain(habit, search.fitted[names]) for names in dict.fromkeys([*best, *parts])}
    most = max(search.log_posterior(names) + gain for names, gain in gains.items())
    return _Weighed(habit, most - habit.cost, max(gains.values()))


def _parts(names: Set) -> list[Set]:
    """A set, and what it is without one of its effects."""
    return [names, *(names - {name} for name in sorted(names))]


def _gain(habit: _Habit, hypothesis: Hypothesis) -> float:
    """What a fit is promised to gain [nats]."""
    try:
        return promised(habit.on(hypothesis.problem), hypothesis.fit)
    except NO_FIT:
        return -np.inf


def _refitted_gain(habit: _Habit, hypothesis: Hypothesis) -> float:
    """What it gains [nats]."""
    try:
        return refitted(habit.on(hypothesis.problem), hypothesis.fit).log_evidence - hypothesis.fit.log_evidence
    except NO_FIT:
        return -np.inf
