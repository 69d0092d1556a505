"""Explanations fitted with the model itself: effects at their most probable sizes, alone or beside an unknown function,
each with its evidence."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from math import log

import numpy as np
from scipy.special import ndtr, ndtri

from effects.base import Effect
from effects.parameter import parameters_of
from effects.prior import Uniform
from workbench.errors import WorkbenchError
from workbench.findings import Estimate, SizePosterior
from workbench.likelihood.bench import Bench, sharpened
from workbench.likelihood.fit import (
    FAR,
    Fit,
    Problem,
    fitted,
    linearised,
    possible,
    prior_cost,
    refitted,
    with_parameters,
)
from workbench.likelihood.own_errors import shapes_of_laws
from workbench.likelihood.unknown import Seen, Shape, expected, seen
from workbench.likelihood.whitening import LawError, law_error

REACH = 4.0  # standard deviations to either side over which a posterior is integrated
PLACES = 17
ALSO = 0.5  # probability that an unknown law which shows in one group of channels shows in another one too
LAW_ROUNDS = 6  # times the errors of laws are taken again where a fit ended
LAW_CLOSE = 20.0  # change of half their ln determinant that is none, over that at which a fit is done
IMPOSSIBLE = -1e30  # ln density where the model has no answer: a number, so that it can be interpolated
SIZES_TRIED, OTHERS_TRIED = 3, {2: 8, 3: 4, 4: 3}  # values of the size and of every other parameter, by their number
TURNS_TRIED = 8  # parts of a turn by which a direction is moved
SHARES = 100  # of a posterior, whose middles stand for it where several are brought together
NORMAL_95 = 1.6449  # two-sided 90 % of a standard normal


@dataclass(frozen=True, eq=False)
class Hypothesis:
    """Effects that may be missing (none: nothing is), fitted.

    log_evidence: ln p of the fitted rows, up to what all hypotheses share [nats]
    log_det: half the ln determinant of the errors of the effects' own laws, which the problem integrates out
    """

    fit: Fit
    problem: Problem
    log_evidence: float
    log_det: float = 0.0

    @property
    def names(self) -> frozenset[str]:
        return frozenset(effect.name() for effect in self.fit.effects)

    @property
    def effects(self) -> tuple[Effect, ...]:
        return self.fit.at_maximum


def null_of(bench: Bench) -> Hypothesis:
    """Nothing is missing."""
    return Hypothesis(bench.null, bench.fit, bench.null.log_evidence)


def fitted_from(
    bench: Bench, effects: Sequence[Effect], x: np.ndarray, z: np.ndarray, slopes: np.ndarray | None = None
) -> Hypothesis:
    """Effects fitted from a start, with the errors of their laws integrated out; where it is not known how large an
    error is, the most probable one, and the evidence of all.

    effects: null effects;  x: nuisances (m,);  z: parameters of all effects one after the other (k,)
    slopes: d readings / d x (n, m) of a fit near the start, where there is one
    Raises:
        WorkbenchError: the model has no answer at the start.
    """
    found = []
    for each in product(*(effect.with_errors for effect in effects)):
        found.append(_fitted_from(bench, each, x, z, slopes))
        x, z, slopes = found[-1].fit.x, found[-1].fit.z, found[-1].fit.slopes
    evidence = float(np.logaddexp.reduce([h.log_evidence for h in found])) - log(len(found))
    return replace(max(found, key=lambda h: h.log_evidence), log_evidence=evidence)


def _fitted_from(
    bench: Bench, effects: Sequence[Effect], x: np.ndarray, z: np.ndarray, slopes: np.ndarray | None
) -> Hypothesis:
    """With the errors that the effects have; evidence by Laplace, for one parameter by integration over it.

    Errors of laws are those of where the fit with them ends: a large effect has a large error, with which it is fitted
    small, and has a small one. Once fits threw each other to both sides, the place is closed in between them.
    """
    place = np.concatenate([x, z])
    problem, log_det = _with_law_error_at(bench, effects, place)
    fit = fitted(problem, tuple(effects), x, z, slopes)
    sides: dict[bool, tuple[np.ndarray, float]] = {}
    for _ in range(LAW_ROUNDS):
        end = np.concatenate([fit.x, fit.z])
        there = _with_law_error_at(bench, effects, end)
        off = there[1] - log_det
        if abs(off) < LAW_CLOSE * bench.fit.close(fit.objective):
            problem, log_det = there
            break
        sides = _narrowed(sides, place, off)
        place = end if len(sides) == 1 else _between(*sides.values())
        problem, log_det = there if place is end else _with_law_error_at(bench, effects, place)
        fit = refitted(problem, fit)
    evidence = fit.log_evidence if len(z) != 1 else _integrated(problem, fit)[2]
    return Hypothesis(fit, problem, evidence - log_det, log_det)


def held_at(bench: Bench, fit: Fit, effects: Sequence[Effect], z: np.ndarray) -> Hypothesis:
    """Some effects of a fit where it ended, the others taken away and nothing fitted again.

    effects: null effects;  z: their parameters one after the other (k,)
    """
    problem, log_det = _with_law_error_at(bench, effects, np.concatenate([fit.x, z]))
    held = linearised(problem, fit.x, effects, z)
    return Hypothesis(held, problem, held.log_evidence - log_det, log_det)


def _with_law_error_at(bench: Bench, effects: Sequence[Effect], place: np.ndarray) -> tuple[Problem, float]:
    """See ``with_law_error``. place: nuisances, then parameters of the effects (m + k,)"""
    x, z = np.split(place, [len(bench.fit.start)])
    return with_law_error(bench.fit, with_parameters(effects, z), x)


def _narrowed(
    sides: Mapping[bool, tuple[np.ndarray, float]], place: np.ndarray, off: float
) -> dict[bool, tuple[np.ndarray, float]]:
    """The nearest place to either side, with one more; the other side counts half where the same one is moved again
    (regula falsi after Illinois: Dowell and Jarratt, BIT 11 (1971), 168).

    off: by what half the ln determinant is more where a fit with errors of this place ended
    """
    is_above = off > 0
    stale = 0.5 if is_above in list(sides)[-1:] else 1.0
    other = {side: (p, stale * o) for side, (p, o) in sides.items() if side is not is_above}
    return other | {is_above: (place, off)}


def _between(one: tuple[np.ndarray, float], other: tuple[np.ndarray, float]) -> np.ndarray:
    """Where a straight line through both is zero."""
    (a, above), (b, below) = one, other
    return a + (b - a) * above / (above - below)


def turned(bench: Bench, hypothesis: Hypothesis) -> Hypothesis:
    """The fit again with every direction moved by eighths of a turn, where that ends higher: an eccentricity to the
    other side makes the same cogging, but another voltage where a coil lacks turns."""
    return _from_others(bench, hypothesis, _turns)


def from_elsewhere(bench: Bench, hypothesis: Hypothesis) -> Hypothesis:
    """The fit again from other sizes, directions and the like of every effect that has several parameters, where that
    ends higher: a fit that begins at a wrong direction makes the effect small first, and stays there."""
    return _from_others(bench, hypothesis, lambda *there: np.vstack([_grid(*there), _turns(*there)]))


def _from_others(
    bench: Bench, hypothesis: Hypothesis, others: Callable[[Effect, np.ndarray, slice], np.ndarray]
) -> Hypothesis:
    """others: from an effect, the parameters of all (k,) and the places of its own to other parameters (n, k)"""
    place = 0
    for effect in hypothesis.fit.effects:
        own = slice(place, place + len(parameters_of(effect)))
        fit, place = hypothesis.fit, own.stop
        start = _highest(hypothesis, others(effect, fit.z, own))
        if start is not None:
            again = fitted_from(bench, fit.effects, fit.x, start, fit.slopes)
            hypothesis = max(hypothesis, again, key=lambda h: h.log_evidence)
    return hypothesis


def _grid(effect: Effect, z: np.ndarray, own: slice) -> np.ndarray:
    """Parameters (n, k) with those of one effect at the places of a grid, even in probability; none where it has only
    one."""
    count = own.stop - own.start
    if count == 1:
        return np.empty((0, len(z)))
    axes = [ndtri((np.arange(n) + 0.5) / n) for n in (SIZES_TRIED, *[OTHERS_TRIED[count]] * (count - 1))]
    grid = list(product(*axes))
    places = np.tile(z, (len(grid), 1))
    places[:, own] = grid
    return places


def _turns(effect: Effect, z: np.ndarray, own: slice) -> np.ndarray:
    """Parameters (n, k) with one direction of an effect moved by eighths of a turn; none for an effect without any."""
    directions = [k for k, p in enumerate(parameters_of(effect).values(), own.start) if isinstance(p.prior, Uniform)]
    steps = np.arange(1, TURNS_TRIED) / TURNS_TRIED
    places = np.tile(z, (len(directions), len(steps), 1))
    for k, moved in zip(directions, places):
        moved[:, k] = np.clip(ndtri(np.mod(ndtr(z[k]) + steps, 1.0)), -FAR, FAR)
    return places.reshape(-1, len(z))


def _highest(hypothesis: Hypothesis, places: np.ndarray) -> np.ndarray | None:
    """The parameters (k,), of some (n, k), where the fit would be higher than it is, and highest; None where at none of
    them."""
    fit = hypothesis.fit
    if not len(places):
        return None
    best = max((fit.z, *places), key=lambda z: _profile(hypothesis.problem, fit, fit.x, z))
    return None if best is fit.z else best


def with_law_error(problem: Problem, effects: Sequence[Effect], x: np.ndarray) -> tuple[Problem, float]:
    """The problem with the declared errors of the effects' own laws integrated out, whose shapes are those of
    ``shapes_of_laws``, and half the ln determinant of that."""
    wrong = [effect for effect in effects if effect.law_error > 0]
    if not wrong:
        return problem, 0.0
    changes = [effect.law_error * change_by(problem, effects, effect, x) for effect in wrong]
    return _without_laws(problem, [_law(problem, number, changes) for number in range(len(problem.stack.channels))])


def change_by(problem: Problem, effects: Sequence[Effect], effect: Effect, x: np.ndarray) -> np.ndarray:
    """What one of the effects does to the readings, SI (n,): by itself, or beside the others where the model has no
    answer so."""
    predict, others = problem.predictor.predict, tuple(other for other in effects if other is not effect)
    try:
        return predict(x, (effect,)) - predict(x)
    except WorkbenchError:
        return predict(x, tuple(effects)) - predict(x, others)


def _without_laws(problem: Problem, laws: Sequence[LawError]) -> tuple[Problem, float]:
    return replace(problem, white=problem.white.with_laws(laws)), sum(law.half_log_det for law in laws)


def _law(problem: Problem, number: int, changes: Sequence[np.ndarray]) -> LawError:
    channel = problem.stack.channels[number]
    raw = shapes_of_laws(problem.stack, channel, changes)
    return law_error(channel.rows, problem.white.of(np.arange(problem.stack.size)[channel.rows])(raw))


def exact(hypothesis: Hypothesis) -> Hypothesis:
    """The hypothesis with a base model that is exact at its maximum, where the base model answers by an expansion."""
    problem, fit = sharpened(hypothesis.problem, hypothesis.fit)
    if fit is hypothesis.fit:
        return hypothesis
    gain = fit.log_evidence - hypothesis.fit.log_evidence
    return replace(hypothesis, fit=fit, problem=problem, log_evidence=hypothesis.log_evidence + gain)


# ---- beside an unknown function --------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class Beside:
    """A hypothesis and an unknown function beside it.

    log_evidence: ln p with every shape and size of it averaged over [nats];  leading: the most probable shapes, the
    first in the channels that need it most, one for each further group of channels that shows it too
    functions: their expected values on the rows of each, SI
    """

    hypothesis: Hypothesis
    log_evidence: float
    leading: tuple[Seen, ...]
    functions: tuple[np.ndarray, ...]

    def columns(self) -> np.ndarray:
        """Whitened columns of the leading shapes (n, k)."""
        return np.hstack([s.columns(self.hypothesis.problem.stack.size) for s in self.leading])


def beside_unknown(hypothesis: Hypothesis, shapes: Sequence[Shape]) -> Beside | None:
    """The hypothesis with an unknown function: the shapes that suit best by linear algebra, then a fit with these; None
    where no shape can be seen in these rows.

    ln Z = ln Z of the refit + ln of the share that these shapes and sizes have of the sum over all
    """
    fit = hypothesis.fit
    residual = at_zero(hypothesis)
    leading, share = _leading(_rewhitened(shapes, hypothesis.problem), fit.jacobian, residual)
    if not leading:
        return None
    problem, log_det = _without_unknown(hypothesis.problem, leading)
    refit = refitted(problem, fit)
    evidence = refit.log_evidence - log_det - hypothesis.log_det + share
    functions, background = [], fit.jacobian
    for s in leading:
        others = [o.columns(len(residual)) for o in leading if o is not s]
        functions.append(expected(s, np.hstack([background, *others]), residual))
    return Beside(hypothesis, evidence, leading, tuple(functions))


def at_zero(hypothesis: Hypothesis) -> np.ndarray:
    """Whitened residual of a fit with its nuisances carried back to zero, its effects as they are (n,)."""
    fit = hypothesis.fit
    return fit.residual + fit.jacobian[:, : len(fit.x)] @ fit.x


def _leading(shapes: Sequence[Shape], background: np.ndarray, residual: np.ndarray) -> tuple[tuple[Seen, ...], float]:
    """The shapes that suit best, group of channels after group, and ln of their share of the sum over all [nats]."""
    found = seen(shapes, background, residual)
    if not found:
        return (), 0.0
    groups = len({s.channels for s in shapes})
    chosen = [max(found, key=lambda s: s.log_evidence)]
    share = float(np.logaddexp.reduce([s.log_evidence for s in found])) - float(chosen[0].gains.max())
    while left := _in_other_channels(shapes, chosen):
        background = np.hstack([background, chosen[-1].columns(len(residual))])
        found = seen(left, background, residual)
        best = max(found, key=lambda s: s.log_evidence)
        of_group = [s.log_evidence for s in found if s.shape.channels == best.shape.channels]
        gain = float(np.logaddexp.reduce(of_group)) + log(groups) + log(ALSO)
        if gain <= 0:
            break
        chosen.append(best)
        share += gain - float(best.gains.max())
    return tuple(chosen), share


def _in_other_channels(shapes: Sequence[Shape], chosen: Sequence[Seen]) -> list[Shape]:
    taken = {channel for s in chosen for channel in s.shape.channels}
    return [shape for shape in shapes if not taken.intersection(shape.channels)]


def _rewhitened(shapes: Sequence[Shape], problem: Problem) -> list[Shape]:
    """Shapes as the whitener of a problem sees them, the errors of laws taken out."""
    return [replace(shape, columns=problem.white.of(shape.rows)(shape.raw)) for shape in shapes]


def _without_unknown(problem: Problem, leading: Sequence[Seen]) -> tuple[Problem, float]:
    """The problem with unknown functions of some shapes and sizes integrated out, and half the ln determinant."""
    laws = []
    for s in leading:
        rows, white = s.shape.rows, problem.white.of(s.shape.rows)(s.size * s.shape.raw)
        own = [c.rows for c in problem.stack.channels if c.name in s.shape.channels]
        laws += [law_error(at, white[(at.start <= rows) & (rows < at.stop)]) for at in own]
    return _without_laws(problem, laws)


# ---- rows ------------------------------------------------------------------------------------------------------------


def sealed_rows(bench: Bench, hypothesis: Hypothesis) -> Problem | None:
    """The rows that are sealed, answered by the base model of the hypothesis; None where none are."""
    if bench.held_out is None:
        return None
    return replace(bench.held_out, predictor=hypothesis.problem.predictor.on(bench.held_out.stack))


# ---- sizes -----------------------------------------------------------------------------------------------------------


def _integrated(problem: Problem, fit: Fit) -> tuple[np.ndarray, np.ndarray, float]:
    """Places of the one parameter z, ln density there, and ln evidence; the nuisances by Laplace at each place."""
    m = len(fit.x)
    spread = np.sqrt(fit.covariance[m, m])
    places = np.unique(np.clip(fit.z[0] + spread * np.linspace(-REACH, REACH, PLACES), *possible(fit.effects)))
    drift = fit.covariance[:m, m] / fit.covariance[m, m]
    density = np.array([_profile(problem, fit, fit.x + drift * (z - fit.z[0]), np.array([z])) for z in places])
    density -= _unkept(problem, fit)
    widths = np.gradient(places)
    widths[[0, -1]] *= 0.5
    return places, density, float(np.logaddexp.reduce(density + np.log(widths)) - 0.5 * log(2 * np.pi))


def _profile(problem: Problem, fit: Fit, x: np.ndarray, z: np.ndarray) -> float:
    """ln of prior times likelihood at z (k,) with the nuisances integrated out around their best values; nothing where
    the model has no answer: a motor that cannot turn there made none of these readings."""
    slopes = fit.jacobian[:, : len(x)]
    try:
        residual = problem.residual(x, with_parameters(fit.effects, z))
    except WorkbenchError:
        return IMPOSSIBLE
    weights = problem.weights(residual)
    normal = _normal(fit, weights)
    move = np.linalg.solve(normal, slopes.T @ (weights * residual) - x)
    value = problem.misfit(residual - slopes @ move) + 0.5 * float(np.sum((x + move) ** 2)) + prior_cost(z)
    return -value - 0.5 * float(np.linalg.slogdet(normal)[1])


def _unkept(problem: Problem, fit: Fit) -> float:
    """What straight lines still promise at the maximum of a fit, and the model did not keep [nats]: it is no evidence,
    as it is none for the fit without effects, which the same lines promise as much."""
    residual = problem.residual(fit.x, with_parameters(fit.effects, fit.z))
    reached = problem.misfit(residual) + 0.5 * float(fit.x @ fit.x) + prior_cost(fit.z)
    normal = _normal(fit, problem.weights(residual))
    return _profile(problem, fit, fit.x, fit.z) + reached + 0.5 * float(np.linalg.slogdet(normal)[1])


def _normal(fit: Fit, weights: np.ndarray) -> np.ndarray:
    """Curvature of the objective over the nuisances (m, m). weights: of the rows (n,)"""
    slopes = fit.jacobian[:, : len(fit.x)]
    return slopes.T @ (weights[:, None] * slopes) + np.eye(len(fit.x))


def estimates(
    hypothesis: Hypothesis, among: Mapping[Hypothesis, float] | None = None
) -> dict[str, dict[str, Estimate]]:
    """Effect -> parameter -> value and 90 % interval.

    among: hypotheses with their weights, over all of which with the effect the interval is taken; only this one if None
    """
    weights = among or {hypothesis: 1.0}
    return {
        effect.name(): {name: _estimate(hypothesis, weights, effect, name) for name in parameters_of(effect)}
        for effect in hypothesis.effects
    }


def _estimate(hypothesis: Hypothesis, weights: Mapping[Hypothesis, float], effect: Effect, name: str) -> Estimate:
    """The value is that of the hypothesis, or the middle of what all others with the effect say where it lies beyond
    their interval; what the law of the effect may be wrong by widens that."""
    parameter = parameters_of(effect)[name]
    value = _value(effect, name, hypothesis.fit.z[_place(hypothesis, effect.name(), name)])
    parts = [(_samples(h, effect.name(), name), w) for h, w in weights.items() if effect.name() in h.names]
    samples = np.concatenate([s for s, _ in parts])
    shares = np.concatenate([np.full(len(s), w) for s, w in parts])
    order = np.argsort(samples)
    below = (np.cumsum(shares[order]) - shares[order] / 2) / shares.sum()
    low, middle, high = np.interp([0.05, 0.5, 0.95], below, samples[order]).tolist()
    value = value if low <= value <= high else middle
    law = NORMAL_95 * effect.size_error * abs(value) if name == next(iter(parameters_of(effect))) else 0.0
    low90 = max(value - np.hypot(value - low, law) if low < value else low, parameter.low)
    high90 = min(value + np.hypot(high - value, law) if high > value else high, parameter.high)
    return Estimate(value, float((high90 - low90) / (2 * NORMAL_95)), float(low90), float(high90), parameter.unit)


def _place(hypothesis: Hypothesis, effect_name: str, name: str) -> int:
    """Number of a parameter among those of all effects."""
    every = [(effect.name(), p) for effect in hypothesis.fit.effects for p in parameters_of(effect)]
    return every.index((effect_name, name))


def _samples(hypothesis: Hypothesis, effect_name: str, name: str) -> np.ndarray:
    """Values of a parameter that stand for its posterior, each as likely as the others."""
    effect = next(e for e in hypothesis.fit.effects if e.name() == effect_name)
    z = _quantiles(hypothesis, _place(hypothesis, effect_name, name))
    return np.array([_value(effect, name, place) for place in z])


def _value(effect: Effect, name: str, z: float) -> float:
    p = parameters_of(effect)[name]
    return float(np.clip(p.prior.value(float(np.clip(z, -FAR, FAR))), p.low, p.high))


def _quantiles(hypothesis: Hypothesis, place: int) -> np.ndarray:
    """z in the middle of ``SHARES`` equal shares of its posterior."""
    fit, middles = hypothesis.fit, (np.arange(SHARES) + 0.5) / SHARES
    if len(fit.z) == 1:
        places, density, _ = _integrated(hypothesis.problem, fit)
        fine = np.linspace(places[0], places[-1], 801)
        mass = np.cumsum(np.exp(np.interp(fine, places, density) - density.max()))
        return np.interp(middles, mass / mass[-1], fine)
    spread = np.sqrt(fit.covariance[len(fit.x) + place, len(fit.x) + place])
    return fit.z[place] + spread * ndtri(middles)


def density_of(hypothesis: Hypothesis) -> SizePosterior:
    """Posterior and prior density of the parameter of an effect that has only one."""
    effect = hypothesis.fit.effects[0]
    name, parameter = next(iter(parameters_of(effect).items()))
    places, density, _ = _integrated(hypothesis.problem, hypothesis.fit)
    z = np.linspace(places[0], places[-1], 121)
    values = np.array([parameter.prior.value(float(place)) for place in z])
    slope = np.abs(np.gradient(values, z)) + 1e-300
    after = np.exp(np.interp(z, places, density) - density.max()) / slope
    before = np.exp(-0.5 * z**2) / np.sqrt(2 * np.pi) / slope
    after = after / np.abs(np.trapezoid(after, values))
    found = estimates(hypothesis)[effect.name()][name]
    return SizePosterior(effect.name(), name, parameter.unit, values, after, before, found)
