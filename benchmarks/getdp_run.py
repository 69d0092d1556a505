"""A case solved by GetDP, as a whole process: reading problem and mesh, Newton, writing torque and flux linkage."""

from __future__ import annotations

import re
import shutil
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from benchmarks.gmsh_format import CENTRE, FIRST_SIDE, OUTER, SECOND_SIDE, region_numbers, write_mesh
from benchmarks.processes import PeerError, run
from benchmarks.reference_case import FieldCase
from benchmarks.result import CodeResult
from units import MU_0

_PROBLEM = Path(__file__).parent / "getdp_model" / "machine.pro"
_PHASES = range(3)


@dataclass(frozen=True)
class LinearSolver:
    """A direct solver of PETSc: name for tables and the options that choose it."""

    name: str
    options: tuple[str, ...]


AS_INSTALLED = LinearSolver("GetDP, MUMPS", ())
# The quickest of MUMPS, UMFPACK, SuperLU, CHOLMOD and PETSc's own on the reference mesh.
FASTEST = LinearSolver(
    "GetDP, CHOLMOD", ("-ksp_type", "preonly", "-pc_type", "cholesky", "-pc_factor_mat_solver_type", "cholmod")
)


def getdp_version() -> str:
    """Version of the installed program. Raises PeerError without one."""
    if shutil.which("getdp") is None:
        raise PeerError("GetDP is not installed: run 'sh benchmarks/set_up', or install Debian's package getdp")
    with TemporaryDirectory() as folder:
        output, _ = run(["getdp", "-info"], Path(folder))
    values = dict(re.findall(r"^(.*?)\s*: (.*)$", output, flags=re.MULTILINE))
    return f"{values['Version']}, PETSc {values['PETSc version'].split()[0]}"


def solve_getdp(
    case: FieldCase, tolerance: float, solver: LinearSolver = FASTEST, points: int = 3, with_potential: bool = False
) -> CodeResult:
    """Solve with GetDP in a folder of its own.

    tolerance: residual relative to the load; points: of the quadrature in a triangle
    with_potential: also read the potential at the corners, which costs the process time
    """
    with TemporaryDirectory() as name:
        folder = Path(name)
        _write_problem(case, tolerance, points, folder)
        post = ("Results", "Potential") if with_potential else ("Results",)
        files = ("getdp", "machine.pro", "-msh", "case.msh", "-v", "3")
        output, cost = run([*files, "-solve", "Newton", "-pos", *post, *solver.options], folder)
        torque = _last_number(folder / "torque.txt")
        linkage = np.array([_last_number(folder / f"linkage_{phase}.txt") for phase in _PHASES])
        potential = _potential(folder / "potential.txt", case.mesh.corners) if with_potential else None
    return CodeResult(solver.name, torque, linkage, _residuals(output, tolerance), cost, potential, {})


def _last_number(path: Path) -> float:
    if not path.is_file():
        raise PeerError(f"GetDP wrote no {path.name}")
    return float(path.read_text().split()[-1])


def _residuals(output: str, tolerance: float) -> tuple[float, ...]:
    residuals = tuple(float(value) for value in re.findall(r"^residual \d+ (\S+)", output, flags=re.MULTILINE))
    if not residuals or residuals[-1] > tolerance:
        raise PeerError(f"GetDP did not converge: relative residuals {residuals}\n{output[-2000:]}")
    return residuals


def _potential(path: Path, count: int) -> np.ndarray:
    """Potential at the corners from a table: number of rows, then node and value."""
    nodes, potentials = np.loadtxt(path, skiprows=1, unpack=True)
    values = np.full(count, np.nan)
    values[nodes.astype(int) - 1] = potentials
    return values


# ---- the problem ----------------------------------------------------------------------------------------------------


def _write_problem(case: FieldCase, tolerance: float, points: int, folder: Path) -> None:
    write_mesh(case.mesh, folder / "case.msh")
    shutil.copy(_PROBLEM, folder / "machine.pro")
    parts = (_numbers(case, tolerance, points), _groups(case), _functions(case))
    (folder / "case.pro").write_text("\n".join(line for part in parts for line in part) + "\n")


def _numbers(case: FieldCase, tolerance: float, points: int) -> list[str]:
    inner, outer = case.torque_ring
    values = {
        "MU_0": MU_0,
        "SECTORS": case.section.sectors,
        "SIGN": case.mesh.sign,
        "SECTOR_ANGLE": case.mesh.sector_angle,
        "SIDE_AREA": case.section.half_slot_area,
        "RING_DEPTH": outer - inner,
        "TOLERANCE": tolerance,
        "POINTS": points,
    }
    return [f"{name} = {value!r};" for name, value in values.items()]


def _groups(case: FieldCase) -> list[str]:
    numbers = region_numbers(case.mesh)
    iron = {"stator_iron", "rotor_iron"}
    groups = {
        "Iron": [numbers[name] for name in iron],
        "Linear": [number for name, number in numbers.items() if name not in iron],
        "Copper": [numbers[name] for name in case.coil_sides],
        "Magnets": [numbers[name] for name in case.remanences],
        "Ring": [numbers["stator_gap"]],
        "Domain": list(numbers.values()),
        "Outer": [OUTER],
        "FirstSide": [FIRST_SIDE],
        "SecondSide": [SECOND_SIDE],
        "Centre": [CENTRE],
    }
    lines = [f"  {name} = Region[{{{', '.join(map(str, sorted(members)))}}}];" for name, members in groups.items()]
    return ["Group {", *lines, "}"]


def _functions(case: FieldCase) -> list[str]:
    numbers, (b2, nu) = region_numbers(case.mesh), case.law_table
    pairs = ", ".join(f"{x!r}, {y!r}" for x, y in zip(b2.tolist(), nu.tolist()))
    lines = [f"  law() = {{{pairs}}};"]
    for name, density in case.current_densities.items():
        lines.append(f"  j[Region[{numbers[name]}]] = Vector[0, 0, {density!r}];")
    for name, (x, y) in case.remanences.items():
        lines.append(f"  br[Region[{numbers[name]}]] = Vector[{x!r}, {y!r}, 0];")
    for name, (phase, sign) in case.coil_sides.items():
        lines += [f"  turn_{i}[Region[{numbers[name]}]] = {sign if i == phase else 0};" for i in _PHASES]
    return ["Function {", *lines, "}"]
