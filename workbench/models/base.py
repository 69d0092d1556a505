"""What the workbench asks of a model of a device: the whole protocol. The first five a model must answer; the others
have an answer here that suits a model which is exact and quick."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from effects.base import Columns
from workbench.data.table import Campaign, Table, Tolerance

Progress = Callable[[str], None]


@dataclass(frozen=True, eq=False)
class Option:
    """A measurement that could be made: rows to choose from.

    conditions: SI (n,);  random: standard uncertainty of one reading of each response, SI (n,);  cost: of a dozen rows
    unknown: expected unknown function there, of random (n,) each
    """

    kind: str
    words: str
    conditions: Mapping[str, np.ndarray]
    random: Mapping[str, np.ndarray]
    cost: float = 1.0
    unknown: Mapping[str, np.ndarray] | None = None


class BaseModel:
    """A model of a kind of device. ``name`` is how files speak of it: "damper", "dq", "machine"."""

    name: str

    def accepts(self, device: Mapping[str, object]) -> bool:
        """Whether a ``[device]`` table is of this kind of device."""
        raise NotImplementedError

    def design(self, device: Mapping[str, object]) -> Any:
        """The frozen dataclass of the device as drawn, from the ``[device]`` table of a campaign."""
        raise NotImplementedError

    def with_tolerance(self, design: Any, tolerance: Tolerance, z: float) -> Any:
        """The design with one toleranced input moved by z standard deviations."""
        raise NotImplementedError

    def respond(self, design: Any, kind: str, conditions: Columns) -> dict[str, np.ndarray]:
        """Response columns of one table of a kind at true conditions, SI."""
        raise NotImplementedError

    def own_tolerances(self, design: Any) -> tuple[Tolerance, ...]:
        """Inputs of the model that are uncertain on every device of the kind, whatever a campaign declares."""
        return ()

    def prepared(self, design: Any, tables: Sequence[Table], progress: Progress | None = None) -> BaseModel:
        """The model made ready to answer quickly for the rows of some tables."""
        return self

    def anywhere(self, design: Any) -> BaseModel:
        """A model that answers at once at any conditions, if only to ten percent: what conventions are judged by."""
        return self

    @property
    def is_expansion(self) -> bool:
        """Whether it answers by an expansion about a design, so that ``recentred`` makes it more exact elsewhere."""
        return False

    def recentred(self, design: Any, tables: Sequence[Table] = ()) -> BaseModel:
        """The model, exact at another design. tables: at their true conditions, as far as they matter to that"""
        return self

    def is_alike(self, design: Any, other: Any) -> bool:
        """Whether two designs differ in nothing that an expansion is of; one that was touched does."""
        return design is other

    def numerical(self, design: Any, table: Table) -> tuple[Mapping[str, np.ndarray], ...]:
        """Shapes of the model's own numerical error in the rows of a table, response -> SI (n,); each comes with a
        standard normal weight that all tables and repeats share."""
        return ()

    def left_open(self, design: Any, table: Table) -> Mapping[str, np.ndarray]:
        """What the model cannot say of the readings of a table, response -> one standard deviation of each, SI (n, L);
        each of every response by itself."""
        return {}

    def options(self, design: Any, campaign: Campaign) -> Sequence[Option]:
        """What could be measured next besides what was."""
        return ()

    def doubts(self, design: Any) -> tuple[str, ...]:
        """One sentence for each thing in the declared device that no device of the kind has."""
        return ()
