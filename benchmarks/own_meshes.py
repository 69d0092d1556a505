"""Kinds of rotors on a mesh of NGSolve's own, against this project's solution on its usual mesh.

NGSolve is told the drawing, the materials and the ampere-turns of the coils (``benchmarks.ngsolve_own_mesh``). The
current is the largest of the machine's file, the rotor stands where the cogging torque is large, and the same
position follows without current. Part of ``python -m benchmarks.other_kinds``; writes
results/reference/benchmarks/own_meshes.csv.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import lcm, pi

import numpy as np

from benchmarks.comparison import relative
from benchmarks.drawn_kinds import drawn, halbach, own
from benchmarks.ngsolve_own_mesh import Fineness, Peer, solve_on_own_mesh
from benchmarks.tables import write_table
from geometry.cross_section import CrossSection, mesh_cross_section
from magnetostatics.currents import PhaseCurrents
from magnetostatics.flux_linkage import phase_flux_linkage
from magnetostatics.model import FieldModel, OperatingPoint
from magnetostatics.torque import arkkio_torque, maxwell_torque
from pipeline.modules import PROJECT
from study.machine_file import MachineFile

TABLE = PROJECT / "results" / "reference" / "benchmarks" / "own_meshes.csv"
WITH_MAGNETS, WITHOUT = 0.5, -0.8  # rad, current angles
FULL, NONE = "full current", "no current"
COARSER = 2.0  # edges of the peer's other mesh
# Of the peer's mesh where the usual one does not do: the outline of szesynrm has hundreds of corners, at which the
# field is singular (B ~ r^-1/3 at a right angle of iron), and unresolved they move the peer's torque by 0.12 %.
FINENESS = {"OutlineRotor": Fineness(0.5, 10.0)}


@dataclass(frozen=True)
class Row:
    """One state of one machine.

    torque_Nm_per_m, flux_mWb_per_m: NGSolve's, the largest linkage of a phase per turn
    ring_difference, fluxes_difference: of this project's torque by the ring and by consistent fluxes, relative to the
        torque at full current; flux_difference: of the linkages, relative to the largest
    peer_change: of NGSolve's torque from a mesh of edges twice as long, relative to the torque at full current
    """

    kind: str
    machine: str
    state: str
    triangles: int
    torque_Nm_per_m: float
    flux_mWb_per_m: float
    ring_difference: float
    fluxes_difference: float
    flux_difference: float
    peer_change: float


@dataclass(frozen=True, eq=False)
class Ours:
    """Torque by two routes [Nm/m] and linkages of the phases (3,) [Wb/m per turn]."""

    ring: float
    fluxes: float
    flux_linkage: np.ndarray


def machines() -> Iterator[tuple[str, MachineFile]]:
    """All that are compared on two meshes."""
    yield from drawn()
    yield halbach()
    yield own()


def compared(name: str, found: MachineFile) -> Iterator[Row]:
    """One machine by both codes, with current and, if it has magnets, without."""
    section, angle = usual_section(found), position(found)
    states = {state: PhaseCurrents(angle, currents) for state, currents in ampere_turns(found).items()}
    told = [state.ampere_turns(section) for state in states.values()]
    kind = type(found.machine.rotor).__name__
    usual = FINENESS.get(kind, Fineness())
    meshes = usual, replace(usual, edges=usual.edges / COARSER)
    finer, coarser = (solve_on_own_mesh(section, found.materials, angle, told, one) for one in meshes)
    ours = solved(found, section, list(states.values()))
    for state, one, peer, other in zip(states, ours, finer, coarser, strict=True):
        yield _row(kind, name, state, one, peer, other, abs(finer[0].torque))


def _row(kind: str, name: str, state: str, ours: Ours, peer: Peer, coarser: Peer, scale: float) -> Row:
    return Row(
        kind,
        name,
        state,
        peer.triangles,
        peer.torque,
        1e3 * float(np.abs(peer.flux_linkage).max()),
        abs(ours.ring - peer.torque) / scale,
        abs(ours.fluxes - peer.torque) / scale,
        relative(ours.flux_linkage, peer.flux_linkage),
        abs(coarser.torque - peer.torque) / scale,
    )


def usual_section(found: MachineFile) -> CrossSection:
    """Meshed as its file says."""
    return mesh_cross_section(found.machine, found.layout, found.density)


def position(found: MachineFile) -> float:
    """A quarter of the period of the cogging torque from where magnet and tooth face each other [rad]."""
    return 2 * pi / lcm(found.machine.slots, found.machine.repeats) / 4


def ampere_turns(found: MachineFile) -> dict[str, tuple[float, float, float]]:
    """Of a coil of phases A, B, C in every state [A]."""
    magnets = found.machine.rotor.magnets_per_pitch > 0
    amplitude = found.number("drive", "line_current_peak_A")
    state = OperatingPoint(position(found), found.equivalent_turns * amplitude, WITH_MAGNETS if magnets else WITHOUT)
    a, b, c = state.phase_densities(found.machine.pole_pairs, found.layout.phase_axis).tolist()
    return {FULL: (a, b, c)} | ({NONE: (0.0, 0.0, 0.0)} if magnets else {})


def solved(found: MachineFile, section: CrossSection, states: list[PhaseCurrents]) -> list[Ours]:
    """This project's solutions on the usual mesh."""
    model = FieldModel(section, found.materials)
    solutions = [model.solve(state) for state in states]
    return [Ours(arkkio_torque(one), maxwell_torque(one), phase_flux_linkage(one)) for one in solutions]


def main() -> None:
    """Compare, print and write."""
    write_table(TABLE, (row for name, found in machines() for row in compared(name, found)))
