"""Every kind of rotor against NGSolve on identical triangles: ``python -m benchmarks.other_kinds``.

Torque, flux linkages and potential at a large current, quadratic elements, the machines of ``benchmarks.drawn_kinds``.
Both codes integrate for themselves, NGSolve with the law of the steel from a table, as in ``benchmarks.other_codes``.
Then the same machines on meshes of NGSolve's own, ``benchmarks.own_meshes``. Needs ``sh benchmarks/set_up``.
Writes results/reference/benchmarks/other_kinds.csv and own_meshes.csv.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from threadpoolctl import threadpool_limits

from benchmarks import own_meshes
from benchmarks.airgap_run import solve_cold
from benchmarks.comparison import EXACT, relative
from benchmarks.drawn_kinds import drawn, halbach, own
from benchmarks.ngsolve_run import solve_ngsolve
from benchmarks.reference_case import FieldCase, State
from benchmarks.tables import write_table
from geometry.cross_section import CrossSection, mesh_cross_section
from geometry.half_cell import MeshDensity
from magnetostatics.model import OperatingPoint
from pipeline.modules import PROJECT
from study.machine_file import MachineFile
from units import AMPERE_PER_SQUARE_MILLIMETRE

TABLE = PROJECT / "results" / "reference" / "benchmarks" / "other_kinds.csv"
DENSITY = MeshDensity(gap_edges=240, longest_gap_edge=2.5, gap_layers=2, across_iron=2.0)
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


def machines() -> Iterator[tuple[str, MachineFile]]:
    """All that are compared on the same triangles."""
    yield from drawn()
    yield halbach()
    yield own()


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
    ours, peer = solve_cold(case, EXACT), solve_ngsolve(case, EXACT, damped=True)
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
    with threadpool_limits(1):
        write_table(TABLE, (compared(name, found) for name, found in machines()))
        own_meshes.main()


if __name__ == "__main__":
    main()
