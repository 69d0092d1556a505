"""What spreading tasks costs and gains: ``python -m benchmarks.scaling``.

Overhead of a task that does nothing, and wall time of the small sweep of the automotive study on one to four workers,
on the processes of this machine and on a dask cluster of it. Results are compared by their hash. Prints a line each.
"""

from __future__ import annotations

import time
from pathlib import Path
from tempfile import TemporaryDirectory

from optimisation.sweep import sweep_stage
from pipeline.checkpoint import Checkpoint
from pipeline.codec import digest
from pipeline.pools import DaskCluster, PooledWorkers
from processes import Pool, Processes
from study.inputs_field import field_case, saturation_limit, sweep_grid
from study.read import read_study

STUDY = "automotive"
EMPTY_TASKS = 400
WORKERS = (1, 2, 4)
KINDS = {"processes": Processes, "dask": DaskCluster}


def nothing(number: int) -> int:
    """A task that does nothing."""
    return number


def measured(kind: str, count: int) -> dict[str, object]:
    """One row: overhead of a task [ms], wall time of the sweep [s], hash of its result."""
    pool: Pool = KINDS[kind](count)
    with TemporaryDirectory() as folder:
        workers = PooledWorkers("scaling", pool, lambda what: Checkpoint(Path(folder) / f"{what}.jsonl", "scaling"))
        workers.map("start", nothing, {str(k): k for k in range(8)})
        began = time.perf_counter()
        workers.map("empty", nothing, {str(k): k for k in range(EMPTY_TASKS)})
        overhead = (time.perf_counter() - began) / EMPTY_TASKS
        study = read_study(STUDY)
        began = time.perf_counter()
        maps = sweep_stage(field_case(study), sweep_grid(study), saturation_limit(study), workers)
        wall = time.perf_counter() - began
    pool.end()
    found = {"executor": kind, "workers": count, "overhead_ms": 1e3 * overhead, "sweep_s": wall}
    return {**found, "hash": digest(maps)[:12]}


if __name__ == "__main__":
    for kind in KINDS:
        for count in WORKERS:
            print("{executor:10} {workers} workers, {overhead_ms:.2f} ms a task, sweep {sweep_s:.1f} s, {hash}".format(
                **measured(kind, count)), flush=True)  # fmt: skip
