"""A bench model: a base that answers for a design, and the effects it was given. A model is a value.

model + effect, model.without("end_leakage"), model.answers(table)
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from effects.base import Columns, DesignEffect, Effect, InstrumentEffect, ResponseEffect, StateEffect
from workbench.data.table import Conditions, Table
from workbench.errors import WorkbenchError
from workbench.models.base import BaseModel


@dataclass(frozen=True)
class Model:
    """A base model, a design and the effects that were added, in their order."""

    base: BaseModel
    design: Any
    effects: tuple[Effect, ...] = ()

    @property
    def names(self) -> tuple[str, ...]:
        """Of its effects, in their order."""
        return tuple(effect.name() for effect in self.effects)

    def __add__(self, effect: Effect) -> Model:
        if effect.name() in self.names:
            raise WorkbenchError(f"the model already has the effect {effect.name()}: remove it first")
        if not effect.can_act_on(self.design):
            raise WorkbenchError(f"{effect.name()} cannot act on a {type(self.design).__name__}")
        return replace(self, effects=self.effects + (effect,))

    def without(self, name: str) -> Model:
        """The model without the effect of that name."""
        if name not in self.names:
            have = ", ".join(self.names) or "none"
            raise WorkbenchError(f"the model has no effect {name}; it has {have}")
        return replace(self, effects=tuple(effect for effect in self.effects if effect.name() != name))

    def answers(self, table: Table) -> dict[str, np.ndarray]:
        """What the instruments should have shown in the rows of a table: response columns, SI (n,)."""
        if not table.rows:  # all of its rows are held out, or none are
            return {name: response.values for name, response in table.responses.items()}
        kind, design, order = table.kind, self.design_as_built, {"order": table.order}
        conditions = self._given(table, self.true_conditions(table))
        response = self.base.respond(design, kind, conditions)
        _require_answers(table, response | _between_lines(response, table))
        told = self._given(table, {**conditions, **order})
        for effect in self._of[ResponseEffect]:
            response = dict(effect.on_response(response, told, kind, design))
        for effect in self._of[InstrumentEffect]:
            response = dict(effect.on_reading(response, told, kind))
        return response | _between_lines(response, table)

    def true_conditions(self, table: Table) -> dict[str, np.ndarray]:
        """What the device was in where the instruments showed the conditions of a table, SI (n,) each."""
        conditions = dict(table.conditions)
        for effect in self._of[InstrumentEffect]:
            conditions = dict(effect.on_condition(conditions, table.kind))
        for effect in self._of[StateEffect]:
            state = effect.on_state({**conditions, "order": table.order}, table.kind, self.design_as_built)
            conditions = without_order(state)
        return conditions

    def _given(self, table: Table, conditions: Mapping[str, np.ndarray]) -> Conditions:
        """Conditions that say which of them is missing."""
        if not conditions:
            raise WorkbenchError(f"{table.file}: has no condition column; a {self.base.name} is asked at conditions.")
        return Conditions(conditions, table.file)

    @cached_property
    def design_as_built(self) -> Any:
        """The design after all effects that act on it."""
        design = self.design
        for effect in self._of[DesignEffect]:
            design = effect.on_design(design)
        return design

    @cached_property
    def _of(self) -> Mapping[type, list]:
        """The effects of every kind; all tables ask for them."""
        kinds = (DesignEffect, StateEffect, ResponseEffect, InstrumentEffect)
        return {kind: [effect for effect in self.effects if isinstance(effect, kind)] for kind in kinds}


def without_order(conditions: Columns) -> dict[str, np.ndarray]:
    """The conditions that a base model is asked at; it does not know what was measured first."""
    return {name: values for name, values in conditions.items() if name != "order"}


def _require_answers(table: Table, response: Mapping[str, np.ndarray]) -> None:
    missing = [name for name in table.responses if name not in response]
    if missing:
        raise WorkbenchError(
            f"{table.file}: the model does not answer {missing[0]!r} in a table of kind {table.kind}; it answers "
            f"{', '.join(response)}."
        )


def _between_lines(response: dict[str, np.ndarray], table: Table) -> dict[str, np.ndarray]:
    """Voltages between two phases, v_ab = v_a - v_b, where a table has them and the model answers for the phases."""
    pairs = table.between_lines.items()
    return {n: response[p] - response[m] for n, (p, m) in pairs if n not in response and {p, m} <= set(response)}
