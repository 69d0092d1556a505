"""From probabilities to one verdict. Every number that is printed is the probability of the sentence beside it."""

from __future__ import annotations

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
    """Exactly one verdict. Where an unknown function is there for sure no name is printed beside it: an effect may be
    what its shape lacks of the true law.

    plainly_nothing: P(nothing that these data would show plainly); where that is unlikely, be the alarm threshold not
        reached, nothing is said to be missing and nothing to be right
    """
    sure, can_tell = thresholds.sure, thresholds.can_tell
    named = p.nothing < thresholds.quiet and can_tell and p.remains < sure
    if named and (groups := printed(p, sure)):
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
    """For every effect of the leading set the smallest group of names, itself first, one of which is there for sure;
    effects for which there is no such group are left out."""
    found: list[frozenset[str]] = []
    for name in sorted(p.leading, key=lambda n: (-p.of(n), n)):
        group = _group_of(p, name, sure, frozenset().union(*found, p.leading - {name}))
        if group is not None:
            found.append(group)
    while found and p.all_of(tuple(found)) < sure:
        found.remove(min(found, key=lambda group: (p.any_of(group), -len(group))))
    return tuple(found)


def _group_of(p: Posterior, name: str, sure: float, taken: frozenset[str]) -> frozenset[str] | None:
    """The effect and what may stand for it, most probable first, until one of them is there for sure."""
    group = frozenset((name,))
    while p.any_of(group) < sure:
        others = [n for n in p.names if n not in group and n not in taken and _stands_for(p, n, name)]
        if len(group) == MOST or not others:
            return None
        group |= {max(others, key=lambda n: p.any_of(group | {n}))}
    return group


def _stands_for(p: Posterior, other: str, name: str) -> bool:
    """Whether an effect takes the place of this one of the leading set rather than of another of it: of all, it is
    found beside this one least."""
    beside = lambda leading: p.all_of((frozenset((other,)), frozenset((leading,)))) / p.of(leading)  # noqa: E731
    return min(sorted(p.leading), key=beside) == name


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
