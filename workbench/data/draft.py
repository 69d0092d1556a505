"""Writes the ``campaign.toml`` of a plain CSV file, with blanks for what only the lab knows."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from workbench.data.campaign import BOOKKEEPING, FILE
from workbench.data.column_units import split_unit
from workbench.data.kinds import KINDS
from workbench.errors import WorkbenchError

_HEAD = """# A campaign: what was measured, how well it is known. Fill in every "?" before use.
[campaign]
id = "{id}"
repeats = {repeats}                  # two or more show the size of the noise
holdout = {holdout}

[device]
model = "?"                          # damper, dq or machine, and the keys it needs

[tolerance]                          # inputs of the model:  name = {{ sigma_rel = 0.01, source = "drawing" }}

[systematic]                         # errors of instruments:  voltage_gain = {{ sigma = 0.002, kind = "gain" }}

[[table]]
file = "{file}"
kind = "{kind}"
[table.columns]
"""


def draft_of(path: Path) -> str:
    """The text of a ``campaign.toml`` for one CSV file.

    Raises:
        WorkbenchError: the file is not there or is no table.
    """
    try:
        frame = pd.read_csv(path, skipinitialspace=True, nrows=100_000).rename(columns=str.strip)
    except (OSError, ValueError, pd.errors.ParserError) as error:
        raise WorkbenchError(f"{path}: cannot be read as CSV: {error}.") from None
    kind = likely_kind([split_unit(name)[0] for name in frame])
    repeats = frame["repeat"].nunique() if "repeat" in frame else 1
    holdout = '{ rule = "last repeat of every table" }' if repeats > 1 else '"none"'
    head = _HEAD.format(id=path.parent.name or path.stem, repeats=repeats, holdout=holdout, file=path.name, kind=kind)
    return head + "".join(_line(name, kind) for name in frame)


def likely_kind(quantities: list[str]) -> str:
    """The kind whose responses and axes cover most of the columns."""

    def score(name: str) -> int:
        kind = KINDS[name]
        answers = sum(kind.is_response(q) for q in quantities)
        return 3 * answers + sum(any(_like(q, axis) for axis in kind.axes) for q in quantities) if answers else -1

    return max(KINDS, key=lambda name: (score(name), name == "generic"))


def _like(quantity: str, axis: str) -> bool:
    return quantity == axis or (axis.endswith("_?") and quantity[:-1] == axis[:-1])


def _line(name: str, kind: str) -> str:
    quantity, unit = split_unit(name)
    if name in BOOKKEEPING:
        return f'"{name}" = {{ role = "{name}" }}\n'
    if name == "direction":
        return f'"{name}" = {{ role = "group" }}\n'
    if KINDS[kind].is_response(quantity):
        return f'"{name}" = {{ unit = "{unit or "?"}", role = "response", u_random = "?" }}\n'
    return f'"{name}" = {{ unit = "{unit or "?"}", role = "condition" }}\n'


def write_draft(path: Path) -> Path:
    """Writes the draft beside the CSV file, which is only read.

    Raises:
        WorkbenchError: there is a campaign file already.
    """
    target = path.parent / FILE
    if target.exists():
        raise WorkbenchError(f"{target}: exists already; it is not overwritten.")
    target.write_text(draft_of(path), encoding="utf-8")
    return target
