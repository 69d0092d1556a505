"""Every kind of rotor against NGSolve on identical triangles: ``python -m benchmarks.other_kinds``.

Torque, flux linkages and potential at a saturating current, quadratic elements: machines of ``machines/``, and of the
kinds of rotors that none of them has one inside the stator of one. Both codes integrate for themselves, NGSolve with
the law of the steel from a table, as in ``benchmarks.other_codes``. Needs ``sh benchmarks/set_up``.
Writes results/reference/benchmarks/other_kinds.csv.
"""

from __future__ import annotations

import csv
from collections.abc import Iterator
from dataclasses import asdict, dataclass, fields, replace

import numpy as np
from threadpoolctl import threadpool_limits

from benchmarks.airgap_run import solve_cold
from benchmarks.comparison import EXACT, relative
from benchmarks.ngsolve_run import solve_ngsolve
from benchmarks.reference_case import FieldCase, State
from geometry.cross_section import CrossSection, mesh_cross_section
from geometry.half_cell import MeshDensity
from geometry.magnetisation import PARALLEL
from geometry.parts import Rotor
from geometry.rotors.bread_loaf_magnets import BreadLoafMagnets
from geometry.rotors.ribbed_v_shape import RibbedVShape
from geometry.rotors.spoke import Spoke
from geometry.rotors.surface_magnets import SurfaceMagnets
from magnetostatics.model import OperatingPoint
from pipeline.modules import PROJECT
from study.machine_file import MachineFile, read_machine
from units import AMPERE_PER_SQUARE_MILLIMETRE
from units import MILLIMETRE as mm

TABLE = PROJECT / "results" / "reference" / "benchmarks" / "other_kinds.csv"
FILES = ("outrunner_9_12", "inset_ferrite_6_4", "prius_2004", "v2_48_8", "consequent_12_8", "synrm_48_4",
         "szesynrm_outline")  # fmt: skip
DENSITY = MeshDensity(gap_edges=240, longest_gap_edge=2.5, gap_layers=2, across_iron=2.0)
INSIDE_OF_TWELVE_SLOTS = (
    SurfaceMagnets(8, 15.7 * mm, 2.5 * mm, 5.0 * mm, 0.85, PARALLEL),
    BreadLoafMagnets(8, 15.7 * mm, 12.8 * mm, 9.0 * mm, 5.0 * mm),
    Spoke(8, 15.7 * mm, 3.0 * mm, 6.0 * mm),
)
FULL = 20.0 * AMPERE_PER_SQUARE_MILLIMETRE  # amplitude in the copper
WITH_MAGNETS, WITHOUT = 0.5, -0.8  # rad, current angles


@dataclass(frozen=True)
class Row:
    """kind: of the rotor; torque_Nm_per_m: NGSolve's; the rest: how far this project's solution is from it, relative to
    torque, largest flux linkage and largest potential"""

    kind: str
    machine: str
    triangles: int
    torque_Nm_per_m: float
    torque_difference: float
    flux_difference: float
    potential_difference: float


def drawn() -> Iterator[tuple[str, MachineFile]]:
    """Machines with windings and materials by name, all kinds of rotors that are drawn by their dimensions or an
    outline."""
    for name in FILES:
        yield name, read_machine(name)
    v, twelve = read_machine("prius_2004"), read_machine("consequent_12_8")
    rib = RibbedVShape(rib=1.2 * mm, **vars(v.machine.rotor))
    yield "prius_2004, a rib between its magnets", _with_rotor(v, rib)
    for rotor in INSIDE_OF_TWELVE_SLOTS:
        yield "consequent_12_8, another rotor", _with_rotor(twelve, rotor)


def _with_rotor(found: MachineFile, rotor: Rotor) -> MachineFile:
    return replace(found, machine=replace(found.machine, rotor=rotor))


def case_of(found: MachineFile, order: str = "P2") -> FieldCase:
    """The smallest sector of a machine at full current, its rotor turned so that both sides are straight: Netgen looks
    for the image of every edge between two nodes of a side, also where it crosses a triangle behind a step."""
    gamma = WITH_MAGNETS if found.machine.rotor.magnets_per_pitch else WITHOUT
    section = mesh_cross_section(found.machine, found.layout, DENSITY)
    point = OperatingPoint(_start(section, "stator") - _start(section, "rotor"), FULL, gamma)
    return FieldCase(section, found.materials, State("full current", point), order)


def _start(section: CrossSection, part: str) -> float:
    """Angle of the ray that a part of the sector begins with [rad]."""
    x, y = section.mesh.p[:, section.mesh.facets[:, section.mesh.boundaries[f"{part}_start"]]].reshape(2, -1)
    return float(np.arctan2(y[(far := np.hypot(x, y).argmax())], x[far]))


def compared(name: str, found: MachineFile) -> Row:
    """One machine by both codes."""
    case = case_of(found)
    ours, peer = solve_cold(case, EXACT), solve_ngsolve(case, EXACT)
    return Row(
        type(found.machine.rotor).__name__,
        name,
        case.section.mesh.nelements,
        peer.torque,
        relative(ours.torque, peer.torque),
        relative(ours.flux_linkage, peer.flux_linkage),
        relative(ours.potential, peer.potential),
    )


def main() -> None:
    """Compare, print and write."""
    rows = []
    with threadpool_limits(1):
        for name, found in drawn():
            rows.append(compared(name, found))
            print(*asdict(rows[-1]).values(), flush=True)
    with open(TABLE, "w", newline="", encoding="utf-8") as file:
        table = csv.DictWriter(file, [one.name for one in fields(Row)], lineterminator="\n")
        table.writeheader()
        table.writerows({name: _digits(value) for name, value in asdict(row).items()} for row in rows)


def _digits(value: object) -> object:
    return f"{value:.3g}" if isinstance(value, float) and abs(value) < 1e-3 else value


if __name__ == "__main__":
    main()
