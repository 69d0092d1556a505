"""Fits of one effect, of two, and of an effect beside an unknown function, each with its evidence."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import logsumexp

from effects.base import Effect
from effects.parameter import parameters_of
from workbench.errors import WorkbenchError
from workbench.explain.bank import Prepared
from workbench.explain.rivals import Choice, Unknown, smooth_shapes, spread_conditions
from workbench.findings import Estimate, SizePosterior
from workbench.likelihood.bench import Bench, extrapolated, sharpened
from workbench.likelihood.fit import FAR, Fit, Problem, fitted, prior_cost, with_parameters
from workbench.likelihood.linear import Nuisances
from workbench.likelihood.noise import LawError, law_error

REACH = 4.0  # standard deviations to either side over which a posterior is integrated
PLACES = 17
LAW_LENGTH = 1.0  # over which the error of a law changes, of the standard deviation of a condition
LAW_LANDMARKS = 24
# What a fit cannot know: effects too small to be seen, heavy tails, errors of laws. On 89 virtual benches whose truth
# follows other laws (seeds that are never scored) 90 % intervals held the true size in 0.83 of all cases without it, in
# 0.91 with it; the scatter of fitted sizes about the true ones was 1.17 times what the fits said.
WIDENING = 1.2
NORMAL_95 = 1.6449  # two-sided 90 % of a standard normal


@dataclass(frozen=True, eq=False)
class Hypothesis:
    """Effects that are missing, fitted. log_evidence: ln Z of the fitted rows, up to what all hypotheses share."""

    fit: Fit
    problem: Problem
    log_evidence: float

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(effect.name() for effect in self.fit.effects)

    @property
    def effects(self) -> tuple[Effect, ...]:
        return self.fit.at_maximum


def with_law_error(
    bench: Bench, effects: Sequence[Effect], x: np.ndarray, part: Problem | None = None
) -> tuple[Problem, float]:
    """The problem with the declared errors of the effects' own laws integrated out, and half the ln determinant of
    that.

    The change that an effect makes is wrong by a smooth function of the conditions of relative size ``model_error``:
        covariance_ij += (model_error change_i) (model_error change_j) exp(-|x_i - x_j|^2 / (2 LAW_LENGTH^2))
    part: rows; those to fit where it is not given
    """
    problem = bench.fit if part is None else part
    wrong = [effect for effect in effects if effect.model_error > 0]
    if not wrong:
        return problem, 0.0
    base = problem.predictor.predict(x)
    changes = [effect.model_error * (problem.predictor.predict(x, (effect,)) - base) for effect in wrong]
    laws = tuple(_law(problem, number, changes) for number in range(len(problem.stack.channels)))
    return replace(problem, white=replace(problem.white, laws=laws)), sum(law.half_log_det for law in laws)


def _law(problem: Problem, number: int, changes: Sequence[np.ndarray]) -> LawError:
    channel = problem.stack.channels[number]
    shapes = smooth_shapes(spread_conditions(problem.stack.tables[channel.table]), LAW_LENGTH, LAW_LANDMARKS)
    raw = np.zeros((problem.stack.size, shapes.shape[1] * len(changes)))
    raw[channel.rows] = np.hstack([change[channel.rows, None] * shapes for change in changes])
    return law_error(channel.rows, problem.white(raw)[channel.rows])


def single(bench: Bench, prepared: Prepared) -> list[Hypothesis]:
    """Fits of one effect (variant) from the best places of its grid, distinct maxima only, best first.

    Raises:
        WorkbenchError: the model has no answer at any of these places.
    """
    found: list[Hypothesis] = []
    no_answer = None
    for z in prepared.best(bench.residual):
        try:
            hypothesis = _from_start(bench, prepared.signature.effect, z)
        except WorkbenchError as error:  # no steady state at this start; another may have one
            no_answer = error
            continue
        if all(np.max(np.abs(hypothesis.fit.z - have.fit.z)) > 0.3 for have in found):
            found.append(hypothesis)
    if not found and no_answer is not None:
        raise no_answer
    return sorted(found, key=lambda h: h.fit.objective)


def _from_start(bench: Bench, effect: Effect, z: np.ndarray) -> Hypothesis:
    problem, log_det = with_law_error(bench, with_parameters((effect,), z), bench.centre.x)
    return hypothesis_from(problem, log_det, (effect,), bench.centre.x, z)


def exact(hypothesis: Hypothesis) -> Hypothesis:
    """The hypothesis with a base model that is exact at its maximum, where the base model answers by an expansion."""
    problem, fit = sharpened(hypothesis.problem, hypothesis.fit)
    if fit is hypothesis.fit:
        return hypothesis
    gain = fit.log_evidence - hypothesis.fit.log_evidence
    return replace(hypothesis, fit=fit, problem=problem, log_evidence=hypothesis.log_evidence + gain)


def fitted_rows(bench: Bench, hypothesis: Hypothesis) -> Problem:
    """The rows that were fitted, errors of laws left out, answered by the base model of the hypothesis."""
    return replace(bench.fit, predictor=hypothesis.problem.predictor)


def held_out(bench: Bench, hypothesis: Hypothesis) -> Problem:
    """The rows that are held out, answered by the base model of the hypothesis."""
    return replace(bench.held_out, predictor=hypothesis.problem.predictor.on(bench.held_out.stack))


def held_residual(bench: Bench, hypothesis: Hypothesis | None) -> np.ndarray:
    """Whitened residual of the rows that are held out, errors of laws integrated out; None: of the model as it is."""
    if hypothesis is None:
        return bench.held_out.residual(bench.null.x)
    x, effects = hypothesis.fit.x, hypothesis.effects
    part, _ = with_law_error(bench, effects, x, held_out(bench, hypothesis))
    return part.residual(x, effects)


def pair(bench: Bench, first: Hypothesis, second: Effect, z: np.ndarray, alone: Hypothesis | None) -> Hypothesis:
    """The fit of a fitted effect together with another that starts at z; also from the fit of the other alone, where
    there is one: there tolerances are free that stood in for it."""
    starts = [(first.fit.x, z, second)]
    if alone is not None:
        starts.append((alone.fit.x, alone.fit.z, alone.fit.effects[0]))
    return max((_together(bench, first, *start) for start in starts), key=lambda h: h.log_evidence)


def _together(bench: Bench, first: Hypothesis, x: np.ndarray, z: np.ndarray, second: Effect) -> Hypothesis:
    effects = first.fit.effects + (second,)
    place = np.concatenate([first.fit.z, z])
    problem, log_det = with_law_error(bench, with_parameters(effects, place), x)
    return hypothesis_from(problem, log_det, effects, x, place)


def hypothesis_from(problem, log_det, effects, x, z) -> Hypothesis:
    """The fit from one start, and its evidence: by Laplace, for one parameter by integration over it."""
    fit = fitted(problem, effects, x, z)
    evidence = fit.log_evidence if len(z) != 1 else _integrated(problem, fit)[2]
    return Hypothesis(fit, problem, evidence - log_det)


def _integrated(problem: Problem, fit: Fit) -> tuple[np.ndarray, np.ndarray, float]:
    """Places of the one parameter z, ln density there, and ln evidence; the nuisances by Laplace at each place."""
    m = len(fit.x)
    spread = np.sqrt(fit.covariance[m, m])
    places = np.unique(np.clip(fit.z[0] + spread * np.linspace(-REACH, REACH, PLACES), -FAR, FAR))
    drift = fit.covariance[:m, m] / fit.covariance[m, m]
    density = np.array([_profile(problem, fit, fit.x + drift * (z - fit.z[0]), z) for z in places])
    widths = np.gradient(places)
    widths[[0, -1]] *= 0.5
    return places, density, float(logsumexp(density + np.log(widths)) - 0.5 * np.log(2 * np.pi))


def _profile(problem: Problem, fit: Fit, x: np.ndarray, z: float) -> float:
    """ln of prior times likelihood at z with the nuisances integrated out around their best values."""
    slopes = fit.jacobian[:, : len(x)]
    residual = problem.residual(x, with_parameters(fit.effects, np.array([z])))
    weights = problem.weights(residual)
    normal = slopes.T @ (weights[:, None] * slopes) + np.eye(len(x))
    move = np.linalg.solve(normal, slopes.T @ (weights * residual) - x)
    value = problem.misfit(residual - slopes @ move) + 0.5 * float(np.sum((x + move) ** 2)) + prior_cost(z)
    return -value - 0.5 * np.linalg.slogdet(normal)[1]


def estimates(hypothesis: Hypothesis) -> dict[str, dict[str, Estimate]]:
    """Effect -> parameter -> value and 90 % interval."""
    fit, out, place = hypothesis.fit, {}, 0
    for effect in fit.effects:
        found = {}
        for name, parameter in parameters_of(effect).items():
            low, high = (fit.z[place] + WIDENING * (z - fit.z[place]) for z in _interval(hypothesis, place))
            values = [_value(effect, name, z) for z in (fit.z[place], low, high)]
            low90, high90 = max(min(values[1:]), parameter.low), min(max(values[1:]), parameter.high)
            std = (high90 - low90) / (2 * NORMAL_95)
            found[name] = Estimate(values[0], float(std), float(low90), float(high90), parameter.unit)
            place += 1
        out[effect.name()] = found
    return out


def _value(effect: Effect, name: str, z: float) -> float:
    from math import inf

    p = parameters_of(effect)[name]
    return float(np.clip(p.prior.value(float(np.clip(z, -FAR, FAR))), max(p.low, -inf), min(p.high, inf)))


def _interval(hypothesis: Hypothesis, place: int) -> tuple[float, float]:
    """5 % and 95 % points of z."""
    fit = hypothesis.fit
    if len(fit.z) == 1:
        places, density, _ = _integrated(hypothesis.problem, fit)
        fine = np.linspace(places[0], places[-1], 801)
        mass = np.cumsum(np.exp(np.interp(fine, places, density) - density.max()))
        return tuple(np.interp([0.05, 0.95], mass / mass[-1], fine))
    spread = np.sqrt(fit.covariance[len(fit.x) + place, len(fit.x) + place])
    return fit.z[place] - NORMAL_95 * spread, fit.z[place] + NORMAL_95 * spread


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


@dataclass(frozen=True, eq=False)
class Rival:
    """The unknown function beside a fit (the null or an effect).

    whitened, raw: its mean, whitened and in units of the uncertainty, on the rows to fit (n,)
    explained: expected change of the whitened residuals of the fit, by it and by the parameters that move with it (n,)
    """

    log_evidence: float
    whitened: np.ndarray
    raw: np.ndarray
    explained: np.ndarray


def rival(problem: Problem, fit: Fit, unknown: Unknown) -> Rival:
    """The unknown function beside a fit: the prior of it that suits best by linear algebra, then a fit with that one.

    ln Z = ln Z of the refit with the unknown function integrated out + ln of the share that this prior has of the sum
    """
    nuisances, residual = Nuisances(fit.jacobian), extrapolated(fit)
    gains = unknown.log_evidences(nuisances, residual[:, None])[:, 0]
    best = int(np.argmax(gains))
    choice = unknown.choices[best]
    free, half_log_det = with_unknown(problem, unknown, choice)
    refit = fitted(free, fit.effects, fit.x, fit.z)
    others = float(logsumexp(gains)) - gains[best] + choice.log_prior
    whitened, raw, shift = unknown.mean(nuisances, residual, choice)
    explained = whitened + fit.jacobian @ (shift - np.concatenate([fit.x, fit.z]))
    return Rival(refit.log_evidence - half_log_det + others, whitened, raw, explained)


def with_unknown(problem: Problem, unknown: Unknown, choice: Choice) -> tuple[Problem, float]:
    """The problem with an unknown function integrated out, and half the ln determinant of all that is so."""
    laws = []
    for c, length in choice.parts:
        shapes = unknown.shapes[c][length]
        raw = np.zeros((problem.stack.size, shapes.raw.shape[1]))
        raw[shapes.rows] = choice.amplitude * shapes.raw * problem.stack.u[shapes.rows, None]
        laws.append(law_error(shapes.rows, problem.white(raw)[shapes.rows]))
    white = replace(problem.white, laws=problem.white.laws + tuple(laws))
    return replace(problem, white=white), sum(law.half_log_det for law in white.laws)
