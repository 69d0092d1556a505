"""The neighbours of what leads, fitted from where it ended: without one of its effects, with one exchanged for another,
with an unknown law in the place of all."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cache, cached_property
from itertools import combinations

import numpy as np

from effects.base import Effect
from effects.parameter import parameters_of
from workbench.errors import WorkbenchError
from workbench.explain.explore import explored
from workbench.explain.hypotheses import Hypothesis, held_at
from workbench.explain.tried import (
    NEGLIGIBLE,
    NO_FIT,
    REACH,
    Progress,
    Promise,
    Search,
    Set,
    additions,
    fit_set,
    label_of,
    start_from,
)
from workbench.likelihood.fit import with_parameters
from workbench.likelihood.predictor import STEP, Predictor
from workbench.likelihood.signatures import Signature
from workbench.likelihood.unknown_laws import LAWS
from workbench.likelihood.whitening import Whitener, law_error

EXCHANGED = 2  # others that are tried in the place of each effect of what leads
TWO_EXCHANGED = 4  # sets that are tried in the place of what leads, that lack two of its effects
PULLED = 3.0  # standard deviations of a tolerance, from which its place is offered to effects
STEPS = 2  # of Gauss and Newton towards the size at which another effect does the same
ALMOST = 0.7  # of the change by an effect, that another may leave to be tried in its place


def exchange(search: Search, leader: Set, progress: Progress) -> None:
    """What leads is weighed against the few that do most nearly the same as one of its effects, or as a tolerance that
    it pulls far, from where it ended: a promise beside such a pull is too modest by many nats."""
    leading = _Leading(search.fitted[leader])
    parts = [leader - {name} for name in sorted(leader)]
    starts = [promise for part in parts for promise in _instead_of_effects(search, leading, part)]
    if len(leader) > 1:
        starts += _instead_of_effects(search, leading, frozenset())
    if search.beliefs.leaves_room(leader):
        pulled = np.flatnonzero(np.abs(leading.whole.fit.x) > PULLED)
        starts += [promise for k in pulled for promise in _instead_of_pull(search, leading, int(k))]
    for promise in starts:
        if not _is_weighed(search, promise.every) and promise.label not in search.failed:
            progress("fitting " + promise.label)
            fit_set(search, promise)


def _is_weighed(search: Search, names: Set) -> bool:
    """Whether a set was fitted and has a say. One that lies far behind what it could take the place of may have ended
    in another valley, between a tolerance that is pulled far and a small effect: from here it may end higher."""
    return names in search.fitted and search.log_posterior(names) > search.log_posterior(search.ranked[0]) - NEGLIGIBLE


@dataclass(frozen=True, eq=False)
class _Leading:
    """A fit, and what others do as it weighs it: worked out once for all that they may take the place of."""

    whole: Hypothesis

    @property
    def held(self) -> Whitener:
        """With the tolerances where they are."""
        return self.whole.problem.white

    @cached_property
    def free(self) -> Whitener:
        """With the tolerances integrated out."""
        tolerances = self.whole.fit.jacobian[:, : len(self.whole.fit.x)]
        return replace(self.held, laws=(*self.held.laws, law_error(slice(None), tolerances)))

    @cached_property
    def shifts(self) -> Callable[[Signature], tuple[np.ndarray, np.ndarray]]:
        """What an effect does on its grid, whitened with the tolerances free and held (n, K) each."""

        @cache
        def found(signature: Signature) -> tuple[np.ndarray, np.ndarray]:
            held = self.held(signature.change)
            return self.free.laws[-1].apply(held), held

        return found


def _instead_of_effects(search: Search, leading: _Leading, kept: Set) -> list[Promise]:
    """Starts of a fit of which some effects are kept, with another one in the place of the others."""
    rest, z = _part_of(leading.whole, kept)
    return _twins(search, leading, rest, z, leading.whole.fit.x)


def _instead_of_pull(search: Search, leading: _Leading, number: int) -> list[Promise]:
    """Starts of a fit with others in the place of a tolerance that it pulls far."""
    fit = leading.whole.fit
    x = np.where(np.arange(len(fit.x)) == number, 0.0, fit.x)
    return _twins(search, leading, fit.effects, fit.z, x, fit.jacobian[:, number] * fit.x[number])


@dataclass(frozen=True, eq=False)
class _Gap:
    """What a fit does beyond a part of it, which another effect is to fill, tolerances making good what they can.

    rest: effects that stay, at their parameters;  x: nuisances beside them (m,)
    line: what the pull of a tolerance would do as a straight line, whitened (n,), where the gap is one
    """

    leading: _Leading
    rest: tuple[Effect, ...]
    x: np.ndarray
    line: np.ndarray | None = None

    @property
    def _predictor(self) -> Predictor:
        return self.leading.whole.problem.predictor

    @cached_property
    def left(self) -> np.ndarray:
        """Readings with what stays, SI (n,)."""
        return self._predictor.predict(self.x, self.rest)

    @cached_property
    def change(self) -> np.ndarray:
        """Of the readings, SI (n,)."""
        whole = self.leading.whole
        return self._predictor.predict(whole.fit.x, whole.effects) - self.left

    @cached_property
    def free(self) -> np.ndarray:
        """The change, whitened with the tolerances integrated out (n,)."""
        return self.leading.free(self.change)

    @cached_property
    def held(self) -> np.ndarray:
        """The change, whitened with the tolerances where they are (n,)."""
        return self.leading.held(self.change)

    @property
    def size(self) -> float:
        """Of the change, free of tolerances."""
        return float(np.linalg.norm(self.free))

    def nearest(self, signature: Signature) -> tuple[float, Effect, np.ndarray]:
        """What another effect leaves of the change, free of tolerances; the effect, and its z there.

        Where a tolerance makes good nearly all, no more is left than that by which sizes differ from a line, and the
        grid says nothing of it: there the size that is alike with the tolerances held is asked of the model.
        """
        free, held = self.leading.shifts(signature)
        left, effect, z = signature.nearest(self.free, free, self.leading.free)
        found = [(float(np.linalg.norm(left)), effect, z)]
        found += [self._by_model(effect, z) for z in self._alike(signature, held)]
        return min(found, key=lambda one: one[0])

    def _alike(self, signature: Signature, held: np.ndarray) -> Iterator[np.ndarray]:
        """z where an effect does nearly the same with the tolerances held: on its grid, and in the place of a pull
        by straight lines, as the grid begins where the tolerance has ended."""
        left, _, z = signature.nearest(self.held, held, self.leading.held)
        if np.linalg.norm(left) < ALMOST * np.linalg.norm(self.held):
            yield z
        if self.line is not None:
            left, z = signature.straight(self.line, self.leading.held)
            if np.linalg.norm(left) < ALMOST * np.linalg.norm(self.line):
                yield z

    def _by_model(self, effect: Effect, z: np.ndarray) -> tuple[float, Effect, np.ndarray]:
        """The same by steps of Gauss and Newton from z; infinitely much where the model has no answer."""
        try:
            for _ in range(STEPS):
                z = z + self._step(effect, z)
            left = self.leading.free(self.change - self._made(effect, z))
            return float(np.linalg.norm(left)), effect, z
        except (WorkbenchError, ArithmeticError, np.linalg.LinAlgError):
            return np.inf, effect, z

    def _step(self, effect: Effect, z: np.ndarray) -> np.ndarray:
        """Of z, by no more than one standard deviation along each axis."""
        held, moves = self.leading.held, STEP * np.eye(len(z))
        slopes = np.column_stack([self._made(effect, z + m) - self._made(effect, z - m) for m in moves]) / (2 * STEP)
        left = self.change - self._made(effect, z)
        return np.clip(np.linalg.lstsq(held(slopes), held(left), rcond=None)[0], -1.0, 1.0)

    def _made(self, effect: Effect, z: np.ndarray) -> np.ndarray:
        return self._predictor.predict(self.x, (*self.rest, effect.at(z))) - self.left


def _twins(
    search: Search,
    leading: _Leading,
    rest: tuple[Effect, ...],
    z_rest: np.ndarray,
    x: np.ndarray,
    line: np.ndarray | None = None,
) -> list[Promise]:
    """Starts with another effect that does most nearly what a fit does beyond what stays of it, nearest first; with
    unknown laws likewise, as two effects may take the place of a law that nobody knows.

    rest, z_rest, x: what stays of the fit;  line: see ``_Gap``
    """
    whole, gap = leading.whole, _Gap(leading, with_parameters(rest, z_rest), x, line)
    kept = frozenset(effect.name() for effect in rest)
    starts = []
    for other in search.signatures.names:
        if other in whole.names or not search.beliefs.may_join(other, kept):
            continue
        away, effect, z = min((gap.nearest(s) for s in search.signatures.found[other]), key=lambda n: n[0])
        if away < ALMOST * gap.size:
            starts.append((away, other, effect, z))
    starts.sort(key=lambda start: start[:2])
    known, laws = ([s for s in starts if (s[1] in LAWS) is is_law][:EXCHANGED] for is_law in (False, True))
    return [
        start_from(search, whole.fit, kept | {other}, (*rest, effect), x, np.concatenate([z_rest, z]))
        for _, other, effect, z in known + laws
    ]


def exchange_two(search: Search, leader: Set, progress: Progress) -> None:
    """What leads is weighed against the few sets that lack two of its effects, or its only one, have one or two others
    and promise most: two may do together what two others do, none of which takes the place of one. Promises are made
    where it ended: beside a fit without both, which pulls tolerances far, they were wrong by tens of nats."""
    away = combinations(sorted(leader), min(2, len(leader))) if leader else ()
    starts = sorted(promise for gone in away for promise in _instead_of_two(search, leader, leader.difference(gone)))
    for promise in starts[:TWO_EXCHANGED]:
        progress("fitting " + promise.label)
        fit_set(search, promise)


def _instead_of_two(search: Search, leader: Set, kept: Set) -> list[Promise]:
    """The sets with some effects of what leads that promise about as much as it does by the same linear algebra, each
    with how much more; none where the model has no answer with these effects alone."""
    whole = search.fitted[leader]
    try:
        held = held_at(search.bench, whole.fit, *_part_of(whole, kept))
    except NO_FIT:
        return []
    added = additions(search, held, held.fit.jacobian, search.signatures_beside(whole))
    (looked_at,) = explored(added.names, [added.readings], search.beliefs, kept, len(kept) + 2)
    every = {kept | names: found for names, found in looked_at.items() if names}
    if leader not in every:
        return []
    value = {n: added.gain(e) + search.beliefs.log_prior(n) for n, e in every.items()}
    more = {n: (e, value[n] - value[leader]) for n, e in every.items() if n not in search.fitted}
    return added.promises({n: (e, gain) for n, (e, gain) in more.items() if gain >= -REACH})


def less_one(search: Search, progress: Progress) -> None:
    """What leads is weighed against itself without each of its effects, fitted from where it ended, once more where it
    was fitted from elsewhere: a promise beside a null whose tolerances were pulled far may have hidden such a part, or
    begun its fit in another valley. Until such a leader is found."""
    while (whole := search.fitted[search.ranked[0]]) not in search.parted:
        search.parted.add(whole)
        for names in (whole.names - {name} for name in sorted(whole.names)):
            if names:
                progress("fitting " + label_of(names))
                fit_part(search, whole, names)


def fit_part(search: Search, whole: Hypothesis, names: Set) -> bool:
    """Fits some of the effects of a fit, from where it ended; False where the model has no answer."""
    effects, z = _part_of(whole, names)
    return fit_set(search, start_from(search, whole.fit, names, effects, whole.fit.x, z))


def _part_of(whole: Hypothesis, names: Set) -> tuple[tuple[Effect, ...], np.ndarray]:
    """Some of the effects of a fit, as null effects, and their parameters."""
    parts, place = [], 0
    for effect in whole.fit.effects:
        count = len(parameters_of(effect))
        parts.append((effect, whole.fit.z[place : place + count]))
        place += count
    kept = [(effect, z) for effect, z in parts if effect.name() in names]
    return tuple(effect for effect, _ in kept), np.concatenate([np.zeros(0), *(z for _, z in kept)])
