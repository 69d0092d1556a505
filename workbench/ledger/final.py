"""The final model as people read it: its numbers with 90 % intervals, and the conditions it was learned at."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from effects.base import Effect
from effects.parameter import Parameter, parameters_of
from workbench.data.column_units import for_people, unit_inside
from workbench.findings import Estimate, FinalParameter, LearnedAt
from workbench.ledger.learned import FittedCalibration, FittedInput, Learned, LearnedRange, slopes

NORMAL_95 = 1.6449  # half width of a 90 % interval over the standard deviation


def final_parameters(learned: Learned) -> tuple[FinalParameter, ...]:
    """Of effects first, then of inputs and instruments; none of a file that holds no covariance."""
    if learned.source is None:
        return ()
    std = np.sqrt(np.diag(learned.covariance))
    errors: list[FittedInput | FittedCalibration] = [*learned.inputs, *learned.calibrations]
    shifts = tuple(_shift(error, s) for error, s in zip(errors, std))
    return (*_of_effects(learned.effects, std[len(errors) :]), *shifts)


def _of_effects(effects: tuple[Effect, ...], std: np.ndarray) -> Iterator[FinalParameter]:
    named = [(effect, name, p) for effect in effects for name, p in parameters_of(effect).items()]
    for (effect, name, p), s, slope in zip(named, std, slopes(effects)):
        yield FinalParameter(effect.name(), name, _estimate(p, getattr(effect, name), s, slope))


def _estimate(p: Parameter, value: float, std: float, slope: float) -> Estimate:
    """Ends of the interval by the standard normal number behind the parameter, so that they stay possible."""
    z, half = p.prior.standard(value), NORMAL_95 * abs(std / slope) if slope else 0.0
    ends = np.clip([p.prior.value(z - half), p.prior.value(z + half)], p.low, p.high)
    return Estimate(value, float(std), float(ends.min()), float(ends.max()), p.unit)


def _shift(error: FittedInput | FittedCalibration, std: float) -> FinalParameter:
    owner = "input" if isinstance(error, FittedInput) else "instrument"
    relative = error.tolerance.relative if isinstance(error, FittedInput) else error.systematic.kind == "gain"
    factor, unit = (100.0, "%") if relative else (1.0, unit_inside(error.name))
    value, half = factor * error.shift, factor * NORMAL_95 * float(std)
    return FinalParameter(owner, error.name, Estimate(value, factor * float(std), value - half, value + half, unit))


def learned_at(ranges: tuple[LearnedRange, ...]) -> tuple[LearnedAt, ...]:
    """Conditions in the units in which people read them."""
    return tuple(LearnedAt(f"{r.kind}.{r.response}", r.rows, r.chi2_per_n, _conditions(r)) for r in ranges)


def _conditions(r: LearnedRange) -> dict[str, tuple[float, float, str]]:
    found = {}
    for name, (low, high) in r.conditions.items():
        unit, factor = for_people(name)
        found[name] = (factor * low, factor * high, unit)
    return found
