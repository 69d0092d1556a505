"""From probabilities to one verdict. Every number that is printed is the probability of the sentence beside it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from workbench.believed import LIKELY, MOST
from workbench.explain.explore import Posterior

NOTHING_MISSING, EFFECT, GROUP, PAIR, SEVERAL = "nothing_missing", "effect", "group", "pair", "several"
PARTIAL, NONE_OF_THESE, CANNOT_TELL, CONVENTION = "partial", "none_of_these", "cannot_tell", "convention"


@dataclass(frozen=True)
class Verdict:
    """kind: one of the nine words;  names: the effects, or the members of a group

    alternatives: of a name, what may stand for it instead;  probability: that the sentence of the verdict is true
    """

    kind: str
    names: tuple[str, ...]
    probability: float
    alternatives: dict[str, tuple[str, ...]]

    @property
    def groups(self) -> dict[str, tuple[str, ...]]:
        """Every effect that is said to be there, with what may stand for it instead."""
        own = [self.names] if self.kind == GROUP else [(name,) for name in self.names]
        apart = [(first, *others) for first, others in self.alternatives.items()]
        return {group[0]: group for group in own + apart}

    @property
    def all_names(self) -> frozenset[str]:
        """All names that it prints."""
        return frozenset(name for group in self.groups.values() for name in group)


@dataclass(frozen=True)
class Thresholds:
    """What simulated campaigns of the same bench say of its probabilities.

    sure: from which a name is printed, so that a false one is rare;  quiet: P(nothing) from which there is no alarm
    can_tell: whether an unknown law would be noticed and not be given a name of the library
    """

    sure: float
    quiet: float
    can_tell: bool


def verdict(p: Posterior, thresholds: Thresholds, plainly_nothing: float) -> Verdict:
    """Exactly one verdict.

    p: where something unknown is likely, that of ``explore.beside_the_unknown``
    plainly_nothing: P(nothing that these data would show plainly); where that is unlikely, be the alarm threshold not
        reached, nothing is said to be missing and nothing to be right
    """
    sure, can_tell = thresholds.sure, thresholds.can_tell
    if p.nothing < thresholds.quiet and can_tell and (groups := printed(p, sure)):
        return _of_groups(p, groups)
    is_quiet = p.nothing >= thresholds.quiet
    if is_quiet and not can_tell:
        return Verdict(CANNOT_TELL, (), p.nothing, {})
    if is_quiet and plainly_nothing >= LIKELY:
        return Verdict(NOTHING_MISSING, (), plainly_nothing, {})
    if p.remains >= LIKELY and can_tell and not is_quiet:
        return Verdict(NONE_OF_THESE, (), p.remains, {})
    return Verdict(CANNOT_TELL, (), 1.0 - p.nothing, {})


def printed(p: Posterior, sure: float) -> tuple[frozenset[str], ...]:
    """The groups of names of the most probable set of effects, see ``_groups``; where it has none, as two of its
    effects stand for one another, those of its most probable part that has some."""
    parts = sorted((names for names in p.sets if names < p.leading), key=lambda n: (-p.sets[n], sorted(n)))
    return next(filter(None, (_groups(p, leading, sure) for leading in (p.leading, *parts))), ())


def _groups(p: Posterior, leading: frozenset[str], sure: float) -> tuple[frozenset[str], ...]:
    """For every effect of a set the smallest group of names, itself first, one of which is there for sure; effects for
    which there is no such group are left out. Where all groups together are not sure, the weakest of them takes a name
    more, and is left out where there is none."""
    found: dict[str, frozenset[str]] = {}
    for name in sorted(leading, key=lambda n: (-p.of(n), n)):
        group: frozenset[str] | None = frozenset((name,))
        while group is not None and p.any_of(group) < sure:
            group = _wider(p, leading, name, group, found)
        found |= {} if group is None else {name: group}
    while found and p.all_of(tuple(found.values())) < sure:
        name = min(found, key=lambda n: (p.any_of(found[n]), -len(found[n])))
        group = _wider(p, leading, name, found.pop(name), found)
        found |= {} if group is None else {name: group}
    return tuple(found.values())


def _wider(
    p: Posterior, leading: frozenset[str], name: str, group: frozenset[str], others: Mapping[str, frozenset[str]]
) -> frozenset[str] | None:
    """A group with the most probable name more that may stand for its first; None where there is none."""
    taken = frozenset().union(group, *others.values(), leading - {name})
    left = [other for other in p.names if other not in taken and _stands_for(p, leading, other, name)]
    if len(group) == MOST or not left:
        return None
    return group | {max(left, key=lambda n: p.any_of(group | {n}))}


def _stands_for(p: Posterior, leading: frozenset[str], other: str, name: str) -> bool:
    """Whether an effect takes the place of this one of the leading set rather than of another of it: of all, it is
    found beside this one least."""
    return min(sorted(leading), key=lambda one: p.of_both(other, one) / p.of(one)) == name


def _of_groups(p: Posterior, groups: tuple[frozenset[str], ...]) -> Verdict:
    """Only names that are sure by themselves are printed beside others; what one of several names is, is said apart."""
    ranked = [tuple(sorted(group, key=lambda n: (-p.of(n), n))) for group in groups]
    alternatives = {names[0]: names[1:] for names in ranked if len(names) > 1}
    if len(groups) == 1 and (len(ranked[0]) > 1 or p.remains < LIKELY):
        return Verdict(EFFECT if len(ranked[0]) == 1 else GROUP, ranked[0], p.any_of(groups[0]), {})
    sure = tuple(names[0] for names in ranked if len(names) == 1)
    if not sure:
        first = ranked[0]
        return Verdict(GROUP, first, p.any_of(groups[0]), {n: a for n, a in alternatives.items() if n != first[0]})
    share = p.all_of(tuple(frozenset((name,)) for name in sure))
    if p.remains >= LIKELY or alternatives:
        return Verdict(PARTIAL, sure, share, alternatives)
    return Verdict(PAIR if len(sure) == 2 else SEVERAL, sure, share, {})
