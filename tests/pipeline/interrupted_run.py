"""A run of slow tasks in a process of its own, to be interrupted by the tests: ``interrupted_run.py CHECKPOINT``."""

import signal
import sys
from pathlib import Path

from worker_tasks import slow_square

from pipeline.checkpoint import Checkpoint
from pipeline.pools import PooledWorkers
from pipeline.sentences import sentences
from processes import Processes

if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.default_int_handler)  # whoever starts the tests may have told them to ignore it
    with sentences():
        tasks = {f"task {number}": number for number in range(30)}
        pool = Processes(2)
        workers = PooledWorkers("slow run", pool, lambda what: Checkpoint(Path(sys.argv[1]), "inputs"))
        workers.map("squares", slow_square, tasks)
