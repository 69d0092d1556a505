"""Efficiency in the four quadrants of force and speed, from records of a saw-tooth stroke (thesis section 5.2.2).

Each pass through the middle of the stroke is averaged over a window, in which the reversal's transient has died out and
the speed is constant. Power is positive from the suspension to the battery: mechanical F v, electrical U I.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import nan

import numpy as np

from bench.errors import RecordError
from bench.record import Record

_FEWEST = 8  # samples of a pass
_STRAIGHT = 0.02  # rms of the stroke beside a straight line, of the window: a pass at constant speed


@dataclass(frozen=True)
class Pass:
    """Means over one pass through the middle of the stroke.

    record: its name; velocity [m/s], force: of the actuator, opposing rebound [N]; mechanical, electrical: power from
    the suspension to the battery [W]
    """

    record: str
    velocity: float
    force: float
    mechanical: float
    electrical: float

    @property
    def is_passive(self) -> bool:
        """Whether the suspension gives power: quadrants I and III."""
        return self.mechanical > 0

    @property
    def efficiency(self) -> float:
        """Power that comes out over power that goes in, dimensionless; NaN where both ends give power to the losses."""
        if self.is_passive:
            return self.electrical / self.mechanical if self.electrical > 0 else nan
        return self.mechanical / self.electrical if self.electrical < 0 else nan


def passes(record: Record, window: float) -> tuple[Pass, ...]:
    """All passes of a record with the channels stroke, force, dc_voltage and dc_current (into the battery).

    window: of the stroke around its middle [m]
    Raises RecordError where no pass is as long as it must be, or its speed is not constant.
    """
    stroke = record.channel("stroke")
    middle = 0.5 * (stroke.min() + stroke.max())
    runs = [run for run in _runs(np.abs(stroke - middle) <= 0.5 * window) if _crosses(stroke[run] - middle)]
    found = [_pass(record, run, window) for run in runs if len(run) >= _FEWEST]
    if not found:
        raise RecordError(
            f"{record.name}: expected passes of {_FEWEST} samples or more through the middle {window * 1e3:g} mm of "
            "the stroke, found none; widen the window with --value window_mm=... or sample faster."
        )
    return tuple(found)


def _runs(inside: np.ndarray) -> list[np.ndarray]:
    """Places of uninterrupted runs of True."""
    places = np.flatnonzero(inside)
    return np.split(places, np.flatnonzero(np.diff(places) > 1) + 1) if len(places) else []


def _crosses(offset: np.ndarray) -> bool:
    """Whether a run goes through the middle, and does not only touch the window where the record begins or ends."""
    return bool(offset[0] * offset[-1] < 0)


def _pass(record: Record, run: np.ndarray, window: float) -> Pass:
    stroke, force = record.channel("stroke")[run], record.channel("force")[run]
    line = np.polyfit(record.time[run], stroke, 1)
    beside = float(np.std(stroke - np.polyval(line, record.time[run])))
    if beside > _STRAIGHT * window:
        raise RecordError(
            f"{record.name}: expected a constant speed in the middle of the stroke, found {beside * 1e3:.2g} mm "
            "beside a straight line; drive a saw tooth or narrow the window."
        )
    electrical = record.channel("dc_voltage")[run] * record.channel("dc_current")[run]
    velocity = float(line[0])
    return Pass(record.name, velocity, float(force.mean()), velocity * float(force.mean()), float(electrical.mean()))


def best(found: Sequence[Pass], passive: bool) -> float:
    """Largest efficiency with the suspension giving power, or taking it, dimensionless; NaN where there is none."""
    values = [one.efficiency for one in found if one.is_passive == passive and one.efficiency == one.efficiency]
    return max(values, default=nan)
