"""The table of torque-to-length values that the regression test guards: ``python -m pipeline.reference_torques``.

Writes ``results/reference/torque_per_length.csv``. Run it only when a value is meant to move, and say in the
commit why.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from math import sqrt

import pandas as pd

from disk import write_atomically
from magnetostatics.model import OperatingPoint
from magnetostatics.torque import arkkio_torque, maxwell_torque
from pipeline.modules import PROJECT
from study.inputs_field import field_case
from study.read import read_study
from units import AMPERE_PER_SQUARE_MILLIMETRE, DEGREE

TABLE = PROJECT / "results" / "reference" / "torque_per_length.csv"
STUDY = "motorcycle"
_MACHINES = (
    (),
    ("machine.magnetisation=radial",),
    ("machine.magnet_arc_fraction=0.75",),
    ("machine.back_iron_width_mm=4.0", "machine.rotor_outer_radius_mm=15.94"),
    ("machine.back_iron_width_mm=2.68", "machine.rotor_outer_radius_mm=13.9"),
    ("machine.stator_outer_radius_mm=57.5", "machine.rotor_outer_radius_mm=21.0", "machine.back_iron_width_mm=3.9"),
    ("machine.slots=9",),
    ("machine.slots=9", "machine.back_iron_width_mm=2.6", "machine.rotor_outer_radius_mm=17.0"),
    ("materials.steel=M270-35A",),
    ("materials.recoil_permeability=1.05",),
)
_POINTS = ((-21.0, 6.0, 0.0), (-21.0, 20.0, 0.0), (-24.0, 6.0, 15.0), (-13.3, 6.0, -20.0))  # deg, A/mm2 RMS, deg


@dataclass(frozen=True)
class Case:
    """One row of the table: overrides of the study and the operating point."""

    overrides: str
    angle_deg: float
    j_rms_A_per_mm2: float
    current_angle_deg: float


def cases() -> list[Case]:
    """Every operating point of every machine."""
    return [
        Case(" ".join(machine), angle, density, gamma) for machine in _MACHINES for angle, density, gamma in _POINTS
    ]


def solve(row: Case) -> dict[str, float]:
    """Torque per length by both routes at the mesh of the sweep."""
    case = field_case(read_study(STUDY, row.overrides.split()))
    model = case.model(case.family.reference)
    amplitude = sqrt(2) * row.j_rms_A_per_mm2 * AMPERE_PER_SQUARE_MILLIMETRE
    angles = row.angle_deg * DEGREE, row.current_angle_deg * DEGREE
    solution = model.solve(OperatingPoint(angles[0], amplitude, angles[1], case.packing))
    return {"torque_arkkio_Nm_per_m": arkkio_torque(solution), "torque_maxwell_Nm_per_m": maxwell_torque(solution)}


def main() -> None:
    """Solve every case and write the table."""
    table = pd.DataFrame([{**asdict(case), **solve(case)} for case in cases()])
    write_atomically(TABLE, lambda path: table.to_csv(path, index=False, float_format="%.6f"))
    print(f"{len(table)} values in {TABLE.relative_to(PROJECT)}")


if __name__ == "__main__":
    main()
