"""Most probable nuisances and effect parameters, and the evidence around them.

    minus ln posterior = sum over channels (nu + n)/2 ln(1 + q/nu) + x^T x / 2 + sum over z (t + 1)/2 ln(1 + z^2/t)
    q: sum of squares of the whitened residuals of a channel;  nu: degrees of freedom of its measured noise

The first is Student's t for a noise whose size was measured by repeats: the Gaussian with its size integrated out.
The last is Student's t for the size of an effect, whose prior is only a guess of its magnitude. Beyond what is
possible of a parameter there is nothing: where data ask for more, the evidence is that of the possible side alone.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cache, cached_property

import numpy as np
from scipy.special import gammaln, log_ndtr

from effects.base import Effect
from effects.parameter import parameters_of
from workbench.believed import TAILS
from workbench.data.stack import Stack
from workbench.errors import WorkbenchError
from workbench.likelihood.predictor import STEP, Predictor, jacobian, one_sided
from workbench.likelihood.whitening import Whitener

ITERATIONS = 15
CLOSE = 1e-4  # change of the objective [nats] at which a fit is done
ROUND_CLOSE = 1e-2  # change of the objective [nats] that new slopes may still bring when it is
BEHIND = 30.0  # nats behind what leads, from which on a fit may be less exact,
INEXACT = 0.005  # by this share of what it lies further behind
LENGTHS = (1.0, 0.5, 0.2, 0.05)  # of a bent step that are tried where a straight one is too long
DAMPINGS = (1.0, 30.0)
ALONG = 0.1  # of a step, over which its bend is taken by differences
NEAR = 0.1  # move of an effect's standard normal number, up to which its slopes are taken for those a step before
POOR = 0.25  # of what a step promises, below which its slopes are not those of the place
ROUNDS = 4  # times the slopes of the nuisances are taken anew
FAR = 20.0  # a standard normal number is not followed beyond
# ln of Student's t density at zero over the standard normal one there
LEVEL = float(gammaln((TAILS + 1) / 2) - gammaln(TAILS / 2) - np.log(TAILS / 2) / 2)


def prior_cost(z: np.ndarray) -> float:
    """Minus ln of Student's t density of z over the standard normal one at zero."""
    return float(np.sum(0.5 * (TAILS + 1) * np.log1p(np.square(z) / TAILS) - LEVEL))


def prior_weight(z: np.ndarray) -> np.ndarray:
    """Slope of the prior cost over z, its curvature for a Gauss-Newton step."""
    return (TAILS + 1) / (TAILS + np.square(z))


@dataclass(frozen=True, eq=False)
class Problem:
    """Readings, their noise and the predictor for one set of rows.

    start: x of the nominal device (m,);  lead: objective of the best fit so far, infinite where there is none
    """

    predictor: Predictor
    stack: Stack
    white: Whitener
    dof: np.ndarray
    start: np.ndarray
    lead: float = np.inf

    def close(self, objective: float) -> float:
        """Change that new slopes may still bring when a fit is done at an objective [nats]."""
        return max(ROUND_CLOSE, INEXACT * (objective - self.lead - BEHIND))

    def residual(self, x: np.ndarray, effects: Sequence[Effect] = ()) -> np.ndarray:
        """Whitened reading minus prediction (n,)."""
        return self.white(self.stack.y - self.predictor.predict(x, effects))

    def squares(self, residual: np.ndarray) -> np.ndarray:
        """q of every channel (channels,)."""
        return self.stack.by_channel(residual**2)

    def misfit(self, residual: np.ndarray) -> float:
        """Minus ln likelihood, up to what all hypotheses share."""
        return misfit(self.squares(residual), self.dof, self.stack.sizes)

    def channel_weights(self, residual: np.ndarray) -> np.ndarray:
        """Slope of the misfit to q/2 of every channel (channels,)."""
        return (self.dof + self.stack.sizes) / (self.dof + self.squares(residual))

    def weights(self, residual: np.ndarray) -> np.ndarray:
        """The same of the channel of every row (n,)."""
        return np.repeat(self.channel_weights(residual), self.stack.sizes)


def misfit(squares: np.ndarray, dof: np.ndarray, sizes: np.ndarray) -> float:
    """Sum over channels of (nu + n)/2 ln(1 + q/nu)."""
    return float(np.sum(0.5 * (dof + sizes) * np.log1p(squares / dof)))


def possible(effects: Sequence[Effect]) -> tuple[np.ndarray, np.ndarray]:
    """Least and greatest z of all parameters, one after the other (k,), so far as they are followed."""
    ends = [_possible(type(effect)) for effect in effects]
    low, high = (np.array([z for one in ends for z in one[side]]) for side in (0, 1))
    return low, high


@cache
def _possible(effect: type[Effect]) -> tuple[list[float], list[float]]:
    parameters = parameters_of(effect).values()
    low, high = [p.prior.standard(p.low) for p in parameters], [p.prior.standard(p.high) for p in parameters]
    return np.clip(low, -FAR, FAR).tolist(), np.clip(high, -FAR, FAR).tolist()


@dataclass(frozen=True, eq=False)
class Fit:
    """Of some effects (none: the null).

    x, z: nuisances and effect parameters at the maximum;  residual: whitened (n,);  jacobian: whitened, of x then z
    slopes: d readings / d x, SI (n, m)
    objective: minus ln posterior;  log_evidence: by Laplace;  covariance: of x then z
    """

    effects: tuple[Effect, ...]
    x: np.ndarray
    z: np.ndarray
    residual: np.ndarray
    jacobian: np.ndarray
    slopes: np.ndarray
    objective: float
    log_evidence: float
    covariance: np.ndarray

    @property
    def at_maximum(self) -> tuple[Effect, ...]:
        return with_parameters(self.effects, self.z)


def with_parameters(effects: Sequence[Effect], z: np.ndarray) -> tuple[Effect, ...]:
    """The effects at their parameters, z one after the other."""
    out, place = [], 0
    for effect in effects:
        size = len(parameters_of(effect))
        out.append(effect.at(z[place : place + size]))
        place += size
    return tuple(out)


def fitted(
    problem: Problem, effects: Sequence[Effect], x: np.ndarray, z: np.ndarray, slopes: np.ndarray | None = None
) -> Fit:
    """The fit from one start by damped Gauss-Newton.

    slopes: d readings / d x (n, m) of a fit near the start, used until the last steps; without them they are taken at
    the start
    """
    search = _Search(problem, tuple(effects), len(x))
    p = np.concatenate([x, z])
    p, *_ = search.descend(p, search.nuisance_slopes(x, z) if slopes is None else slopes, ROUND_CLOSE)
    return _with_new_slopes(search, p)


def refitted(problem: Problem, fit: Fit) -> Fit:
    """The fit again where the problem is another one, from where it ended, with its slopes if that changes little."""
    search = _Search(problem, fit.effects, len(fit.x))
    p, gain, value = search.descend(np.concatenate([fit.x, fit.z]), fit.slopes)
    return search.result(p, fit.slopes) if gain < problem.close(value) else _with_new_slopes(search, p)


def promised(problem: Problem, fit: Fit) -> float:
    """What a fit of the same effects is promised to gain by straight lines where the problem is another one [nats].

    Raises:
        WorkbenchError: the model has no answer there.
    """
    residual = problem.residual(fit.x, fit.at_maximum)
    step = fit.covariance @ (fit.jacobian.T @ (problem.weights(fit.residual) * (residual - fit.residual)))
    x, z = np.split(step, [len(fit.x)])
    value = problem.misfit(residual - fit.jacobian @ step)
    return fit.objective - value - 0.5 * float(np.sum((fit.x + x) ** 2)) - prior_cost(fit.z + z)


def _with_new_slopes(search: _Search, p: np.ndarray) -> Fit:
    """The fit from p on, its slopes taken anew until that gains no more: each time by the same share of what the time
    before did; of one that lies far behind what leads, nothing that matters."""
    gain = 0.0
    for _ in range(ROUNDS):
        slopes, before = search.nuisance_slopes(p[: search.m], p[search.m :]), gain
        p, gain, value = search.descend(p, slopes)
        if gain * min(gain / max(before, CLOSE), 1.0) < search.problem.close(value):
            break
    return search.result(p, slopes)


def linearised(problem: Problem, x: np.ndarray, effects: Sequence[Effect] = (), z: Sequence[float] = ()) -> Fit:
    """What a fit of effects would be if it ended at nuisances x (m,) and parameters z (k,)."""
    search = _Search(problem, tuple(effects), len(x))
    z = np.asarray(z, dtype=float)
    return search.result(np.concatenate([x, z]), search.nuisance_slopes(x, z))


@dataclass(frozen=True, eq=False)
class _Line:
    """The model as a line about a place of a descent.

    p: the place (m + k,);  residual: whitened there (n,);  slopes: d f / d p, whitened (n, m + k)
    weights: of the rows (n,);  prior: curvature of the prior (m + k,)
    low, high: ends of what is possible (m + k,), infinite where none are
    """

    p: np.ndarray
    residual: np.ndarray
    slopes: np.ndarray
    weights: np.ndarray
    prior: np.ndarray
    low: np.ndarray
    high: np.ndarray

    @cached_property
    def normal(self) -> np.ndarray:
        """Curvature of the objective as Gauss and Newton have it."""
        return self.slopes.T @ (self.weights[:, None] * self.slopes) + np.diag(self.prior)

    @cached_property
    def downhill(self) -> np.ndarray:
        """Minus the gradient of the objective."""
        return self.slopes.T @ (self.weights * self.residual) - self.prior * self.p

    @cached_property
    def held(self) -> np.ndarray:
        """Where the data ask for more than is possible (m + k,)."""
        return np.where(self.downhill > 0, self.p >= self.high, self.p <= self.low)

    def solved(self, ahead: np.ndarray, damping: float = 0.0) -> np.ndarray:
        """The step that a slope of the objective asks for (m + k,), what is held left where it is."""
        free = ~self.held
        normal = np.where(free[:, None] & free, self.normal, 0.0) + np.diag(self.held + damping * np.diag(self.normal))
        return np.linalg.solve(normal, np.where(free, ahead, 0.0))

    @cached_property
    def straight(self) -> np.ndarray:
        """The step of Gauss and Newton."""
        return self.solved(self.downhill)

    @property
    def promised(self) -> float:
        """What it promises [nats]."""
        return 0.5 * float(self.downhill @ self.straight)


@dataclass
class _Search:
    problem: Problem
    effects: tuple[Effect, ...]
    m: int
    memory: dict = field(default_factory=dict)

    @cached_property
    def possible(self) -> tuple[np.ndarray, np.ndarray]:
        """Least and greatest x, which has no ends, and z (m + k,)."""
        low, high = possible(self.effects)
        return np.append(np.full(self.m, -np.inf), low), np.append(np.full(self.m, np.inf), high)

    def predict(self, p: np.ndarray) -> np.ndarray:
        key = p.tobytes()
        if key not in self.memory:
            effects = with_parameters(self.effects, p[self.m :])
            self.memory[key] = self.problem.predictor.predict(p[: self.m], effects)
        return self.memory[key]

    def residual(self, p: np.ndarray) -> np.ndarray:
        return self.problem.white(self.problem.stack.y - self.predict(p))

    def objective(self, p: np.ndarray, residual: np.ndarray) -> float:
        x, z = p[: self.m], p[self.m :]
        return self.problem.misfit(residual) + 0.5 * float(x @ x) + prior_cost(z)

    def prior_curvature(self, p: np.ndarray) -> np.ndarray:
        return np.concatenate([np.ones(self.m), prior_weight(p[self.m :])])

    def nuisance_slopes(self, x: np.ndarray, z: np.ndarray) -> np.ndarray:
        effects = with_parameters(self.effects, z)
        return jacobian(self.problem.predictor, x, effects, self.predict(np.concatenate([x, z])))

    def effect_slopes(self, p: np.ndarray) -> np.ndarray:
        slopes = np.empty((self.problem.stack.size, len(p) - self.m))
        for k in range(self.m, len(p)):
            inward = STEP if p[k] < 0 else -STEP  # towards the centre: never over a bound for nothing
            slopes[:, k - self.m] = one_sided(self.predict, p, k, inward, self.predict(p))
        return self.problem.white(slopes)

    def descend(
        self, p: np.ndarray, nuisance_slopes: np.ndarray, close: float = CLOSE
    ) -> tuple[np.ndarray, float, float]:
        """Where a step with these slopes promises or gains less than ``close`` [nats], or little of what it promises;
        what the objective gains by all of them, and what it is there [nats]. The slopes by the effects are taken anew
        where these have moved, and before a step is believed to be the last."""
        p = np.clip(p, *self.possible)
        nuisance_slopes, residual = self.problem.white(nuisance_slopes), self.residual(p)
        first = value = self.objective(p, residual)
        taken_at, is_last = p, True
        for _ in range(ITERATIONS):
            is_new = is_last or self._is_far(p, taken_at)
            if is_new:
                taken_at, slopes = p, np.hstack([nuisance_slopes, self.effect_slopes(p)])
            line = self._line(p, residual, slopes)
            gain = line.promised
            if line.promised >= close:
                p, residual, new = self._step(line, value)
                value, gain = new, value - new
            is_last = gain < max(close, POOR * line.promised)
            if is_last and is_new:
                break
        return p, first - value, value

    def _is_far(self, p: np.ndarray, other: np.ndarray) -> bool:
        return bool(np.any(np.abs(p - other)[self.m :] > NEAR))

    def _line(self, p: np.ndarray, residual: np.ndarray, slopes: np.ndarray) -> _Line:
        return _Line(p, residual, slopes, self.problem.weights(residual), self.prior_curvature(p), *self.possible)

    def _step(self, line: _Line, value: float) -> tuple[np.ndarray, np.ndarray, float]:
        """Gauss-Newton, the step shortened and bent until the objective falls: that stays on a ridge between an effect
        and a tolerance; then damped. The place, the residual and the objective there."""
        for move in self._moves(line):
            trial = np.clip(line.p + move, *self.possible)
            try:
                residual = self.residual(trial)
            except WorkbenchError:  # no steady state there: as bad as can be
                continue
            new = self.objective(trial, residual)
            if new < value:
                return trial, residual, new
        return line.p, line.residual, value

    def _moves(self, line: _Line) -> Iterator[np.ndarray]:
        """Steps to be tried one after the other, each worked out when it is asked for. Next to nothing is not worth
        shorter ones: together they gained a tenth of a nat in all fits of a hard search, for a fifth of its trials."""
        yield line.straight
        if line.promised < ROUND_CLOSE:
            return
        bend = self._bend(line)
        for length in LENGTHS:
            yield length * line.straight + length**2 * bend
        for damping in DAMPINGS:
            yield line.solved(line.downhill, damping)

    def _bend(self, line: _Line) -> np.ndarray:
        """By which a step leaves its line to follow the ridge, at its whole length (m + k,): the geodesic acceleration
        of Transtrum and Sethna (2012), "Improvements to the Levenberg-Marquardt algorithm for nonlinear least-squares
        minimization"; none where the model has no answer to either side.

        -1/2 (J^T W J + P)^-1 J^T W f'',  f'' = d^2 f / dt^2 along p + t straight
        """
        try:
            ahead, behind = (self.residual(line.p + side * ALONG * line.straight) for side in (1.0, -1.0))
        except WorkbenchError:
            return np.zeros(len(line.p))
        curved = (ahead - 2 * line.residual + behind) / ALONG**2  # of the residual: minus that of the model
        return 0.5 * line.solved(line.slopes.T @ (line.weights * curved))

    def result(self, p: np.ndarray, nuisance_slopes: np.ndarray) -> Fit:
        residual = self.residual(p)
        slopes = np.hstack([self.problem.white(nuisance_slopes), self.effect_slopes(p)])
        line, value = self._line(p, residual, slopes), self.objective(p, residual)
        x, z, covariance = p[: self.m], p[self.m :], np.linalg.inv(line.normal)
        evidence = -value - 0.5 * np.linalg.slogdet(line.normal)[1] + _log_possible(line, np.sqrt(np.diag(covariance)))
        return Fit(self.effects, x, z, residual, slopes, nuisance_slopes, value, float(evidence), covariance)


def _log_possible(line: _Line, spread: np.ndarray) -> float:
    """ln of the share of the bell about a fit that is possible; for each parameter, with the slope a where it is held,

        integral from low to high of exp(a t - t^2/2) dt / sqrt(2 pi) = exp(a^2/2) (Phi(high - a) - Phi(low - a))

    spread: standard deviations (m + k,), in which low, high and 1/a are measured from the fit
    """
    ends = np.isfinite(line.high)
    slope = np.where(line.held, line.downhill * spread, 0.0)[ends]
    low, high = ((end[ends] - line.p[ends]) / spread[ends] for end in (line.low, line.high))
    up = slope >= 0  # the larger of both integrals to the left of the ends, by symmetry
    left, right = np.where(up, low, -high), np.where(up, high, -low)
    slope = np.abs(slope)
    shares = log_ndtr(right - slope) + np.log1p(-np.exp(log_ndtr(left - slope) - log_ndtr(right - slope)))
    return float(np.sum(shares + slope**2 / 2))
