"""A run of slow tasks in a process of its own, to be interrupted by the tests: ``interrupted_run.py CHECKPOINT``."""

import sys
from pathlib import Path

from worker_tasks import slow_square

from pipeline.checkpoint import Checkpoint
from pipeline.parallel import run_parallel
from pipeline.stage import command

if __name__ == "__main__":
    with command():
        tasks = {f"task {number}": number for number in range(30)}
        run_parallel(slow_square, tasks, 2, Checkpoint(Path(sys.argv[1]), "inputs"), "slow run")
