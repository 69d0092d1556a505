"""What the statistics ask of a model: readings for given nuisances and effects, and their derivatives."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from typing import Any, Protocol

import numpy as np

from effects.base import Effect, InstrumentEffect
from effects.parameter import parameters_of
from geometry.errors import GeometryError
from materials.errors import MaterialError
from workbench.data.stack import Stack
from workbench.errors import WorkbenchError
from workbench.likelihood.conditions import readings
from workbench.likelihood.nuisance import EffectParameters, InstrumentError, Nuisance, TolerancedInput
from workbench.likelihood.own_errors import numerical
from workbench.models.model import Model

_REMEMBERED = 128  # designs: a few times as many as there are inputs
STEP = 0.02  # of a standard normal number in a difference quotient; effects of 1e-2 sigma are far above rounding


class Predictor(Protocol):
    """Readings that the instruments should show, stacked over all channels (n,)."""

    names: tuple[str, ...]  # one a component of x
    stack: Stack  # whose rows are predicted
    centre: np.ndarray  # x (m,) at the centres of the priors: elsewhere than zero for what the model has learned
    shapes: np.ndarray  # of the model's own numerical error (n, L); their weights are the last L components of x

    def predict(self, x: np.ndarray, effects: Sequence[Effect] = ()) -> np.ndarray:
        """Readings (n,) at nuisances x (m,), standard normal numbers, with further effects."""


@dataclass(frozen=True, eq=False)
class DirectPredictor:
    """Asks the model itself. x: first what the campaign declares, then the parameters of effects the model has, both
    from where they stand now, then the weights of the model's own numerical error.

    origin: x where a fit starts, zero where it is not given
    """

    model: Model
    nuisances: tuple[Nuisance, ...]
    stack: Stack
    calls: list[int] = field(default_factory=lambda: [0])
    origin: np.ndarray | None = None
    least_shapes: int = 0  # of other rows, whose weights are components of x too

    @property
    def fitted(self) -> tuple[EffectParameters, ...]:
        return tuple(EffectParameters(effect) for effect in self.model.effects)

    @property
    def names(self) -> tuple[str, ...]:
        own = tuple(f"{effect.name}.{p}" for effect in self.fitted for p in parameters_of(effect.effect))
        return tuple(n.name for n in self.nuisances) + own + tuple(f"numerical_error_{k}" for k in range(self.weights))

    @property
    def weights(self) -> int:
        """Number of shapes of the numerical error."""
        return self.shapes.shape[1]

    @cached_property
    def shapes(self) -> np.ndarray:
        """Of the base model's own numerical error at the device as drawn (n, L)."""
        found = numerical(self.model, self.stack)
        missing = max(self.least_shapes - found.shape[1], 0)
        return np.column_stack([found, np.zeros((self.stack.size, missing))])

    @property
    def start(self) -> np.ndarray:
        """x of the nominal device with the effects as they stand in the model, or the origin that was given (m,)."""
        return np.zeros(len(self.names)) if self.origin is None else self.origin

    @property
    def centre(self) -> np.ndarray:
        """x at the centres of the priors (m,): zero but for the effects of the model, which stand where they were
        fitted."""
        own = [-effect.now for effect in self.fitted]
        return np.concatenate([np.zeros(len(self.nuisances)), *own, np.zeros(self.weights)])

    def answering(self) -> DirectPredictor:
        """This, or where the nominal device has no answer in some row, the same from an origin that has one: one
        tolerance away.

        Raises:
            WorkbenchError: of the nominal device, if there is no such place.
        """
        try:
            self.predict(self.start)
            return self
        except WorkbenchError as no_answer:
            for x in _near(len(self.names)):
                try:
                    self.predict(x)
                except WorkbenchError:
                    continue
                return replace(self, origin=x)
            raise no_answer

    def model_at(self, x: np.ndarray, effects: Sequence[Effect] = ()) -> Model:
        """The model with the nuisances and effects at their values."""
        own, place = [], len(self.nuisances)
        for effect in self.fitted:
            own.append(effect.moved(x[place : place + effect.size]))
            place += effect.size
        moved = list(zip(self.nuisances, np.asarray(x).tolist()))
        design = self._design(tuple(z for nuisance, z in moved if isinstance(nuisance, TolerancedInput)))
        errors = (self._error(nuisance, z) for nuisance, z in moved if not isinstance(nuisance, TolerancedInput))
        return replace(self.model, design=design, effects=(*own, *effects, *errors))

    @cached_property
    def _error(self) -> Callable[[InstrumentError, float], InstrumentEffect]:
        """Of an instrument at so many standard deviations: slopes by others leave it as it is."""
        return lru_cache(maxsize=_REMEMBERED)(lambda nuisance, z: nuisance.at(z))

    @cached_property
    def _design(self) -> Callable[[tuple[float, ...]], Any]:
        """The design with its first inputs moved by so many standard deviations, one after the other: few of them
        change from one prediction to the next."""
        inputs = [nuisance for nuisance in self.nuisances if isinstance(nuisance, TolerancedInput)]

        @lru_cache(maxsize=_REMEMBERED)
        def moved(z: tuple[float, ...]) -> Any:
            if not z:
                return self.model.design
            return self.model.base.with_tolerance(moved(z[:-1]), inputs[len(z) - 1].tolerance, z[-1])

        return moved

    def predict(self, x: np.ndarray, effects: Sequence[Effect] = ()) -> np.ndarray:
        """As ``Predictor`` says.

        Raises:
            WorkbenchError: the model has no answer there, or there can be no such device: a step of a fit may be long.
        """
        self.calls[0] += 1
        with answers_only():
            model = self.model_at(x, effects)
            exact = self.stack.vector([model.answers(table) for table in self.stack.tables])
        if not np.isfinite(exact).all():
            raise WorkbenchError(f"the answer of the model is no number in {np.sum(~np.isfinite(exact))} readings")
        return exact + self.shapes @ x[len(x) - self.weights :] if self.weights else exact

    def wherever_known(self, x: np.ndarray, effects: Sequence[Effect] = ()) -> np.ndarray:
        """As ``predict``; NaN in rows where the model has no answer (n,)."""
        return readings(self.model_at(x, effects), self.stack) + self.shapes @ x[len(x) - self.weights :]

    def on(self, stack: Stack) -> DirectPredictor:
        """The same for other rows."""
        return replace(self, stack=stack, least_shapes=self.weights)


@contextmanager
def answers_only() -> Iterator[None]:
    """Where a model is asked for what may not be.

    Raises:
        WorkbenchError: in the place of all that says so.
    """
    try:
        yield
    except (GeometryError, MaterialError) as error:
        raise WorkbenchError(f"there can be no such device: {error}") from error
    except (ArithmeticError, np.linalg.LinAlgError) as error:
        raise WorkbenchError(f"the model has no answer: {error}") from error


def _near(m: int) -> Iterator[np.ndarray]:
    """One of m standard normal numbers moved to either side, the smallest moves first."""
    for size in (1.0, 2.0, 3.0):
        for k in range(m):
            for sign in (1.0, -1.0):
                yield sign * size * np.eye(m)[k]


def jacobian(predictor: Predictor, x: np.ndarray, effects: Sequence[Effect] = (), base: np.ndarray | None = None):
    """d readings / d x (n, m): central differences, one-sided where ``base`` = predict(x) is given."""
    slopes = np.empty((predictor.stack.size, len(x)))
    moved = len(x) - predictor.shapes.shape[1]
    slopes[:, moved:] = predictor.shapes
    answer = lambda there: predictor.predict(there, effects)  # noqa: E731
    for k in range(moved):
        if base is None:
            step = STEP * np.eye(len(x))[k]
            slopes[:, k] = (answer(x + step) - answer(x - step)) / (2 * STEP)
        else:
            slopes[:, k] = one_sided(answer, x, k, STEP, base)
    return slopes


def one_sided(
    answer: Callable[[np.ndarray], np.ndarray], p: np.ndarray, k: int, step: float, base: np.ndarray
) -> np.ndarray:
    """Slope of answers by component k of p (n,), by a step to one side; to the other where the model has no answer
    there, as a motor at its limit of voltage, or does not move, as an effect on its bound. base: answer(p)"""
    along = step * np.eye(len(p))[k]
    try:
        slope = (answer(p + along) - base) / step
        return slope if slope.any() else (base - answer(p - along)) / step
    except WorkbenchError:
        return (base - answer(p - along)) / step
