"""A device as it is known from elsewhere, applied to new readings: nothing of it is fitted again.

    reading = f(p, c) + e,   p ~ N(p_file, covariance of the file),   c ~ N(0, 1) calibrations of the new instruments

Only c moves, to its most probable value with p where it is. With derivatives A over p (in its standard deviations) and
B over c, both over the noise, that is linear in the readings:

    c = K (r + B c_0),   K = (1 + B^T B)^-1 B^T

so that a prediction errs by (A - B K A) p from what is not known exactly, by B (1 + B^T B)^-1 B^T from the calibration,
by what the laws of its effects may be wrong by, by what was left unexplained where it was learned, and the reading by
its noise. What an error of p does that a calibration can do as well is taken up by the calibration.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.linalg import block_diag

from effects.base import Effect
from effects.parameter import parameters_of
from workbench.data.stack import Stack, part_of, rows_in, stacked
from workbench.data.table import Table
from workbench.ledger.learned import FittedInput, Learned, LearnedRange
from workbench.likelihood.conditions import readings, with_conditions
from workbench.likelihood.noise import Noise, measured_noise
from workbench.likelihood.nuisance import Calibration
from workbench.likelihood.own_errors import errors_of_laws, left_open_by_base, numerical
from workbench.likelihood.predictor import STEP
from workbench.likelihood.whitening import Whitener, variance_of_readings, whitener
from workbench.models.model import Model

ROUNDS = 6  # of finding the calibrations; gains and offsets act almost linearly, two or three are needed
SETTLED = 0.01  # standard deviations by which a calibration still moves


@dataclass(frozen=True, eq=False)
class Known:
    """nominal: the device as drawn, without effects, its base ready for the rows that are asked

    inputs, effects: as known;  weights: of the shapes of the model's own numerical error
    covariance: of shifts of inputs, parameters of effects (k of them together), then weights, SI (k + L, k + L)
    ranges: where it was learned, with what was left unexplained there
    """

    nominal: Model
    inputs: tuple[FittedInput, ...]
    effects: tuple[Effect, ...]
    weights: np.ndarray
    covariance: np.ndarray
    ranges: tuple[LearnedRange, ...] = ()

    @property
    def size(self) -> int:
        """Numbers that the model is made of, k."""
        return len(self.inputs) + sum(len(parameters_of(effect)) for effect in self.effects)

    def model_at(self, step: np.ndarray) -> Model:
        """The model with inputs and parameters of effects moved by a step from what is known, SI (k,)."""
        design = self.nominal.design
        for x, move in zip(self.inputs, step):
            z = (x.shift + move) / x.tolerance.sigma
            design = self.nominal.base.with_tolerance(design, x.tolerance, z) if z else design
        return replace(self.nominal, design=design, effects=self._moved(step[len(self.inputs) :]))

    def _moved(self, step: np.ndarray) -> tuple[Effect, ...]:
        moved, place = [], 0
        for effect in self.effects:
            names = list(parameters_of(effect))
            values = {name: getattr(effect, name) + step[place + k] for k, name in enumerate(names)}
            moved.append(replace(effect, **values) if any(step[place : place + len(names)]) else effect)
            place += len(names)
        return tuple(moved)

    @cached_property
    def steps(self) -> np.ndarray:
        """A small step of each number, on the side that its bounds allow, SI (k,)."""
        steps = STEP * np.sqrt(np.diag(self.covariance)[: self.size])
        bounds = [(getattr(e, n), p) for e in self.effects for n, p in parameters_of(e).items()]
        for k, (value, p) in enumerate(bounds, len(self.inputs)):
            steps[k] *= 1.0 if value + steps[k] <= p.high else -1.0
        return steps

    def with_weights(self, count: int) -> Known:
        """The same with at least so many weights, those that nothing is known of as uncertain as before anything."""
        new = max(count - len(self.weights), 0)
        covariance = block_diag(self.covariance, np.eye(new)) if new else self.covariance
        return replace(self, weights=np.append(self.weights, np.zeros(new)), covariance=covariance)

    def unexplained(self, kind: str, response: str) -> float:
        """Rms residual beyond the noise to expect of a response, SI: what was left where it was learned; for a kind
        that was not, the most of all kinds with that response."""
        same = [r for r in self.ranges if r.response == response]
        return max((r.unexplained for r in [r for r in same if r.kind == kind] or same), default=0.0)

    def exact(self) -> Known:
        """The same with a base that is exact at this device, for one that answers by an expansion."""
        if not self.nominal.base.is_expansion:
            return self
        design = self.model_at(np.zeros(self.size)).design_as_built
        return replace(self, nominal=replace(self.nominal, base=self.nominal.base.recentred(design)))


def corrected(learned: Learned, nominal: Model) -> Known:
    """The device with all that a model file knows of it."""
    own = np.r_[: len(learned.inputs), len(learned.inputs) + len(learned.calibrations) : len(learned.names)]
    covariance = learned.covariance[np.ix_(own, own)]
    ranges = learned.source.ranges if learned.source else ()
    return Known(nominal, learned.inputs, learned.effects, np.array(learned.weights), covariance, ranges)


def as_drawn(learned: Learned, nominal: Model) -> Known:
    """The device as drawn: inputs at their nominal values, as uncertain as they were declared, no effects."""
    inputs = tuple(replace(x, shift=0.0) for x in learned.inputs)
    return Known(nominal, inputs, (), np.zeros(0), np.diag([x.tolerance.sigma**2 for x in inputs]))


@dataclass(frozen=True, eq=False)
class Prediction:
    """Of every row of a stack; NaN where the model has no steady state (n,).

    reading: most probable;  sd: standard deviation of reading minus prediction;  whitened: residual over its noise, of
    size and correlation as measured from repeats
    calibration: of the new instruments, standard normal numbers (m,)
    """

    stack: Stack
    reading: np.ndarray
    sd: np.ndarray
    whitened: np.ndarray
    calibration: np.ndarray

    def on(self, stack: Stack, kept: np.ndarray) -> Prediction:
        """The same for a stack of which only some rows were predicted (n,)."""
        reading, sd, whitened = (_filled(kept, values) for values in (self.reading, self.sd, self.whitened))
        return Prediction(stack, reading, sd, whitened, self.calibration)


def predicted(known: Known, calibrations: Sequence[Calibration], tables: Sequence[Table]) -> Prediction:
    """What a known device should show in some tables, the instruments' own calibration found from them."""
    stack, c = stacked(tables), np.zeros(len(calibrations))
    shapes = numerical(known.nominal, stack)
    asked = _Asked(known.with_weights(shapes.shape[1]), tuple(calibrations))
    masks = _whole_rows(stack, np.isfinite(readings(asked.model_at(np.zeros(known.size), c), stack)))
    part = part_of(stack, masks)
    around = asked.around(part, c)
    for _ in range(ROUNDS):
        c, before = around.calibrated(c), c
        around = asked.around(part, c)
        if np.abs(c - before).max(initial=0.0) < SETTLED:
            break
    return around.prediction(c).on(stack, rows_in(stack, masks))


def _whole_rows(stack: Stack, answered: np.ndarray) -> list[np.ndarray]:
    """Mask of the rows of each table in which all channels have an answer."""
    masks = [np.ones(table.rows, dtype=bool) for table in stack.tables]
    for channel in stack.channels:
        masks[channel.table] &= answered[channel.rows]
    return masks


def _filled(kept: np.ndarray, values: np.ndarray) -> np.ndarray:
    whole = np.full(len(kept), np.nan)
    whole[kept] = values
    return whole


@dataclass(frozen=True)
class _Asked:
    """A known device at the new instruments."""

    known: Known
    calibrations: tuple[Calibration, ...]

    def model_at(self, step: np.ndarray, c: np.ndarray) -> Model:
        model = self.known.model_at(step)
        errors = (nuisance.at(z) for nuisance, z in zip(self.calibrations, c.tolist()))
        return replace(model, effects=(*model.effects, *errors))

    def around(self, stack: Stack, c: np.ndarray) -> _Around:
        """The prediction at some calibration, with its derivatives."""
        none, shapes = np.zeros(self.known.size), self._shapes(stack)
        base = readings(self.model_at(none, c), stack)
        at_p = lambda move: readings(self.model_at(move, c), stack)  # noqa: E731
        at_c = lambda move: readings(self.model_at(none, c + move), stack)  # noqa: E731
        over_p = [_slope(at_p, base, direction, s) for direction, s in zip(np.eye(len(none)), self.known.steps)]
        over_c = [_slope(at_c, base, direction, STEP) for direction in np.eye(len(c))]
        u = with_conditions(self.model_at(none, c), stack, base)
        p = np.column_stack([*over_p, shapes]) @ _root(self.known.covariance)
        left = [self.known.unexplained(stack.tables[c.table].kind, c.response) for c in stack.channels]
        laws = errors_of_laws(self.known.model_at(none), stack)
        unexplained = np.sqrt(sum(np.square([np.repeat(left, [c.size for c in stack.channels]), *laws])))
        columns = np.column_stack([p, *over_c])
        stack = replace(stack, u=u, left_open=left_open_by_base(self.known.nominal, stack))
        return _Around(stack, base + shapes @ self.known.weights, columns, len(c), unexplained)

    def _shapes(self, stack: Stack) -> np.ndarray:
        found = numerical(self.known.nominal, stack)
        return np.column_stack([found, np.zeros((stack.size, len(self.known.weights) - found.shape[1]))])


@dataclass(frozen=True, eq=False)
class _Around:
    """Prediction at some calibration and its derivatives over standard normal numbers: those of what is known, its
    numerical error among them, then the m calibrations.

    unexplained: what was left where it was learned, and what laws of its effects may be wrong by, SI (n,)
    """

    stack: Stack
    base: np.ndarray
    columns: np.ndarray
    m: int
    unexplained: np.ndarray

    @cached_property
    def answered(self) -> np.ndarray:
        """True where the model has an answer, there and a small step away (n,)."""
        return np.isfinite(self.base) & np.isfinite(self.columns).all(axis=1) & np.isfinite(self.stack.u)

    @cached_property
    def rows(self) -> list[np.ndarray]:
        """Mask of the rows of each table that are used."""
        return _whole_rows(self.stack, self.answered)

    @cached_property
    def kept(self) -> np.ndarray:
        return rows_in(self.stack, self.rows)

    @cached_property
    def part(self) -> Stack:
        return part_of(self.stack, self.rows)

    @cached_property
    def noise(self) -> Noise:
        return measured_noise(self.part, self.base[self.kept])

    @cached_property
    def white(self) -> Whitener:
        return whitener(self.part, self.noise)

    @cached_property
    def residual(self) -> np.ndarray:
        return self.part.y - self.base[self.kept]

    @cached_property
    def split(self) -> tuple[np.ndarray, np.ndarray]:
        """A of what is known (n, k) and B of the calibrations (n, m)."""
        columns = self.columns[self.kept]
        return columns[:, : columns.shape[1] - self.m], columns[:, columns.shape[1] - self.m :]

    @cached_property
    def posterior(self) -> np.ndarray:
        """Covariance of the calibrations given the readings (m, m)."""
        over_c = self.white(self.split[1])
        return np.linalg.inv(np.eye(self.m) + over_c.T @ over_c)

    def calibrated(self, c: np.ndarray) -> np.ndarray:
        """The most probable calibrations; c: where the derivatives were taken (m,)."""
        over_c = self.white(self.split[1])
        return self.posterior @ over_c.T @ (self.white(self.residual) + over_c @ c)

    def prediction(self, c: np.ndarray) -> Prediction:
        over_p, over_c = self.split
        taken_up = self.posterior @ self.white(over_c).T @ self.white(over_p)
        left = over_p - over_c @ taken_up
        of_calibration = ((over_c @ self.posterior) * over_c).sum(axis=1)
        of_readings = variance_of_readings(self.part, self.white, self.noise.channels)
        variance = (left**2).sum(axis=1) + of_calibration + self.unexplained[self.kept] ** 2 + of_readings
        whole = Prediction(self.part, self.base[self.kept], np.sqrt(variance), self.white(self.residual), c)
        return whole.on(self.stack, self.kept)


def _root(covariance: np.ndarray) -> np.ndarray:
    """R of covariance = R R^T, also where it is singular (k, k)."""
    variance, vectors = np.linalg.eigh(covariance / _outer(covariance))
    sd = np.sqrt(np.diag(_outer(covariance)))
    return sd[:, None] * vectors * np.sqrt(np.maximum(variance, 0.0))


def _outer(covariance: np.ndarray) -> np.ndarray:
    """Products of standard deviations, 1 where there is none: SI numbers differ by many powers of ten."""
    sd = np.sqrt(np.diag(covariance))
    sd = np.where(sd > 0, sd, 1.0)
    return np.outer(sd, sd)


def _slope(at: Callable[[np.ndarray], np.ndarray], base: np.ndarray, direction: np.ndarray, step: float) -> np.ndarray:
    """d readings / d number by a step to one side, to the other where there is no answer; zero for a step of zero."""
    if step == 0.0:
        return np.zeros_like(base)
    slope = (at(step * direction) - base) / step
    missing = ~np.isfinite(slope)
    if missing.any():
        slope[missing] = ((base - at(-step * direction)) / step)[missing]
    return slope
