"""The whole machine out of one solved sector: rotor turned to its angle, sectors copied around, A with its sign.

Cells are quadratic triangles in the order corners 0 1 2, then the middles of the edges 01 12 20, which is both
scikit-fem's and VTK's.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, singledispatch
from math import pi

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from figures.style import degrees, signed
from geometry.cross_section import CrossSection
from magnetostatics.case import FieldCase
from magnetostatics.currents import CoilCurrents, PhaseCurrents
from magnetostatics.elements import LINEAR, QUADRATIC, element_dofs, refine_order
from magnetostatics.fields_stage import NullFields
from magnetostatics.model import FieldSolution, OperatingPoint, OperatingState
from units import AMPERE_PER_SQUARE_MILLIMETRE, DEGREE

# Reference coordinates of the six nodes and the gradients of the six functions there (function, direction, node).
_NODES = np.array([[0, 1, 0, 0.5, 0.5, 0], [0, 0, 1, 0, 0.5, 0.5]], dtype=float)
_REFERENCE = QUADRATIC.gradients_at(_NODES)
_QUARTERS = np.array([[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]])  # a quadratic triangle as four straight ones
_SAME_PLACE = 1e-8  # m; nodes closer than that are one node
_NONE = "no current"


@dataclass(frozen=True, eq=False)
class Region:
    """Which cells belong to what: index (E,) into names."""

    index: np.ndarray
    names: tuple[str, ...]

    def cells_of(self, *prefixes: str) -> np.ndarray:
        """Cells of all regions whose name starts with one of the prefixes."""
        wanted = [i for i, name in enumerate(self.names) if name.startswith(prefixes)]
        return np.flatnonzero(np.isin(self.index, wanted))


@dataclass(frozen=True, eq=False)
class WholeField:
    """Field of a whole machine (or of one sector) as it stands in space.

    points (2, n) [m]; cells (6, E); a (n,) [Wb/m]; region of every cell; description of the operating point
    """

    points: np.ndarray
    cells: np.ndarray
    a: np.ndarray
    region: Region
    description: str

    @cached_property
    def areas(self) -> np.ndarray:
        """Area of every cell (E,) [m^2]."""
        (ux, uy), (vx, vy) = self._edges
        return np.abs(ux * vy - uy * vx) / 2

    @cached_property
    def flux_density(self) -> np.ndarray:
        """B (2, 6, E) [T] at the six nodes of every cell: (dA/dy, -dA/dx), straight from the quadratic potential."""
        (ux, uy), (vx, vy) = self._edges
        along_u, along_v = np.einsum("idk,ie->dke", _REFERENCE, self.a[self.cells])
        determinant = ux * vy - uy * vx
        return np.stack([along_v * ux - along_u * vx, along_v * uy - along_u * vy]) / determinant

    @cached_property
    def cell_flux_density(self) -> np.ndarray:
        """Mean B of every cell (2, E) [T]; B is linear in a cell, so it is the mean of the corners."""
        return self.flux_density[:, :3].mean(axis=1)

    @cached_property
    def smooth(self) -> SmoothField:
        """|B| and A on straight triangles, averaged at the nodes within each region only."""
        return _smooth(self)

    @property
    def _edges(self) -> tuple[np.ndarray, np.ndarray]:
        a, b, c = self.points[:, self.cells[:3]].transpose(1, 0, 2)
        return b - a, c - a


@dataclass(frozen=True, eq=False)
class SmoothField:
    """For drawing: points (2, n) [m], triangles (3, T), |B| (n,) [T], A (n,) [Wb/m], region (T,).

    Nodes on the border of two regions exist once for each, so nothing bleeds across it.
    """

    points: np.ndarray
    triangles: np.ndarray
    b: np.ndarray
    a: np.ndarray
    region: np.ndarray


def whole_field(solution: FieldSolution) -> WholeField:
    """The whole machine around a solution, rotor turned to its angle; nodes that meet are one node."""
    model, angle = solution.model, solution.point.angle
    a = refine_order(model.topology.facets, solution.a) if model.order is LINEAR else solution.a
    return copied_around(model.section, a, angle, model.unknowns.turn(angle).rest, describe(solution.point))


def null_field(fields: NullFields, case: FieldCase, state: str) -> WholeField:
    """The whole machine of a kept field, in one of ``magnetostatics.rotation.STATES``."""
    point = fields.point(state)
    return copied_around(fields.section(case), fields.potential(state), point.angle, fields.rest, describe(point))


def whole_geometry(section: CrossSection, angle: float = 0.0) -> WholeField:
    """The whole machine without a field (A = 0 everywhere), rotor at this mechanical angle [rad]."""
    _, size = element_dofs(section.mesh, QUADRATIC)
    return copied_around(section, np.zeros(size), angle, 0.0, "")


def copied_around(section: CrossSection, a: np.ndarray, angle: float, rest: float, description: str) -> WholeField:
    """The whole machine from the potential a (n,) [Wb/m] of the quadratic elements of a section.

    angle: of the rotor [rad]; rest: what is left of it between two nodes of the sliding circle [rad]
    """
    cells, _ = element_dofs(section.mesh, QUADRATIC)
    points = _nodes_in_space(section, cells, angle, rest)
    copies = range(section.sectors)
    all_points = np.hstack([_turn(points, k * 2 * pi / section.sectors) for k in copies])
    all_cells = np.hstack([cells + k * points.shape[1] for k in copies])
    first, node = _merge(all_points)
    signed = np.concatenate([section.sign**k * a for k in copies])
    return WholeField(all_points[:, first], node[all_cells], signed[first], whole_region(section), description)


def whole_region(section: CrossSection) -> Region:
    """Region of every cell of the whole machine; slots and magnets are counted on round the machine."""
    names, indices = list(section.mesh.subdomains), []
    one = np.empty(section.mesh.nelements, dtype=int)
    for number, cells in enumerate(section.mesh.subdomains.values()):
        one[cells] = number
    all_names: dict[str, int] = {}
    for k in range(section.sectors):
        numbers = [all_names.setdefault(_renamed(name, k, section), len(all_names)) for name in names]
        indices.append(np.array(numbers)[one])
    return Region(np.concatenate(indices), tuple(all_names))


def describe(point: OperatingState) -> str:
    """The operating point in words."""
    return f"rotor at {degrees(point.angle / DEGREE)}, {current_in_words(point)}"


@singledispatch
def current_in_words(point: OperatingState) -> str:
    """What flows, for each kind of operating state."""
    return "currents as given"


@current_in_words.register
def _(point: OperatingPoint) -> str:
    density = point.current_density / AMPERE_PER_SQUARE_MILLIMETRE
    return f"{density:.3f} A/mm² (peak), current angle {degrees(point.current_angle / DEGREE)}" if density else _NONE


@current_in_words.register
def _(point: PhaseCurrents) -> str:
    if not any(point.currents):
        return _NONE
    least = 1e-9 * max(map(abs, point.currents))  # rounding of a current that is none
    turns = (current * point.turns if abs(current) > least else 0.0 for current in point.currents)
    return ", ".join(signed(one, 4) for one in turns) + " ampere-turns in phases A, B, C"


@current_in_words.register
def _(point: CoilCurrents) -> str:
    largest = max(abs(turns) for turns in point.coil_ampere_turns)
    return f"coils with up to {largest:.4g} ampere-turns" if largest else _NONE


def _renamed(name: str, sector: int, section: CrossSection) -> str:
    """Name of a sector's region in copy ``sector``: slot_0_R of the second half of 12 slots is slot_6_R."""
    kind, *rest = name.split("_")
    if kind == "slot":
        return f"slot_{(int(rest[0]) + sector * section.teeth) % section.machine.slots}_{rest[1]}"
    if kind == "magnet":
        return f"magnet_{int(rest[0]) + sector * section.magnets}"
    return name


def _nodes_in_space(section: CrossSection, cells: np.ndarray, angle: float, rest: float) -> np.ndarray:
    """Corners and edge middles (2, n) [m] with the rotor turned.

    When the rotor stands between two nodes of the sliding circle, its side of the gap is sheared by ``rest`` so that
    both sides meet, exactly as in the solution.
    """
    corners = section.mesh.p.copy()
    moving = np.unique(section.mesh.t[:, section.rotor_elements])
    corners[:, moving] = _turn(section.rotor_gap.sheared(corners[:, moving], -rest), angle)
    points = np.empty((2, cells.max() + 1))
    points[:, : corners.shape[1]] = corners
    for middle, (start, end) in zip(cells[3:], ((0, 1), (1, 2), (2, 0)), strict=True):
        points[:, middle] = (corners[:, cells[start]] + corners[:, cells[end]]) / 2
    return points


def _turn(points: np.ndarray, angle: float) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s], [s, c]]) @ points


def _merge(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Of points (2, n): the first of each place (m,), and for every point the number of its place (n,)."""
    pairs = cKDTree(points.T).query_pairs(_SAME_PLACE, output_type="ndarray")
    links = coo_array((np.ones(len(pairs)), pairs.T), shape=(points.shape[1],) * 2)
    count, node = connected_components(links, directed=False)
    first = np.empty(count, dtype=int)
    first[node[::-1]] = np.arange(points.shape[1])[::-1]
    return first, node


def _smooth(field: WholeField) -> SmoothField:
    """Area-weighted mean of |B| over the cells of one region around each node."""
    region = np.broadcast_to(field.region.index, field.cells.shape)
    key = field.cells * len(field.region.names) + region
    distinct, node = np.unique(key, return_inverse=True)
    weight = np.broadcast_to(field.areas, field.cells.shape).ravel()
    b = np.hypot(*field.flux_density).ravel()
    mean = np.bincount(node.ravel(), weights=weight * b) / np.bincount(node.ravel(), weights=weight)
    source = distinct // len(field.region.names)
    triangles = node.reshape(field.cells.shape)[_QUARTERS].transpose(1, 0, 2).reshape(3, -1)
    return SmoothField(field.points[:, source], triangles, mean, field.a[source], np.tile(field.region.index, 4))
