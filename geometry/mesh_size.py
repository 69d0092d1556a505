"""How large a mesh will be, found from its outline alone: nobody should wait for a mesh that nobody can solve."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import lcm

from geometry.chords import natural_edges
from geometry.errors import GeometryError
from geometry.half_cell import HalfCell, MeshDensity, half_cells
from geometry.machine import Machine
from geometry.parts import DrawnMachine
from geometry.plane_mesh import Drawing

# A state of 300 000 unknowns takes some 10 s and 3 GB, and a sweep solves ten thousands of states; the machines of the
# studies have 8 000.
LARGEST_MESH = 300_000
_UNKNOWNS_PER_TRIANGLE = 2.0  # of quadratic elements: a vertex belongs to six triangles, an edge to two
# Triangles inside an outline of n edges, a n^b: between n (a strip) and n^2 (a disc). Fitted to the half cells of 150
# random machines, 20 to 10^5 triangles: within a factor of 2.7.
_TRIANGLES, _EXPONENT = 0.16, 1.75


def check_mesh_size(machine: DrawnMachine, density: MeshDensity, sectors: int = 1) -> None:
    """Raise GeometryError, naming what to change, when a mesh would be larger than ``LARGEST_MESH``."""
    unknowns = expected_unknowns(machine, density, sectors)
    if unknowns > LARGEST_MESH:
        raise GeometryError(
            f"the mesh would have about {_thousands(unknowns)} unknowns, more than the {_thousands(LARGEST_MESH)} that "
            f"can be solved in reasonable time: {_advice(machine, density)}"
        )


def _thousands(count: float) -> str:
    return f"{round(count / 1000)} 000"


def expected_unknowns(machine: DrawnMachine, density: MeshDensity, sectors: int = 1) -> float:
    """Unknowns of a field solution (dimensionless), within a factor of 2.7.

    sectors: how many such parts make up the machine
    """
    copies = 2 * machine.slots / sectors, 2 * machine.repeats / sectors
    cells = half_cells(machine, density)
    return _UNKNOWNS_PER_TRIANGLE * sum(n * expected_triangles(cell, machine) for n, cell in zip(copies, cells))


def expected_triangles(cell: HalfCell, machine: DrawnMachine) -> float:
    """Triangles of a half cell (dimensionless): those of the gap layers and those of the drawing."""
    return 2 * cell.edges * cell.density.gap_layers + _TRIANGLES * outline_edges(cell.draw(machine)) ** _EXPONENT


def outline_edges(drawing: Drawing) -> float:
    """Mesh edges on all curves of a drawing (dimensionless); between two points the edge length changes linearly."""
    fixed = {curve: edges for curve, (_, edges) in drawing.curves.items()}
    return sum(natural_edges(drawing, *curve) if edges is None else edges for curve, edges in fixed.items())


def _advice(machine: DrawnMachine, density: MeshDensity) -> str:
    """The change that helps most: of a number by a factor of two, or of slots and poles without common measure."""
    if lcm(2 * machine.slots, 2 * machine.repeats) > 4 * density.edges_wanted(machine):
        return (
            f"change slots or poles, {machine.slots} and {machine.poles} meet on a sliding circle of "
            f"{density.edges_around(machine)} edges"
        )
    usual = MeshDensity()
    found = {f"enlarge {name}": (larger, density) for name, larger in _larger(machine)}
    for name in ("gap_edges", "gap_layers", "across_iron"):
        if getattr(density, name) > 2 * getattr(usual, name):
            found[f"reduce {name}"] = machine, replace(density, **{name: getattr(density, name) // 2})
    return min(found, key=lambda change: expected_unknowns(*found[change]), default="take larger dimensions")


def _larger(machine: DrawnMachine) -> Iterator[tuple[str, DrawnMachine]]:
    """The machine with one of the dimensions that fine edges come from twice as large, where it states them."""
    for name in ("airgap", "back_iron_width", "tooth_width"):
        if isinstance(machine, Machine):
            yield name, replace(machine, **{name: 2 * getattr(machine, name)})
