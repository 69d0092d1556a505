"""From evidences to probabilities, and from probabilities to one verdict."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import log

import numpy as np
from scipy.special import logsumexp

from workbench.explain.hypotheses import Hypothesis
from workbench.explain.priors import EFFECT_AND_UNKNOWN, NOTHING, ONE_EFFECT, TWO_EFFECTS, UNKNOWN
from workbench.likelihood.linear import Nuisances

SURE = 0.9  # probability from which something is named
NAMED = 0.6  # share of what is missing that names must carry to be printed
LIKELY_TWIN = 0.01  # of the probability of the leader, for an effect that the data cannot tell from it
LIKELY = 0.03  # the same for one that they can
SAME_SHAPE = 0.8  # cosine of two signatures from which the pair lives on their small difference
TWINS = 3.0  # expected log-Bayes factor [nats] below which two effects cannot be told apart
LARGEST_GROUP = 4  # names; with more the data tell nothing
POWER_NEEDED = 0.5  # share of unknown discrepancies of ten u that must be noticed before a name is believed

NOTHING_MISSING, EFFECT, GROUP, PAIR = "nothing_missing", "effect", "group", "pair"
PARTIAL, NONE_OF_THESE, CANNOT_TELL = "partial", "none_of_these", "cannot_tell"

Pair = tuple[str, str]


@dataclass(frozen=True)
class Evidences:
    """ln evidences of all hypotheses, on one scale. rest: an effect beside the unknown function"""

    nothing: float
    singles: Mapping[str, float]
    pairs: Mapping[Pair, float]
    unknown: float
    rest: Mapping[str, float]


@dataclass(frozen=True)
class Posterior:
    """Probabilities of all hypotheses; they add up to one.

    logs: their logarithms for effects and pairs, by their names; small probabilities are zero, these keep their order
    """

    nothing: float
    singles: Mapping[str, float]
    pairs: Mapping[Pair, float]
    unknown: float
    rest: Mapping[str, float]
    logs: Mapping[tuple[str, ...], float] = field(default_factory=dict)

    def log(self, names: tuple[str, ...]) -> float:
        if names in self.logs:
            return self.logs[names]
        share = self.singles[names[0]] if len(names) == 1 else self.pairs[names]
        return float(np.log(max(share, 1e-300)))


@dataclass(frozen=True)
class Verdict:
    """kind: one of the seven words;  names: the effect, or the members of the group or pair"""

    kind: str
    names: tuple[str, ...]
    probability: float


def posterior(evidences: Evidences) -> Posterior:
    """Probabilities with the shares of ``priors``; pairs that were not fitted keep their share out of the
    sum."""
    effects = max(len(evidences.singles), 1)
    pairs = max(effects * (effects - 1) // 2, 1)
    weighed = Evidences(
        evidences.nothing + log(NOTHING),
        {n: v + log(ONE_EFFECT / effects) for n, v in evidences.singles.items()},
        {n: v + log(TWO_EFFECTS / pairs) for n, v in evidences.pairs.items()},
        evidences.unknown + log(UNKNOWN),
        {n: v + log(EFFECT_AND_UNKNOWN / effects) for n, v in evidences.rest.items()},
    )
    total = logsumexp(_all(weighed))
    share = lambda values: {name: float(np.exp(v - total)) for name, v in values.items()}  # noqa: E731
    return Posterior(
        float(np.exp(weighed.nothing - total)),
        share(weighed.singles),
        share(weighed.pairs),
        float(np.exp(weighed.unknown - total)),
        share(weighed.rest),
        {(n,): float(v - total) for n, v in weighed.singles.items()}
        | {n: float(v - total) for n, v in weighed.pairs.items()},
    )


def _all(e: Evidences) -> list[float]:
    return [e.nothing, e.unknown, *e.singles.values(), *e.pairs.values(), *e.rest.values()]


def separation(first: Hypothesis, second: Hypothesis, x_count: int, changes: Mapping[str, np.ndarray]) -> float:
    """Expected log-Bayes factor [nats] of the first over the second if the first is true at its fitted size.

    D = 1/2 min over v of |W_first - V v|^2, V: what the second can do near its own fit (its change and its slopes)
    """
    nuisances = Nuisances(first.fit.jacobian[:, :x_count])
    own = nuisances.root(changes[first.names[0]])
    other = np.column_stack([changes[second.names[0]], second.fit.jacobian[:, x_count:]])
    basis, size, _ = np.linalg.svd(nuisances.root(other), full_matrices=False)
    basis = basis[:, size > 1e-6 * max(size.max(initial=0.0), 1e-12)]
    return 0.5 * float(own @ own - np.sum((basis.T @ own) ** 2))


def twins_of(name: str, separations: Mapping[Pair, float]) -> tuple[str, ...]:
    """Effects that the data cannot tell from the named one."""
    others = {pair[1] for pair in separations if pair[0] == name}
    return tuple(o for o in sorted(others) if min(separations[name, o], separations[o, name]) < TWINS)


@dataclass(frozen=True)
class Signs:
    """What speaks beside the probabilities.

    alarm: the data are not those of an empty campaign
    power: to notice an unknown discrepancy of ten u
    left: fitted and held-out rows agree on something that the leading explanation leaves over
    left_by_nothing: the same for the model as it is
    bendable: the two effects of the leading pair have nearly the same shape; together they follow any smooth curve
    mended: the effect of the leading pair whose law may be wrong by all that the other one adds; empty for none
    idle: the leading explanation explains next to nothing
    """

    alarm: bool
    power: float
    left: bool = False
    left_by_nothing: bool = False
    bendable: bool = False
    mended: str = ""
    idle: bool = False


def verdict(p: Posterior, twins: Mapping[str, tuple[str, ...]], signs: Signs) -> Verdict:
    """Exactly one verdict.

    twins: effects that cannot be told from each effect
    """
    if not signs.alarm:
        return _quiet(p, signs)
    if signs.power < POWER_NEEDED:
        return Verdict(CANNOT_TELL, (), 1 - p.nothing)
    shares = shares_of(p)
    something = sum(shares.values())
    kind = max(shares, key=shares.get)
    if kind == NONE_OF_THESE:
        return Verdict(NONE_OF_THESE, (), max(p.unknown / something, SURE * signs.left))
    if signs.left or kind == PARTIAL:
        sure = max(shares[PARTIAL] / something, SURE * signs.left)
        return Verdict(NONE_OF_THESE, (), sure) if signs.idle else Verdict(PARTIAL, leaders(p), sure)
    return _of_pairs(p, twins, signs, something) if kind == PAIR else _of_singles(p, twins, something)


def _quiet(p: Posterior, signs: Signs) -> Verdict:
    if signs.left_by_nothing:  # and no effect is probable enough for an alarm
        return Verdict(NONE_OF_THESE, (), SURE)
    return Verdict(NOTHING_MISSING if signs.power >= POWER_NEEDED else CANNOT_TELL, (), p.nothing)


def shares_of(p: Posterior) -> dict[str, float]:
    """Probability of each kind of something."""
    return {
        EFFECT: sum(p.singles.values()),
        PAIR: sum(p.pairs.values()),
        NONE_OF_THESE: p.unknown,
        PARTIAL: sum(p.rest.values()),
    }


def leaders(p: Posterior) -> tuple[str, ...]:
    """Names of the most probable explanation that effects of the library give: one or two."""
    singles, pairs = [(name,) for name in p.singles], list(p.pairs)
    if pairs and (not singles or logsumexp([p.log(n) for n in pairs]) > logsumexp([p.log(n) for n in singles])):
        return max(pairs, key=p.log)
    return max(singles, key=p.log, default=())


def _of_singles(p: Posterior, twins: Mapping[str, tuple[str, ...]], something: float) -> Verdict:
    """The leader and its twins; more names where they are needed to be sure, as long as each of them is likely
    itself."""
    ranked = sorted(p.singles, key=lambda name: (-p.singles[name], name))
    best = p.singles[ranked[0]]
    names = [
        n for n in ranked if n == ranked[0] or (n in twins.get(ranked[0], ()) and p.singles[n] > LIKELY_TWIN * best)
    ]
    for name in ranked:
        if sum(p.singles[n] for n in names) >= SURE * sum(p.singles.values()) or p.singles[name] < LIKELY * best:
            break
        if name not in names:
            names.append(name)
    share = sum(p.singles[n] for n in names) / something
    if len(names) > LARGEST_GROUP or share < NAMED:
        return Verdict(CANNOT_TELL, (), share)
    return Verdict(EFFECT if len(names) == 1 else GROUP, tuple(names), share)


def _of_pairs(p: Posterior, twins: Mapping[str, tuple[str, ...]], signs: Signs, something: float) -> Verdict:
    """The leading pair, where no other pair but by twins is as likely; else the effect of it that is sure."""
    best = max(p.pairs, key=p.pairs.get)
    share = sum(p.pairs.values()) / something
    if signs.mended:
        return Verdict(EFFECT, (signs.mended,), share)
    alike = [{name, *twins.get(name, ())} for name in best]
    same = [q for q in p.pairs if all(any(name in names for name in q) for names in alike)]
    if not signs.bendable and sum(p.pairs[q] for q in same) >= SURE * sum(p.pairs.values()):
        return Verdict(PAIR, best, share)
    common = {name: sum(v for q, v in p.pairs.items() if name in q) for name in best}
    alone = {name: p.log((name,)) if name in p.singles else -np.inf for name in best}
    return Verdict(PARTIAL, (max(best, key=lambda name: (common[name], alone[name])),), share)
