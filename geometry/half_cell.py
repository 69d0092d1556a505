"""Half a slot pitch of the stator and half a pole pitch of the rotor: all that is ever meshed.

Every other part of a machine is a mirrored or turned copy (``geometry/cross_section.py``), so the mesh has exactly the
symmetry of the machine and costs the same for 9 or 48 slots. The two halves meet on the sliding circle in the middle
of the air gap, whose nodes are equally spaced; towards iron and magnets the gap is meshed in structured layers.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, lcm, pi

import numpy as np

from geometry.parts import DrawnMachine, Part, Rim, Rotor, Stator
from geometry.plane_mesh import Drawing, PlaneMesh, triangulate


@dataclass(frozen=True)
class MeshDensity:
    """How fine to mesh. The defaults hold torque to 0.2 % with quadratic elements: by consistent fluxes always, by the
    ring average of most machines, with 0.4 % at worst.

    gap_edges: least number of edges around the sliding circle
    longest_gap_edge: longest edge on the sliding circle, relative to the air gap
    gap_layers: structured layers between the sliding circle and the iron, on each side
    across_iron: number of elements across a tooth
    """

    gap_edges: int = 180
    longest_gap_edge: float = 1.25
    gap_layers: int = 2
    across_iron: float = 2.0

    def edges_around(self, machine: DrawnMachine) -> int:
        """Edges on the whole sliding circle: a whole number per half pitch of stator and rotor."""
        unit = lcm(2 * machine.slots, 2 * machine.repeats)
        return unit * ceil(self.edges_wanted(machine) / unit)

    def edges_wanted(self, machine: DrawnMachine) -> float:
        """Least number of edges around the sliding circle, by count and by their length."""
        return max(self.gap_edges, 2 * pi * machine.mid_gap_radius / (self.longest_gap_edge * machine.airgap))

    def gap_edge_length(self, machine: DrawnMachine) -> float:
        """Edge length on the sliding circle [m]."""
        return 2 * pi * machine.mid_gap_radius / self.edges_around(machine)


class HalfCell:
    """Half a pitch of stator or rotor: how it is drawn for a machine, and how it is meshed."""

    def __init__(self, density: MeshDensity, edges: int) -> None:
        self.density, self.edges = density, edges  # edges of the half pitch on the sliding circle

    def part(self, machine: DrawnMachine) -> Part:
        """The stator or the rotor of a machine."""
        raise NotImplementedError

    def width(self, machine: DrawnMachine) -> float:
        """Angle of the half pitch [rad]."""
        return self.part(machine).pitch / 2

    def rim_radius(self, machine: DrawnMachine) -> float:
        """Radius of the circle between the drawing and the structured gap layers [m]."""
        return self.part(machine).rim_radius

    def draw(self, machine: DrawnMachine) -> Drawing:
        """Outline of everything but the gap layers; the same points and curves for every machine."""
        density = self.density
        return self.part(machine).draw(Rim(self.edges, density.gap_edge_length(machine), density.across_iron))

    def mesh(self, machine: DrawnMachine) -> PlaneMesh:
        """Triangles of a machine, with the gap layers last."""
        drawn = triangulate(self.draw(machine))
        rim = drawn.nodes_at_radius(self.rim_radius(machine))
        points = np.vstack([drawn.points, self.gap_points(machine, drawn.points[rim])])
        grid = np.vstack([rim, np.arange(len(drawn.points), len(points)).reshape(self.density.gap_layers, -1)])
        triangles = _split_quads(grid)
        region = np.concatenate([drawn.region, np.full(len(triangles), len(drawn.region_names))])
        return PlaneMesh(points, np.vstack([drawn.triangles, triangles]), region, drawn.region_names + ("gap",))

    def gap_points(self, machine: DrawnMachine, rim: np.ndarray) -> np.ndarray:
        """Nodes [m], (n, 2), of the layers from the rim, whose nodes [m], (k, 2), are given by rising angle, to the
        sliding circle."""
        share = np.arange(1, self.density.gap_layers + 1)[:, None] / self.density.gap_layers
        equal = np.linspace(0, self.width(machine), self.edges + 1)
        angles = (1 - share) * np.arctan2(rim[:, 1], rim[:, 0]) + share * equal
        radius = self.rim_radius(machine)
        radii = radius + share * (machine.mid_gap_radius - radius)
        return np.stack([radii * np.cos(angles), radii * np.sin(angles)], axis=-1).reshape(-1, 2)


class StatorHalfCell(HalfCell):
    """From the axis of tooth 0 (angle 0) to the centre of slot 0."""

    def part(self, machine: DrawnMachine) -> Stator:
        return machine.stator


class RotorHalfCell(HalfCell):
    """From the axis of pole 0 to half a pitch of the rotor."""

    def part(self, machine: DrawnMachine) -> Rotor:
        return machine.rotor


def half_cells(machine: DrawnMachine, density: MeshDensity) -> tuple[StatorHalfCell, RotorHalfCell]:
    """The half cells of a machine at a mesh density."""
    edges = density.edges_around(machine)
    return StatorHalfCell(density, edges // (2 * machine.slots)), RotorHalfCell(density, edges // (2 * machine.repeats))


def _split_quads(grid: np.ndarray) -> np.ndarray:
    """Triangles of a structured grid of nodes (rows, columns), with alternating diagonals."""
    a, b, c, d = (x.ravel() for x in (grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]))
    rows, columns = np.indices((grid.shape[0] - 1, grid.shape[1] - 1)).reshape(2, -1)
    even = ((rows + columns) % 2 == 0)[:, None, None]
    one = np.stack([np.stack([a, b, c], 1), np.stack([a, c, d], 1)], 1)
    other = np.stack([np.stack([a, b, d], 1), np.stack([b, c, d], 1)], 1)
    return np.where(even, one, other).reshape(-1, 3)
