"""What every test needs before numpy or a plotting library is loaded, and the longest files first.

Every file runs in one of two processes: one that takes two minutes and begins last leaves the other without work.
"""

import os

for _threads in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ.setdefault(_threads, "1")  # the tests run on two processes already
os.environ.setdefault("MPLBACKEND", "Agg")  # no window
os.environ.setdefault("PYVISTA_OFF_SCREEN", "true")

LONGEST = (
    "workbench/test_machine_walks.py", "pipeline/test_whole_pipeline.py", "workbench/models/test_machine_surrogate.py",
    "workbench/test_users_walk.py", "pipeline/test_cluster.py", "test_static.py", "pipeline/test_drive_study.py",
    "workbench/models/test_machine_field.py", "magnetostatics/test_mesh_error.py", "workbench/test_commands.py",
    "physics/test_defect_orders.py", "optimisation/test_optimum.py",
)  # fmt: skip


def pytest_collection_modifyitems(items):
    """The files named above in their order, then the others as they were found."""
    places = {name: place for place, name in enumerate(LONGEST)}

    def place(item):
        return next((places[name] for name in LONGEST if item.path.as_posix().endswith(f"/tests/{name}")), len(LONGEST))

    items.sort(key=place)
