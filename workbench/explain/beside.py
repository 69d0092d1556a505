"""Unknown functions beside nothing and beside what leads, and effects beside the best of these."""

from __future__ import annotations

from heapq import heappush

import numpy as np

from workbench.explain.explore import Explanation, explored
from workbench.explain.hypotheses import Beside, beside_unknown
from workbench.explain.neighbours import fit_part
from workbench.explain.tried import REACH, Progress, Promise, Search, Set, additions, fit_set, label_of

BESIDE = 4  # sets that are looked at beside an unknown function
MOST_BESIDE = 16  # effects at most that are fitted beside one; BESIDE where it is far better than any without


def weigh_unknown(search: Search, progress: Progress) -> None:
    """Unknown functions beside nothing and beside the leaders, and effects beside the best of these."""
    progress("unknown functions")
    most = BESIDE if search.is_beaten else MOST_BESIDE
    for names in [*search.ranked[:BESIDE], frozenset()]:
        weigh(search, names)
    if not search.beside:
        return
    heap: list[Promise] = []
    _effects_beside(search, search.beside[frozenset()], heap)
    if leader := search.leader_beside:
        _effects_beside(search, search.beside[leader], heap)
    best = lambda: search.best_beside - search.beliefs.log_unknown  # noqa: E731
    for number, promise in enumerate(sorted(heap)[:most]):
        if number < BESIDE or -promise.order >= best() - REACH:
            _fit_beside(search, promise)


def less_one_beside(search: Search, progress: Progress) -> None:
    """What leads beside an unknown function is weighed there without each of its effects, until such a leader is found:
    where such a function ends the search, nobody has asked for these, and an effect of no size at all was named."""
    parted: set[Set] = set()
    while search.is_beaten and (leader := search.leader_beside) not in parted:
        parted.add(leader)
        for names in (leader - {name} for name in sorted(leader)):
            progress("an unknown function beside " + (label_of(names) or "nothing"))
            if names in search.fitted or fit_part(search, search.fitted[leader], names):
                weigh(search, names)


def weigh(search: Search, names: Set) -> None:
    """An unknown function beside a set that was fitted, where that was not looked at yet."""
    found = None if names in search.beside else beside_unknown(search.fitted[names], search.shapes)
    if found is not None:
        search.beside[names] = found


def _effects_beside(search: Search, beside: Beside, heap: list[Promise]) -> None:
    """What one effect more would gain beside an unknown function."""
    hypothesis = beside.hypothesis
    have = hypothesis.names
    if not search.beliefs.leaves_room(have):
        return
    added = additions(search, hypothesis, np.hstack([hypothesis.fit.jacobian, beside.columns()]))
    promised: dict[Set, tuple[Explanation, float]] = {}
    (looked_at,) = explored(added.names, [added.readings], search.beliefs, have, len(have) + 1)
    for found in looked_at.values():
        every = have | found.names
        if found.names and every not in search.beside:
            gain = beside.log_evidence + search.forms.get(have, 0.0) + added.gain(found)
            search.guessed_beside[every] = max(gain, search.guessed_beside.get(every, -np.inf))
            promised[every] = found, gain + search.beliefs.log_prior(every)
    for promise in added.promises(promised):
        heappush(heap, promise)


def _fit_beside(search: Search, promise: Promise) -> None:
    """A set beside an unknown function, fitted where the set was not."""
    every = promise.every
    if every in search.beside:
        return
    search.guessed_beside.pop(every, None)
    if every in search.fitted or fit_set(search, promise):
        weigh(search, every)
