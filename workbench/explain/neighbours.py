"""The neighbours of what leads, fitted from where it ended: without one of its effects, with one exchanged for another,
with an unknown law in the place of all."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from effects.base import Effect
from effects.parameter import parameters_of
from workbench.explain.hypotheses import Hypothesis
from workbench.explain.tried import NEGLIGIBLE, Progress, Promise, Search, Set, fit_set, label_of, start_from
from workbench.likelihood.fit import with_parameters
from workbench.likelihood.unknown_laws import LAWS
from workbench.likelihood.whitening import law_error

EXCHANGED = 2  # others that are tried in the place of each effect of what leads
PULLED = 3.0  # standard deviations of a tolerance, from which its place is offered to effects
ALMOST = 0.7  # of the change by an effect, that another may leave to be tried in its place


def exchange(search: Search, leader: Set, progress: Progress) -> None:
    """What leads is weighed against the few that do most nearly the same as one of its effects, or as a tolerance that
    it pulls far, from where it ended: a promise beside such a pull is too modest by many nats."""
    whole = search.fitted[leader]
    parts = [leader - {name} for name in sorted(leader)]
    starts = [promise for part in parts for promise in _instead_of_effects(search, whole, part)]
    if len(leader) > 1:
        starts += _instead_of_effects(search, whole, frozenset())
    if search.beliefs.leaves_room(leader):
        pulled = np.flatnonzero(np.abs(whole.fit.x) > PULLED)
        starts += [promise for k in pulled for promise in _instead_of_pull(search, whole, int(k))]
    for promise in starts:
        if not _is_weighed(search, promise.every) and promise.label not in search.failed:
            progress("fitting " + promise.label)
            fit_set(search, promise)


def _is_weighed(search: Search, names: Set) -> bool:
    """Whether a set was fitted and has a say. One that lies far behind what it could take the place of may have ended
    in another valley, between a tolerance that is pulled far and a small effect: from here it may end higher."""
    return names in search.fitted and search.log_posterior(names) > search.log_posterior(search.ranked[0]) - NEGLIGIBLE


def _instead_of_effects(search: Search, whole: Hypothesis, kept: Set) -> list[Promise]:
    """Starts of a fit of which some effects are kept, with another one in the place of the others."""
    rest, z = _part_of(whole, kept)
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
    """Starts with another effect that does most nearly what a fit does beyond what is left of it (n,), nearest first,
    tolerances making good what they can; with unknown laws likewise, as two effects may take the place of a law that
    nobody knows.

    rest, z_rest, x: what stays of the fit
    """
    problem = whole.problem
    tolerances = law_error(slice(None), whole.fit.jacobian[:, : len(x)])
    white = replace(problem.white, laws=(*problem.white.laws, tolerances))
    target = white(problem.predictor.predict(whole.fit.x, whole.effects) - left)
    starts = []
    kept = frozenset(effect.name() for effect in rest)
    for other in search.signatures.names:
        if other in whole.names or not search.beliefs.may_join(other, kept):
            continue
        nearest = min((s.nearest(target, white) for s in search.signatures.found[other]), key=lambda n: n[0])
        if nearest[0] < ALMOST * float(np.linalg.norm(target)):
            starts.append((nearest[0], other, *nearest[1:]))
    starts.sort(key=lambda start: start[:2])
    known, laws = ([s for s in starts if (s[1] in LAWS) is is_law][:EXCHANGED] for is_law in (False, True))
    return [
        start_from(search, whole.fit, kept | {other}, (*rest, effect), x, np.concatenate([z_rest, z]))
        for _, other, effect, z in known + laws
    ]


def less_one(search: Search, progress: Progress) -> None:
    """What leads is weighed against itself without each of its effects, fitted from where it ended, once more where it
    was fitted from elsewhere: a promise beside a null whose tolerances were pulled far may have hidden such a part, or
    begun its fit in another valley. Until such a leader is found."""
    tried: set[Set] = set()
    while (leader := search.ranked[0]) not in tried:
        tried.add(leader)
        for names in (leader - {name} for name in sorted(leader)):
            if names:
                progress("fitting " + label_of(names))
                _fit_part(search, search.fitted[leader], names)


def _fit_part(search: Search, whole: Hypothesis, names: Set) -> None:
    """Fits some of the effects of a fit, from where it ended."""
    effects, z = _part_of(whole, names)
    fit_set(search, start_from(search, whole.fit, names, effects, whole.fit.x, z))


def _part_of(whole: Hypothesis, names: Set) -> tuple[tuple[Effect, ...], np.ndarray]:
    """Some of the effects of a fit, as null effects, and their parameters."""
    parts, place = [], 0
    for effect in whole.fit.effects:
        count = len(parameters_of(effect))
        parts.append((effect, whole.fit.z[place : place + count]))
        place += count
    kept = [(effect, z) for effect, z in parts if effect.name() in names]
    return tuple(effect for effect, _ in kept), np.concatenate([np.zeros(0), *(z for _, z in kept)])
