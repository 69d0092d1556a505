"""What the thesis prints of the energy of its prototype in a quarter car (Tables 4.6-4.14)."""

from __future__ import annotations

import csv
from dataclasses import dataclass, fields

from units import GRAVITY
from vehicle.tables import DATA

_TEXT = 3  # leading columns that are words


@dataclass(frozen=True)
class PrintedEnergy:
    """One column of the tables; None where nothing is printed.

    table: its number; command, actuator: names as in ``vehicle.energy_stage``
    electrical, peak_electrical, mechanical: at the battery and at the suspension [W]
    shaft_apparent [W], shaft_power_factor, of the suspension; machine_power [W], machine_apparent [W],
    machine_power_factor, of the rotor; machine_loss, mechanical_loss, mount_loss, element_loss: losses [W]
    shaft_active, machine_active, regenerating: shares of the time, dimensionless, as the power factors
    elastic, inertial: reactive powers [W]; comfort: RMS [m/s^2]; road_holding: RMS, dimensionless
    """

    table: str
    command: str
    actuator: str
    electrical: float
    peak_electrical: float | None
    mechanical: float
    shaft_apparent: float | None
    shaft_power_factor: float | None
    machine_power: float | None
    machine_apparent: float | None
    machine_power_factor: float | None
    machine_loss: float
    mechanical_loss: float | None
    mount_loss: float | None
    element_loss: float | None
    shaft_active: float
    machine_active: float
    regenerating: float
    elastic: float | None
    inertial: float | None
    comfort: float
    road_holding: float


def printed_energy() -> tuple[PrintedEnergy, ...]:
    """All columns, in the order of the tables."""
    lines = (DATA / "thesis_energy.csv").read_text(encoding="utf-8").splitlines()
    rows = list(csv.reader(line for line in lines if not line.startswith("#")))[1:]
    return tuple(_column(row) for row in rows)


def _column(row: list[str]) -> PrintedEnergy:
    values = [float(cell) if cell else None for cell in row[_TEXT:]]
    names = (field.name for field in fields(PrintedEnergy))
    found = dict(zip(names, (*row[:_TEXT], *values), strict=True))
    found["comfort"] = float(row[-2]) * GRAVITY
    return PrintedEnergy(**found)  # type: ignore[arg-type]
