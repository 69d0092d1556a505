"""What a campaign itself declares as uncertain: inputs of the model and errors shared by the rows of an instrument.

Each is a standard normal number z. At z = 0 the model is the nominal one.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from effects.base import Columns, Effect, InstrumentEffect
from effects.parameter import parameters_of
from workbench.data.column_units import split_unit
from workbench.data.table import Campaign, Systematic, Tolerance
from workbench.errors import WorkbenchError


@dataclass(frozen=True)
class TolerancedInput:
    """An input of the model, moved by z standard deviations."""

    tolerance: Tolerance

    @property
    def name(self) -> str:
        return self.tolerance.name


@dataclass(frozen=True)
class InstrumentError:
    """An instrument's shared error: the effect of that name with its parameter at z sigma."""

    systematic: Systematic
    effect: InstrumentEffect

    @property
    def name(self) -> str:
        return self.systematic.name

    def at(self, z: float) -> InstrumentEffect:
        """The effect at z [1] standard deviations of what is declared."""
        return replace(self.effect, **{next(iter(parameters_of(self.effect))): self.systematic.sigma * z})


@dataclass(frozen=True)
class ColumnError(InstrumentEffect):
    """Gain or offset of the columns that name it in ``u_sys``; reading = true * (1 + g) or true + o."""

    kind: str
    columns: tuple[str, ...]
    size: float = 0.0

    def on_condition(self, conditions: Columns, kind: str) -> Columns:
        return {name: self._true(v) if name in self.columns else v for name, v in conditions.items()}

    def on_reading(self, response: Columns, conditions: Columns, kind: str) -> Columns:
        return {name: self._read(v) if name in self.columns else v for name, v in response.items()}

    def _read(self, true: np.ndarray) -> np.ndarray:
        return true * (1 + self.size) if self.kind == "gain" else true + self.size

    def _true(self, read: np.ndarray) -> np.ndarray:
        return read / (1 + self.size) if self.kind == "gain" else read - self.size


@dataclass(frozen=True)
class DeclaredError:
    """A shared error of declared columns."""

    systematic: Systematic
    columns: tuple[str, ...]

    @property
    def name(self) -> str:
        return self.systematic.name

    def at(self, z: float) -> InstrumentEffect:
        """The effect at z [1] standard deviations of what is declared."""
        return ColumnError(self.systematic.kind, self.columns, self.systematic.sigma * z)


@dataclass(frozen=True)
class EffectParameters:
    """The parameters of an effect that the model already has: they are fitted again, by N(0, 1) around where they
    stand."""

    effect: Effect

    @property
    def name(self) -> str:
        return self.effect.name()

    @property
    def size(self) -> int:
        return len(parameters_of(self.effect))

    def moved(self, x: np.ndarray) -> Effect:
        """The effect with its parameters moved by x standard normal numbers (k,) from where they stand; at 0 bit for
        bit."""
        return self.effect.at(self.now + x) if np.any(x) else self.effect

    @property
    def now(self) -> np.ndarray:
        """Where they stand, as standard normal numbers (k,)."""
        return np.array([p.prior.standard(getattr(self.effect, n)) for n, p in parameters_of(self.effect).items()])


Calibration = InstrumentError | DeclaredError
Nuisance = TolerancedInput | Calibration


def nuisances_of(
    campaign: Campaign, library: Mapping[str, type[Effect]], declared: Mapping[str, Sequence[Any]]
) -> tuple[Nuisance, ...]:
    """All that a campaign declares as uncertain, in the order of its file.

    declared: systematic -> (file, column) of ``u_sys``
    """
    inputs = tuple(TolerancedInput(tolerance) for tolerance in campaign.tolerances)
    return inputs + tuple(_error(systematic, library, declared) for systematic in campaign.systematics)


def _error(
    systematic: Systematic, library: Mapping[str, type[Effect]], declared: Mapping[str, Sequence[Any]]
) -> Nuisance:
    if systematic.name in declared:
        return DeclaredError(
            systematic, tuple(sorted({split_unit(column)[0] for _, column in declared[systematic.name]}))
        )
    cls = library.get(systematic.name)
    if cls is None or not issubclass(cls, InstrumentEffect) or len(parameters_of(cls)) != 1:
        known = [n for n, c in library.items() if issubclass(c, InstrumentEffect) and len(parameters_of(c)) == 1]
        raise WorkbenchError(
            f"[systematic] {systematic.name} is no known instrument error; use one of {', '.join(known)}, or name "
            "it in u_sys of the columns it acts on."
        )
    return InstrumentError(systematic, cls())
