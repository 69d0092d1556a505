"""Machines that somebody built, from their drawings alone: ``python -m benchmarks.built_machines``.

The field of the files in ``machines/``, nothing fitted, against what was measured on them, and predictions of what has
not been compared yet; that of another rotor around the stator of the outrunner is ``benchmarks.other_rotor``,
the locked torque of the Prius motor with its interval ``benchmarks.locked_torque``.
Writes results/reference/benchmarks/built_machines.csv.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import pi, sqrt

import numpy as np
import pandas as pd

from geometry.cross_section import mesh_cross_section
from magnetostatics.currents import PhaseCurrents
from magnetostatics.model import FieldModel
from magnetostatics.torque import arkkio_torque
from magnetostatics.turn import Supply, Turned, turned
from pipeline.modules import PROJECT
from study.machine_file import MachineFile, read_machine
from units import DEGREE, RPM

TABLE = PROJECT / "results" / "reference" / "benchmarks" / "built_machines.csv"
POSITIONS = 15  # of an electrical period; its fundamental is free of the orders that three phases have
LOCKED = (50.0, 100.0, 150.0, 200.0, 250.0)  # A
BEYOND = np.arange(90.0, 166.0, 7.5) * DEGREE  # electrical, where the reluctance torque helps that of the magnets


@dataclass(frozen=True)
class Row:
    """machine, quantity with its unit; drawn: from the drawing; measured: None where it is a prediction; remark."""

    machine: str
    quantity: str
    drawn: float
    measured: float | None
    remark: str

    @property
    def error_percent(self) -> float | None:
        """Of the drawing."""
        return None if self.measured is None else 100 * (self.drawn / self.measured - 1)


def no_load(found: MachineFile, span: float | None = None, positions: int = POSITIONS) -> Turned:
    """Turned without current over an angle [rad], an electrical period where none is given."""
    model = FieldModel(mesh_cross_section(found.machine, found.layout, found.density), found.materials)
    span = 2 * pi / found.machine.pole_pairs if span is None else span
    angles = span * np.arange(positions) / positions
    return turned(model, Supply(0.0, 0.0, found.turns), found.active_length, angles)


def with_remanence(found: MachineFile, remanence: float) -> MachineFile:
    """The same with other magnets [T]."""
    magnet = replace(found.materials.magnet, remanence=remanence)
    return replace(found, materials=replace(found.materials, magnet=magnet))


def prius() -> Iterator[Row]:
    """Line voltage at 1000 rpm."""
    drawn = line_voltage(read_machine("prius_2004"))
    yield Row("prius_2004", "line voltage at 1000 rpm, rms / V", drawn, measured_line_voltage(),
              "steel, remanence and bridge assumed; another code has the same voltage of this drawing")  # fmt: skip


def line_voltage(found: MachineFile) -> float:
    """Of a drawing at 1000 rpm, RMS [V]."""
    return sqrt(3 / 2) * 1000 * RPM * found.machine.pole_pairs * no_load(found).fundamental


def measured_line_voltage() -> float:
    """Of the Prius motor at 1000 rpm, RMS [V]: at four speeds with magnets at 25 degC."""
    table = pd.read_csv(PROJECT / "measurements" / "prius-2004" / "back_emf.csv")
    return 1000 * float((table.v_ll_V @ table.speed_rpm) / (table.speed_rpm @ table.speed_rpm))


def prius_locked() -> Iterator[Row]:
    """Largest torque over the rotor angle, direct current in phase A and back through B and C; not compared yet."""
    found = read_machine("prius_2004")
    model = FieldModel(mesh_cross_section(found.machine, found.layout, found.density), found.materials)
    for current in LOCKED:
        torque = max(abs(locked_torque(found, model, current, beyond)) for beyond in BEYOND)
        yield Row("prius_2004", f"locked torque at {current:g} A in phase A / Nm", torque, None,
                  "prediction: direct current, half of it back through B and through C; 20 degC")  # fmt: skip


def locked_torque(found: MachineFile, model: FieldModel, current: float, beyond: float) -> float:
    """Torque [Nm] with the d axis an electrical angle beyond the axis of phase A [rad]; current [A]."""
    angle = (found.layout.phase_axis + beyond) / found.machine.pole_pairs
    point = PhaseCurrents(angle, (current, -current / 2, -current / 2), found.turns)
    return found.active_length * arkkio_torque(model.solve(point))


def ferrite() -> Iterator[Row]:
    """Voltage of a phase and cogging: both fall short of the drawing as less flux would have it."""
    found = read_machine("inset_ferrite_6_4")
    linkage = no_load(found).fundamental
    cogging = np.ptp(no_load(found, 30 * DEGREE, 24).torque[:, 0]) / 2
    yield Row("inset_ferrite_6_4", "voltage of a phase at 2000 rpm, peak / V", linkage * 2 * 2000 * RPM, 47.37,
              "stack of 30 mm, no end leakage and no stacking factor in the plane field")  # fmt: skip
    yield Row("inset_ferrite_6_4", "cogging, peak / Nm", cogging, 0.0357,
              "goes with the square of the flux; whether 0.0357 is peak or peak to peak is not said")  # fmt: skip


def outrunners() -> Iterator[Row]:
    """With the remanence that its file assumes and with that of its seller."""
    steel, measured = read_machine("outrunner_9_12"), 0.2678
    for remanence, remark in ((1.20, "remanence assumed"), (1.45, "N52 as its seller claims")):
        drawn = 1e3 * no_load(with_remanence(steel, remanence)).fundamental
        yield Row("outrunner_9_12", "flux linkage of a phase / mWb", drawn, measured, f"{remanence:g} T, {remark}")


def main() -> None:
    rows = [row for rows in (prius(), prius_locked(), ferrite(), outrunners()) for row in rows]
    table = pd.DataFrame([
        (r.machine, r.quantity, f"{r.drawn:.4g}", r.measured and f"{r.measured:.4g}",
         r.measured and f"{r.error_percent:+.1f}", r.remark) for r in rows
    ], columns=["machine", "quantity", "drawn", "measured", "error_percent", "remark"])  # fmt: skip
    table.to_csv(TABLE, index=False)
    print(table.to_string(index=False))


if __name__ == "__main__":
    main()
