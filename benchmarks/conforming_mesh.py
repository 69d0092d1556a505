"""A meshed cross-section with its rotor turned in space, as one conforming mesh that any other code can read.

The solver keeps stator and rotor apart and joins them by index. Here the rotor's nodes are moved to their place and
merged with those of the stator, so that the other codes see the same triangles without knowing about the sliding
circle. A sector of a turned machine has a step in its two sides: the part of the sliding circle that only one of the
two pieces reaches belongs to them, and a side is the image of the other, turned by the angle of one sector.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import pi

import numpy as np
from scipy.spatial import cKDTree

from geometry.cross_section import CrossSection
from geometry.parts import DrawnMachine
from magnetostatics.elements import LINEAR
from magnetostatics.unknowns import number_unknowns

_SAME_PLACE = 1e-9  # m, far below any edge and far above rounding


@dataclass(frozen=True, eq=False)
class ConformingMesh:
    """Triangles of one sector, or of the whole machine, with the rotor at ``angle``.

    points (n, 2) [m]; triangles (m, 3), counter-clockwise, or (m, 6) with the middles of the edges 01, 12, 20 behind
    region (m,): index into region_names
    outer, first_side, second_side (k, 2) or (k, 3): edges; on the first the potential is zero; second_side[i] is
        first_side[i] turned by one sector
    sector_angle [rad], 2 pi for a whole machine; sign: of the potential from first_side to second_side
    """

    points: np.ndarray
    triangles: np.ndarray
    region: np.ndarray
    region_names: tuple[str, ...]
    outer: np.ndarray
    first_side: np.ndarray
    second_side: np.ndarray
    sector_angle: float
    sign: int
    angle: float

    @property
    def is_quadratic(self) -> bool:
        """Whether the middles of the edges are nodes."""
        return self.triangles.shape[1] == 6

    @property
    def corners(self) -> int:
        """Number of points that are corners of triangles; they come first."""
        return int(self.triangles[:, :3].max()) + 1


def conforming_mesh(section: CrossSection, angle: float) -> ConformingMesh:
    """One mesh of linear triangles with the rotor turned by an angle [rad] that brings nodes onto nodes.

    Raises ValueError at an angle between two nodes.
    """
    _check_angle(section, angle)
    placed = _placed_points(section, angle)
    points, merged = merge(placed)
    region, names = _regions(section)
    triangles = merged[section.mesh.t.T]
    edges = _boundary_edges(triangles)
    is_outer = _is_outer(points[edges], section.machine)
    width = 2 * pi / section.sectors
    first, second = _sides(points, edges[~is_outer], (width - section.machine.slot_pitch) / 2, width)
    return ConformingMesh(points, triangles, region, names, edges[is_outer], first, second, width, section.sign, angle)


def quadratic(mesh: ConformingMesh) -> ConformingMesh:
    """The same mesh with a node in the middle of every edge."""
    corners = mesh.triangles
    pairs = np.sort(np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]), axis=1)
    edges, number = np.unique(pairs, axis=0, return_inverse=True)
    middle = len(mesh.points) + number.reshape(3, -1).T
    lookup = {tuple(edge): len(mesh.points) + i for i, edge in enumerate(edges.tolist())}

    def with_middles(lines):
        middles = [lookup[tuple(sorted(line))] for line in lines.tolist()]
        return np.column_stack([lines, np.array(middles, dtype=int)])

    return replace(
        mesh,
        points=np.vstack([mesh.points, mesh.points[edges].mean(axis=1)]),
        triangles=np.hstack([corners, middle]),
        outer=with_middles(mesh.outer),
        first_side=with_middles(mesh.first_side),
        second_side=with_middles(mesh.second_side),
    )


def _check_angle(section: CrossSection, angle: float) -> None:
    rest = number_unknowns(section, LINEAR).turn(angle).rest
    if rest != 0.0:
        raise ValueError(f"at the rotor angle {angle} rad the nodes are {rest} rad apart; take one at which they meet")


def _placed_points(section: CrossSection, angle: float) -> np.ndarray:
    """Nodes (n, 2) with those of the rotor turned."""
    mesh = section.mesh
    is_rotor = np.zeros(mesh.p.shape[1], dtype=bool)
    is_rotor[mesh.t[:, _rotor_triangles(section)]] = True
    turned = np.exp(1j * angle) * (mesh.p[0] + 1j * mesh.p[1])
    return np.where(is_rotor, [turned.real, turned.imag], mesh.p).T


def _rotor_triangles(section: CrossSection) -> np.ndarray:
    return np.flatnonzero(section.rotor_elements)


def merge(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Points without duplicates (n', 2) and the new number of every old point (n,)."""
    _, first, number = np.unique(_first_at_same_place(points), return_index=True, return_inverse=True)
    return points[first], number


def _first_at_same_place(points: np.ndarray) -> np.ndarray:
    """Lowest number of the points at the same place (n,)."""
    lowest = np.arange(len(points))
    for a, b in cKDTree(points).query_pairs(_SAME_PLACE):
        lowest[max(a, b)] = min(a, b, lowest[max(a, b)])
    return lowest


def _regions(section: CrossSection) -> tuple[np.ndarray, tuple[str, ...]]:
    """Region of every triangle; the gap is split at the sliding circle, for torque integrals over one half."""
    names = list(section.mesh.subdomains)
    region = np.empty(section.mesh.nelements, dtype=int)
    for index, name in enumerate(names):
        region[section.mesh.subdomains[name]] = index
    rotor_gap = np.intersect1d(_rotor_triangles(section), section.mesh.subdomains["gap"])
    region[rotor_gap] = len(names)
    names[names.index("gap")] = "stator_gap"
    return region, (*names, "rotor_gap")


def _boundary_edges(triangles: np.ndarray) -> np.ndarray:
    """Edges (k, 2) that belong to one triangle only."""
    edges = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    distinct, count = np.unique(edges, axis=0, return_counts=True)
    return distinct[count == 1]


def _is_outer(ends: np.ndarray, machine: DrawnMachine) -> np.ndarray:
    """Whether the edges (k, 2, 2) lie on a circle where the potential is zero."""
    circles = machine.stator.grounded_radius, machine.rotor.grounded_radius
    return np.any([_on_circle(ends, radius) for radius in circles if radius is not None], axis=0)


def _on_circle(ends: np.ndarray, radius: float) -> np.ndarray:
    """Whether both ends of the edges (k, 2, 2) lie on a circle [m]."""
    return (np.abs(np.hypot(*ends.T) - radius) < _SAME_PLACE).all(axis=0)


def _sides(points: np.ndarray, edges: np.ndarray, middle: float, width: float) -> tuple[np.ndarray, np.ndarray]:
    """Split the sides of a sector into edges on the clockwise side and their images, turned by one sector.

    middle: angle of the middle of the stator's sector [rad]; width: of the sector [rad]
    """
    place = points @ np.array([1, 1j])
    is_first = np.angle(place[edges].sum(axis=1) * np.exp(-1j * middle)) < 0
    first, others = edges[is_first], np.unique(edges[~is_first])
    if not len(edges):
        return first, first
    distance, partner = cKDTree(points[others]).query(_as_points(place[first] * np.exp(1j * width)))
    if distance.max() > _SAME_PLACE or 2 * len(first) != len(edges):
        raise ValueError(f"the sides of the sector do not match: {len(first)} of {len(edges)} edges are on the first")
    return first, others[partner]


def _as_points(place: np.ndarray) -> np.ndarray:
    """Complex numbers (...) as points (..., 2)."""
    return np.stack([place.real, place.imag], axis=-1)
