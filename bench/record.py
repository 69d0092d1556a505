"""A record of the bench: equally sampled channels over time, from a file in the format of a campaign.

Headings say quantity and unit (``force_N``, ``stroke [mm]``, ``time_s``); any dialect of CSV, text or Parquet that the
workbench reads. Inside everything is SI. A quantity that does not change (a shunt, a bias) may be a column of equal
numbers, or stated for all records.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from bench.errors import RecordError
from workbench.data.column_units import FACTORS, OFFSETS, to_inside
from workbench.data.raw_table import RawTable, read_raw

_JITTER = 0.25  # of a step, by which a time may stand beside its place: rounded clocks, no missing samples
_SHORTEST = 16  # samples
_ALIKE = 1e-6  # relative spread of a quantity that does not change


@dataclass(frozen=True, eq=False)
class Record:
    """Channels over time.

    name: of the file; step: time between samples [s]; channels: by quantity [SI], each (n,)
    not_read: headings of columns without a known unit
    """

    name: str
    step: float
    channels: Mapping[str, np.ndarray]
    not_read: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if not self.channels:
            found = ", ".join(self.not_read) or "none"
            raise RecordError(
                f"{self.name}: expected columns with a known unit beside time, such as force_N, found {found}; write "
                "the unit at the end of the heading."
            )
        if self.samples < _SHORTEST:
            raise RecordError(
                f"{self.name}: expected a record of {_SHORTEST} samples or more, found {self.samples}; record longer."
            )

    @property
    def samples(self) -> int:
        """Number of samples."""
        return len(next(iter(self.channels.values())))

    @property
    def time(self) -> np.ndarray:
        """From the first sample [s], (n,)."""
        return self.step * np.arange(self.samples)

    @property
    def duration(self) -> float:
        """Of all samples [s]."""
        return self.step * self.samples

    def channel(self, quantity: str) -> np.ndarray:
        """A channel [SI], (n,). Raises RecordError where the record has none of this name, or gaps in it."""
        if quantity not in self.channels:
            found = ", ".join(self.channels)
            found += f" and, without a known unit, {', '.join(self.not_read)}" if self.not_read else ""
            raise RecordError(
                f"{self.name}: expected a column {quantity!r} with its unit, such as {_example(quantity)}, found "
                f"{found}; rename the column with --column {quantity}=HEADING or record it."
            )
        values = self.channels[quantity]
        if not np.isfinite(values).all():
            row = int(np.argmin(np.isfinite(values))) + 1
            raise RecordError(
                f"{self.name}: expected a number in every row of {quantity!r}, found a gap in sample {row}; cut the "
                "record there."
            )
        return values

    def constant(self, quantity: str) -> float:
        """The value of a constant channel [SI], infinite for an open circuit.

        Raises RecordError where it changes or is missing.
        """
        values = self.channels.get(quantity)
        if values is not None and np.isinf(values).all():
            return float("inf")
        values = self.channel(quantity)
        if np.ptp(values) > _ALIKE * np.max(np.abs(values), initial=1e-300):
            raise RecordError(
                f"{self.name}: expected one {quantity} in the whole record, found {values.min():g} to "
                f"{values.max():g} (SI); cut the record where it changes."
            )
        return float(values[0])

    def velocity(self) -> np.ndarray:
        """The channel velocity where it was recorded, else the stroke's derivative by central differences [m/s],
        (n,)."""
        return (
            self.channel("velocity") if "velocity" in self.channels else np.gradient(self.channel("stroke"), self.step)
        )


_UNITS = {"stroke": "mm", "force": "N", "velocity": "m_per_s", "shunt": "mohm", "pressure": "Pa", "angle": "deg"}


def _example(quantity: str) -> str:
    unit = next((unit for word, unit in _UNITS.items() if word in quantity), None)
    fallback = "V" if "voltage" in quantity else "A" if "current" in quantity else "s"
    return f"{quantity}_{unit or fallback}"


def read_record(path: Path, columns: Mapping[str, str], stated: Mapping[str, float]) -> Record:
    """The record of a file.

    columns: heading by quantity, where the heading is another word; stated: quantities [SI] that hold for the whole
    record and stand in no column
    Raises:
        RecordError: no time, unequal sampling, a stated quantity that is a column as well, too few samples.
    """
    raw = read_raw(path)
    names = {heading: quantity for quantity, heading in columns.items()}
    _require_headings(raw, names)
    places = {names.get(h.written, names.get(h.name, h.name)): k for k, h in enumerate(raw.headings)}
    channels = {quantity: _inside(raw, place, quantity) for quantity, place in places.items() if _has_unit(raw, place)}
    if twice := sorted(set(stated) & set(channels)):
        raise RecordError(f"{raw.where}: {twice[0]} is stated and stands in a column as well; leave one of them out.")
    if "time" not in channels:
        raise RecordError(
            f"{raw.where}: expected a column 'time' with its unit, such as time_s, found none; name it with --column "
            "time=HEADING."
        )
    step = _step(raw.where, channels.pop("time"))
    constants = {quantity: np.full(raw.rows, value) for quantity, value in stated.items()}
    not_read = tuple(heading.written for place, heading in enumerate(raw.headings) if not _has_unit(raw, place))
    return Record(raw.where, step, {**constants, **channels}, not_read)


def _require_headings(raw: RawTable, names: Mapping[str, str]) -> None:
    known = {word for heading in raw.headings for word in (heading.written, heading.name)}
    for heading, quantity in names.items():
        if heading not in known:
            raise RecordError(
                f"{raw.where}: --column {quantity}={heading} names no column; it has "
                f"{', '.join(h.written for h in raw.headings)}."
            )


def _has_unit(raw: RawTable, place: int) -> bool:
    """Whether a column is a quantity: it has a known unit, or holds dates and times of day."""
    unit = raw.headings[place].unit
    return unit in FACTORS or unit in OFFSETS or raw.holds_times(place)


def _inside(raw: RawTable, place: int, quantity: str) -> np.ndarray:
    """A column in SI; dates and times of day are read as seconds."""
    unit = "s" if raw.holds_times(place) else raw.headings[place].unit
    return to_inside(raw.values(place), quantity, unit, raw.where)


def _step(where: str, time: np.ndarray) -> float:
    """Time between samples [s]; raises RecordError where they are not equally spaced."""
    if len(time) < 2 or not np.isfinite(time).all():
        raise RecordError(
            f"{where}: expected finite times of two samples or more, found {len(time)}; complete the record."
        )
    step = float(time[-1] - time[0]) / (len(time) - 1)
    beside = np.abs(time - time[0] - step * np.arange(len(time)))
    worst = int(np.argmax(beside))
    if step <= 0 or beside[worst] > _JITTER * step:
        raise RecordError(
            f"{where}: expected equally spaced times, found sample {worst + 1} at {time[worst]:g} s, "
            f"{beside[worst]:.2g} s beside its place in steps of {step:.4g} s; resample the record or cut out the "
            "gap."
        )
    return step
