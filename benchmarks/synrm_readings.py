"""Which reading of its source the reluctance machine's measurements ask for: ``python -m benchmarks.synrm_readings``.

Coil pitch, gap, stacking, steel and currents are open in the source. Each reading is solved by the field of
``machines/szesynrm_outline.toml`` and held against the locked torque over the angle at three currents, nothing fitted,
and beside the best factor and the best zero of the angle of each current: what then remains is the shape over the
angle, and how the factor moves with the current is the pattern of a gap, of saturation or of a length.
Writes results/reference/benchmarks/synrm_readings.csv.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from threadpoolctl import threadpool_limits

from benchmarks.tables import write_table
from geometry.cross_section import mesh_cross_section
from geometry.half_cell import MeshDensity
from geometry.outline import Arc, Curve, Line
from geometry.parts import ComposedMachine
from geometry.rotors.outline_rotor import OutlineRotor
from geometry.winding import star_of_slots
from magnetostatics.currents import PhaseCurrents
from magnetostatics.flux_linkage import phase_flux_linkage
from magnetostatics.model import FieldModel, MachineMaterials
from magnetostatics.torque import arkkio_torque
from materials.altered_steel import stacked
from materials.library import load_steel
from pipeline.modules import PROJECT
from study.machine_file import MachineFile, read_machine
from units import DEGREE
from units import MILLIMETRE as mm

TABLE = PROJECT / "results" / "reference" / "benchmarks" / "synrm_readings.csv"
MEASURED = PROJECT / "measurements" / "synrm-48-4"
DENSITY = MeshDensity(gap_edges=384, gap_layers=2, across_iron=1.0)
ANGLES = np.arange(-22.5, 22.6, 1.25) * DEGREE  # of high permeance from the axis of phase A, mechanical
ZEROS = np.arange(-2.0, 2.01, 0.1) * DEGREE
SMALL = 2.0  # A, of the inductance


@dataclass(frozen=True)
class Reading:
    """What the source leaves open. steel: None for that of the machine's file; currents: over those read"""

    words: str
    coil_pitch: int = 12
    gap: float = 1.0 * mm
    stacking: float = 0.97
    steel: str | None = None
    currents: float = 1.0

    def model(self, found: MachineFile) -> FieldModel:
        """The field of this reading."""
        layout = star_of_slots(found.machine.slots, found.machine.pole_pairs, 2, self.coil_pitch)
        law = found.materials.stator_steel if self.steel is None else load_steel(self.steel)
        steel = stacked(law, self.stacking)
        section = mesh_cross_section(with_gap(found.machine, self.gap), layout, DENSITY)
        return FieldModel(section, MachineMaterials(steel, steel, found.materials.magnet))


READINGS = (
    Reading("coil pitch 10", coil_pitch=10),
    Reading("coil pitch 10, currents 5 % larger", coil_pitch=10, currents=1.05),
    Reading("coil pitch 11", coil_pitch=11),
    Reading("full pitch, as in the machine's file"),
    Reading("full pitch, gap 1.05 mm", gap=1.05 * mm),
    Reading("full pitch, gap 1.1 mm", gap=1.1 * mm),
    Reading("full pitch, gap 1.05 mm, no insulation between sheets", gap=1.05 * mm, stacking=1.0),
    Reading("full pitch, gap 1.1 mm, no insulation between sheets", gap=1.1 * mm, stacking=1.0),
    Reading("full pitch, steel M470-50A", steel="M470-50A"),
)


@dataclass(frozen=True)
class Row:
    """rms: of the error, nothing fitted, % of the largest reading; factor: reading over model; shape: rms beside the
    best factor and zero, %; zero: of the angle [degrees]; by the current of phase A [A]; inductance between lines"""

    reading: str
    rms_15: float
    rms_21: float
    rms_31: float
    factor_15: float
    factor_21: float
    factor_31: float
    shape_15: float
    shape_21: float
    shape_31: float
    zero_15: float
    zero_21: float
    zero_31: float
    largest_inductance_mH: float
    smallest_inductance_mH: float


@dataclass(frozen=True)
class Held:
    """One current: rms [%], best factor, zero [rad], rms beside both [%]."""

    rms: float
    factor: float
    zero: float
    shape: float


def with_gap(machine: ComposedMachine, gap: float) -> ComposedMachine:
    """The rotor smaller or larger in all its lines, so that a gap [m] is left."""
    rotor = machine.rotor
    assert isinstance(rotor, OutlineRotor)
    share = (machine.stator.rim_radius - gap) / rotor.outer_radius
    outline = tuple(_scaled(curve, share) for curve in rotor.outline)
    return replace(machine, rotor=replace(rotor, outline=outline, outer_radius=share * rotor.outer_radius))


def _scaled(curve: Curve, share: float) -> Curve:
    if isinstance(curve, Arc):
        return replace(curve, radius=share * curve.radius, centre=share * curve.centre)
    return Line(share * curve.start, share * curve.end)


def measured() -> Iterator[tuple[tuple[float, float, float], pd.DataFrame]]:
    """Currents of the phases [A] and the rows read at them, smallest current first."""
    table = pd.read_csv(MEASURED / "torque_angle.csv")
    for currents, rows in table.groupby(["i_a_A", "i_b_A", "i_c_A"]):
        a, b, c = (float(current) for current in currents)
        yield (a, b, c), rows


def torques(model: FieldModel, currents: tuple[float, float, float], found: MachineFile) -> np.ndarray:
    """That hold the rotor at ``ANGLES`` [Nm]."""
    axis = model.section.layout.phase_axis / found.machine.pole_pairs
    states = (PhaseCurrents(axis + angle, currents, found.equivalent_turns) for angle in ANGLES)
    return np.array([-found.active_length * arkkio_torque(model.solve(state)) for state in states])


def held(model_torques: np.ndarray, rows: pd.DataFrame) -> Held:
    """A model's torques at ``ANGLES`` against readings."""
    read, largest = rows.torque_Nm.to_numpy(), rows.torque_Nm.abs().max()

    def beside(zero: float) -> tuple[float, float]:
        model = np.interp(rows.angle_mech_deg * DEGREE - zero, ANGLES, model_torques)
        factor = float(model @ read / (model @ model))
        return float(np.sqrt(np.mean((read - factor * model) ** 2)) / largest), factor

    zero = min(ZEROS, key=lambda one: beside(one)[0])
    shape, factor = beside(zero)
    drawn = np.interp(rows.angle_mech_deg * DEGREE, ANGLES, model_torques)
    return Held(100 * float(np.sqrt(np.mean((read - drawn) ** 2))) / largest, factor, zero, 100 * shape)


def inductances(model: FieldModel, found: MachineFile) -> np.ndarray:
    """Between two lines, end windings left out, over a pole [mH]."""
    turns, axis = found.equivalent_turns, model.section.layout.phase_axis / found.machine.pole_pairs
    linkages = []
    for angle in axis + np.arange(0.0, 90.0, 7.5) * DEGREE:
        phases = phase_flux_linkage(model.solve(PhaseCurrents(angle, (0.0, SMALL, -SMALL), turns)))
        linkages.append(turns * found.active_length * (phases[1] - phases[2]))
    return 1e3 * np.array(linkages) / SMALL


def row(reading: Reading, found: MachineFile) -> Row:
    """One reading against all that was measured."""
    model = reading.model(found)
    every = []
    for (a, b, c), rows in measured():
        currents = (reading.currents * a, reading.currents * b, reading.currents * c)
        every.append(held(torques(model, currents, found), rows))
    line = inductances(model, found)
    columns = [
        [round(one.rms, 1) for one in every],
        [round(one.factor, 3) for one in every],
        [round(one.shape, 1) for one in every],
        [round(one.zero / DEGREE, 1) for one in every],
        [round(float(line.max()), 2), round(float(line.min()), 2)],
    ]
    return Row(reading.words, *(value for column in columns for value in column))


def main() -> None:
    """Solve, print and write."""
    found = read_machine("szesynrm_outline")
    with threadpool_limits(1):
        write_table(TABLE, (row(reading, found) for reading in READINGS))


if __name__ == "__main__":
    main()
