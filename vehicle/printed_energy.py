"""What the thesis prints of the energy of its prototype in a quarter car (Tables 4.6-4.14)."""

from __future__ import annotations

import csv
from dataclasses import dataclass, fields

from units import GRAVITY
from vehicle.tables import DATA


@dataclass(frozen=True)
class PrintedEnergy:
    """One column of the tables; None where nothing is printed.

    command, actuator: names as in ``vehicle.energy_stage``; electrical, mechanical, machine_loss, mechanical_loss [W]
    machine_power_factor, shaft_active, machine_active, regenerating: shares, dimensionless
    elastic, inertial: reactive powers [W]; comfort: RMS [m/s^2]; road_holding: RMS, dimensionless
    """

    command: str
    actuator: str
    electrical: float
    mechanical: float
    machine_loss: float
    mechanical_loss: float | None
    machine_power_factor: float | None
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
    command, actuator, *numbers = row
    values = [float(cell) if cell else None for cell in numbers]
    found = dict(zip((field.name for field in fields(PrintedEnergy)), (command, actuator, *values), strict=True))
    found["comfort"] = float(numbers[-2]) * GRAVITY
    return PrintedEnergy(**found)  # type: ignore[arg-type]
