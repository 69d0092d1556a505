"""A case solved by GetDP, as a whole process: reading mesh and problem, solving, writing torque and flux linkage."""

from __future__ import annotations

import re
import shutil
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.conforming_mesh import ConformingMesh
from benchmarks.processes import Cost, PeerError, run
from benchmarks.reference_case import FieldCase, sampled_law
from benchmarks.result import PeerResult
from units import MU_0

_MODEL = Path(__file__).parent / "getdp_model" / "machine.pro"
_OUTER, _FIRST, _SECOND, _CENTRE = 1001, 1002, 1003, 1004  # numbers of the groups of lines and points
_SHAPES = {1: 15, 2: 1, 3: 8}  # Gmsh's number of a point, a line and a quadratic line, by its number of nodes
_TRIANGLES = {3: 2, 6: 9}
# MUMPS, which this program comes with, in its symmetric mode.
_LINEAR_SOLVER = ("-ksp_type", "preonly", "-pc_type", "cholesky", "-pc_factor_mat_solver_type", "mumps")


@dataclass(frozen=True)
class GetdpSettings:
    """tolerance: residual relative to the load; points: of the quadrature in a triangle; law_tolerance: of nu"""

    tolerance: float
    points: int
    law_tolerance: float = 1e-5


def getdp_version() -> str:
    """Version and linear algebra of the installed program. Raises PeerError without one."""
    if shutil.which("getdp") is None:
        raise PeerError("GetDP is not installed; run 'sh benchmarks/set_up' or install Debian's package getdp")
    output, _ = run(["getdp", "-info"], Path("/tmp"))
    values = dict(re.findall(r"^(.*?)\s*: (.*)$", output, flags=re.MULTILINE))
    return f"{values['Version']} (PETSc {values['PETSc version'].split()[0]}, MUMPS)"
