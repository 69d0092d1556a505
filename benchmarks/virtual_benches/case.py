"""A blind case: the folder of a campaign as a laboratory would hand it over, and beside it what was hidden."""

from __future__ import annotations

import csv
import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path

import numpy as np

GROUPS = ("null", "single", "pair", "several", "outside", "mistake")
LAST_REPEAT = "last repeat of every table"
VISIBLE = 20.0  # chi2 that an effect adds after the tolerances took what they can; 10 nats


@dataclass(frozen=True)
class Answer:
    """What was hidden in a campaign.

    bench: "damper", "dq", ...;  group: one of GROUPS
    effects: names as in the library, with the size of their first parameter in SI; empty for null and outside
    outside: words for a truth that no effect of the library describes
    visibility: chi2 that each hidden effect adds beyond tolerances, instruments and the other hidden effects, by name
    ambient: names among ``effects`` that every bench of this kind has, whatever else it hides
    mistake: names by which the diagnosis may call what the laboratory wrote down wrongly;  detail: that, in words
    about: how the bench was made: "declared" (true over declared u), "remount" (scatter of a scan in u), ...
    """

    bench: str
    group: str
    seed: int
    effects: Mapping[str, float] = field(default_factory=dict)
    outside: str = ""
    visibility: Mapping[str, float] = field(default_factory=dict)
    ambient: tuple[str, ...] = ()
    mistake: tuple[str, ...] = ()
    detail: str = ""
    about: Mapping[str, float] = field(default_factory=dict)

    def is_visible(self, name: str) -> bool:
        return self.visibility[name] >= VISIBLE

    def write(self, path: Path) -> None:
        path.write_text(json.dumps(asdict(self), indent=1), encoding="utf-8")


@dataclass(frozen=True, eq=False)
class Series:
    """One table before it is written; columns carry the unit in their name.

    conditions: set points as logged, responses: readings, (n,) of one repeat each, stacked over the repeats
    u_random: declared uncertainty as written in campaign.toml
    """

    file: str
    kind: str
    repeat: np.ndarray
    conditions: Mapping[str, np.ndarray]
    responses: Mapping[str, np.ndarray]
    u_random: Mapping[str, str]


@dataclass(frozen=True, eq=False)
class Bench:
    """A device and its measurements, ready to be written: all a campaign.toml needs."""

    id: str
    device: Mapping[str, object]
    tolerance: Mapping[str, float]  # relative
    systematic: Mapping[str, tuple[str, float]]  # key -> kind, sigma
    tables: tuple[Series, ...]
    holdout: str = LAST_REPEAT  # empty: the campaign says nothing about it

    def write(self, folder: Path) -> Path:
        """campaign.toml and a CSV file a table; returns the folder."""
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "campaign.toml").write_text(self._toml(), encoding="utf-8")
        for table in self.tables:
            _write_csv(folder / table.file, table)
        return folder

    def _toml(self) -> str:
        repeats = int(max(table.repeat.max() for table in self.tables)) + 1
        lines = ["[campaign]", f'id = "{self.id}"', f"repeats = {repeats}"]
        lines += [f'holdout = {{ rule = "{self.holdout}" }}'] if self.holdout else []
        lines += ["", "[device]"]
        lines += [f"{key} = {_text(value)}" for key, value in self.device.items()]
        lines += ["", "[tolerance]"] + [f"{key} = {{ sigma_rel = {s:g} }}" for key, s in self.tolerance.items()]
        lines += ["", "[systematic]"]
        lines += [f'{key} = {{ sigma = {s:g}, kind = "{kind}" }}' for key, (kind, s) in self.systematic.items()]
        for table in self.tables:
            random = ", ".join(f'{column} = "{formula}"' for column, formula in table.u_random.items())
            lines += ["", "[[table]]", f'file = "{table.file}"', f'kind = "{table.kind}"', f"u_random = {{ {random} }}"]
        return "\n".join(lines) + "\n"


def _text(value: object) -> str:
    return f'"{value}"' if isinstance(value, str) else f"{value:.10g}"


def _write_csv(path: Path, table: Series) -> None:
    columns = {"repeat": table.repeat, **table.conditions, **table.responses}
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        writer.writerows(zip(*([_cell(value) for value in values] for values in columns.values())))


def _cell(value: float) -> str:
    return "" if np.isnan(value) else f"{value:.8g}"
