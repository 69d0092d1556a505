"""Sets of effects that explain readings, by linear algebra alone: every effect beside nothing, then every other effect
beside each of the sets that lead, up to four at once beside what every other bench shows."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from itertools import combinations, product
from math import exp, fsum, log, log1p

import numpy as np

from effects.base import Effect
from workbench.believed import MOST, UNKNOWN_RATE
from workbench.likelihood.marginal import Catalogue, Readings
from workbench.likelihood.unknown_laws import LAWS, without_laws

StandsOut = Callable[[str, frozenset[str]], bool]  # an effect, of a set

LEADERS = (1, 8, 6, 4)  # sets of none, one, two and three effects that are looked at with one effect more


@dataclass(frozen=True)
class Beliefs:
    """Prior shares, from the base rates of the effects. excluded: pairs of which one is a special case of the other,
    and pairs of unknown laws"""

    log_odds: Mapping[str, float]
    excluded: frozenset[frozenset[str]]

    @property
    def log_unknown(self) -> float:
        """ln odds of an unknown function."""
        return log(UNKNOWN_RATE) - log1p(-UNKNOWN_RATE)

    def base_rate(self, name: str) -> float:
        """Share of benches that have the effect."""
        return 1.0 / (1.0 + exp(-self.log_odds[name]))

    def log_prior(self, names: frozenset[str]) -> float:
        """ln odds of a set of effects over nothing."""
        return fsum(self.log_odds[name] for name in names)  # the same in whatever order a set has

    def may_join(self, name: str, names: frozenset[str]) -> bool:
        if name in names or any(frozenset((name, other)) in self.excluded for other in names):
            return False
        return self._is_usual(name) or sum(not self._is_usual(other) for other in names) < MOST

    def _is_usual(self, name: str) -> bool:
        """Whether at least every other bench shows an effect: such a one is not counted among what is hidden."""
        return self.log_odds[name] >= 0

    def leaves_room(self, names: frozenset[str]) -> bool:
        """Whether any effect may join a set."""
        return any(self.may_join(name, names) for name in self.log_odds)


def beliefs_of(library: Mapping[str, type[Effect]], names: Iterator[str] | tuple[str, ...]) -> Beliefs:
    """The prior shares of effects of a library."""
    chosen = tuple(names)
    odds = {name: log(library[name].base_rate) - log1p(-library[name].base_rate) for name in chosen}
    pairs = {frozenset((name, other)) for name in chosen for other in library[name].contains if other != name}
    laws = {frozenset(pair) for pair in combinations((name for name in chosen if name in LAWS), 2)}
    return Beliefs(odds, frozenset(pairs | laws))


@dataclass(frozen=True, eq=False)
class Explanation:
    """A set of effects by linear algebra.

    terms: numbers of the terms it is made of;  gain: ln p over nothing, forms and places averaged [nats]
    forms: of that, what the other forms of the effects than those of the terms make [nats]
    """

    names: frozenset[str]
    terms: tuple[int, ...]
    gain: float
    forms: float = 0.0


@dataclass(frozen=True, eq=False)
class Extension:
    """One effect more. gain: ln p it adds, forms and places averaged [nats];  term: number of its most probable term

    forms: ln p of all forms over that of the form of the term alone [nats], at least minus ln of their number
    """

    name: str
    gain: float
    term: int
    forms: float


@dataclass(frozen=True, eq=False)
class Names:
    """Which terms of a catalogue belong to which effect; those of one effect stand together."""

    catalogue: Catalogue

    @cached_property
    def order(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(term.name for term in self.catalogue.terms))

    @cached_property
    def ranges(self) -> list[tuple[int, int]]:
        """First and one past the last term of every effect."""
        starts = _starts([term.name for term in self.catalogue.terms]).tolist()
        return list(zip(starts, [*starts[1:], len(self.catalogue.terms)]))

    @cached_property
    def priors(self) -> np.ndarray:
        return np.array([term.log_prior for term in self.catalogue.terms])

    def extensions(self, gains: np.ndarray) -> Iterator[Iterator[Extension]]:
        """Every effect beside each of many explanations. gains: of all terms (explanations, terms) [nats]"""
        if not self.order:
            return iter([iter(())] * len(gains))
        scores = gains + self.priors
        sums = _sums(scores, [start for start, _ in self.ranges])
        best = np.stack([start + scores[:, start:end].argmax(axis=1) for start, end in self.ranges], axis=1)
        forms = sums - np.take_along_axis(self._of_forms(scores), self.forms[best], axis=1)
        rows = zip(sums.tolist(), best.tolist(), forms.tolist())
        return (map(Extension, self.order, *row) for row in rows)

    def _of_forms(self, scores: np.ndarray) -> np.ndarray:
        """ln p of every form if it were the only one (explanations, forms)."""
        return _sums(scores, self._form_starts) - _sums(self.priors[None], self._form_starts)

    @cached_property
    def _form_starts(self) -> np.ndarray:
        return _starts(self.forms)

    @cached_property
    def forms(self) -> np.ndarray:
        """Number of the form that every term is of."""
        keys = [(term.name, term.variant) for term in self.catalogue.terms]
        numbers = {key: k for k, key in enumerate(dict.fromkeys(keys))}
        return np.array([numbers[key] for key in keys])


def _starts(labels: Sequence[object] | np.ndarray) -> np.ndarray:
    """Where labels, equal ones side by side, change."""
    return np.flatnonzero([k == 0 or labels[k] != labels[k - 1] for k in range(len(labels))])


def _sums(scores: np.ndarray, starts: Sequence[int] | np.ndarray) -> np.ndarray:
    """ln of the sums of what has these logarithms, from each start to the next (explanations, starts)."""
    return np.logaddexp.reduceat(scores, starts, axis=1)


def explored(
    names: Names,
    readings: Sequence[Readings],
    beliefs: Beliefs,
    already: frozenset[str] = frozenset(),
    most: int = MOST,
    beam: tuple[int, ...] = LEADERS,
) -> list[dict[frozenset[str], Explanation]]:
    """Of each readings the sets of effects that were looked at, those without any first.

    already: effects that the background has;  most: effects at once, those included
    beam: sets of none, one, two ... effects that are looked at with one effect more
    """
    nothing = Explanation(frozenset(), (), 0.0)
    may_join = cache(lambda name, others: beliefs.may_join(name, others | already))
    found = [{nothing.names: nothing} for _ in readings]
    edges = [[nothing] for _ in readings]
    for width in beam[: max(most - len(already), 0)]:
        rank = lambda e: -(e.gain + beliefs.log_prior(e.names))  # noqa: E731
        leaders = [(k, leader) for k, edge in enumerate(edges) for leader in sorted(edge, key=rank)[:width]]
        edges = [[] for _ in readings]
        for (k, leader), extensions in zip(leaders, _extensions(names, readings, leaders)):
            for extension in extensions:
                if may_join(extension.name, leader.names):
                    edges[k] += _kept(found[k], leader, extension)
    return found


def _extensions(
    names: Names, readings: Sequence[Readings], leaders: Sequence[tuple[int, Explanation]]
) -> Iterator[Iterator[Extension]]:
    """Every effect beside each of explanations (number of its readings, explanation). Those of the same terms, of which
    many readings have some, are looked at together."""
    alike: dict[tuple[int, ...], list[int]] = {}
    for place, (_, leader) in enumerate(leaders):
        alike.setdefault(leader.terms, []).append(place)
    gains = np.empty((len(leaders), len(names.catalogue.terms)))
    for terms, places in alike.items():
        gains[places] = names.catalogue.gains(terms, [readings[leaders[place][0]] for place in places]).T
    return names.extensions(gains)


def _kept(
    found: dict[frozenset[str], Explanation], leader: Explanation, extension: Extension
) -> tuple[Explanation, ...]:
    """A set with one effect more, where it was not found yet or was found to gain less."""
    names, gain = leader.names | {extension.name}, leader.gain + extension.gain
    if names in found and found[names].gain >= gain:
        return ()
    found[names] = Explanation(names, leader.terms + (extension.term,), gain, leader.forms + extension.forms)
    return (found[names],)


@dataclass(frozen=True)
class Posterior:
    """Probabilities of all explanations: of sets of effects alone, and of the same beside an unknown function.

    They add up to one. What is printed is one of ``nothing``, ``of``, ``any_of``, ``all_of``, ``remains``.
    """

    alone: Mapping[frozenset[str], float]
    beside: Mapping[frozenset[str], float]

    @property
    def nothing(self) -> float:
        """P(no effect and no unknown function)."""
        return self.alone.get(frozenset(), 0.0)

    @property
    def remains(self) -> float:
        """P(something is there that no effect of the library is), with or without effects."""
        return _share(self.beside.values())

    @property
    def none_of_these(self) -> float:
        """P(an unknown function and no effect of the library)."""
        return self.beside.get(frozenset(), 0.0)

    @cached_property
    def sets(self) -> dict[frozenset[str], float]:
        """Probability of every set of effects, whatever else is there."""
        found = dict(self.alone)
        for names, p in self.beside.items():
            found[names] = found.get(names, 0.0) + p
        return found

    def of(self, name: str) -> float:
        """P(the effect is there)."""
        return self.of_both(name, name)

    def of_both(self, one: str, other: str) -> float:
        """P(two effects are there)."""
        return min(self._together.get((one, other), 0.0), 1.0)

    @cached_property
    def _together(self) -> dict[tuple[str, str], float]:
        """Of every two effects that are in one set, and of each with itself."""
        found: dict[tuple[str, str], float] = {}
        for names, p in self.sets.items():
            for pair in product(names, names):
                found[pair] = found.get(pair, 0.0) + p
        return found

    def any_of(self, names: frozenset[str]) -> float:
        """P(at least one of the effects is there)."""
        return _share(p for have, p in self.sets.items() if have & names)

    def all_of(self, groups: tuple[frozenset[str], ...]) -> float:
        """P(at least one effect of every group is there)."""
        return _share(p for have, p in self.sets.items() if all(have & group for group in groups))

    @cached_property
    def leading(self) -> frozenset[str]:
        """The most probable set of effects."""
        return max(self.sets, key=lambda names: (self.sets[names], -len(names), sorted(names)), default=frozenset())

    @cached_property
    def names(self) -> tuple[str, ...]:
        """All effects, most probable first."""
        return tuple(sorted({one for one, _ in self._together}, key=lambda name: (-self.of(name), name)))


def _share(shares: Iterable[float]) -> float:
    """Their sum, which rounding must not carry beyond one."""
    return min(sum(shares), 1.0)


def posterior(
    alone: Mapping[frozenset[str], float], beside: Mapping[frozenset[str], float], beliefs: Beliefs
) -> Posterior:
    """Probabilities from ln evidences, on one scale, of sets alone and beside an unknown function. A set that holds an
    unknown law counts as its effects beside something unknown."""
    logs = [v + beliefs.log_prior(n) for n, v in alone.items()]
    more = [v + beliefs.log_prior(n) + beliefs.log_unknown for n, v in beside.items()]
    total = np.logaddexp.reduce(logs + more)
    found = Posterior({}, {})
    for names, v in zip(alone, logs):
        _add(found.alone if LAWS.keys().isdisjoint(names) else found.beside, names, exp(v - total))
    for names, v in zip(beside, more):
        _add(found.beside, names, exp(v - total))
    return found


def _add(shares: dict[frozenset[str], float], names: frozenset[str], share: float) -> None:
    effects = without_laws(names)
    shares[effects] = shares.get(effects, 0.0) + share


def beside_the_unknown(p: Posterior, beliefs: Beliefs, stands_out: StandsOut) -> Posterior:
    """The same where something unknown is likely there, so that an effect beside it may be there, or may only be what
    its shape lacks of the true law.

    A law that takes k of N effects to be followed takes any of them with k/N, and one is there with its base rate pi,
    so that of those taken pi / (pi + k/N) are there. k: mean number of effects beside the unknown function
    stands_out: whether an effect of a set explains too much to be what a law of another shape has taken
    Raises ValueError where nothing unknown is possible.
    """
    if not p.remains > 0:
        raise ValueError("nothing unknown is possible: its effects cannot be told from what it lacks")
    taken = fsum(len(names) * share for names, share in p.beside.items()) / fsum(p.beside.values())
    chance = taken / len(without_laws(frozenset(beliefs.log_odds)))
    found: dict[frozenset[str], float] = {}
    for names, share in p.beside.items():
        rates = {name: beliefs.base_rate(name) for name in names}
        there = {name: 1.0 if stands_out(name, names) else rate / (rate + chance) for name, rate in rates.items()}
        for part, portion in _parts(names, there):
            found[part] = found.get(part, 0.0) + share * portion
    return Posterior(p.alone, found)


def _parts(names: frozenset[str], there: Mapping[str, float]) -> list[tuple[frozenset[str], float]]:
    """Every part of a set, and the share of those in which it is all that is there."""
    parts = [(frozenset[str](), 1.0)]
    for name in names:
        parts = [(part, share * (1.0 - there[name])) for part, share in parts] + [
            (part | {name}, share * there[name]) for part, share in parts
        ]
    return parts
