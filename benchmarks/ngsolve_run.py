"""A case solved by NGSolve, in a Python environment of its own: Newton's method on a loaded mesh and space."""

from __future__ import annotations

import json
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from benchmarks.conforming_mesh import ConformingMesh
from benchmarks.gmsh_format import centre_nodes
from benchmarks.processes import Cost, PeerError, run
from benchmarks.reference_case import FieldCase
from benchmarks.result import CodeResult
from units import MU_0

PYTHON = Path(__file__).resolve().parent.parent / ".venv-benchmark" / "bin" / "python"
_WORKER = Path(__file__).parent / "ngsolve_worker.py"
_VERSION = "import ngsolve; print(ngsolve.__version__)"


def ngsolve_version() -> str:
    """Version of NGSolve in the environment of the benchmark. Raises PeerError without one."""
    if not PYTHON.is_file():
        raise PeerError("there is no .venv-benchmark, the environment with NGSolve: run 'sh benchmarks/set_up'")
    with TemporaryDirectory() as folder:
        output, _ = run([str(PYTHON), "-c", _VERSION], Path(folder))
    return output.split()[-1]


def solve_ngsolve(case: FieldCase, tolerance: float, points: int = 3, damped: bool = False) -> CodeResult:
    """Solve with NGSolve; the cost is that of Newton's method, from zero field.

    tolerance: residual relative to the load; points: 3 for the quadrature of this project, more for a finer one
    damped: whether steps that overshoot are halved, which saturated bridges need and the clock would see
    """
    with TemporaryDirectory() as name:
        folder = Path(name)
        told = _description(case, tolerance, points) | {"damped": damped}
        (folder / "case.json").write_text(json.dumps(told))
        np.savez(folder / "mesh.npz", **_arrays(case.mesh))
        run([str(PYTHON), str(_WORKER), name], folder)
        result = json.loads((folder / "result.json").read_text())
        potential = np.load(folder / "potential.npy")
    if result["residuals"][-1] > tolerance:
        raise PeerError(f"NGSolve did not converge: relative residuals {result['residuals']}")
    others = {"torque_by_weight": result["torque_by_weight"]}
    cost = Cost(result["cpu"], result["wall"])
    linkage = np.array(result["flux_linkage"])
    return CodeResult("NGSolve", result["torque"], linkage, tuple(result["residuals"]), cost, potential, others)


def _description(case: FieldCase, tolerance: float, points: int) -> dict:
    machine, (b2, nu) = case.section.machine, case.law_table
    return {
        "order": 2 if case.mesh.is_quadratic else 1,
        "points": points,
        "tolerance": tolerance,
        "regions": case.mesh.region_names,
        "iron": ["stator_iron", "rotor_iron"],
        "current_densities": case.current_densities,
        "remanences": case.turning_remanences,
        "recoil_permeability": case.materials.magnet.recoil_permeability,
        "coil_sides": case.coil_sides,
        "side_area": case.section.half_slot_area,
        "ring": case.torque_ring,
        "gap": (machine.rotor.rim_radius, machine.stator.rim_radius),
        "sectors": case.section.sectors,
        "sign": case.mesh.sign,
        "centre": centre_nodes(case.mesh).tolist(),
        "mu_0": MU_0,
        "b2": b2.tolist(),
        "nu": nu.tolist(),
    }


def _arrays(mesh: ConformingMesh) -> dict[str, np.ndarray]:
    """Corner nodes only: NGSolve adds the edges of quadratic elements itself."""
    pairs = np.unique(np.column_stack([mesh.first_side[:, :2].ravel(), mesh.second_side[:, :2].ravel()]), axis=0)
    return {
        "points": mesh.points[: mesh.corners],
        "triangles": mesh.triangles[:, :3],
        "region": mesh.region,
        "outer": mesh.outer[:, :2],
        "first_side": mesh.first_side[:, :2],
        "second_side": mesh.second_side[:, :2],
        "pairs": pairs[pairs[:, 0] != pairs[:, 1]],
    }
