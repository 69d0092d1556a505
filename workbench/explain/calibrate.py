"""How far can the probabilities of this bench be trusted, and what could it show? By simulated campaigns of it, with
tolerances, effects, unknown functions and noise drawn, linear around the fit without effects."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from math import floor

import numpy as np

from effects.parameter import parameters_of
from workbench.believed import FALSE_ALARMS, LIKELY, NAMED, PLAIN, SPARE
from workbench.explain.explore import Beliefs, Names, Posterior, explored, posterior
from workbench.explain.verdict import Thresholds
from workbench.findings import DetectionLimit
from workbench.likelihood.bench import Bench
from workbench.likelihood.marginal import Readings
from workbench.likelihood.noise import drawn_noise
from workbench.likelihood.signatures import Signatures
from workbench.likelihood.unknown import SIZES, Beside, Shape, seen
from workbench.likelihood.unknown_laws import LAWS

EMPTY, HIDDEN = 100, 120  # simulated campaigns that hide nothing, and that hide something
UNKNOWN = 30  # simulated campaigns that hide an unknown function of one size
POWER_SIZES = (3.0, 10.0)  # of unknown functions [rms over the uncertainty of a reading]
NORMAL_90 = 1.2816  # one-sided 90 % of a standard normal
_LEADERS = (1, 3)  # sets that are looked at with one effect more
EFFECTS_ALONE, EFFECTS_IN_PAIRS = 0.5, 0.25  # of the campaigns that hide something
UNKNOWN_LAWS = 0.5  # of the rest, where there are such laws; an unknown function in the others


@dataclass(frozen=True, eq=False)
class Simulated:
    """One simulated campaign. truth: effects in it;  unknown: whether an unknown function is"""

    readings: Readings
    residual: np.ndarray
    truth: frozenset[str]
    unknown: bool


@dataclass(frozen=True, eq=False)
class Simulator:
    """Campaigns of a bench, and their posteriors by linear algebra."""

    bench: Bench
    signatures: Signatures
    beliefs: Beliefs
    shapes: tuple[Shape, ...]
    random: np.random.Generator

    @cached_property
    def names(self) -> Names:
        return Names(self.signatures.catalogue(self.bench.centre.jacobian, self.bench.fit.white))

    @cached_property
    def energies(self) -> np.ndarray:
        """Squared length that the tolerances leave of what every term adds (terms,)."""
        background = self.bench.centre.jacobian
        shifts = np.column_stack([term.shift for term in self.names.catalogue.terms])
        root = np.linalg.cholesky(np.eye(background.shape[1]) + background.T @ background)
        taken = np.linalg.solve(root, background.T @ shifts)
        np.square(shifts, out=shifts)  # in place: there may be 40 MB of them
        return np.sum(shifts, axis=0) - np.sum(taken**2, axis=0)

    def noise(self, count: int) -> np.ndarray:
        """Whitened residuals (n, count) of campaigns that hide nothing.

        Fits learn from the readings how large the noise is, to first order by the weight of a channel: of a noise that
        is larger than expected only the rest that this leaves can be taken for a discovery.
        """
        jacobian = self.bench.centre.jacobian
        tolerances = jacobian @ self.random.standard_normal((jacobian.shape[1], count))
        noise = drawn_noise(self.bench.fit.stack, self.bench.noise, self.random, count)
        return tolerances + noise * np.sqrt(np.column_stack([self.bench.fit.weights(one) for one in noise.T]))

    def empty(self, count: int) -> list[Simulated]:
        """Campaigns that hide nothing."""
        return self._as_simulated(self.noise(count), [(frozenset(), False)] * count)

    def hiding(self, count: int) -> list[Simulated]:
        """Campaigns with effects after their base rates at sizes after their priors, or with an unknown function."""
        residuals, truths = self.noise(count), []
        for k in range(count):
            change, truth, unknown = self._hidden()
            residuals[:, k] += change
            truths.append((truth, unknown))
        return self._as_simulated(residuals, truths)

    def unknown_of(self, size: float, count: int) -> list[Simulated]:
        """Campaigns with an unknown function of a size [rms over the uncertainty of a reading]."""
        residuals = self.noise(count)
        for k in range(count):
            shape = self.shapes[int(self.random.integers(len(self.shapes)))]
            drawn = shape.columns @ self.random.standard_normal(shape.columns.shape[1])
            residuals[shape.rows, k] += drawn * size / max(float(np.sqrt(np.mean(drawn**2))), 1e-300)
        return self._as_simulated(residuals, [(frozenset(), True)] * count)

    def _hidden(self) -> tuple[np.ndarray, frozenset[str], bool]:
        kind = self.random.random()
        known = [name for name in self.names.order if name not in LAWS]
        if kind < EFFECTS_ALONE + EFFECTS_IN_PAIRS and known:
            chosen = self._effects(known, 1 if kind < EFFECTS_ALONE else 2)
            return sum(self._effect(name) for name in chosen), frozenset(chosen), False
        laws = [name for name in self.names.order if name in LAWS]
        if laws and self.random.random() < UNKNOWN_LAWS:
            return self._effect(str(self.random.choice(laws))), frozenset(), True
        shape = self.shapes[int(self.random.integers(len(self.shapes)))]
        change = np.zeros(self.bench.fit.stack.size)
        weights = float(self.random.choice(SIZES)) * self.random.standard_normal(shape.columns.shape[1])
        change[shape.rows] = shape.columns @ weights
        return change, frozenset(), True

    def _effects(self, known: Sequence[str], count: int) -> list[str]:
        rates = np.exp([self.beliefs.log_odds[name] for name in known])
        count = min(count, len(rates))
        return [str(n) for n in self.random.choice(known, count, replace=False, p=rates / rates.sum())]

    def _effect(self, name: str) -> np.ndarray:
        """Whitened change by an effect at a size after its prior (n,)."""
        mine = np.flatnonzero([term.name == name for term in self.names.catalogue.terms])
        shares = np.exp(self.names.priors[mine])
        term = self.names.catalogue.terms[int(self.random.choice(mine, p=shares / shares.sum()))]
        weights = np.clip(self.random.standard_normal(term.columns.shape[1]), *term.reach.T)
        return term.shift + term.columns @ weights

    def _as_simulated(self, residuals: np.ndarray, truths: list[tuple[frozenset[str], bool]]) -> list[Simulated]:
        readings = self.names.catalogue.readings(residuals)
        return [Simulated(r, residuals[:, k], *t) for k, (r, t) in enumerate(zip(readings, truths))]

    @cached_property
    def _beside_nothing(self) -> Beside:
        return Beside(self.shapes, self.bench.centre.jacobian)

    def posteriors(self, campaigns: Sequence[Simulated], most: int) -> list[Posterior]:
        """Of campaigns: sets of up to so many effects, and unknown functions beside nothing."""
        every = explored(self.names, [c.readings for c in campaigns], self.beliefs, most=most, beam=_LEADERS)
        unknown = self._beside_nothing.log_evidences(np.column_stack([c.residual for c in campaigns]))
        return [
            posterior({names: e.gain for names, e in sets.items()}, {frozenset(): float(one)}, self.beliefs)
            for sets, one in zip(every, unknown)
        ]


def thresholds_of(simulator: Simulator) -> tuple[Thresholds, dict[float, float]]:
    """What is said from which probability on, and the share of unknown functions of a size that would be noticed."""
    empty, hiding = simulator.empty(EMPTY), simulator.hiding(HIDDEN)
    quiet = min(1.0 - NAMED, lowest([p.nothing for p in simulator.posteriors(empty, 1)], FALSE_ALARMS))
    wrong = [_surest_false_name(p, c.truth) for p, c in zip(simulator.posteriors(hiding, 2), hiding)]
    sure = max(NAMED, -lowest([-p for p in wrong], FALSE_ALARMS))
    if spare_readings(simulator.bench) < SPARE:
        return Thresholds(sure, quiet, False), dict.fromkeys(POWER_SIZES, 0.0)
    power = {size: _noticed(simulator, size, quiet, sure) for size in POWER_SIZES}
    return Thresholds(sure, quiet, power[max(power)] >= LIKELY), power


def spare_readings(bench: Bench) -> float:
    """Readings to fit beyond what tolerances and instruments take, and the one that the size of an effect takes."""
    jacobian = bench.centre.jacobian
    taken = np.trace(np.linalg.solve(np.eye(jacobian.shape[1]) + jacobian.T @ jacobian, jacobian.T @ jacobian))
    return bench.fit.stack.size - float(taken) - 1.0


def lowest(values: list[float], share: float) -> float:
    """The value that a new one falls below with at most this probability (split conformal, finite sample); the least of
    fewer values than that takes."""
    place = max(floor(share * (len(values) + 1)) - 1, 0)
    return float(np.sort(values)[place])


def _surest_false_name(p: Posterior, truth: frozenset[str]) -> float:
    return max((p.of(name) for name in p.names if name not in truth), default=0.0)


def _noticed(simulator: Simulator, size: float, quiet: float, sure: float) -> float:
    found = simulator.posteriors(simulator.unknown_of(size, UNKNOWN), 2)
    return float(np.mean([p.nothing < quiet and _surest_false_name(p, frozenset()) < sure for p in found]))


def plainly_nothing(simulator: Simulator, p: Posterior, residual: np.ndarray) -> float:
    """P(nothing is missing that these data would show plainly): effects and unknown functions too small for that count
    as nothing.

    residual: of the null, carried back to zero (n,)
    """
    names = simulator.names
    scores = names.catalogue.gains((), names.catalogue.readings(residual[:, None]))[:, 0] + names.priors
    plain = {name: 0.0 for name in names.order}
    for name, (start, end) in zip(names.order, names.ranges):
        weights = np.exp(scores[start:end] - scores[start:end].max())
        plain[name] = float(weights @ (simulator.energies[start:end] >= 2 * PLAIN) / weights.sum())
    small = sum(share * (1 - plain[next(iter(names))]) for names, share in p.alone.items() if len(names) == 1)
    return p.nothing + small + p.none_of_these * (1 - _plain_unknown(simulator, residual))


def _plain_unknown(simulator: Simulator, residual: np.ndarray) -> float:
    """Share of the belief in an unknown function that would be seen plainly."""
    found = seen(simulator.shapes, simulator.bench.centre.jacobian, residual)
    weights, plain = [], []
    for s in found:
        energy = np.sum(s.shape.columns**2)
        weights += list(s.gains + s.shape.log_prior)
        plain += [0.5 * (a * a * energy - np.log1p(a * a * energy)) >= PLAIN for a in SIZES]
    shares = np.exp(np.array(weights) - max(weights)) if weights else np.zeros(0)
    return float(shares @ np.array(plain, dtype=float) / shares.sum()) if weights else 0.0


def detection_limits(simulator: Simulator, thresholds: Thresholds) -> tuple[DetectionLimit, ...]:
    """Smallest size of every effect that would be seen in nine of ten campaigns; effects that never would are left
    out."""
    found: dict[str, DetectionLimit] = {}
    energies = simulator.energies
    for name, (start, end) in zip(simulator.names.order, simulator.names.ranges):
        if name in LAWS:
            continue
        needed = _needed(simulator.beliefs.log_odds[name], thresholds)
        limit = _limit(simulator, name, start, end, energies, needed)
        if limit is not None:
            found[name] = limit
    return tuple(found.values())


def _needed(log_odds: float, thresholds: Thresholds) -> float:
    """Squared length from which an effect is an alarm in nine of ten campaigns: with g = |s|^2 / 2 the gain of ln p is
    g +- sqrt(2 g), and it must exceed what the odds and the size of the grid cost."""
    gain = -log_odds + np.log((1 - thresholds.quiet) / max(thresholds.quiet, 1e-6)) + _OCCAM
    return float((NORMAL_90 + np.sqrt(NORMAL_90**2 + 2 * max(gain, 0.0))) ** 2)


_OCCAM = 3.0  # nats that the unknown size of an effect costs, of a size known to some 5 % of what was believed possible


def _limit(simulator: Simulator, name: str, start: int, end: int, energies: np.ndarray, needed: float):
    terms = simulator.names.catalogue.terms[start:end]
    values: list[tuple[float, float]] = []
    signatures = simulator.signatures.found[name]
    parameter, p = next(iter(parameters_of(signatures[0].effect).items()))
    for term, energy in zip(terms, energies[start:end]):
        signature = signatures[term.variant]
        z = signature.z[term.place]
        if energy > 0 and np.all(np.abs(z[1:]) < 0.5 * signature.width + 1e-9):
            change = getattr(signature.effect.at(z), parameter) - p.null
            values.append((abs(change) * float(np.sqrt(needed / energy)), change))
            if energy < needed:
                values.pop()
    if not values:
        return None
    size, change = min(values)
    title = signatures[0].effect.title
    return DetectionLimit(name, title, parameter, p.null + np.sign(change) * size, p.unit)
