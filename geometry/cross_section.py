"""The meshed cross-section: the smallest sector of the machine, copied out of one stator and one rotor half cell.

Stator and rotor are two separate pieces of one mesh, both drawn at angle zero and not joined on the sliding circle in
the middle of the air gap: whoever solves on it joins them at the angle he wants, so that turning the rotor moves no
node.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from skfem import MeshTri

from geometry.checks import check_machine
from geometry.gap import GapHalf
from geometry.half_cell import HalfCell, MeshDensity, half_cells
from geometry.mesh_size import check_mesh_size
from geometry.parts import DrawnMachine, Rotor, Segment
from geometry.plane_mesh import PlaneMesh
from geometry.triangle_mesh import TriangleMesh
from geometry.winding import WindingLayout, sector_symmetric

_BESIDE_THE_LINE = 1e-6  # rad, small against any element
_WITHIN = 0.9  # of the width of narrow iron of the rotor, whose round borders are meshed as chords


@dataclass(frozen=True)
class Probe:
    """A straight segment over which |B| is averaged (thesis Fig. 3.17): points (2, n) [m], weights (n,), shares
    of the points in the mean (sum 1); iron: which subdomain it lies in."""

    name: str
    points: np.ndarray
    weights: np.ndarray
    iron: str = "stator_iron"


@dataclass(frozen=True)
class Assembly:
    """Where the parts stand that the defects of ``geometry.defects`` have moved; by default where they are drawn.

    stator_centre: of the stator, against the axis of rotation [m]
    rotor_centre: of the rotor, against the axis of rotation and turning with the rotor [m]
    magnet_turns: (number of the magnet, angle by which it has been turned about the rotor's centre [rad])
    """

    stator_centre: tuple[float, float] = (0.0, 0.0)
    rotor_centre: tuple[float, float] = (0.0, 0.0)
    magnet_turns: tuple[tuple[int, float], ...] = ()

    def magnet_turn(self, number: int) -> float:
        """Angle by which a magnet has been turned [rad]."""
        return sum(angle for which, angle in self.magnet_turns if which == number)


@dataclass(frozen=True)
class CrossSection:
    """One sector of a machine, meshed.

    mesh: triangles with subdomains ``stator_iron, rotor_iron, shaft, gap, opening, slot_<k>_<R|L>, magnet_<m>,
        between`` and boundaries ``outer, stator_start, stator_end, rotor_start, rotor_end, stator_slide, rotor_slide``
    sectors: how many such sectors make up the machine
    antiperiodic: True when the field changes sign from one sector to the next
    pieces: the half cells of stator and rotor that the mesh is copied from; none where it was refined or read
    assembly: where the parts stand that have been moved against each other
    """

    machine: DrawnMachine
    layout: WindingLayout
    mesh: MeshTri
    sectors: int
    antiperiodic: bool
    pieces: tuple[Piece, ...]
    assembly: Assembly = Assembly()

    @property
    def teeth(self) -> int:
        """Teeth (and slots) in the sector."""
        return self.machine.slots // self.sectors

    @property
    def poles(self) -> int:
        """Poles in the sector."""
        return self.machine.poles // self.sectors

    @property
    def rotor_pitches(self) -> int:
        """Equal pitches of the rotor in the sector: its poles, or half as many."""
        return self.machine.repeats // self.sectors

    @property
    def magnets(self) -> int:
        """Magnets in the sector."""
        return self.rotor_pitches * self.machine.rotor.magnets_per_pitch

    @property
    def coil_sides(self) -> tuple[tuple[int, str], ...]:
        """(slot, side) of every half slot in the sector, counter-clockwise; the first is of the slot before tooth 0."""
        return _coil_sides(self.machine.slots, 2 * self.teeth)

    @property
    def half_slots_per_coil_side(self) -> int:
        """A coil side fills half a slot in a double layer, both halves in a single layer."""
        return 3 - self.layout.layers

    @property
    def sign(self) -> int:
        """Factor of the vector potential from one sector to the next."""
        return -1 if self.antiperiodic else 1

    @property
    def stator_gap(self) -> GapHalf:
        """The gap between the sliding circle and the stator bore."""
        m = self.machine
        return GapHalf(m.mid_gap_radius, m.stator.rim_radius, self.assembly.stator_centre)

    @property
    def rotor_gap(self) -> GapHalf:
        """The gap between the sliding circle and the magnets, in the coordinates of the rotor."""
        m = self.machine
        return GapHalf(m.mid_gap_radius, m.rotor.rim_radius, self.assembly.rotor_centre)

    def magnetisation_angle(self, number: int, points: np.ndarray) -> np.ndarray:
        """Angle of the magnetisation of a magnet [rad], (...), taken outwards, at points of the rotor [m], (2, ...).

        number: of the magnet
        """
        (x, y), rotor = self.assembly.rotor_centre, self.machine.rotor
        pitch, which = divmod(number, rotor.magnets_per_pitch)
        axis = pitch * rotor.pitch + self.assembly.magnet_turn(number)
        return rotor.direction(np.arctan2(points[1] - y, points[0] - x), axis, which)

    def polarity(self, number: int) -> int:
        """1 for a magnet of an outward pole, -1 for one of an inward pole, dimensionless."""
        pitch = number // self.machine.rotor.magnets_per_pitch
        return 1 - 2 * (pitch % 2) if self.machine.half_wave else 1

    @cached_property
    def rotor_elements(self) -> np.ndarray:
        """Whether each element turns with the rotor (E,): all on its side of the middle of the air gap."""
        centroids = self.mesh.p[:, self.mesh.t].mean(axis=1)
        inside = np.hypot(*centroids) < self.machine.mid_gap_radius
        return inside if self.machine.rotor.rim_radius < self.machine.mid_gap_radius else ~inside

    @property
    def rotor_band(self) -> np.ndarray:
        """Indices (k,) of the elements of the gap on the rotor side of the sliding circle."""
        gap = self.mesh.subdomains["gap"]
        return gap[self.rotor_elements[gap]]

    @cached_property
    def half_slot_area(self) -> float:
        """Area of one coil side as meshed [m^2]; the median, so that a defect of one slot does not count."""
        sides = [self.mesh.subdomains[f"slot_{slot}_{side}"] for slot, side in self.coil_sides]
        areas = _triangle_areas(self.mesh, np.concatenate(sides))
        first = np.cumsum([0, *map(len, sides[:-1])])
        return float(np.median(np.add.reduceat(areas, first)))

    @cached_property
    def tooth_probes(self) -> tuple[Probe, ...]:
        """Across each tooth, tooth 0 first."""
        m = self.machine
        points, weights = _segment(*m.stator.tooth_probe)
        return tuple(Probe(f"tooth_{k}", _turn(points, k * m.slot_pitch), weights) for k in range(self.teeth))

    @cached_property
    def back_iron_probes(self) -> tuple[Probe, ...]:
        """Radially through the back iron behind each slot, slot 0 first.

        The segment is an edge line of the mesh, where the tangential field of two elements differs: both sides count
        half.
        """
        m = self.machine
        points, weights = _segment(*m.stator.back_iron_probe)
        weights = np.concatenate([weights, weights]) / 2
        beyond = _BESIDE_THE_LINE - (self.teeth * m.slot_pitch if self.sectors > 1 else 0.0)
        sides = [(-_BESIDE_THE_LINE, _BESIDE_THE_LINE)] * (self.teeth - 1) + [(-_BESIDE_THE_LINE, beyond)]
        return tuple(
            Probe(
                f"back_iron_{k}", np.hstack([_turn(points, (k + 0.5) * m.slot_pitch + side) for side in pair]), weights
            )
            for k, pair in enumerate(sides)
        )

    @cached_property
    def rotor_probes(self) -> tuple[Probe, ...]:
        """Across narrow iron of the rotor, where it stands as drawn, all of one name by rising angle."""
        drawn = self.machine.rotor.probes
        return tuple(probe for name, segment in drawn.items() for probe in self._alike(name, segment))

    def _alike(self, name: str, segment: Segment) -> Iterator[Probe]:
        """In every pitch of the sector; what lies beside the axis of a pole lies there on both sides."""
        points, weights = _segment(*segment)
        points = _WITHIN * points + (1 - _WITHIN) * np.mean(segment, axis=0)[:, None]
        mirrored = points * np.array([[1.0], [-1.0]])
        sides = (points,) if np.allclose(mirrored[:, ::-1], points) else (mirrored, points)
        places = (_turn(side, k * self.machine.rotor.pitch) for k in range(self.rotor_pitches) for side in sides)
        return (Probe(f"{name}_{k}", place, weights, "rotor_iron") for k, place in enumerate(places))


def mesh_cross_section(
    machine: DrawnMachine, layout: WindingLayout, density: MeshDensity = MeshDensity(), whole: bool = False
) -> CrossSection:
    """Mesh the smallest sector that field and winding repeat on, or the whole machine.

    Raises GeometryError when the machine cannot be built (see ``geometry/checks.py``) or its mesh would be too large.
    """
    check_machine(machine)
    sectors = 1 if whole or not sector_symmetric(layout, machine.sectors, machine.is_antiperiodic) else machine.sectors
    check_mesh_size(machine, density, sectors)
    antiperiodic = sectors > 1 and machine.is_antiperiodic
    counts = 2 * machine.slots // sectors, 2 * machine.repeats // sectors
    cells = half_cells(machine, density)
    stator, rotor = (Piece.of(cell, machine, count, sectors == 1) for cell, count in zip(cells, counts))
    return CrossSection(machine, layout, _join(stator, rotor, machine, sectors), sectors, antiperiodic, (stator, rotor))


@dataclass(frozen=True, eq=False)
class Piece:
    """Stator or rotor of a sector: a half cell, mirrored and turned ``count`` times from half a pitch below its ray on.

    Copy h covers the angles (h - 1) width .. h width beyond the ray; even copies are mirrored. Nodes on shared rays are
    shared.
    cell, mesh: the half cell and its triangles
    nodes: index in the piece of every half-cell node in every copy (count, n)
    """

    cell: HalfCell
    mesh: PlaneMesh
    nodes: np.ndarray
    width: float
    ray: float  # angle of the axis of copies 0 and 1 [rad]

    @classmethod
    def of(cls, cell: HalfCell, machine: DrawnMachine, count: int, closed: bool) -> Piece:
        """Mesh a half cell and number its copies; closed: the last copy meets the first."""
        mesh, width = cell.mesh(machine), cell.width(machine)
        ray = cell.part(machine).first_ray
        return cls(cell, mesh, _shared_numbering(mesh, width, count, closed), width, ray)

    @property
    def count(self) -> int:
        """Number of half cells."""
        return len(self.nodes)

    def place(self, points: np.ndarray) -> np.ndarray:
        """Points of the piece [m], (2, m), from the points of the half cell [m], (n, 2)."""
        placed = np.empty((2, self.nodes.max() + 1))
        for h, nodes in enumerate(self.nodes):
            placed[:, nodes] = _place(points, h, self.width, self.ray).T
        return placed

    def place_copies(self, points: np.ndarray, copies: Iterable[int]) -> tuple[np.ndarray, np.ndarray]:
        """Points of the half cell in some copies: [m], (2, k), and node indices (k,); points or moves [m], (n, 2)."""
        copies = [h % self.count for h in copies]
        placed = np.hstack([_place(points, h, self.width, self.ray).T for h in copies])
        return placed, np.concatenate([self.nodes[h] for h in copies])

    @cached_property
    def triangles(self) -> np.ndarray:
        """Node indices of the triangles of the piece (3, m), counter-clockwise, copy by copy."""
        points = self.place(self.mesh.points).T
        return _counter_clockwise(points, self.nodes[:, self.mesh.triangles].reshape(-1, 3)).T

    @property
    def region(self) -> np.ndarray:
        """Region index of every triangle (m,)."""
        return np.tile(self.mesh.region, self.count)

    @property
    def copy(self) -> np.ndarray:
        """Number of the half cell that every triangle belongs to."""
        return np.repeat(np.arange(self.count), len(self.mesh.triangles))

    @property
    def start(self) -> np.ndarray:
        """Indices (k,) of the nodes on the first ray, outwards."""
        return self.nodes[0][self.mesh.nodes_at_angle(self.width)]

    @property
    def end(self) -> np.ndarray:
        """Indices (k,) of the nodes on the last ray, outwards."""
        return self.nodes[-1][self.mesh.nodes_at_angle(self.width)]


def _place(points: np.ndarray, copy: int, width: float, ray: float) -> np.ndarray:
    """Half-cell points moved to their place in copy h."""
    mirrored = points * np.array([1.0, -1.0]) if copy % 2 == 0 else points
    return _turn(mirrored.T, ray + (copy // 2) * 2 * width).T


def _shared_numbering(cell: PlaneMesh, width: float, count: int, closed: bool) -> np.ndarray:
    """Node number of every half-cell node in every copy (count, n); neighbours share the nodes on their common ray."""
    on_axis, on_edge = cell.nodes_at_angle(0.0), cell.nodes_at_angle(width)
    size = len(cell.points)
    nodes = np.arange(count * size).reshape(count, size)
    for h in range(1, count):
        shared = on_axis if h % 2 == 1 else on_edge
        nodes[h, shared] = nodes[h - 1, shared]
    if closed:
        nodes[-1, on_edge] = nodes[0, on_edge]
    at_origin = np.flatnonzero(np.hypot(*cell.points.T) < 1e-12)
    nodes[:, at_origin] = nodes[0, at_origin]
    return np.unique(nodes, return_inverse=True)[1].reshape(count, size)


def _counter_clockwise(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    a, b, c = points[triangles.T]
    clockwise = _cross(b - a, c - a) < 0
    return np.where(clockwise[:, None], triangles[:, ::-1], triangles)


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]


def _join(stator: Piece, rotor: Piece, machine: DrawnMachine, sectors: int) -> MeshTri:
    points = [piece.place(piece.mesh.points) for piece in (stator, rotor)]
    offset, first_rotor_triangle = points[0].shape[1], stator.triangles.shape[1]
    triangles = np.ascontiguousarray(np.hstack([stator.triangles, rotor.triangles + offset]))
    mesh = TriangleMesh(np.hstack(points), triangles, sort_t=False, validate=False)
    names = _stator_names(stator, machine.slots)
    for name, where in _rotor_names(rotor, machine.rotor).items():
        where = where + first_rotor_triangle
        names[name] = np.concatenate([names[name], where]) if name in names else where
    mesh = mesh.with_subdomains(names)
    return mesh.with_boundaries(_boundaries(mesh, stator, rotor, machine, sectors))


def _regions(piece: Piece) -> dict[str, np.ndarray]:
    return {name: np.flatnonzero(piece.region == index) for index, name in enumerate(piece.mesh.region_names)}


def _stator_names(stator: Piece, slots: int) -> dict[str, np.ndarray]:
    regions = _regions(stator)
    copper = regions.pop("copper")
    sides = _coil_sides(slots, stator.count)
    coils = {f"slot_{slot}_{side}": copper[stator.copy[copper] == h] for h, (slot, side) in enumerate(sides)}
    return {"stator_iron": regions.pop("iron")} | regions | coils


def _coil_sides(slots: int, half_cells: int) -> tuple[tuple[int, str], ...]:
    """(slot, side) of every half cell: odd h = 2k+1 is side R of slot k, even h = 2k is side L of slot k-1."""
    return tuple(((h - 1) // 2, "R") if h % 2 else ((h // 2 - 1) % slots, "L") for h in range(half_cells))


def _rotor_names(piece: Piece, rotor: Rotor) -> dict[str, np.ndarray]:
    """A magnet on the axis of a pole has a half in each of two copies, beside it there are as many in every copy as the
    half pitch has regions of magnets."""
    regions = _regions(piece)
    drawn = [regions.pop(name) for name in rotor.magnet_regions]
    magnets: dict[str, np.ndarray] = {}
    for number in range(piece.count * rotor.magnets_per_pitch // 2):
        first, layer = divmod(number, len(drawn))
        copies = piece.copy[drawn[layer]] if rotor.magnets_per_pitch > 1 else piece.copy[drawn[layer]] // 2
        magnets[f"magnet_{number}"] = drawn[layer][copies == first]
    return {"rotor_iron": regions.pop("iron")} | regions | magnets


def _boundaries(
    mesh: MeshTri, stator: Piece, rotor: Piece, machine: DrawnMachine, sectors: int
) -> dict[str, np.ndarray]:
    offset = stator.nodes.max() + 1
    radius = np.hypot(*mesh.p)
    is_rotor = np.arange(mesh.p.shape[1]) >= offset
    on_slide = np.abs(radius - machine.mid_gap_radius) < 1e-9
    sets = {
        "outer": _on_circles(radius, (machine.stator.grounded_radius, machine.rotor.grounded_radius)),
        "stator_slide": on_slide & ~is_rotor,
        "rotor_slide": on_slide & is_rotor,
    }
    if sectors > 1:
        rays = {"stator_start": stator.start, "stator_end": stator.end}
        rays |= {"rotor_start": offset + rotor.start, "rotor_end": offset + rotor.end}
        sets |= {name: np.isin(np.arange(mesh.p.shape[1]), nodes) for name, nodes in rays.items()}
    facets = np.flatnonzero(np.bincount(mesh.t2f.ravel()) == 1)
    a, b = mesh.facets[:, facets]
    return {name: facets[inside[a] & inside[b]] for name, inside in sets.items()}


def _on_circles(radius: np.ndarray, circles: Iterable[float | None]) -> np.ndarray:
    """Whether each radius is that of one of the circles there are."""
    return np.any([np.abs(radius - circle) < 1e-9 for circle in circles if circle is not None], axis=0)


def _triangle_areas(mesh: MeshTri, which: np.ndarray) -> np.ndarray:
    (ax, bx, cx), (ay, by, cy) = mesh.p[:, mesh.t[:, which]]
    return np.abs((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)) / 2


def _turn(points: np.ndarray, angle: float) -> np.ndarray:
    """Points (2, n) turned counter-clockwise by an angle [rad] about the origin."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s], [s, c]]) @ points


@lru_cache
def _gauss_points(count: int) -> tuple[np.ndarray, np.ndarray]:
    return np.polynomial.legendre.leggauss(count)


def _segment(start: tuple[float, float], end: tuple[float, float], points: int = 12) -> tuple[np.ndarray, np.ndarray]:
    """Gauss points (2, n) and weights (n,) of the average over a straight segment."""
    nodes, weights = _gauss_points(points)
    first, last = np.array(start)[:, None], np.array(end)[:, None]
    return first + (last - first) * (nodes + 1) / 2, weights / 2
