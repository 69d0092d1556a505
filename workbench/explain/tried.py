"""What was tried: sets of effects that were fitted, what linear algebra promises of others, and the fit of one more.

Sets of up to four effects are looked at beside every set that was fitted, at its own slopes and with the errors of its
laws.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from heapq import heapify
from math import exp, log

import numpy as np

from effects.base import Effect
from effects.parameter import parameters_of
from workbench.believed import PLAIN
from workbench.errors import WorkbenchError
from workbench.explain.explore import Beliefs, Explanation, Names, Posterior, explored, posterior
from workbench.explain.hypotheses import Beside, Hypothesis, at_zero, change_by, fitted_from, from_elsewhere, turned
from workbench.likelihood.bench import Bench
from workbench.likelihood.fit import FAR, Fit
from workbench.likelihood.gains import Gains
from workbench.likelihood.marginal import Readings
from workbench.likelihood.signatures import Signatures
from workbench.likelihood.unknown import Shape
from workbench.likelihood.unknown_laws import LAWS, UnknownLaw

REACH = 2.0  # nats behind the best, beyond which a set is left at what it promises: promises were good to one nat
SLACK = 0.2  # of a promised gain, by which a promise may be too modest where the model is not linear
NOTHING = 1.0  # nat, that is no evidence of anything
NEGLIGIBLE = 7.0  # nats behind the best, from which a fit says nothing of a size
STARTS = (1.0, 0.5, 0.2, 0.0)  # shares of the way from the null to a promise, that a fit of it begins at
MOVED = 3.0  # of the noise of all readings, that one standard deviation of a tolerance makes more or less beside a fit
IMITATED = 50.0  # times what is left, that an effect explains which stands for no law: on kinds for tuning 28 at most
KEPT = 40  # promises beside one fit that are followed up
NO_FIT = (WorkbenchError, ArithmeticError, np.linalg.LinAlgError)

Progress = Callable[[str], None]
Set = frozenset[str]


@dataclass(order=True)
class Promise:
    """A set that could be fitted, by linear algebra beside a fit. order: minus ln of its promised posterior

    effects, x, z: null effects, nuisances and parameters where a fit of it begins
    forms: what other forms of its effects add to ln evidence [nats]
    slopes: d readings / d x (n, m) of the fit beside which it was promised
    """

    order: float
    label: str
    every: Set = field(compare=False)
    effects: tuple[Effect, ...] = field(compare=False)
    x: np.ndarray = field(compare=False)
    z: np.ndarray = field(compare=False)
    forms: float = field(compare=False)
    slopes: np.ndarray | None = field(compare=False, default=None)


@dataclass(frozen=True, eq=False)
class Additions:
    """What may be added beside a fit. The products of all columns are let go of when the promises are made."""

    search: Search
    parent: Hypothesis
    names: Names
    gains: Gains

    @property
    def readings(self) -> Readings:
        """Residual of the parent at zero nuisances, as the catalogue has it."""
        return self.names.catalogue.readings(self.gains.residual[:, None])[0]

    def promises(self, found: Mapping[Set, tuple[Explanation, float]]) -> list[Promise]:
        """Of sets with ln of their promised posterior; the best few and the smaller ones that they hold."""
        leading = sorted(found, key=lambda every: (-found[every][1], label_of(every)))[:KEPT]
        return [self._promise(e, *found[e]) for e in found if any(e <= every for every in leading)]

    def gain(self, found: Explanation) -> float:
        """Of a set, in the likelihood of the fits [nats]."""
        return self.gains.of(found.terms, found.gain, float(self.names.priors[list(found.terms)].sum()))

    def _promise(self, every: Set, found: Explanation, promised: float) -> Promise:
        fit, m = self.parent.fit, len(self.parent.fit.x)
        end, place = self.gains.end(found.terms), 0
        background = self.gains.of_background(end, end.weights)
        effects, z = list(fit.effects), [fit.z + background[m : m + len(fit.z)]]
        for term in (self.names.catalogue.terms[t] for t in found.terms):
            signature = self.search.signatures.found[term.name][term.variant]
            count = len(parameters_of(signature.effect))
            effects.append(signature.effect)
            z.append(signature.at(term.place, np.clip(end.weights[place : place + count], -2.0, 2.0)))
            place += count
        forms = self.search.forms.get(self.parent.names, self.search.own_forms(self.parent.names)) + found.forms
        x = np.clip(background[:m], -FAR, FAR)
        return Promise(-promised, label_of(every), every, tuple(effects), x, np.concatenate(z), forms, fit.slopes)


@dataclass(eq=False)
class Search:
    """All that was tried. fitted: by set of names;  forms: what other forms of the effects add to ln evidence

    guessed: ln evidence by the expansion of sets that promised too little to be fitted
    origins: the fitted sets beside which that was guessed;  beside: sets beside an unknown function
    guessed_beside: ln evidence of such sets that were not fitted;  expanded: fits beside which more was looked for
    exact: sets that were fitted with a base model that is exact where they ended, and what this gave them [nats]
    parted: fits beside which those without one of their effects were made
    elsewhere: signatures beside fits of large effects
    before: fits of a search that took other readings for wild, from which those of the same sets begin
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
    parted: set[Hypothesis] = field(default_factory=set)
    elsewhere: list[Signatures] = field(default_factory=list)
    before: Mapping[Set, Fit] = field(default_factory=dict)

    def drop(self, names: Set, why: str) -> None:
        """Takes back a set that was fitted and cannot be."""
        del self.fitted[names]
        self.forms.pop(names, None)
        self.beside.pop(names, None)
        self.failed[label_of(names)] = why

    def log_evidence(self, names: Set) -> float:
        """Of a set that was fitted, all its forms together [nats]."""
        return self.fitted[names].log_evidence + self.forms.get(names, 0.0) + self.exactness(names)

    def by_expansion(self, names: Set) -> float:
        """The same without what an exact base model gave or would give: what guesses are made from, to which that is
        added once [nats]."""
        return self.fitted[names].log_evidence + self.forms.get(names, 0.0) - self.exact.get(names, 0.0)

    def exactness(self, names: Set) -> float:
        """What an exact base model would give a set that has none: as much as the exact one that is most like it in
        effects that the expansion is concerned with. The null says nothing of sets that leave the device as it is: it
        is exact from the beginning, their tolerances stand elsewhere."""
        if names in self.exact or len(self.exact) == 1:  # nothing but the null is
            return 0.0
        mine = names & self.of_expansion

        def unlike(exact: Set) -> tuple:
            field = exact & self.of_expansion
            return -len(field & mine), len(field ^ mine), not exact, len(exact ^ names), sorted(exact)

        return self.exact[min(self.exact, key=unlike)]

    @cached_property
    def of_expansion(self) -> Set:
        """Effects that change the device in what the base model is expanded in."""
        return frozenset(name for name, forms in self.signatures.found.items() if self._moves(forms[0].effect))

    def _moves(self, effect: Effect) -> bool:
        model = self.bench.model
        try:
            changed = replace(model, effects=(effect.at(np.ones(len(parameters_of(effect)))),)).design_as_built
        except WorkbenchError:  # what cannot be built is not the same
            return True
        return not model.base.is_alike(model.design, changed)

    def signatures_beside(self, hypothesis: Hypothesis) -> Signatures:
        """Of all effects beside a fit: those of the centre or of a fit before, but where its effects are so large that
        tolerances do there what they do at none of these, and so would effects. A base model that answers by an
        expansion is compared about its drawing alone: it may have been pulled far from there."""
        if self.bench.model.base.is_expansion:
            return self.signatures
        fit, white = hypothesis.fit, self.bench.fit.white
        known = [self.signatures, *self.elsewhere]
        moved = [float(np.linalg.norm(white(fit.slopes - s.slopes), axis=0).max(initial=0.0)) for s in known]
        if min(moved) > MOVED:
            here = self.signatures.beside(hypothesis.problem.predictor, fit.x, fit.at_maximum, fit.slopes)
            self.elsewhere.append(here)
            return here
        return known[int(np.argmin(moved))]

    def own_forms(self, names: Set) -> float:
        """What forms add to ln evidence where only those count that a fit has [nats]."""
        return -sum(log(len(self.signatures.found[name])) for name in sorted(names))

    def log_evidence_beside(self, names: Set) -> float:
        """Of a set beside an unknown function, all its forms together [nats]. An unknown function makes good what an
        expansion lacks: an exact model gives nothing more, but may take."""
        return self.beside[names].log_evidence + self.forms.get(names, 0.0) + min(self.exactness(names), 0.0)

    def log_posterior_beside(self, names: Set) -> float:
        """Of that, up to what all share and to what it takes to believe in an unknown function [nats]."""
        return self.log_evidence_beside(names) + self.beliefs.log_prior(names)

    @property
    def leader_beside(self) -> Set:
        """The best set beside an unknown function, of those that were weighed so far; none where none was."""
        return max(self.beside, key=self.log_posterior_beside, default=frozenset())

    @property
    def best_beside(self) -> float:
        """Its ln posterior [nats]; infinitely little where none was weighed."""
        if not self.beside:
            return -np.inf
        return self.log_posterior_beside(self.leader_beside) + self.beliefs.log_unknown

    def log_posterior(self, names: Set) -> float:
        """Up to what all share [nats]."""
        return self.log_evidence(names) + self.beliefs.log_prior(names)

    def believed(self, names: Set) -> float:
        """ln posterior of a set that was not fitted [nats]."""
        return self.guessed[names] + self.exactness(names) + self.beliefs.log_prior(names)

    def is_near(self, names: Set) -> bool:
        """Whether a fit is not plainly worse than the best one."""
        return self.log_posterior(names) > self.log_posterior(self.ranked[0]) - PLAIN

    @property
    def is_beaten(self) -> bool:
        """Whether an unknown function is so much better than all that was fitted that it would be seen plainly."""
        return self.best_beside > self.log_posterior(self.ranked[0]) + PLAIN

    @property
    def is_over(self) -> bool:
        """Whether no other set of effects is of use: such a function is better beside none of them, or by more than
        the last effect of what leads gained, as the next one is believed to gain less."""
        if not self.is_beaten:
            return False
        return not self.leader_beside or self.best_beside - self.log_posterior(self.ranked[0]) > self.last_gain

    @property
    def last_gain(self) -> float:
        """What the effects of what leads gained over the best part of it that was fitted, for each [nats]."""
        leader, *others = self.ranked
        part = next((names for names in others if names < leader), None)
        if part is None:
            return 0.0
        return (self.log_posterior(leader) - self.log_posterior(part)) / len(leader - part)

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

    def weights(self, name: str) -> dict[Hypothesis, float]:
        """The fits with an effect and how probable they are, over the most probable one of them."""
        logs = {names: self.log_posterior(names) for names in self.fitted if name in names}
        best = max(logs.values())
        return {self.fitted[names]: exp(v - best) for names, v in logs.items() if v > best - NEGLIGIBLE}

    @property
    def unknown_in_words(self) -> str:
        """The most probable of the unknown functions beside nothing and the unknown laws; empty where none is seen."""
        function = self.beside.get(frozenset())
        least = -np.inf if function is None else function.log_evidence + self.beliefs.log_unknown
        words = function.leading[0].shape.words() if function is not None else ""
        with_law = next((names for names in self.ranked if names & LAWS.keys()), frozenset())
        if with_law and self.log_posterior(with_law) > least:
            words = next(e.words() for e in self.fitted[with_law].effects if isinstance(e, UnknownLaw))
        return words

    def stands_out(self, name: str, names: Set) -> bool:
        """Whether an effect of a set explains so much that it cannot stand for the law of an unknown function beside
        the set: one that does leaves a good part of what it explains, in channels that the effect changes. A set
        that was only guessed is taken for the most of it that was fitted."""
        holding = [part for part in self.fitted if name in part and part <= names]
        if not holding:
            return False
        nearest = max(holding, key=lambda part: (len(part), self.log_evidence(part)))
        without = max(self.log_evidence(part) for part in self.fitted if part <= names - {name})
        explained = self.log_evidence(nearest) - without
        return explained > IMITATED * self._left_to_unknown(name, nearest)

    def _left_to_unknown(self, name: str, names: Set) -> float:
        """What suits best of unknown functions and laws gains beside a set, no less than what is nothing; of functions
        in channels that an effect of the set leaves as they are, nothing [nats]."""
        known = self.log_evidence(names)
        found = [self.log_evidence(n) for n in self.fitted if n - LAWS.keys() == names and n != names]
        found += [self.guessed_beside[names]] if names in self.guessed_beside else []
        if names in self.beside:
            where = (channel for one in self.beside[names].leading for channel in one.shape.channels)
            is_elsewhere = self._changed_by(name, names).isdisjoint(where)
            found += [known if is_elsewhere else self.log_evidence_beside(names)]
        return max(max(found, default=np.inf) - known, NOTHING)

    def _changed_by(self, name: str, names: Set) -> frozenset[str]:
        """Channels that an effect of a set that was fitted changes by more than their noise."""
        problem, fit = self.fitted[names].problem, self.fitted[names].fit
        (effect,) = (effect for effect in fit.at_maximum if effect.name() == name)
        squares = problem.squares(change_by(problem, fit.at_maximum, effect, fit.x) / problem.white.sigma)
        return frozenset(c.name for c, square in zip(problem.stack.channels, squares) if square > 1.0)

    @property
    def posterior(self) -> Posterior:
        """Probabilities of everything that was fitted or guessed."""
        return self.posterior_without(frozenset())

    def posterior_without(self, struck: Set) -> Posterior:
        """The same without all that some effects are part of."""
        weighed = {names: self.log_evidence_beside(names) for names in self.beside}
        alone, beside = self.evidences, self._with_guesses(self.guessed_beside, weighed)
        kept = ({names: v for names, v in part.items() if not names & struck} for part in (alone, beside))
        return posterior(*kept, self.beliefs)

    @property
    def evidences(self) -> dict[Set, float]:
        """ln evidence of everything that was fitted or guessed without an unknown function [nats]."""
        guessed = {names: guess + self.exactness(names) for names, guess in self.guessed.items()}
        return self._with_guesses(guessed, {names: self.log_evidence(names) for names in self.fitted})

    def _with_guesses(self, guessed: Mapping[Set, float], fitted: Mapping[Set, float]) -> dict[Set, float]:
        """ln evidence of all sets; one that was only guessed counts for no more than the best that was fitted."""
        prior = self.beliefs.log_prior
        best = max((evidence + prior(names) for names, evidence in fitted.items()), default=-np.inf)
        return {names: min(guess, best - prior(names)) for names, guess in guessed.items()} | fitted


def label_of(names: Set) -> str:
    """A set in words."""
    return " with ".join(sorted(names))


def start_from(
    search: Search, fit: Fit, every: Set, effects: tuple[Effect, ...], x: np.ndarray, z: np.ndarray
) -> Promise:
    """A fit of effects of which only the forms that they have count, near another fit."""
    return Promise(0.0, label_of(every), every, effects, x, z, search.own_forms(every), fit.slopes)


def promised_of(search: Search, every: Set) -> float:
    """ln posterior that a set promises: its guess, what an exact base model would give it, and a share of what it would
    gain over all that was fitted of it."""
    before = max(search.log_evidence(names) for names in search.fitted if names <= every)
    gain = search.believed(every) - search.beliefs.log_prior(every) - before
    return search.believed(every) + SLACK * max(gain, 0.0)


def fit_set(search: Search, promise: Promise) -> bool:
    """Fits a set; False where the model has no answer. Replaces a guess of it, and an earlier fit that was worse. A fit
    that ends far below its guess may have ended in a wrong valley."""
    every = promise.every
    guess, bench = search.guessed.pop(every, -np.inf), _behind_the_lead(search)
    if every in search.before and every not in search.fitted:
        known = search.before[every]
        promise = replace(promise, effects=known.effects, x=known.x, z=known.z, slopes=known.slopes)
    try:
        found = _fitted(bench, promise)
    except NO_FIT as error:
        if every not in search.fitted:
            search.failed[promise.label] = str(error)
        return every in search.fitted
    found = _bettered(bench, found, guess - PLAIN - promise.forms)
    if every in search.fitted and found.log_evidence + promise.forms <= search.log_evidence(every):
        return True
    search.fitted[every] = found
    search.exact.pop(every, None)
    search.beside.pop(every, None)
    search.forms[every] = promise.forms
    _lower(search, every, max(guess - search.by_expansion(every), 0.0))
    return True


def _bettered(bench: Bench, found: Hypothesis, least: float) -> Hypothesis:
    """A fit from other directions, and from elsewhere where its ln evidence is less than it should be; as it was where
    the model has no answer there."""
    try:
        found = turned(bench, found)
        return from_elsewhere(bench, found) if found.log_evidence < least else found
    except NO_FIT:
        return found


def _behind_the_lead(search: Search) -> Bench:
    """The bench, whose fits need to be exact only near what leads."""
    lead = search.fitted[search.ranked[0]].fit.objective
    return replace(search.bench, fit=replace(search.bench.fit, lead=lead))


def _fitted(bench: Bench, promise: Promise) -> Hypothesis:
    """From where linear algebra promises it; where the model has no answer there, from ever nearer to the null.

    Raises:
        WorkbenchError: the model has no answer at any of these places.
    """

    def begun(share: float) -> Hypothesis:
        x = share * promise.x + (1 - share) * bench.null.x
        return fitted_from(bench, promise.effects, x, share * promise.z, promise.slopes)

    for share in STARTS[:-1]:
        try:
            return begun(share)
        except NO_FIT:
            continue
    return begun(STARTS[-1])


def _lower(search: Search, every: Set, shortfall: float) -> None:
    """Sets that hold one whose guess was too high were guessed too high as well, unless beside a nearer fit."""
    origin = search.origins.get(every, frozenset())
    for names in search.guessed:
        if names > every and search.origins[names] <= origin:
            search.guessed[names] -= shortfall


def expand(search: Search, hypothesis: Hypothesis, heap: list[Promise]) -> None:
    """Promises of one or two effects more beside a fit; they take the place of what was guessed beside it before, when
    it was not exact and some may have made good what the expansion lacks."""
    have = hypothesis.names
    search.expanded.add(have)
    added = additions(search, hypothesis, hypothesis.fit.jacobian)
    promised: dict[Set, tuple[Explanation, float]] = {}
    is_near = search.is_near(have)
    for every, (found, guess) in _guesses_beside(search, have, added).items():
        origin = search.origins.get(every, have)
        nearer = len(have) - len(origin)
        may_raise = nearer == 0 or is_near
        if origin == have or nearer > 0 or (may_raise and guess > search.guessed.get(every, -np.inf)):
            search.guessed[every], search.origins[every] = guess, have
            promised[every] = found, promised_of(search, every)
    renewed = added.promises(promised)
    stale = {promise.every for promise in renewed}
    heap[:] = [promise for promise in heap if promise.every not in stale] + renewed
    heapify(heap)


def _guesses_beside(search: Search, have: Set, added: Additions) -> dict[Set, tuple[Explanation, float]]:
    """Sets beside a fit that were not fitted, with their ln evidence as it is guessed: less by as much as that of a
    fitted set that they hold would have been guessed too high beside the same fit."""
    (looked_at,) = explored(added.names, [added.readings], search.beliefs, have, len(have) + 2)
    every = (e for e in looked_at.values() if e.names)
    found = {have | e.names: (e, search.by_expansion(have) + added.gain(e)) for e in every}
    short = {n: max(found[n][1] - search.by_expansion(n), 0.0) for n in found if n in search.fitted}
    less = {n: max((short[part] for part in short if part < n), default=0.0) for n in found}
    return {n: (e, guess - less[n]) for n, (e, guess) in found.items() if n not in search.fitted}


def additions(
    search: Search, hypothesis: Hypothesis, background: np.ndarray, signatures: Signatures | None = None
) -> Additions:
    """What may be added beside a fit. background: whitened columns that are in every explanation there (n, m)

    signatures: of all effects near there; those beside the fit where None are given
    """
    slopes, white = hypothesis.fit.slopes, hypothesis.problem.white
    near = signatures or search.signatures_beside(hypothesis)
    names = Names(near.catalogue_at(slopes, background, white, hypothesis.names))
    gains = Gains(hypothesis.problem, hypothesis.fit, at_zero(hypothesis), names.catalogue)
    return Additions(search, hypothesis, names, gains)
