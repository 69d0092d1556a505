"""A conforming mesh as a file in Gmsh's format 2.2, with a number for every region and every piece of the boundary."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from benchmarks.conforming_mesh import ConformingMesh

OUTER, FIRST_SIDE, SECOND_SIDE, CENTRE = 1001, 1002, 1003, 1004  # numbers of the pieces of the boundary
_POINT, _LINE, _TRIANGLE = {1: 15}, {2: 1, 3: 8}, {3: 2, 6: 9}  # Gmsh's shape by number of nodes
_AT_CENTRE = 1e-12  # m


def region_numbers(mesh: ConformingMesh) -> dict[str, int]:
    """Number of every region in the file."""
    return {name: index + 1 for index, name in enumerate(mesh.region_names)}


def centre_nodes(mesh: ConformingMesh) -> np.ndarray:
    """The node on the axis, which in an antiperiodic sector has zero potential; empty for other meshes."""
    at_centre = np.flatnonzero(np.hypot(*mesh.points.T) < _AT_CENTRE)
    return at_centre if mesh.sign < 0 else at_centre[:0]


def write_mesh(mesh: ConformingMesh, path: Path) -> None:
    """Write the file."""
    nodes = [f"{i} {x:.17g} {y:.17g} 0" for i, (x, y) in enumerate(mesh.points.tolist(), start=1)]
    lines = [
        *_elements(_POINT, np.full(len(centre_nodes(mesh)), CENTRE), centre_nodes(mesh)[:, None]),
        *_elements(_LINE, np.full(len(mesh.outer), OUTER), mesh.outer),
        *_elements(_LINE, np.full(len(mesh.first_side), FIRST_SIDE), mesh.first_side),
        *_elements(_LINE, np.full(len(mesh.second_side), SECOND_SIDE), mesh.second_side),
        *_elements(_TRIANGLE, mesh.region + 1, mesh.triangles),
    ]
    elements = [f"{i} {line}" for i, line in enumerate(lines, start=1)]
    text = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", *_section("Nodes", nodes), *_section("Elements", elements), ""]
    path.write_text("\n".join(text))


def _elements(shapes: dict[int, int], numbers: np.ndarray, nodes: np.ndarray) -> list[str]:
    shape = shapes.get(nodes.shape[1])
    return [f"{shape} 2 {n} {n} {' '.join(map(str, row))}" for n, row in zip(numbers.tolist(), (nodes + 1).tolist())]


def _section(name: str, lines: list[str]) -> list[str]:
    return [f"${name}", str(len(lines)), *lines, f"$End{name}"]
