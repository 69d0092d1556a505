"""How often would these data cry wolf, and what could they show? By simulated campaigns, linear around the null fit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import log

import numpy as np
from scipy.special import logsumexp

from workbench.data.stack import Stack
from workbench.explain.bank import Prepared
from workbench.explain.priors import NOTHING, ONE_EFFECT, UNKNOWN
from workbench.explain.rivals import Choice, Unknown
from workbench.likelihood.bench import Bench
from workbench.likelihood.linear import Nuisances
from workbench.likelihood.noise import Noise

FALSE_ALARM_RATE = 0.02  # wanted share of empty campaigns that raise an alarm
SIMULATIONS = 400
PLAIN = 10.0  # nats that an effect or an unknown function is expected to gain, from which it would be seen plainly
NORMAL_90 = 1.2816  # one-sided 90 % of a standard normal
POWER_SIZES = (3.0, 10.0)  # amplitudes of unknown discrepancies, of the uncertainty of a reading
# Readings that the tolerances must leave beside the size of one effect, to abstain at all: with fewer the best of 25
# signatures comes near to any residual: one of 25 random directions has a cosine above 0.9 in 30 % of all cases in five
# dimensions, in 92 % in three.
SPARE = 5.0


@dataclass(frozen=True, eq=False)
class Screen:
    """Everything the linear evidences need: prepared signatures of all effects, and the unknown function."""

    nuisances: Nuisances
    prepared: tuple[Prepared, ...]
    unknown: Unknown

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(p.signature.name for p in self.prepared))

    def log_evidences(self, residuals: np.ndarray) -> dict[str, np.ndarray]:
        """ln evidence over the null of each effect, variants averaged, for residuals (n, R): (R,) each."""
        found: dict[str, list] = {name: [] for name in self.names}
        for p in self.prepared:
            found[p.signature.name].append(
                p.log_evidence(residuals) if p.signature.is_seen else np.zeros(residuals.shape[1])
            )
        return {name: logsumexp(v, axis=0) - log(len(v)) for name, v in found.items()}

    def shares(self, residuals: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """ln odds over "nothing" of one effect of the library, and of the unknown function (R,) each."""
        singles = np.array(list(self.log_evidences(residuals).values()))
        library = logsumexp(singles, axis=0) - log(max(len(singles), 1)) + log(ONE_EFFECT / NOTHING)
        return library, self.unknown.log_evidence(self.nuisances, residuals) + log(UNKNOWN / NOTHING)

    def alarm(self, residuals: np.ndarray) -> np.ndarray:
        """ln odds of "something" over "nothing" (R,)."""
        return np.logaddexp(*self.shares(residuals))


def plain_shares(screen: Screen, residual: np.ndarray) -> tuple[dict[str, float], float]:
    """Of what is believed of each effect (by name) and of the unknown function, the share of sizes that would be seen
    plainly; the rest is too small to show in these data.

    residual: of the null, carried back to zero (n,)
    """
    weights: dict[str, list] = {name: [] for name in screen.names}
    for p in screen.prepared:
        score = p.gains(residual[:, None])[0][:, 0] + p.signature.log_prior
        weights[p.signature.name].append((score, 0.5 * p.energy >= PLAIN))
    effects = {name: _share(*map(np.concatenate, zip(*parts))) for name, parts in weights.items()}
    gains = screen.unknown.log_evidences(screen.nuisances, residual[:, None])[:, 0]
    return effects, _share(gains, np.array([screen.unknown.expected_gain(c) >= PLAIN for c in screen.unknown.choices]))


def _share(log_weights: np.ndarray, chosen: np.ndarray) -> float:
    weights = np.exp(log_weights - log_weights.max())
    return float(weights[chosen].sum() / weights.sum())


def empty_campaigns(
    stack: Stack, noise: Noise, nuisances: Nuisances, random: np.random.Generator, count: int
) -> np.ndarray:
    """Whitened residuals (n, count) of campaigns that hide nothing: tolerances and noise drawn, its size and
    correlation
    known only as well as the repeats tell."""
    z = random.standard_normal((stack.size, count))
    out = np.empty_like(z)
    for channel, found in zip(stack.channels, noise.channels):
        size = np.sqrt(found.dof / random.chisquare(found.dof, count))
        more = random.normal(0.0, np.sqrt((1 - found.rho**2) / max(found.dof, 10.0)), count)
        part = z[channel.rows]
        out[channel.rows] = size * (part + more * np.vstack([np.zeros((1, count)), part[:-1]])) / np.sqrt(1 + more**2)
    return out + nuisances.jacobian @ random.standard_normal((nuisances.jacobian.shape[1], count))


def alarm_threshold(screen: Screen, bench: Bench, random: np.random.Generator, count: int = SIMULATIONS) -> float:
    """ln odds of "something" that only the wanted share of empty campaigns exceeds."""
    empty = empty_campaigns(bench.fit.stack, bench.noise, bench.nuisances, random, count)
    return float(np.quantile(screen.alarm(empty), 1 - FALSE_ALARM_RATE))


def abstention_power(screen: Screen, bench: Bench, threshold: float, random, count: int = 100) -> dict[float, float]:
    """Share of unknown smooth discrepancies of a size that raise an alarm and are not taken for an effect of the
    library; 0 where the readings are too few to tell any curve from an effect."""
    if spare_readings(bench) < SPARE:
        return dict.fromkeys(POWER_SIZES, 0.0)
    out = {}
    for size in POWER_SIZES:
        empty = empty_campaigns(bench.fit.stack, bench.noise, bench.nuisances, random, count)
        drawn = _discrepancies(screen.unknown, size, bench.fit.stack.size, random, count)
        library, unknown = screen.shares(empty + drawn)
        out[size] = float(np.mean((np.logaddexp(library, unknown) > threshold) & (unknown > library)))
    return out


def spare_readings(bench: Bench) -> float:
    """Readings to fit beyond what tolerances and instruments take and the one that the size of an effect takes."""
    taken = float(np.sum(bench.nuisances.factor**2))  # trace of 1 - (1 + J J^T)^-1
    return bench.fit.stack.size - taken - 1.0


def _discrepancies(unknown: Unknown, size: float, rows: int, random: np.random.Generator, count: int) -> np.ndarray:
    """Draws of the unknown function in one channel each (rows, count)."""
    places = sorted({choice.parts for choice in unknown.choices if len(choice.parts) == 1})
    picked = random.integers(0, len(places), count)
    return np.hstack([unknown.draw(Choice(places[k], size, 0.0), random, rows, 1) for k in picked])


def detection_limit(screen: Screen, prepared: Prepared, threshold: float) -> float | None:
    """Smallest value of the first parameter that raises an alarm in nine of ten campaigns, others at the prior's
    centre.

    None where even the largest size on the grid is not seen.
    """
    signature = prepared.signature
    if not signature.is_seen:
        return None
    cells = np.flatnonzero(np.all(np.abs(signature.z[:, 1:]) < 0.5 * signature.width + 1e-9, axis=1))
    residuals = signature.s[:, cells]
    margin = prepared.log_evidence(residuals) + log(ONE_EFFECT / NOTHING / max(len(screen.names), 1))
    margin = margin - NORMAL_90 * np.sqrt(np.maximum(prepared.energy[cells], 0.0)) - threshold
    return _smallest(signature, cells, margin)


def _smallest(signature, cells: Sequence[int], margin: np.ndarray) -> float | None:
    from effects.parameter import parameters_of

    name, parameter = next(iter(parameters_of(signature.effect).items()))
    values = np.array([getattr(signature.effect.at(signature.z[c]), name) for c in cells]) - parameter.null
    found = [_crossing(values[side], margin[side]) for side in (values > 0, values < 0) if side.any()]
    found = [value for value in found if value is not None]
    return min(found) + parameter.null if found else None


def _crossing(values: np.ndarray, margin: np.ndarray) -> float | None:
    """|value| at which the margin turns positive, linear in between."""
    order = np.argsort(np.abs(values))
    sizes, margin = np.abs(values[order]), margin[order]
    if not (margin > 0).any():
        return None
    first = int(np.argmax(margin > 0))
    if first == 0:
        return float(sizes[0])
    part = -margin[first - 1] / (margin[first] - margin[first - 1])
    return float(sizes[first - 1] + part * (sizes[first] - sizes[first - 1]))
