"""The search for what is missing: linear algebra promises, fits of the model itself decide, best first.

Sets of up to four effects are looked at beside every set that was fitted, at its own slopes and with the errors of its
laws. A set is fitted when what it promises is within reach of the best that was fitted.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from heapq import heapify, heappop, heappush
from math import log

import numpy as np

from effects.base import Effect
from effects.parameter import parameters_of
from workbench.believed import MOST
from workbench.errors import WorkbenchError
from workbench.explain.explore import Beliefs, Explanation, Names, Posterior, beliefs_of, explored, posterior
from workbench.explain.hypotheses import (
    Beside,
    Hypothesis,
    at_zero,
    beside_unknown,
    exact,
    fitted_from,
    null_of,
)
from workbench.likelihood.bench import Bench
from workbench.likelihood.fit import FAR, misfit, with_parameters
from workbench.likelihood.marginal import Readings
from workbench.likelihood.signatures import Signatures, candidates, signatures_of
from workbench.likelihood.unknown import Shape, shapes_of

FITS = 60  # fits of sets of effects at most
LEAST_FITS = 3  # fits at least: a table of one effect tells nobody what was thought of
REACH = 2.0  # nats behind the best, beyond which a set is left at what it promises: promises were good to one nat
EXCHANGED = 2  # others that are tried in the place of each effect of what leads
PULLED = 3.0  # standard deviations of a tolerance, from which its place is offered to effects
ALMOST = 0.7  # of the change by an effect, that another may leave to be tried in its place
SLACK = 0.2  # of a promised gain, by which a promise may be too modest where the model is not linear
EXACT = 4  # fits that are repeated exactly, where the base model answers by an expansion
PART_GAINS = 2.0  # times what an exact model gave what leads, that it may give a part of it besides
KEPT = 40  # promises beside one fit that are followed up
BESIDE = 4  # sets that are looked at beside an unknown function
MOST_BESIDE = 16  # effects at most that are fitted beside one

Progress = Callable[[str], None]
Set = frozenset[str]


@dataclass(order=True)
class Promise:
    """A set that could be fitted, by linear algebra beside a fit. order: minus ln of its promised posterior

    effects, x, z: null effects, nuisances and parameters where a fit of it begins
    forms: what other forms of its effects add to ln evidence [nats]
    """

    order: float
    label: str
    every: Set = field(compare=False)
    effects: tuple[Effect, ...] = field(compare=False)
    x: np.ndarray = field(compare=False)
    z: np.ndarray = field(compare=False)
    forms: float = field(compare=False)


@dataclass(frozen=True, eq=False)
class Additions:
    """What may be added beside a fit. The products of all columns are let go of when the promises are made."""

    search: Search
    parent: Hypothesis
    names: Names
    readings: Readings

    def promises(self, found: Mapping[Set, tuple[Explanation, float]]) -> list[Promise]:
        """Of sets with ln of their promised posterior; the best few and the smaller ones that they hold."""
        leading = sorted(found, key=lambda every: (-found[every][1], _label(every)))[:KEPT]
        return [self._promise(e, *found[e]) for e in found if any(e <= every for every in leading)]

    def _promise(self, every: Set, found: Explanation, promised: float) -> Promise:
        fit, m = self.parent.fit, len(self.parent.fit.x)
        weights = self.names.catalogue.given(found.terms, self.readings).weights
        effects, z = list(fit.effects), [fit.z + weights[m : m + len(fit.z)]]
        place = self.names.catalogue.background.shape[1]
        for term in (self.names.catalogue.terms[t] for t in found.terms):
            signature = self.search.signatures.found[term.name][term.variant]
            count = len(parameters_of(signature.effect))
            effects.append(signature.effect)
            z.append(signature.at(term.place, np.clip(weights[place : place + count], -2.0, 2.0)))
            place += count
        forms = self.search.forms.get(self.parent.names, 0.0) + found.forms
        x = np.clip(weights[:m], -FAR, FAR)
        return Promise(-promised, _label(every), every, tuple(effects), x, np.concatenate(z), forms)


@dataclass(eq=False)
class Search:
    """All that was tried. fitted: by set of names;  forms: what other forms of the effects add to ln evidence

    guessed: ln evidence of sets that promised too little to be fitted;  origins: the fitted sets beside which that was
    guessed;  beside: sets beside an unknown function
    guessed_beside: ln evidence of such sets that were not fitted;  expanded: fits beside which more was looked for
    exact: sets that were fitted with a base model that is exact where they ended, and what this gave them [nats]
    """

    bench: Bench
    signatures: Signatures
    beliefs: Beliefs
    shapes: tuple[Shape, ...]
    fitted: dict[Set, Hypothesis]
    forms: dict[Set, float] = field(default_factory=dict)
    guessed: dict[Set, float] = field(default_factory=dict)
    origins: dict[Set, Set] = field(default_factory=dict)
    beside: dict[Set, Beside] = field(default_factory=dict)
    guessed_beside: dict[Set, float] = field(default_factory=dict)
    failed: dict[str, str] = field(default_factory=dict)
    expanded: set[Set] = field(default_factory=set)
    exact: dict[Set, float] = field(default_factory=lambda: {frozenset(): 0.0})

    def log_evidence(self, names: Set) -> float:
        """Of a set that was fitted, all its forms together [nats]."""
        return self.fitted[names].log_evidence + self.forms.get(names, 0.0) + self.exactness(names)

    def exactness(self, names: Set) -> float:
        """What an exact base model would give a set that has none: as much as the exact one that is most like it."""
        if names in self.exact:
            return 0.0
        return self.exact[min(self.exact, key=lambda e: (-len(e & names), len(e ^ names), sorted(e)))]

    def log_posterior(self, names: Set) -> float:
        """Up to what all share [nats]."""
        return self.log_evidence(names) + self.beliefs.log_prior(names)

    @property
    def ranked(self) -> list[Set]:
        """Sets that were fitted, most probable first."""
        return sorted(self.fitted, key=lambda names: -self.log_posterior(names))

    @property
    def unknown(self) -> np.ndarray:
        """Expected unknown function beside nothing, of the uncertainty of the rows to fit (n,); zero where none is
        seen."""
        out = np.zeros(self.bench.fit.stack.size)
        found = self.beside.get(frozenset())
        for s, function in zip(found.leading, found.functions) if found is not None else ():
            out[s.shape.rows] += function
        return out / self.bench.fit.white.sigma

    @property
    def posterior(self) -> Posterior:
        """Probabilities of everything that was fitted or guessed."""
        guessed = {names: guess + self.exactness(names) for names, guess in self.guessed.items()}
        alone = guessed | {names: self.log_evidence(names) for names in self.fitted}
        beside = {n: b.log_evidence + self.forms.get(n, 0.0) + self.exactness(n) for n, b in self.beside.items()}
        return posterior(alone, {**self.guessed_beside, **beside}, self.beliefs)


def searched(bench: Bench, library: Mapping[str, type[Effect]], progress: Progress = lambda words: None) -> Search:
    """Tries every effect of a library, alone and with others, and unknown functions."""
    signatures = signatures_of(bench, candidates(bench, library), progress)
    beliefs = beliefs_of(library, signatures.names)
    shapes = shapes_of(bench.fit.stack, bench.fit.white)
    search = Search(bench, signatures, beliefs, shapes, {frozenset(): null_of(bench)}, failed=dict(signatures.failed))
    _effects_alone(search, progress)
    _exactly(search, progress)
    _cap(search.guessed, search.beliefs, search.log_posterior(search.ranked[0]), search.exactness)
    _beside_unknown(search, progress)
    _exactly(search, progress)
    return search


def _cap(
    guessed: dict[Set, float], beliefs: Beliefs, best: float, added: Callable[[Set], float] = lambda names: 0.0
) -> None:
    """A guess that was not followed up counts for no more than the best that was fitted (ln posterior).

    added: what is added to the guess of a set [nats]
    """
    for names in guessed:
        guessed[names] = min(guessed[names], best - beliefs.log_prior(names) - added(names))


def best_alone(bench: Bench, signatures: Signatures, beliefs: Beliefs) -> Hypothesis:
    """The fit of the one effect that the signatures are of.

    Raises:
        WorkbenchError: the model has no answer with it.
    """
    search = Search(bench, signatures, beliefs, (), {frozenset(): null_of(bench)})
    heap: list[Promise] = []
    _expand(search, search.fitted[frozenset()], heap)
    if not (heap and _fit(search, heap[0])):
        raise WorkbenchError(next(iter(search.failed.values()), "no answer"))
    _exactly(search, lambda words: None)
    return search.fitted[heap[0].every]


def _effects_alone(search: Search, progress: Progress) -> None:
    """Sets of effects, best first; then what leads without each of its effects and with each exchanged for another,
    until that changes nothing."""
    heap: list[Promise] = []
    _expand(search, search.fitted[frozenset()], heap)
    _best_first(search, heap, progress)
    settled: set[Set] = set()
    while (leader := search.ranked[0]) not in settled:
        settled.add(leader)
        less_one(search, progress)
        for names in (leader - {name} for name in sorted(leader)):
            if names in search.fitted and names not in search.expanded:
                _expand(search, search.fitted[names], heap)
        _exchange(search, leader, progress)
        _best_first(search, heap, progress)


def _exchange(search: Search, leader: Set, progress: Progress) -> None:
    """What leads is weighed against the few that do most nearly the same as one of its effects, or as a tolerance that
    it pulls far, from where it ended: a promise beside such a pull is too modest by many nats."""
    whole = search.fitted[leader]
    starts = [promise for name in sorted(leader) for promise in _instead_of_effect(search, whole, name)]
    if len(leader) < MOST:
        pulled = np.flatnonzero(np.abs(whole.fit.x) > PULLED)
        starts += [promise for k in pulled for promise in _instead_of_pull(search, whole, int(k))]
    for promise in starts:
        if promise.every not in search.fitted and promise.label not in search.failed:
            progress("fitting " + promise.label)
            _fit(search, promise)


def _instead_of_effect(search: Search, whole: Hypothesis, name: str) -> list[Promise]:
    """Starts of a fit with one of its effects exchanged for others."""
    rest, z = _part_of(whole, whole.names - {name})
    x = whole.fit.x
    return _twins(search, whole, rest, z, x, whole.problem.predictor.predict(x, with_parameters(rest, z)))


def _instead_of_pull(search: Search, whole: Hypothesis, number: int) -> list[Promise]:
    """Starts of a fit with others in the place of a tolerance that it pulls far."""
    x = whole.fit.x.copy()
    x[number] = 0.0
    return _twins(search, whole, whole.fit.effects, whole.fit.z, x, whole.problem.predictor.predict(x, whole.effects))


def _twins(
    search: Search, whole: Hypothesis, rest: tuple[Effect, ...], z_rest: np.ndarray, x: np.ndarray, left: np.ndarray
) -> list[Promise]:
    """Starts with another effect that does most nearly what a fit does beyond what is left of it (n,), nearest first.

    rest, z_rest, x: what stays of the fit
    """
    problem = whole.problem
    target = problem.white(problem.predictor.predict(whole.fit.x, whole.effects) - left)
    starts = []
    for other in (o for o in search.signatures.names if search.beliefs.may_join(o, whole.names)):
        nearest = min((s.nearest(target, problem.white) for s in search.signatures.found[other]), key=lambda n: n[0])
        if nearest[0] < ALMOST * float(np.linalg.norm(target)):
            starts.append((nearest[0], other, *nearest[1:]))
    kept = frozenset(effect.name() for effect in rest)
    return [
        _start(search, kept | {other}, (*rest, effect), x, np.concatenate([z_rest, z]))
        for _, other, effect, z in sorted(starts, key=lambda start: start[:2])[:EXCHANGED]
    ]


def _start(search: Search, every: Set, effects: tuple[Effect, ...], x: np.ndarray, z: np.ndarray) -> Promise:
    """A fit of effects of which only the forms that they have count."""
    forms = -sum(log(len(search.signatures.found[name])) for name in sorted(every))
    return Promise(0.0, _label(every), every, effects, x, z, forms)


def _best_first(search: Search, heap: list[Promise], progress: Progress) -> None:
    while heap and len(search.fitted) <= FITS:
        promise = heappop(heap)
        if promise.every in search.fitted or _label(promise.every) in search.failed:
            continue
        if _has_paled(search, promise):
            heappush(heap, promise)
            continue
        if (smaller := _smaller(search, promise, heap)) is not None:
            heappush(heap, promise)
            promise = smaller
        within = -promise.order >= search.log_posterior(search.ranked[0]) - REACH
        if not within and len(search.fitted) > LEAST_FITS:
            heappush(heap, promise)
            break
        progress("fitting " + promise.label)
        if _fit(search, promise) and len(promise.every) < MOST:
            _expand(search, search.fitted[promise.every], heap)


def _smaller(search: Search, promise: Promise, heap: list[Promise]) -> Promise | None:
    """A promise of the same effects but some that leads too, taken from the heap: if it is not kept, neither is that of
    the larger set, nor of a hundred others that hold it."""
    least = search.log_posterior(search.ranked[0]) - REACH
    open_ones = [p for p in heap if p.every < promise.every and p.every in search.guessed]
    leading = [p for p in open_ones if search.guessed[p.every] + search.beliefs.log_prior(p.every) >= least]
    if not leading:
        return None
    first = min(leading, key=lambda p: (len(p.every), p.order, p.label))
    heap.remove(first)
    heapify(heap)
    return first


def _has_paled(search: Search, promise: Promise) -> bool:
    """Whether a promise has become worse since it was made; it is given its new order."""
    order = -_promised(search, promise.every)
    paled, promise.order = order > promise.order, max(order, promise.order)
    return paled


def _promised(search: Search, every: Set) -> float:
    """ln posterior that a set promises: its guess, and a share of what it would gain over all that was fitted of it."""
    guess = search.guessed[every]
    before = max(search.log_evidence(names) for names in search.fitted if names <= every)
    return guess + SLACK * max(guess - before, 0.0) + search.beliefs.log_prior(every)


def less_one(search: Search, progress: Progress) -> None:
    """What leads is weighed against itself without each of its effects, fitted from where it ended, once more where it
    was fitted from elsewhere: a promise beside a null whose tolerances were pulled far may have hidden such a part, or
    begun its fit in another valley. Until such a leader is found."""
    tried: set[Set] = set()
    while (leader := search.ranked[0]) not in tried:
        tried.add(leader)
        for names in (leader - {name} for name in sorted(leader)):
            if names:
                progress("fitting " + _label(names))
                _fit_part(search, search.fitted[leader], names)


def _fit_part(search: Search, whole: Hypothesis, names: Set) -> None:
    """Fits some of the effects of a fit, from where it ended."""
    effects, z = _part_of(whole, names)
    _fit(search, _start(search, names, effects, whole.fit.x, z))


def _part_of(whole: Hypothesis, names: Set) -> tuple[tuple[Effect, ...], np.ndarray]:
    """Some of the effects of a fit, as null effects, and their parameters."""
    parts, place = [], 0
    for effect in whole.fit.effects:
        count = len(parameters_of(effect))
        parts.append((effect, whole.fit.z[place : place + count]))
        place += count
    kept = [(effect, z) for effect, z in parts if effect.name() in names]
    return tuple(effect for effect, _ in kept), np.concatenate([np.zeros(0), *(z for _, z in kept)])


def _label(names: Set) -> str:
    return " with ".join(sorted(names))


def _fit(search: Search, promise: Promise) -> bool:
    """Fits a set; False where the model has no answer. Replaces a guess of it, and an earlier fit that was worse."""
    every = promise.every
    guess = search.guessed.pop(every, -np.inf)
    try:
        found = fitted_from(search.bench, promise.effects, promise.x, promise.z)
    except (WorkbenchError, ArithmeticError, np.linalg.LinAlgError) as error:
        if every not in search.fitted:
            search.failed[promise.label] = str(error)
        return every in search.fitted
    if every in search.fitted and found.log_evidence + promise.forms <= search.log_evidence(every):
        return True
    search.fitted[every] = found
    search.exact.pop(every, None)
    search.forms[every] = promise.forms
    _lower(search, every, max(guess - search.log_evidence(every), 0.0))
    return True


def _lower(search: Search, every: Set, shortfall: float) -> None:
    """Sets that hold one whose guess was too high were guessed too high as well, unless beside a nearer fit."""
    origin = search.origins.get(every, frozenset())
    for names in search.guessed:
        if names > every and search.origins[names] <= origin:
            search.guessed[names] -= shortfall


def _expand(search: Search, hypothesis: Hypothesis, heap: list[Promise]) -> None:
    """Promises of one or two effects more beside a fit."""
    have = hypothesis.names
    search.expanded.add(have)
    added = _additions(search, hypothesis, hypothesis.fit.jacobian)
    sets = explored(added.names, added.readings, search.beliefs, have, min(len(have) + 2, MOST))
    promised: dict[Set, tuple[Explanation, float]] = {}
    for every, found in ((have | found.names, found) for found in sets.values() if found.names):
        if every in search.fitted:
            continue
        guess = search.log_evidence(have) + student_gain(hypothesis, found.gain)
        origin = search.origins.get(every, frozenset())
        if every not in search.guessed or len(have) > len(origin) or guess > search.guessed[every]:
            search.guessed[every], search.origins[every] = guess, have
            promised[every] = found, _promised(search, every)
    renewed = added.promises(promised)
    stale = {promise.every for promise in renewed}
    heap[:] = [promise for promise in heap if promise.every not in stale] + renewed
    heapify(heap)


def _additions(search: Search, hypothesis: Hypothesis, background: np.ndarray) -> Additions:
    names = Names(search.signatures.catalogue(background, hypothesis.problem.white, hypothesis.names))
    return Additions(search, hypothesis, names, names.catalogue.readings(at_zero(hypothesis)[:, None])[0])


def student_gain(hypothesis: Hypothesis, gain: float) -> float:
    """A Gaussian gain of ln p in the likelihood of the fits [nats]: what pulled tolerances cost comes back as it is,
    the rest is taken from the channels that fit worst."""
    problem, x = hypothesis.problem, hypothesis.fit.x
    squares, sizes = problem.squares(hypothesis.fit.residual), problem.sizes
    excess = np.maximum(squares - sizes, 0.0)
    pulls = 0.5 * float(x @ x)
    left = gain - pulls
    if left <= 0 or excess.sum() == 0:
        return gain
    fall = np.minimum(2 * left * excess / excess.sum(), excess)
    return pulls + min(left, misfit(squares, problem.dof, sizes) - misfit(squares - fall, problem.dof, sizes))


def _exactly(search: Search, progress: Progress) -> None:
    """What leads again with a base model that is exact where it ended. Others are believed to gain as much by that as
    the exact one that is most like them; what leads then is made exact, too."""
    for _ in range(EXACT if search.bench.model.base.is_expansion else 0):
        names = _next_exact(search)
        if names is None:
            break
        progress("field solutions for " + _label(names))
        before = search.fitted[names].log_evidence
        search.fitted[names] = exact(search.fitted[names])
        search.exact[names] = search.fitted[names].log_evidence - before


def _next_exact(search: Search) -> Set | None:
    """What leads; then what leads without one of its effects, where it is not far behind: such an effect may have made
    good what the expansion lacks, so that its part gains more by an exact model than the whole."""
    leader = search.ranked[0]
    if leader not in search.exact:
        return leader
    parts = [n for n in search.ranked if n < leader and len(n) == len(leader) - 1 and n not in search.exact]
    least = search.log_posterior(leader) - REACH - PART_GAINS * max(search.exact[leader], 0.0)
    return next((n for n in parts if search.log_posterior(n) >= least), None)


def _beside_unknown(search: Search, progress: Progress) -> None:
    """Unknown functions beside nothing and beside the leaders, and effects beside the best of these."""
    progress("unknown functions")
    for names in dict.fromkeys([*search.ranked[:BESIDE], frozenset()]):
        found = beside_unknown(search.fitted[names], search.shapes)
        if found is not None:
            search.beside[names] = found
    if not search.beside:
        return
    heap: list[Promise] = []
    _effects_beside(search, search.beside[frozenset()], heap)
    leader = max(search.beside, key=lambda n: search.beside[n].log_evidence + search.beliefs.log_prior(n))
    if leader:
        _effects_beside(search, search.beside[leader], heap)
    best = lambda: max(b.log_evidence + search.beliefs.log_prior(n) for n, b in search.beside.items())  # noqa: E731
    for number, promise in enumerate(sorted(heap)[:MOST_BESIDE]):
        if number < BESIDE or -promise.order >= best() - REACH:
            _fit_beside(search, promise)
    _cap(search.guessed_beside, search.beliefs, best())


def _effects_beside(search: Search, beside: Beside, heap: list[Promise]) -> None:
    """What one effect more would gain beside an unknown function."""
    hypothesis = beside.hypothesis
    have = hypothesis.names
    if len(have) == MOST:
        return
    added = _additions(search, hypothesis, np.hstack([hypothesis.fit.jacobian, beside.columns()]))
    promised: dict[Set, tuple[Explanation, float]] = {}
    for found in explored(added.names, added.readings, search.beliefs, have, len(have) + 1).values():
        every = have | found.names
        if found.names and every not in search.beside:
            gain = beside.log_evidence + search.forms.get(have, 0.0) + student_gain(hypothesis, found.gain)
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
    found = None
    if every in search.fitted or _fit(search, promise):
        found = beside_unknown(search.fitted[every], search.shapes)
    if found is not None:
        search.beside[every] = found
