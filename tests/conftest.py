"""What every test needs before numpy or a plotting library is loaded, and the longest files first.

Every file runs in one of two processes: one that takes two minutes and begins last leaves the other without work.

What Python and pytest make of a source file is kept whatever the shell says: without it both processes rewrite the
assertions of all files, half of the time until the first test, and every command that a test starts compiles its code.

Garbage is not looked for among what collecting the tests leaves, which lives to the end: 2 of 8 seconds of collecting.
"""

import os
import sys

import pytest

from processes import without_collecting

os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
sys.dont_write_bytecode = False

for _threads in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ.setdefault(_threads, "1")  # the tests run on two processes already
os.environ.setdefault("MPLBACKEND", "Agg")  # no window
os.environ.setdefault("PYVISTA_OFF_SCREEN", "true")

LONGEST = (
    "pipeline/test_whole_pipeline.py", "magnetostatics/test_other_machines.py", "test_static.py",
    "workbench/test_machine_walks.py", "workbench/test_users_walk.py", "workbench/models/test_machine_surrogate.py",
    "pipeline/test_machine_command.py", "pipeline/test_drive_study.py", "workbench/test_commands.py",
    "workbench/test_conventions.py", "workbench/models/test_machine_field.py", "pipeline/test_cluster.py",
    "pipeline/test_pools.py", "workbench/likelihood/test_noise.py", "magnetostatics/test_weak_form.py",
    "vehicle/test_actuator_ride.py", "vehicle/test_linear_quarter_car.py", "benchmarks/test_synrm_readings.py",
    "benchmarks/test_virtual_benches.py", "workbench/test_walk.py", "workbench/models/test_drawn.py",
    "benchmarks/test_ngsolve_bench.py", "workbench/explain/test_unknown_laws.py", "workbench/test_bad_campaigns.py",
    "workbench/report/test_pages.py", "figures/test_energy.py", "pipeline/test_second_design.py",
    "gearbox/test_stage.py", "magnetostatics/test_mesh_error.py", "workbench/ledger/test_prius_validation.py",
    "physics/test_defect_orders.py", "drivetrain/test_linkage_front.py", "pipeline/test_solve_command.py",
    "physics/test_magnetic_pull.py", "pipeline/test_machine_winding.py", "bench/test_loop_diagnosis.py",
    "drivetrain/test_outcome.py",
)  # fmt: skip


def pytest_collection_modifyitems(items):
    """The files named above in their order, then the others as they were found."""
    places = {name: place for place, name in enumerate(LONGEST)}

    def place(item):
        return next((places[name] for name in LONGEST if item.path.as_posix().endswith(f"/tests/{name}")), len(LONGEST))

    items.sort(key=place)


@pytest.hookimpl(wrapper=True)
def pytest_collection(session):
    """In the process that hands the tests out too, which collects none."""
    with without_collecting():
        return (yield)
