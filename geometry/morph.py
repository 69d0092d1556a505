"""Another machine on the same triangles: nodes move, connectivity, names and numbering stay.

Nodes on the outline keep their place along their curve; those inside follow by a Laplace equation on the half cell,
with small triangles stiffer than large ones; the gap layers are laid anew, so the sliding circle stays equally spaced.
A design that differs in its dimensions then differs smoothly in all results, which a new mesh would not give, and a
field solution of the one is a start for the other. Far from the first machine the triangles degrade: mesh anew there.

Manufacturing defects move nodes as well, on the mesh of the whole machine and each by a ``Defect`` of its own
(``geometry/defects.py``): what they move is added up, so their order does not matter.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import SuperLU, splu

from geometry.checks import check_machine
from geometry.cross_section import Assembly, CrossSection, Piece
from geometry.errors import GeometryError
from geometry.parts import DrawnMachine
from geometry.plane_mesh import Drawing

_ON_CURVE = 1e-9  # m


class Defect:
    """Something of one machine that is not as drawn and breaks its symmetry; the concrete ones are in ``defects``."""

    def moves(self, morpher: Morpher, section: CrossSection) -> np.ndarray:
        """By how much the nodes of a whole machine without defects move (2, n) [m].

        morpher: of any cross-section on the same triangles; section: the machine, as drawn
        """
        raise NotImplementedError

    def assemble(self, assembly: Assembly) -> Assembly:
        """Where the parts stand after it."""
        return assembly


class Morpher:
    """Moves the nodes of one meshed cross-section onto other machines with the same slots, poles and magnet pattern.

    section: as drawn, that is without defects
    """

    def __init__(self, section: CrossSection) -> None:
        if section.assembly != Assembly():
            raise GeometryError("this mesh has been moved by defects already: take the one that it was moved from")
        self.section = section
        self._pieces = [_PieceMorpher(piece, section.machine) for piece in section.pieces]

    def to(self, machine: DrawnMachine, defects: Iterable[Defect] = ()) -> CrossSection:
        """The cross-section of another machine, with its defects, on the same triangles.

        Raises GeometryError when the machine cannot be built, triangles would turn over, or there are defects and the
        mesh is that of a sector.
        """
        self._check(machine)
        return self._with_defects(self._drawn(machine), tuple(defects))

    def _drawn(self, machine: DrawnMachine) -> CrossSection:
        if machine == self.section.machine:
            return self.section
        return self._at(np.hstack([piece.points(machine) for piece in self._pieces]), machine)

    def copies_moved(self, machine: DrawnMachine, section: CrossSection, copies: Iterable[int]) -> np.ndarray:
        """Moves (2, n) [m] of the nodes of some half cells of the stator, from the machine of a section to another."""
        self._check(machine)
        stator = self._pieces[0]
        half_cells = stator.half_cell(machine) - stator.half_cell(section.machine)
        moves = np.zeros_like(section.mesh.p)
        placed, nodes = stator.piece.place_copies(half_cells, copies)
        moves[:, nodes] = placed
        return moves

    def _with_defects(self, drawn: CrossSection, defects: tuple[Defect, ...]) -> CrossSection:
        if not defects:
            return drawn
        if drawn.sectors > 1:
            raise GeometryError(
                f"a defect breaks the symmetry of the machine, but 1/{drawn.sectors} of it is meshed: "
                "mesh the whole machine (mesh_cross_section(..., whole=True))"
            )
        assembly = drawn.assembly
        for defect in defects:
            assembly = defect.assemble(assembly)
        return self._at(drawn.mesh.p + sum(d.moves(self, drawn) for d in defects), drawn.machine, assembly)

    def _at(self, points: np.ndarray, machine: DrawnMachine, assembly: Assembly = Assembly()) -> CrossSection:
        mesh = replace(self.section.mesh, doflocs=points)
        if _areas(points, mesh.t).min() <= 0:
            raise GeometryError("the mesh cannot be moved that far, triangles would turn over: mesh the machine anew")
        return replace(self.section, machine=machine, mesh=mesh, assembly=assembly)

    def _check(self, machine: DrawnMachine) -> None:
        check_machine(machine)
        base = self.section.machine
        if (machine.slots, machine.poles) != (base.slots, base.poles):
            raise GeometryError("a mesh can only be moved onto a machine with the same slots and poles: mesh it anew")


@dataclass(frozen=True, eq=False)
class _PieceMorpher:
    piece: Piece
    base: DrawnMachine

    def points(self, machine: DrawnMachine) -> np.ndarray:
        """Points of the piece (2, m) for a machine."""
        return self.piece.place(self.half_cell(machine))

    def half_cell(self, machine: DrawnMachine) -> np.ndarray:
        """Points of the half cell (n, 2) for a machine."""
        moved = self.drawn_points + self._follow(self._outline(machine) - self.drawn_points[self.outline_nodes])
        gap = self.piece.cell.gap_points(machine, moved[self.rim])
        return np.vstack([moved, gap])

    @cached_property
    def drawn_points(self) -> np.ndarray:
        """Half-cell nodes that do not belong to the gap layers alone (n, 2)."""
        gap_nodes = self.piece.cell.density.gap_layers * (self.piece.cell.edges + 1)
        return self.piece.mesh.points[: len(self.piece.mesh.points) - gap_nodes]

    @cached_property
    def rim(self) -> np.ndarray:
        """Nodes between drawing and gap layers, by rising angle."""
        nodes = self.piece.mesh.nodes_at_radius(self.piece.cell.rim_radius(self.base))
        return nodes[nodes < len(self.drawn_points)]

    @cached_property
    def _curves(self) -> dict[tuple[str, str], tuple[np.ndarray, np.ndarray]]:
        """Nodes on every curve of the drawing and their share of the way along it."""
        drawing = self.piece.cell.draw(self.base)
        return {curve: _along(drawing, curve, self.drawn_points) for curve in drawing.curves}

    @cached_property
    def outline_nodes(self) -> np.ndarray:
        return np.unique(np.concatenate([nodes for nodes, _ in self._curves.values()]))

    def _outline(self, machine: DrawnMachine) -> np.ndarray:
        """Places (k, 2) of the outline nodes for a machine."""
        drawing, places = self.piece.cell.draw(machine), self.drawn_points.copy()
        if drawing.curves.keys() != self._curves.keys():
            raise GeometryError(f"{self.piece.cell.part(machine).other_corners}: mesh the machine anew")
        for curve, (nodes, share) in self._curves.items():
            places[nodes] = _at(drawing, curve, share)
        return places[self.outline_nodes]

    @cached_property
    def _inside(self) -> np.ndarray:
        return np.setdiff1d(np.arange(len(self.drawn_points)), self.outline_nodes)

    @cached_property
    def _stiffness(self) -> sp.csr_matrix:
        """Laplace matrix of the half cell, every triangle weighted by the inverse of its area."""
        triangles = self.piece.mesh.triangles
        triangles = triangles[(triangles < len(self.drawn_points)).all(axis=1)]
        corners = self.drawn_points[triangles]
        opposite = np.roll(corners, -2, axis=1) - np.roll(corners, -1, axis=1)
        weight = 1 / np.abs(_areas(self.drawn_points.T, triangles.T)) ** 2
        local = np.einsum("eid,ejd,e->eij", opposite, opposite, weight)
        rows, columns = np.repeat(triangles, 3, axis=1), np.tile(triangles, 3)
        size = len(self.drawn_points)
        return sp.csr_matrix((local.ravel(), (rows.ravel(), columns.ravel())), shape=(size, size))

    @cached_property
    def _factor(self) -> SuperLU:
        return splu(self._stiffness[self._inside][:, self._inside].tocsc())

    @cached_property
    def _pull(self) -> sp.csr_matrix:
        """Forces on the inside of moves of the outline."""
        return -self._stiffness[self._inside][:, self.outline_nodes]

    def _follow(self, outline_moves: np.ndarray) -> np.ndarray:
        """Moves of all nodes (n, 2) from those of the outline (k, 2)."""
        moves = np.zeros_like(self.drawn_points)
        moves[self.outline_nodes] = outline_moves
        moves[self._inside] = self._factor.solve(self._pull @ outline_moves)
        return moves


def _along(drawing: Drawing, curve: tuple[str, str], points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Which points lie on a curve, and their share of the way from its start to its end."""
    start, end, centre = _ends(drawing, curve)
    if drawing.curves[curve][0]:
        (x, y), (u, v) = points.T - centre[:, None], start - centre
        first, sweep = np.arctan2(v, u), _sweep(start - centre, end - centre)
        share = np.angle(np.exp(1j * (np.arctan2(y, x) - first))) / sweep
        off = np.abs(np.hypot(x, y) - np.hypot(u, v))
    else:
        way = end - start
        share = (points - start) @ way / (way @ way)
        off = np.hypot(*(points - start - share[:, None] * way).T)
    nodes = np.flatnonzero((off < _ON_CURVE) & (share > -1e-6) & (share < 1 + 1e-6))
    return nodes, share[nodes]


def _at(drawing: Drawing, curve: tuple[str, str], share: np.ndarray) -> np.ndarray:
    """Points (k, 2) at shares of the way along a curve."""
    start, end, centre = _ends(drawing, curve)
    if not drawing.curves[curve][0]:
        return start + share[:, None] * (end - start)
    u, v = start - centre
    angle = np.arctan2(v, u) + share * _sweep(start - centre, end - centre)
    return centre + np.hypot(u, v) * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def _ends(drawing: Drawing, curve: tuple[str, str]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Start, end and, of an arc, centre of a curve, (2,) each [m]."""
    start, end = (np.array(drawing.points[name][:2]) for name in curve)
    return start, end, np.array(drawing.centres.get(curve, (0.0, 0.0)))


def _sweep(start: np.ndarray, end: np.ndarray) -> float:
    """Angle from one direction to another, less than half a turn either way [rad]."""
    return float(np.arctan2(start[0] * end[1] - start[1] * end[0], start @ end))


def _areas(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Signed areas of triangles (3, e) with points (2, n)."""
    (ax, bx, cx), (ay, by, cy) = points[:, triangles]
    return ((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)) / 2
