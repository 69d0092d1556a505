"""Optimum torque against the flux-density limit for every reading of it, on the study's own stator and slot count."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from math import nan

import numpy as np

from geometry.errors import GeometryError
from geometry.machine import Machine
from magnetostatics.case import FamilyCase
from optimisation.design import Design, DesignSolver, Judge
from optimisation.design_map import DesignMap
from optimisation.states import AlignedTooth, EveryTooth, EveryToothAndBackIronOverPeriod, SaturationReading
from optimisation.sweep import SaturationLimit, SweepGrid
from optimisation.torque import NullTorque
from tasks import Workers
from units import MILLIMETRE

_NULL, _PERIOD = EveryTooth(), EveryToothAndBackIronOverPeriod()


@dataclass(frozen=True)
class LimitPoint:
    """The best design under one limit [T] in one reading; torque [Nm/m] and lengths [m] NaN where none holds it."""

    reading: str
    limit: float
    torque: float
    back_iron_width: float
    rotor_outer_radius: float


@dataclass(frozen=True)
class LimitComparison:
    """What each reading of the limit costs. Read off a map of one stator by interpolation; torque is the mean torque.

    chosen: the limit of the study
    """

    chosen: SaturationLimit
    points: tuple[LimitPoint, ...]


@dataclass(frozen=True)
class LimitRow:
    """The study's own stator with one rotor radius and all back_iron_widths [m]."""

    case: FamilyCase
    rotor_outer_radius: float
    back_iron_widths: tuple[float, ...]

    def machines(self) -> list[Machine | None]:
        """The designs, None where one cannot even be drawn."""
        return [self._machine(width) for width in self.back_iron_widths]

    def _machine(self, width: float) -> Machine | None:
        family = self.case.family
        with suppress(GeometryError):
            return family.machine(family.combination, back_iron_width=width, rotor_outer_radius=self.rotor_outer_radius)
        return None


def limits_stage(case: FamilyCase, grid: SweepGrid, limit: SaturationLimit, workers: Workers) -> LimitComparison:
    """Compare the limits in every reading on the grid of the sweep; nothing is solved where none is compared."""
    if not limit.compared:
        return LimitComparison(limit, ())
    outer = case.family.stator_outer_radius
    widths, radii = grid.widths(outer), grid.radii(outer)
    rows = {
        f"rotor radius {radius / MILLIMETRE:g} mm": LimitRow(case, radius, tuple(widths.tolist()))
        for radius in radii.tolist()
    }
    solved = np.stack(list(workers.map("limits", solve_row, rows).values()), axis=1)  # (widths, radii, 4)
    maps = _maps(widths, radii, solved)
    return LimitComparison(limit, tuple(_point(*one, value) for one in maps.items() for value in limit.compared))


def solve_row(row: LimitRow) -> np.ndarray:
    """(widths, 4): mean torque [Nm/m]; aligned tooth and worst tooth in the null state, worst over the period [T]."""
    machines = row.machines()
    drawn = [machine for machine in machines if machine is not None]
    null = DesignSolver(Judge(row.case, _NULL, row.case.nominal_density, NullTorque())).designs(drawn)
    period = DesignSolver(Judge(row.case, _PERIOD, row.case.nominal_density)).designs(drawn)
    found = {machine: _values(*both) for machine, *both in zip(drawn, null, period)}
    return np.array([[nan] * 4 if machine is None else found[machine] for machine in machines])


def _values(null: Design | None, period: Design | None) -> list[float]:
    if null is None or period is None:
        return [nan] * 4
    return [period.torque, null.tooth_aligned, null.tooth_worst, period.limited]


def _maps(widths: np.ndarray, radii: np.ndarray, solved: np.ndarray) -> dict[SaturationReading, DesignMap]:
    readings = (AlignedTooth(), _NULL, _PERIOD)
    return {reading: DesignMap(widths, radii, solved[..., 0], solved[..., 1 + k]) for k, reading in enumerate(readings)}


def _point(reading: SaturationReading, design_map: DesignMap, limit: float) -> LimitPoint:
    best = design_map.best_point(limit)
    values = (nan, nan, nan) if best is None else (best.torque, best.width, best.radius)
    return LimitPoint(reading.name, limit, *values)
