"""Triangulate a few plane regions bounded by straight lines and arcs about the origin. The only user of gmsh."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import cos, sin

import gmsh
import numpy as np

from geometry.errors import GeometryError
from geometry.signal_handlers import kept_signal_handlers

_FRONTAL_DELAUNAY = 6  # gmsh's number for the algorithm that gives the best-shaped triangles


@dataclass
class Drawing:
    """Points, curves and regions of one drawing, to be triangulated by ``triangulate``.

    Points carry the wanted edge length [m]; a curve may carry a fixed number of equal edges instead.
    """

    points: dict[str, tuple[float, float, float]] = field(default_factory=dict)  # x, y, edge length [m]
    curves: dict[tuple[str, str], tuple[bool, int | None]] = field(default_factory=dict)  # is_arc, number of edges
    centres: dict[tuple[str, str], tuple[float, float]] = field(default_factory=dict)  # of arcs [m]
    regions: dict[str, list[tuple[str, ...]]] = field(default_factory=dict)  # corner points of each face in order

    def point(self, name: str, radius: float, angle: float, edge_length: float) -> str:
        """Add a point in polar coordinates [m, rad] and return its name."""
        self.points[name] = (radius * cos(angle), radius * sin(angle), edge_length)
        return name

    def line(self, start: str, end: str, edges: int | None = None) -> None:
        """Add a straight line."""
        self.curves[start, end] = (False, edges)

    def path(self, *points: str) -> None:
        """Add straight lines between successive points."""
        for start, end in zip(points, points[1:]):
            self.line(start, end)

    def arc(self, start: str, end: str, edges: int | None = None, centre: tuple[float, float] | None = None) -> None:
        """Add an arc shorter than half a turn, about a centre x, y [m], or about the origin."""
        self.curves[start, end] = (True, edges)
        if centre is not None:
            self.centres[start, end] = centre

    def place(self, name: str, x: float, y: float, edge_length: float) -> str:
        """Add a point at x [m], y [m] and return its name."""
        self.points[name] = (x, y, edge_length)
        return name

    def region(self, name: str, *corners: str) -> None:
        """Add a face bounded by the curves between successive corners (closed automatically) to a region."""
        self.regions.setdefault(name, []).append(corners)


@dataclass(frozen=True)
class PlaneMesh:
    """Triangles of a drawing: points (n, 2) [m], triangles (m, 3) as indices of points, region (m,) as an index
    of region_names."""

    points: np.ndarray
    triangles: np.ndarray
    region: np.ndarray
    region_names: tuple[str, ...]

    def nodes_at_angle(self, angle: float) -> np.ndarray:
        """Indices (k,) of the nodes on the ray at this angle [rad], outwards; the origin counts as on every ray."""
        distance = self.points @ np.array([-sin(angle), cos(angle)])
        along = self.points @ np.array([cos(angle), sin(angle)])
        nodes = np.flatnonzero((np.abs(distance) < 1e-9) & (along > -1e-9))
        return nodes[np.argsort(along[nodes])]

    def nodes_at_radius(self, radius: float) -> np.ndarray:
        """Indices (k,) of the nodes on the circle of this radius [m], sorted by angle."""
        nodes = np.flatnonzero(np.abs(np.hypot(*self.points.T) - radius) < 1e-9)
        return nodes[np.argsort(np.arctan2(self.points[nodes, 1], self.points[nodes, 0]))]


def triangulate(drawing: Drawing) -> PlaneMesh:
    """Triangles of every region of the drawing, conforming along shared curves.

    gmsh is started anew for every drawing (1 ms): its random numbers go on from one mesh to the next, and the mesh of a
    machine must not depend on what was meshed before.
    Raises GeometryError when gmsh cannot mesh the drawing.
    """
    _start_gmsh()
    try:
        tags = _draw(drawing)
        gmsh.model.mesh.generate(2)
        return _collect(tags)
    except Exception as error:  # gmsh raises bare Exception
        raise GeometryError(f"gmsh could not triangulate the cross-section: {error}") from error
    finally:
        gmsh.finalize()


def _start_gmsh() -> None:
    with kept_signal_handlers():
        gmsh.initialize(readConfigFiles=False, interruptible=False)
    for option, value in (
        ("General.Terminal", 0),
        ("General.NumThreads", 1),
        ("Mesh.Algorithm", _FRONTAL_DELAUNAY),
        ("Mesh.MeshSizeExtendFromBoundary", 1),
        ("Mesh.RandomSeed", 1),
    ):
        gmsh.option.setNumber(option, value)


def _draw(drawing: Drawing) -> dict[str, list[int]]:
    geo = gmsh.model.geo
    origin = geo.addPoint(0, 0, 0)
    others = {curve: geo.addPoint(x, y, 0) for curve, (x, y) in drawing.centres.items()}
    points = {name: geo.addPoint(x, y, 0, size) for name, (x, y, size) in drawing.points.items()}
    curves = {}
    for (start, end), (is_arc, edges) in drawing.curves.items():
        ends = points[start], points[end]
        tag = geo.addCircleArc(ends[0], others.get((start, end), origin), ends[1]) if is_arc else geo.addLine(*ends)
        curves[start, end], curves[end, start] = tag, -tag
        if edges is not None:
            geo.mesh.setTransfiniteCurve(tag, edges + 1)
    regions = {name: [_add_face(face, curves) for face in faces] for name, faces in drawing.regions.items()}
    geo.synchronize()
    return regions


def _add_face(corners: tuple[str, ...], curves: dict[tuple[str, str], int]) -> int:
    geo = gmsh.model.geo
    loop = [curves[pair] for pair in zip(corners, corners[1:] + corners[:1])]
    return geo.addPlaneSurface([geo.addCurveLoop(loop)])


def _collect(tags: dict[str, list[int]]) -> PlaneMesh:
    triangles, region = [], []
    for index, tag in ((index, tag) for index, faces in enumerate(tags.values()) for tag in faces):
        nodes = gmsh.model.mesh.getElementsByType(2, tag)[1].reshape(-1, 3)
        triangles.append(nodes)
        region.append(np.full(len(nodes), index))
    node_tags, coordinates, _ = gmsh.model.mesh.getNodes()
    used, renumbered = np.unique(np.concatenate(triangles), return_inverse=True)
    position = np.empty(int(node_tags.max()) + 1, dtype=int)
    position[node_tags] = np.arange(len(node_tags))
    points = coordinates.reshape(-1, 3)[position[used], :2]
    return PlaneMesh(points, renumbered.reshape(-1, 3), np.concatenate(region), tuple(tags))
