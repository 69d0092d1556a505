"""Run other programs on one thread and know what they cost."""

from __future__ import annotations

import os
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path

ONE_THREAD = {name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NGS_NUM_THREADS")}


class PeerError(RuntimeError):
    """Another code is missing or failed; the message says what to do."""


@dataclass(frozen=True)
class Cost:
    """CPU time (user and system) and wall time [s]."""

    cpu: float
    wall: float


def run(command: list[str], folder: Path) -> tuple[str, Cost]:
    """Output and cost of a program that runs in a folder.

    Raises PeerError with the end of its output when it fails.
    """
    log, began = folder / "output.txt", time.perf_counter()
    with open(log, "wb") as output:
        child = subprocess.Popen(command, cwd=folder, stdout=output, stderr=output, env=os.environ | ONE_THREAD)
        _, status, usage = os.wait4(child.pid, 0)
    cost = Cost(usage.ru_utime + usage.ru_stime, time.perf_counter() - began)
    child.returncode = os.waitstatus_to_exitcode(status)
    text = log.read_text(errors="replace")
    if child.returncode:
        raise PeerError(f"{' '.join(command)} ended with {child.returncode}:\n{text[-2000:]}")
    return text, cost
