"""A measurement as it flows through the workbench: tables of columns in SI with roles and uncertainties."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from workbench.errors import WorkbenchError
from workbench.findings import Prediction

OPEN_CIRCUIT = 1e6  # ohm; a shunt of this size is an open circuit


@dataclass(frozen=True, eq=False)
class Response:
    """One measured response column of a table.

    values, random: reading and its declared random standard uncertainty, SI (n,)
    unit: as in the file, for people; scale: file unit -> SI factor
    bandwidth: frequency above which the recorder lets nothing pass [Hz], None where it is not known
    """

    name: str
    values: np.ndarray
    random: np.ndarray
    unit: str
    scale: float = 1.0
    bandwidth: float | None = None


class Conditions(dict[str, np.ndarray]):
    """Conditions of a table by name; one that a model asks for and the table has not is one sentence."""

    def __init__(self, columns: Mapping[str, np.ndarray], table: str):
        super().__init__(columns)
        self.table = table

    def __missing__(self, name: str) -> np.ndarray:
        known = ", ".join(self) or "none"
        raise WorkbenchError(
            f"{self.table}: the model needs the condition {name!r}, the table has {known}; add it, or say "
            f"it in constants of its [[table]] where it was the same in all rows."
        )


@dataclass(frozen=True, eq=False)
class Table:
    """One table of a campaign; n rows in the order of acquisition.

    kind: measurement kind, for example "back_emf"
    conditions: columns that the model is asked at, by SI-less name ("angle_mech", "i_a", "velocity"), SI (n,)
    condition_random: their declared random uncertainties, SI (n,), where any;  condition_units: as in the file
    responses: measured columns by name without unit ("v_a", "torque", "force", "re", "im")
    scan, repeat: numbers of the scan and of the repeat (n,); autocorrelation never crosses a scan
    held_out: rows that no fit may see (n,) bool
    bandwidth: frequency above which the recorder of the table lets nothing pass [Hz], None where it is not known
    lines: where each row stands in its file (n,); empty where that is not known
    """

    kind: str
    file: str
    conditions: Mapping[str, np.ndarray]
    responses: Mapping[str, Response]
    scan: np.ndarray
    repeat: np.ndarray
    held_out: np.ndarray
    condition_random: Mapping[str, np.ndarray] = field(default_factory=dict)
    bandwidth: float | None = None
    condition_units: Mapping[str, str] = field(default_factory=dict)
    lines: np.ndarray = field(default_factory=lambda: np.zeros(0, dtype=int))

    @property
    def rows(self) -> int:
        return len(self.held_out)

    @cached_property
    def between_lines(self) -> Mapping[str, tuple[str, str]]:
        """Responses that are voltages between two phases, v_ab, and those of the phases, v_a and v_b."""
        named = (
            name for name in self.responses if len(name) == 4 and name.startswith("v_") and set(name[2:]) < {*"abc"}
        )
        return {name: (f"v_{name[2]}", f"v_{name[3]}") for name in named}

    @cached_property
    def scans(self) -> tuple[np.ndarray, ...]:
        """Rows of every scan of every repeat."""
        _, which = np.unique(np.stack([self.scan, self.repeat]), axis=1, return_inverse=True)
        return tuple(np.flatnonzero(which == k) for k in range(which.max(initial=-1) + 1))

    @cached_property
    def order(self) -> np.ndarray:
        """How far each row is through its scan in the order of acquisition, 0 to 1 (n,)."""
        progress = np.zeros(self.rows)
        for scan in np.unique(self.scan):
            mine = self.scan == scan
            progress[mine] = np.linspace(0.0, 1.0, int(mine.sum()))
        return progress


@dataclass(frozen=True)
class Tolerance:
    """An input of the model that is only known to within sigma (SI, or relative to the nominal value)."""

    name: str
    sigma: float
    relative: bool
    source: str = ""


@dataclass(frozen=True)
class Systematic:
    """An error shared by all rows of an instrument.

    name: ``<quantity>_<what>`` without unit: voltage_gain, torque_offset, encoder_zero
    kind: "gain" (relative) or "offset" (SI);  sigma: standard uncertainty
    """

    name: str
    kind: str
    sigma: float


@dataclass(frozen=True, eq=False)
class Campaign:
    """A folder of measurements of one device.

    device: the ``[device]`` table as read, keys with units;  repeats: declared number of repeats
    file_hashes: SHA-256 of every data file;  complaints: what had to be left out or limits the conclusions
    holdout: the rule of ``[campaign]``: "by region", "last repeat of every table", "column:NAME" or "none"; with "by
    region" no row is marked here
    conventions: the section ``[conventions]`` as read
    predictions: for devices that are not measured yet
    """

    id: str
    folder: str
    device: Mapping[str, object]
    tables: tuple[Table, ...]
    tolerances: tuple[Tolerance, ...]
    systematics: tuple[Systematic, ...]
    repeats: int
    file_hashes: Mapping[str, str]
    complaints: tuple[str, ...] = ()
    holdout: str = "by region"
    conventions: Mapping[str, Mapping[str, object]] = field(default_factory=dict)
    predictions: tuple[Prediction, ...] = ()
