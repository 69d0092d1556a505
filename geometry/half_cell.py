"""Half a slot pitch of the stator and half a pole pitch of the rotor: all that is ever meshed.

Every other part of a machine is a mirrored or turned copy (``geometry/cross_section.py``), so the mesh has exactly the
symmetry of the machine and costs the same for 9 or 48 slots. The two halves meet on the sliding circle in the middle
of the air gap, whose nodes are equally spaced; towards iron and magnets the gap is meshed in structured layers.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import asin, ceil, lcm, pi

import numpy as np

from geometry.machine import Machine
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

    def edges_around(self, machine: Machine) -> int:
        """Edges on the whole sliding circle: a whole number per half slot pitch and per half pole pitch."""
        unit = lcm(2 * machine.slots, 2 * machine.poles)
        return unit * ceil(self.edges_wanted(machine) / unit)

    def edges_wanted(self, machine: Machine) -> float:
        """Least number of edges around the sliding circle, by count and by their length."""
        return max(self.gap_edges, 2 * pi * machine.mid_gap_radius / (self.longest_gap_edge * machine.airgap))

    def gap_edge_length(self, machine: Machine) -> float:
        """Edge length on the sliding circle [m]."""
        return 2 * pi * machine.mid_gap_radius / self.edges_around(machine)

    def in_tooth(self, machine: Machine) -> float:
        """Edge length in a tooth [m]. A back iron thinner than half a tooth refines it, though not without end."""
        width = machine.tooth_width
        return min(width, max(2 * machine.back_iron_width, width / 2)) / self.across_iron

    def in_yoke(self, machine: Machine) -> float:
        """Edge length in the back iron and at the bottom of the slot [m]; a thin tooth does not refine them."""
        return min(max(machine.tooth_width, machine.back_iron_width), 2 * machine.back_iron_width) / self.across_iron


class HalfCell:
    """Half a pitch of stator or rotor: how it is drawn for a machine, and how it is meshed."""

    def __init__(self, density: MeshDensity, edges: int) -> None:
        self.density, self.edges = density, edges  # edges of the half pitch on the sliding circle

    def width(self, machine: Machine) -> float:
        """Angle of the half pitch [rad]."""
        raise NotImplementedError

    def rim_radius(self, machine: Machine) -> float:
        """Radius of the circle between the drawing and the structured gap layers [m]."""
        raise NotImplementedError

    def draw(self, machine: Machine) -> Drawing:
        """Outline of everything but the gap layers; the same points and curves for every machine."""
        raise NotImplementedError

    def mesh(self, machine: Machine) -> PlaneMesh:
        """Triangles of a machine, with the gap layers last."""
        drawn = triangulate(self.draw(machine))
        rim = drawn.nodes_at_radius(self.rim_radius(machine))
        points = np.vstack([drawn.points, self.gap_points(machine, drawn.points[rim])])
        grid = np.vstack([rim, np.arange(len(drawn.points), len(points)).reshape(self.density.gap_layers, -1)])
        triangles = _split_quads(grid)
        region = np.concatenate([drawn.region, np.full(len(triangles), len(drawn.region_names))])
        return PlaneMesh(points, np.vstack([drawn.triangles, triangles]), region, drawn.region_names + ("gap",))

    def gap_points(self, machine: Machine, rim: np.ndarray) -> np.ndarray:
        """Nodes [m], (n, 2), of the layers from the rim, whose nodes [m], (k, 2), are given by rising angle, to the
        sliding circle."""
        share = np.arange(1, self.density.gap_layers + 1)[:, None] / self.density.gap_layers
        equal = np.linspace(0, self.width(machine), self.edges + 1)
        angles = (1 - share) * np.arctan2(rim[:, 1], rim[:, 0]) + share * equal
        radius = self.rim_radius(machine)
        radii = radius + share * (machine.mid_gap_radius - radius)
        return np.stack([radii * np.cos(angles), radii * np.sin(angles)], axis=-1).reshape(-1, 2)


class StatorHalfCell(HalfCell):
    """From the axis of tooth 0 (angle 0) to the centre of slot 0; regions iron, opening, copper, gap."""

    def width(self, machine: Machine) -> float:
        return machine.slot_pitch / 2

    def rim_radius(self, machine: Machine) -> float:
        return machine.stator_inner_radius

    def draw(self, machine: Machine) -> Drawing:
        return _draw_stator(machine, self.density, self.edges)


class RotorHalfCell(HalfCell):
    """From the axis of magnet 0 to half a pole pitch; regions shaft, iron, magnet, (between,) gap."""

    def width(self, machine: Machine) -> float:
        return machine.pole_pitch / 2

    def rim_radius(self, machine: Machine) -> float:
        return machine.rotor_outer_radius

    def draw(self, machine: Machine) -> Drawing:
        return _draw_rotor(machine, self.density, self.edges)


def half_cells(machine: Machine, density: MeshDensity) -> tuple[StatorHalfCell, RotorHalfCell]:
    """The half cells of a machine at a mesh density."""
    edges = density.edges_around(machine)
    return StatorHalfCell(density, edges // (2 * machine.slots)), RotorHalfCell(density, edges // (2 * machine.poles))


def _draw_stator(m: Machine, density: MeshDensity, edges: int) -> Drawing:
    d = Drawing()
    _stator_points(d, m, density)
    taper = ("tip_top", "taper") if m.taper_touches_shoe else ("tip_top",)
    _stator_edges(d, m, edges, taper)
    tooth_side = (*taper, "shoe_top", "flank_middle", "flank_end")
    d.region("iron", "bore", "tip", *tooth_side, "bottom", "outer_slot", "outer", "shoe_axis")
    d.region("opening", "tip", "bore_slot", "open_slot", "tip_top")
    d.region("copper", "open_slot", "shoe_slot", "slot_middle", "bottom", *reversed(tooth_side))
    return d


def _stator_points(d: Drawing, m: Machine, density: MeshDensity) -> None:
    """From the bore outwards, on the axis of the tooth, on its side and on the axis of the slot."""
    fine, in_tooth, in_yoke = density.gap_edge_length(m), density.in_tooth(m), density.in_yoke(m)
    in_shoe, axis = min(4 * fine, in_tooth), m.slot_pitch / 2
    r_si, r_shoe, r_sb, r_so = m.stator_inner_radius, m.shoe_top_radius, m.slot_bottom_radius, m.stator_outer_radius
    d.point("bore", r_si, 0, 2 * fine)  # the edges on the bore are set by their number
    d.point("tip", r_si, _tip_angle(m), fine)
    d.point("bore_slot", r_si, axis, 2 * fine)
    d.point("tip_top", m.opening_top_radius, m.opening_top_angle, min(3 * fine, m.shoe_d1))
    d.point("open_slot", m.opening_top_radius, axis, 3 * fine)
    d.point("shoe_top", r_shoe, asin(m.tooth_width / 2 / r_shoe), in_shoe)
    d.point("shoe_axis", r_shoe, 0, 1.5 * in_tooth)
    d.point("shoe_slot", r_shoe, axis, in_yoke)
    d.point("flank_end", r_sb, asin(m.tooth_width / 2 / r_sb), 0.5 * in_tooth)
    d.point("bottom", r_sb, axis, in_yoke)
    d.point("outer_slot", r_so, axis, in_yoke)
    d.point("outer", r_so, 0, in_yoke)
    middle = (r_shoe + r_sb) / 2
    d.point("flank_middle", middle, asin(m.tooth_width / 2 / middle), in_tooth)
    d.point("slot_middle", middle, axis, min(2 * in_yoke, (r_sb - r_shoe) / 2))
    if m.taper_touches_shoe:
        d.point("taper", m.opening_top_radius, m.taper_angle, min(3 * fine, in_shoe))


def _tip_angle(m: Machine) -> float:
    """Of the edge of the shoe at the bore, from the axis of the tooth [rad]."""
    return m.slot_pitch / 2 - asin(m.opening_width / 2 / m.stator_inner_radius)


def _stator_edges(d: Drawing, m: Machine, edges: int, taper: tuple[str, ...]) -> None:
    """Lines and arcs; edges: of the mesh along the bore of half a slot pitch"""
    opening = min(max(2, round(edges * (1 - _tip_angle(m) / (m.slot_pitch / 2)))), edges - 1)
    d.arc("bore", "tip", edges - opening)
    d.arc("tip", "bore_slot", opening)
    if len(taper) > 1:
        d.arc(taper[0], taper[1])
    d.line("tip", "tip_top")
    d.path(taper[-1], "shoe_top", "flank_middle", "flank_end")
    d.arc("tip_top", "open_slot")
    d.arc("flank_end", "bottom")
    d.path("bore_slot", "open_slot", "shoe_slot", "slot_middle", "bottom", "outer_slot")
    d.arc("outer", "outer_slot")
    d.path("bore", "shoe_axis", "outer")


def _draw_rotor(m: Machine, density: MeshDensity, edges: int) -> Drawing:
    fine = density.gap_edge_length(m)
    half_pole = m.pole_pitch / 2
    coarse = m.rotor_core_radius * half_pole
    under_magnet = min(3 * fine, m.magnet_length)
    half_magnet = m.magnet_arc_fraction * half_pole
    covers_pole = m.magnet_arc_fraction >= 1
    magnet_edges = edges if covers_pole else min(max(1, round(edges * m.magnet_arc_fraction)), edges - 1)
    d = Drawing()
    d.point("centre", 0, 0, coarse)
    for name, radius, size in (("shaft", m.shaft_radius, coarse), ("core", m.rotor_core_radius, under_magnet)):
        d.point(name, radius, 0, size)
        d.point(f"{name}_pole", radius, half_pole, size)
    d.point("top", m.rotor_outer_radius, 0, 3 * fine)  # the edges around the rotor are set below
    d.point("top_edge", m.rotor_outer_radius, half_magnet, 3 * fine)
    d.line("centre", "shaft")
    d.line("centre", "shaft_pole")
    d.arc("shaft", "shaft_pole")
    d.line("shaft", "core")
    d.line("shaft_pole", "core_pole")
    d.line("core", "top", max(1, round(m.magnet_length / (6 * fine))))
    d.arc("top", "top_edge", magnet_edges)
    d.region("shaft", "centre", "shaft", "shaft_pole")
    if covers_pole:
        d.arc("core", "core_pole")
        d.line("core_pole", "top_edge")
        d.region("iron", "shaft", "core", "core_pole", "shaft_pole")
        d.region("magnet", "core", "top", "top_edge", "core_pole")
        return d
    d.point("core_edge", m.rotor_core_radius, half_magnet, under_magnet)
    d.point("top_pole", m.rotor_outer_radius, half_pole, 3 * fine)
    d.arc("core", "core_edge")
    d.arc("core_edge", "core_pole")
    d.line("core_edge", "top_edge")
    d.line("core_pole", "top_pole")
    d.arc("top_edge", "top_pole", edges - magnet_edges)
    d.region("iron", "shaft", "core", "core_edge", "core_pole", "shaft_pole")
    d.region("magnet", "core", "top", "top_edge", "core_edge")
    d.region("between", "core_edge", "top_edge", "top_pole", "core_pole")
    return d


def _split_quads(grid: np.ndarray) -> np.ndarray:
    """Triangles of a structured grid of nodes (rows, columns), with alternating diagonals."""
    a, b, c, d = (x.ravel() for x in (grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]))
    rows, columns = np.indices((grid.shape[0] - 1, grid.shape[1] - 1)).reshape(2, -1)
    even = ((rows + columns) % 2 == 0)[:, None, None]
    one = np.stack([np.stack([a, b, c], 1), np.stack([a, c, d], 1)], 1)
    other = np.stack([np.stack([a, b, d], 1), np.stack([b, c, d], 1)], 1)
    return np.where(even, one, other).reshape(-1, 3)
