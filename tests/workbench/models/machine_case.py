"""The machine of the tests: 12 slots, 10 poles, on meshes as coarse as the statement allows."""

from __future__ import annotations

import atexit
import os
import shutil
from functools import cache
from pathlib import Path
from tempfile import gettempdir

from effects.machine_design import MachineAsBuilt
from geometry.half_cell import MeshDensity
from geometry.machine import Machine
from materials.magnet import Magnet
from units import DEGREE
from workbench.models.machine.build import MeshPlan, SurrogateBuilder
from workbench.models.machine.field import LoadedState, MachineField
from workbench.models.machine.surrogate import Surrogate

COARSE = MeshDensity(gap_edges=120, longest_gap_edge=2.5, gap_layers=1, across_iron=1.5)
MIDDLE = MeshDensity(gap_edges=240, gap_layers=1, across_iron=1.5)
PLAN = MeshPlan(MIDDLE, MIDDLE, MIDDLE, MIDDLE)
SOLVED = Path(gettempdir()) / f"machine-case-{os.environ.get('PYTEST_XDIST_TESTRUNUID', os.getpid())}"
atexit.register(shutil.rmtree, SOLVED, ignore_errors=True)  # until then all processes of a run share what is solved
LOADED = LoadedState(0.1, (40.0, -20.0, -20.0))
STATES = (LOADED, *(LoadedState(angle, (0.0, 0.0, 0.0)) for angle in (0.1, 9 * DEGREE, 2 * DEGREE)))  # of inductances


def drawn() -> MachineAsBuilt:
    mm = 1e-3
    machine = Machine(
        12, 5, 42.5 * mm, 15.7 * mm, 3.3 * mm, 5.5 * mm, 2.5 * mm, 0.5 * mm, 2 * mm, 1.43 * mm, 1.43 * mm, 5 * mm
    )
    return MachineAsBuilt.drawn(machine, "35PN270", Magnet(1.3, 1.0, -0.0012, 22.0), 41 * mm, 7, 12.6e-3)


@cache
def field(density: MeshDensity = COARSE) -> MachineField:
    return MachineField(drawn(), density)


@cache
def builder() -> SurrogateBuilder:
    """Only within a test: solved while tests are collected, it costs every process its minute, whatever is run."""
    assert "PYTEST_CURRENT_TEST" in os.environ, "the machine of the tests is solved in a test, not on import"
    return SurrogateBuilder(drawn(), PLAN, SOLVED)


@cache
def surrogate() -> Surrogate:
    return builder().build(STATES)
