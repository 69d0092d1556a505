"""What a tool of the bench hands out: what people read, and the table that the workbench takes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import pandas as pd

from bench.errors import RecordError
from bench.record import Record
from figures.report import Section


@dataclass(frozen=True, eq=False)
class CampaignTable:
    """A table in the format of a campaign.

    kind: of measurement; frame: columns end in their unit; uncertainty: random, by column of a response, a number or
    formula of ``campaign.toml``
    """

    kind: str
    frame: pd.DataFrame
    uncertainty: Mapping[str, str]

    def entry(self, file: str) -> str:
        """The ``[[table]]`` of ``campaign.toml`` for the table in a file of this name."""
        sizes = ", ".join(f'{column} = "{size}"' for column, size in self.uncertainty.items())
        return f'[[table]]\nfile = "{file}"\nkind = "{self.kind}"\nu_random = {{ {sizes} }}\n'


@dataclass(frozen=True, eq=False)
class Analysis:
    """Results of one tool.

    title: of the page; sections: in reading order; table: one row a result, in drawing units
    numbers: results by name with unit, for the JSON; campaign: what feeds the workbench, None where no model answers
    remarks: what must not be overlooked
    """

    title: str
    sections: tuple[Section, ...]
    table: pd.DataFrame
    numbers: Mapping[str, object]
    campaign: CampaignTable | None = None
    remarks: tuple[str, ...] = field(default=())


@dataclass(frozen=True)
class Settings:
    """stated: beside the records, by name [SI]."""

    stated: Mapping[str, float]

    def needed(self, name: str, example: str) -> float:
        """A quantity that is needed [SI]; raises RecordError where it is not stated."""
        if name not in self.stated:
            raise RecordError(f"expected --value {example}, found no {name.replace('_', ' ')}; state it.")
        return self.stated[name]

    def get(self, name: str, default: float) -> float:
        """get: a quantity [SI]; default: where it is not stated [SI]."""
        return self.stated.get(name, default)


Records = Sequence[Record]
