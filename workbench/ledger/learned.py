"""What a campaign taught about a device: effects, fitted inputs, their joint covariance, and where it was learned."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from effects.base import Effect
from effects.parameter import Parameter, parameters_of
from workbench.data.table import Systematic, Table, Tolerance
from workbench.likelihood.bench import Bench
from workbench.likelihood.nuisance import TolerancedInput
from workbench.likelihood.regions import SAME_SETTING, ZERO_CELSIUS
from workbench.likelihood.whitening import variance_of_readings

TURN = 2 * np.pi
SLOPE_STEP = 1e-4  # of a standard normal number, for the slope of a parameter over it


@dataclass(frozen=True)
class FittedInput:
    """An input of the model where the fit left it.

    shift: from the drawing, relative to the nominal value or SI, as the sigma of the tolerance
    """

    tolerance: Tolerance
    shift: float

    @property
    def name(self) -> str:
        return self.tolerance.name


@dataclass(frozen=True)
class FittedCalibration:
    """Error of an instrument of the campaign; relative for a gain, SI for an offset. Other data have their own."""

    systematic: Systematic
    shift: float

    @property
    def name(self) -> str:
        return self.systematic.name


@dataclass(frozen=True, eq=False)
class LearnedRange:
    """Where a channel was fitted.

    conditions: name -> low, high of the fitted rows, SI; the high end of an angle may lie beyond a full turn
    rows, chi2_per_n: of the fit there;  unexplained: rms residual beyond the noise that the fit left there, SI
    """

    kind: str
    response: str
    rows: int
    chi2_per_n: float
    unexplained: float
    conditions: Mapping[str, tuple[float, float]]


@dataclass(frozen=True, eq=False)
class Source:
    """The campaign that a model file is from. data_sha256: file -> hash;  ranges: one a kind and response"""

    campaign: str
    device_sha256: str
    data_sha256: Mapping[str, str]
    ranges: tuple[LearnedRange, ...]


@dataclass(frozen=True, eq=False)
class Learned:
    """All that a model file holds.

    base: name of the base model;  device: the ``[device]`` table, empty in files of before it was kept
    weights: of the shapes of the base model's own numerical error, standard normal numbers
    names, covariance: of shifts of inputs, of calibrations, of parameters of effects and of weights, in this order, SI
    (k,), (k, k)
    source: None in files of before inputs were kept, as is the covariance
    """

    base: str
    device: Mapping[str, object]
    effects: tuple[Effect, ...]
    inputs: tuple[FittedInput, ...] = ()
    calibrations: tuple[FittedCalibration, ...] = ()
    weights: tuple[float, ...] = ()
    covariance: np.ndarray = field(default_factory=lambda: np.zeros((0, 0)))
    source: Source | None = None

    @property
    def names(self) -> tuple[str, ...]:
        """Of the rows of the covariance."""
        parameters = (f"{e.name()}.{p}" for e in self.effects for p in parameters_of(e))
        errors = (f"numerical_error_{k}" for k in range(len(self.weights)))
        return (*(x.name for x in (*self.inputs, *self.calibrations)), *parameters, *errors)


def learned_from(bench: Bench) -> Learned:
    """What the fit of a bench says about its device."""
    predictor, fit, campaign = bench.fit.predictor, bench.null, bench.campaign
    declared = list(zip(predictor.nuisances, map(float, fit.x)))
    inputs = [FittedInput(n.tolerance, n.tolerance.sigma * z) for n, z in declared if isinstance(n, TolerancedInput)]
    errors = [(n.systematic, z) for n, z in declared if not isinstance(n, TolerancedInput)]
    return Learned(
        base=bench.model.base.name,
        device=dict(campaign.device),
        effects=tuple(predictor.model_at(fit.x).effects[: len(predictor.model.effects)]),
        inputs=tuple(inputs),
        calibrations=tuple(FittedCalibration(systematic, systematic.sigma * z) for systematic, z in errors),
        weights=tuple(map(float, fit.x[len(fit.x) - predictor.weights :])),
        covariance=_covariance(bench),
        source=Source(campaign.id, device_hash(campaign.device), dict(campaign.file_hashes), ranges_of(bench)),
    )


def _covariance(bench: Bench) -> np.ndarray:
    """Of inputs, calibrations, parameters of effects and weights, as they stand in x, SI."""
    predictor, fit = bench.fit.predictor, bench.null
    declared = [
        n.tolerance.sigma if isinstance(n, TolerancedInput) else n.systematic.sigma for n in predictor.nuisances
    ]
    effects = predictor.model_at(fit.x).effects[: len(predictor.model.effects)]
    scale = np.array([*declared, *slopes(effects), *np.ones(predictor.weights)])
    return fit.covariance * np.outer(scale, scale)


def slopes(effects: Sequence[Effect]) -> list[float]:
    """d parameter / d standard normal number of all parameters of some effects, SI."""
    return [_slope(p, getattr(effect, name)) for effect in effects for name, p in parameters_of(effect).items()]


def _slope(p: Parameter, value: float) -> float:
    z = p.prior.standard(value)
    return (p.prior.value(z + SLOPE_STEP) - p.prior.value(z - SLOPE_STEP)) / (2 * SLOPE_STEP)


def device_hash(device: Mapping[str, object]) -> str:
    """SHA-256 of a ``[device]`` table, whatever the order of its keys."""
    return hashlib.sha256(json.dumps(device, sort_keys=True, default=str).encode()).hexdigest()


# ---- where it was learned -------------------------------------------------------------------------------------------


def ranges_of(bench: Bench) -> tuple[LearnedRange, ...]:
    """One range a kind and response, over the rows that were fitted."""
    stack, white = bench.fit.stack, bench.null.residual**2
    noise = variance_of_readings(stack, bench.fit.white, bench.noise.channels)
    beyond = (stack.y - bench.fit.predictor.predict(bench.null.x)) ** 2 - noise
    found: dict[tuple[str, str], list[_Part]] = {}
    for channel in (c for c in stack.channels if c.size):
        table = stack.tables[channel.table]
        part = _Part(table, white[channel.rows], beyond[channel.rows])
        found.setdefault((table.kind, channel.response), []).append(part)
    return tuple(_range(kind, response, parts) for (kind, response), parts in found.items())


@dataclass(frozen=True, eq=False)
class _Part:
    """Rows of one channel: squares of the whitened residual, and of the residual beyond the noise, SI (n,)."""

    table: Table
    squares: np.ndarray
    beyond: np.ndarray


def _range(kind: str, response: str, parts: Sequence[_Part]) -> LearnedRange:
    squares, beyond = (np.concatenate([getattr(p, name) for p in parts]) for name in ("squares", "beyond"))
    names = dict.fromkeys(name for p in parts for name in p.table.conditions)
    conditions = {
        name: span(name, np.concatenate([p.table.conditions[name] for p in parts if name in p.table.conditions]))
        for name in names
    }
    unexplained = float(np.sqrt(max(beyond.mean(), 0.0)))
    return LearnedRange(kind, response, len(squares), float(squares.mean()), unexplained, conditions)


def is_angle(name: str) -> bool:
    """Whether a condition goes round."""
    return "angle" in name


def span(name: str, values: np.ndarray) -> tuple[float, float]:
    """Low and high of a condition; of an angle the shortest arc that holds all values, its low end in [0, 2 pi)."""
    if not is_angle(name):
        return float(values.min()), float(values.max())
    around = np.unique(np.mod(values, TURN))
    gaps = np.diff(np.append(around, around[0] + TURN))
    first = (int(np.argmax(gaps)) + 1) % len(around)
    return float(around[first]), float(around[first] + TURN - gaps.max())


def outside(name: str, values: np.ndarray, learned: tuple[float, float]) -> np.ndarray:
    """True where a condition leaves the learned range by more than two readings of one setting differ (n,)."""
    low, high = learned
    zero = ZERO_CELSIUS if name.endswith("_T") else 0.0
    slack = SAME_SETTING * max(abs(low + zero), abs(high + zero), high - low)
    if is_angle(name):
        beyond = np.mod(values - low + slack, TURN)
        return beyond > high - low + 2 * slack
    return (values < low - slack) | (values > high + slack)
