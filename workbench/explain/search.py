"""The search for what is missing: linear algebra promises, fits of the model itself decide, best first.

A set is fitted when what it promises is within reach of the best that was fitted.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from heapq import heapify, heappop, heappush
from typing import Any

import numpy as np

from effects.base import Effect
from workbench.believed import MOST, PLAIN
from workbench.errors import WorkbenchError
from workbench.explain.beside import less_one_beside, weigh, weigh_unknown
from workbench.explain.explore import Beliefs, beliefs_of
from workbench.explain.hypotheses import Hypothesis, exact, null_of
from workbench.explain.neighbours import exchange, exchange_two, less_one
from workbench.explain.tried import (
    NO_FIT,
    REACH,
    Progress,
    Promise,
    Search,
    Set,
    expand,
    fit_set,
    label_of,
    promised_of,
)
from workbench.likelihood.bench import Bench, reweighed
from workbench.likelihood.signatures import Signatures, candidates, signatures_of
from workbench.likelihood.unknown import Shape, shapes_of
from workbench.likelihood.unknown_laws import LAWS

FITS = 60  # fits of sets of effects at most
FIRST_FITS = 8  # after which what leads is asked for the first time which readings are wild
PATIENCE = 8  # fits for every unknown function that is weighed before the end
LEAST_FITS = 3  # fits at least: a table of one effect tells nobody what was thought of
EXACT = 8  # fits that are repeated exactly, where the base model answers by an expansion, and what leads then
DOUBT = 8.0  # nats that an exact model may give an effect of which no fit is exact: up to 7.5 were seen
ROUNDS = 3  # of sets and exact models at most
PART_GAINS = 2.0  # times what an exact model gave what leads, that it may give a part of it besides


def searched(bench: Bench, library: Mapping[str, type[Effect]], progress: Progress = lambda words: None) -> Search:
    """Tries every effect of a library and every unknown law, alone and with others, and unknown functions. It begins
    anew where what leads takes other readings for wild than the model that lacks it, and they are plainly likelier so:
    after a few fits, as large effects lead early, and after the first pass."""
    every = {**library, **LAWS}
    signatures = signatures_of(bench, candidates(bench, every), progress)
    beliefs = beliefs_of(every, signatures.names)
    search, heap = _begun(bench, signatures, beliefs, _shapes(bench))
    for most in (FIRST_FITS, FITS):
        _best_first(search, heap, progress, most)
        again = reweighed(search.bench, _answers(search.fitted[search.ranked[0]], search.bench))
        if again is not search.bench:
            search, heap = _begun_again(search, again)
    _until_exact(search, heap, progress)
    weigh_unknown(search, progress)
    _exactly(search, progress)
    _leader_beside(search, progress)
    less_one_beside(search, progress)
    if search.ranked[0] not in search.exact:  # a part that was found only now
        _exactly(search, progress)
    return search


def _leader_beside(search: Search, progress: Progress) -> None:
    """What leads once models are exact is weighed beside an unknown function as well: a set that an exact model had
    brought to the front left a chi2/n of 5 and was believed, as nobody had asked."""
    for _ in range(ROUNDS):
        if search.ranked[0] in search.beside:
            break
        _weigh_leader(search, progress)
        _exactly(search, progress)


def _begun(
    bench: Bench, signatures: Signatures, beliefs: Beliefs, shapes: tuple[Shape, ...], **kept: Any
) -> tuple[Search, list[Promise]]:
    """A search that has fitted nothing but the null, and what is promised beside it. kept: of ``Search``"""
    null, heap = null_of(bench), list[Promise]()
    search = Search(bench, signatures, beliefs, shapes, {null.names: null}, failed=dict(signatures.failed), **kept)
    expand(search, null, heap)
    return search, heap


def _begun_again(search: Search, bench: Bench) -> tuple[Search, list[Promise]]:
    """The same where other readings are taken for wild: what effects do is as it was, and fits end not far from where
    they did."""
    known = [replace(each, white=bench.fit.white) for each in (search.signatures, *search.elsewhere)]
    before = {names: hypothesis.fit for names, hypothesis in search.fitted.items()}
    return _begun(bench, known[0], search.beliefs, _shapes(bench), elsewhere=known[1:], before=before)


def _shapes(bench: Bench) -> tuple[Shape, ...]:
    """Unknown functions of a bench."""
    return shapes_of(bench.fit.stack, bench.fit.white, bench.fit.predictor.predict(bench.null.x))


def _answers(hypothesis: Hypothesis, bench: Bench) -> np.ndarray:
    """Of a fit for all rows of a bench, as read where it has none: a row that is sealed may lie beyond it (n,)."""
    found = hypothesis.problem.predictor.on(bench.stack).wherever_known(hypothesis.fit.x, hypothesis.effects)
    return np.where(np.isfinite(found), found, bench.stack.y)


def best_alone(bench: Bench, signatures: Signatures, beliefs: Beliefs) -> Hypothesis:
    """The fit of the one effect that the signatures are of, with the evidence of all its forms.

    Raises:
        WorkbenchError: the model has no answer with it.
    """
    search, heap = _begun(bench, signatures, beliefs, ())
    if not (heap and fit_set(search, heap[0])):
        raise WorkbenchError(next(iter(search.failed.values()), "no answer"))
    _exactly(search, lambda words: None)
    every = heap[0].every
    return replace(search.fitted[every], log_evidence=search.log_evidence(every))


def _until_exact(search: Search, heap: list[Promise], progress: Progress) -> None:
    """Sets of effects; once more where exact models let another set lead, whose neighbours nobody has looked at, or
    bring a promise within reach, and where an unknown function had ended the search, but not beside a model that is
    exact."""
    settled: set[Set] = set()
    for _ in range(ROUNDS):
        _effects_alone(search, heap, settled, progress)
        ended = search.is_over
        _exactly(search, progress)
        if (leader := search.ranked[0]) in search.exact and leader in search.expanded:
            expand(search, search.fitted[leader], heap)
        is_settled = leader in settled and not _reaches(search, heap)
        if search.is_over or (is_settled and not ended):
            break


def _reaches(search: Search, heap: list[Promise]) -> bool:
    """Whether a promise is within reach of the best, now that exact models are known; all are given their new order."""
    if len(search.exact) == 1 or len(search.fitted) > FITS:  # nothing but the null is exact
        return False
    _renew(search, heap)
    best = max(search.log_posterior(search.ranked[0]), search.best_beside)
    return any(-promise.order >= best - REACH for promise in heap[:1])


def _renew(search: Search, heap: list[Promise]) -> None:
    """What can be fitted still, as it promises now."""
    heap[:] = [p for p in heap if p.every in search.guessed and p.label not in search.failed]
    for promise in heap:
        promise.order = -promised_of(search, promise.every)
    heapify(heap)


def _effects_alone(search: Search, heap: list[Promise], settled: set[Set], progress: Progress) -> None:
    """Sets of effects, best first; then what leads without each of its effects and with each exchanged for another,
    until that changes nothing, or an unknown function is better by far. settled: sets that led and were treated so"""
    _best_first(search, heap, progress)
    while (leader := search.ranked[0]) not in settled:
        _weigh_leader(search, progress)
        if search.is_over:
            break
        settled.add(leader)
        less_one(search, progress)
        for names in (leader - {name} for name in sorted(leader)):
            if names in search.fitted and names not in search.expanded:
                expand(search, search.fitted[names], heap)
        exchange(search, leader, progress)
        _best_first(search, heap, progress)
        if search.ranked[0] == leader:
            exchange_two(search, leader, progress)


def _weigh_leader(search: Search, progress: Progress) -> None:
    """An unknown function beside what leads."""
    progress("an unknown function")
    weigh(search, search.ranked[0])


def _leads_on(search: Search, names: Set) -> bool:
    """Whether it is worth to look for more beside a fit."""
    return search.is_near(names) and search.beliefs.leaves_room(names)


def _best_first(search: Search, heap: list[Promise], progress: Progress, most: int = FITS) -> None:
    """Fits what promises most, until nothing promises enough."""
    while heap and len(search.fitted) <= most:
        promise = heappop(heap)
        if promise.every in search.fitted or label_of(promise.every) in search.failed:
            continue
        if _has_paled(search, promise):
            heappush(heap, promise)
            continue
        if (smaller := _smaller(search, promise, heap)) is not None:
            heappush(heap, promise)
            promise = smaller
        if len(search.fitted) // PATIENCE > len(search.beside):
            _weigh_leader(search, progress)
        if -promise.order < _enough(search) and len(search.fitted) > LEAST_FITS:
            heappush(heap, promise)
            break
        progress("fitting " + promise.label)
        if fit_set(search, promise) and _leads_on(search, promise.every):
            expand(search, search.fitted[promise.every], heap)


def _enough(search: Search) -> float:
    """ln posterior that a set must promise to be fitted [nats]: that of the best one, an unknown function beside what
    leads among them, as of a machine that has what no effect is dozens explain a little more than others. Or plainly
    more than what leads, and so much that a few alike would do as well as that function: of three effects the first two
    leave more than it does."""
    leading = search.log_posterior(search.ranked[0])
    best = max(leading, search.best_beside)
    return min(best - REACH, leading + max(PLAIN, (best - leading) / MOST))


def _smaller(search: Search, promise: Promise, heap: list[Promise]) -> Promise | None:
    """A promise of the same effects but some that leads too, taken from the heap: if it is not kept, neither is that of
    the larger set, nor of a hundred others that hold it."""
    least = search.log_posterior(search.ranked[0]) - REACH
    open_ones = [p for p in heap if p.every < promise.every and p.every in search.guessed]
    leading = [p for p in open_ones if search.believed(p.every) >= least]
    if not leading:
        return None
    first = min(leading, key=lambda p: (len(p.every), p.order, p.label))
    heap.remove(first)
    heapify(heap)
    return first


def _has_paled(search: Search, promise: Promise) -> bool:
    """Whether a promise has become worse since it was made; it is given its new order."""
    order = -promised_of(search, promise.every)
    paled, promise.order = order > promise.order, max(order, promise.order)
    return paled


def _exactly(search: Search, progress: Progress) -> None:
    """What leads again with a base model that is exact where it ended. Others are believed to gain as much by that as
    the exact one that is most like them; what leads then is made exact, however many are: a belief was wrong by 18 nats
    of an eccentric rotor, and no more than a belief may name effects."""
    while search.bench.model.base.is_expansion:
        names = _next_exact(search)
        if names is None or (names != search.ranked[0] and len(search.exact) > EXACT):  # nothing at all is exact, too
            break
        progress("field solutions for " + label_of(names))
        before = search.fitted[names].log_evidence
        try:
            search.fitted[names] = exact(search.fitted[names])
        except NO_FIT as error:  # it ended at a device that cannot be
            search.drop(names, str(error))
            continue
        search.exact[names] = search.fitted[names].log_evidence - before
        if search.beside.pop(names, None) is not None:
            weigh(search, names)
        if search.is_beaten:
            break


def _next_exact(search: Search) -> Set | None:
    """What leads; then what leads without one of its effects, where it is not far behind: such an effect may have made
    good what the expansion lacks, so that its part gains more by an exact model than the whole (12 nats were seen, of a
    current's gain beside a weak magnet); then what might lead, where what an exact model gave what is most like it is
    wrong by as much as it is, where it would give as much as another set with one of its effects, or where an effect in
    the field is in no exact fit. Of these, sets with the same effects in the field gain alike."""
    leader = search.ranked[0]
    if leader not in search.exact:
        return leader
    most = search.log_posterior(leader)
    known = {names & search.of_expansion for names in search.exact if names}
    others = [names for names in search.ranked if names & search.of_expansion not in known]
    rivals = [n for n in others if search.log_posterior(n) + _doubt(search, n) > most]
    least = most - REACH - PART_GAINS * max(search.exact[leader], 0.0)
    parts = [n for n in search.ranked if n < leader and len(n) == len(leader) - 1 and search.log_posterior(n) >= least]
    return next(iter([n for n in parts if n not in search.exact] + rivals), None)


def _doubt(search: Search, names: Set) -> float:
    """What an exact model may give a set beyond what is believed [nats]."""
    mine, believed = names & search.of_expansion, search.exactness(names)
    unknown = mine - frozenset().union(*search.exact)
    more = [gain - believed for other, gain in search.exact.items() if other & mine]
    return max(DOUBT if unknown else 0.0, abs(believed), *more)
