"""A whole machine meshed by Netgen and solved by NGSolve: python ngsolve_own_worker.py FOLDER, in an environment of its
own.

Reads FOLDER/case.json and FOLDER/outline.npz (written by ``ngsolve_own_mesh``), writes FOLDER/result.json. Circles stay
circles in the mesh, and the torque is the work of the stress on a strain that leaves the corners of the gap out.
"""

from __future__ import annotations

import json
import sys
from math import pi
from pathlib import Path

import ngsolve
import numpy as np
from netgen.geom2d import SplineGeometry
from ngsolve import GridFunction, Integrate, Mesh, dx, grad, sin, sqrt, x, y
from ngsolve_worker import Damped, Problem

GRADING = 0.4  # of edges from one to the next


def meshed(outline: dict, case: dict) -> Mesh:
    """Netgen's triangles of the drawing, with curved edges on arcs."""
    mesh = Mesh(geometry(outline, case).GenerateMesh(maxh=case["largest"], grading=GRADING))
    mesh.Curve(case["order"])
    return mesh


def geometry(outline: dict, case: dict) -> SplineGeometry:
    """The curves with the regions beside them."""
    drawn = SplineGeometry()
    numbers = [drawn.AppendPoint(*point, maxh=case["corner"]) for point in outline["points"].tolist()]
    for which in range(len(outline["ends"])):
        add_curve(drawn, numbers, which, outline, case["regions"])
    for number, name in enumerate(case["regions"], 1):
        drawn.SetMaterial(number, name)
        drawn.SetDomainMaxH(number, case["edge_lengths"][name])
    return drawn


def add_curve(drawn: SplineGeometry, numbers: list[int], which: int, outline: dict, regions: list[str]) -> None:
    """A line, or an arc as a rational spline, which is exact; nothing is beyond the model."""
    start, end = (numbers[point] for point in outline["ends"][which])
    left, right = (["", *regions].index(outline[side][which]) for side in ("left", "right"))
    if outline["is_arc"][which]:
        curve = ["spline3", start, drawn.AppendPoint(*outline["poles"][which].tolist()), end]
    else:
        curve = ["line", start, end]
    drawn.Append(curve, leftdomain=left, rightdomain=right, bc=outline["boundary"][which].item() or "inside")


def with_densities(case: dict, mesh: Mesh) -> dict:
    """Current densities of the ampere-turns in every coil side, and the area of one."""
    areas = {name: Integrate(ngsolve.CF(1) * dx(name), mesh) for name in case["coil_sides"]}
    currents = {name: sign * case["ampere_turns"][phase] for name, (phase, sign) in case["coil_sides"].items()}
    densities = {name: current / areas[name] for name, current in currents.items()}
    return case | {"current_densities": densities, "side_area": float(np.median(list(areas.values())))}


def virtual_work(problem: Problem, a: GridFunction) -> float:
    """Torque on the rotor [Nm/m]: -integral of r B_r B_phi/mu_0 dw/dr while the rotor turns by w = 1, the stator by 0,

    w = (1 + cos(pi s))/2, s from 0 at the rotor to 1 at the stator, so that nothing is strained at the corners.
    """
    rotor, stator = problem.case["gap"]
    r = sqrt(x * x + y * y)
    slope = -pi / 2 * sin(pi * (r - rotor) / (stator - rotor)) / (stator - rotor)
    b = ngsolve.CF((grad(a)[1], -grad(a)[0]))
    shear = (b * ngsolve.CF((x, y))) * (b * ngsolve.CF((-y, x))) / (r * problem.case["mu_0"])
    return -Integrate(shear * slope * dx("gap", bonus_intorder=6), problem.mesh)


def solved(mesh: Mesh, case: dict) -> dict:
    """One state of the machine on a mesh."""
    problem = Damped(with_densities(case, mesh), mesh)
    a, residuals = problem.newton()
    return {
        "torque": virtual_work(problem, a),
        "flux_linkage": [problem.flux_linkage(a, phase) for phase in range(3)],
        "residuals": residuals,
        "triangles": mesh.ne,
    }


def main(folder: Path) -> None:
    ngsolve.SetNumThreads(1)
    case, outline = json.loads((folder / "case.json").read_text()), dict(np.load(folder / "outline.npz"))
    mesh = meshed(outline, case)
    found = [solved(mesh, case | {"ampere_turns": currents}) for currents in case["states"]]
    (folder / "result.json").write_text(json.dumps(found))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
