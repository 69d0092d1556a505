"""Truths of the machine bench by NGSolve: ``python -m benchmarks.ngsolve_truths [--tune] [--score]``.

Every machine takes one to three minutes; what is solved is kept in benchmarks/virtual_benches/solved/ as one small file
each (.npz, and .json that says what the machine is), so that the score is run again without field solutions.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
from pathlib import Path

import numpy as np

from benchmarks.ngsolve_run import PYTHON, ngsolve_version
from benchmarks.processes import ONE_THREAD
from benchmarks.virtual_benches.machine_hidden import Solved, drawn, sensitivities
from benchmarks.virtual_benches.truths import DRAWINGS, description

TRUTHS = Path(__file__).parent / "virtual_benches" / "solved"
PROGRAM = Path(__file__).parent / "virtual_benches" / "ngsolve_machine.py"
DIGITS = 9  # that are kept of every number, relative to the largest of its row


def solve(machines: list[Solved], work: Path) -> None:
    """Solve what is not there yet, one after the other. work: folder for what NGSolve reads and writes"""
    print(f"NGSolve {ngsolve_version()}, {len(machines)} machines", flush=True)
    work.mkdir(parents=True, exist_ok=True)
    TRUTHS.mkdir(parents=True, exist_ok=True)
    for machine in machines:
        if not (TRUTHS / f"{machine.name}.npz").exists():
            _solve(machine, work)


def _solve(machine: Solved, work: Path) -> None:
    asked = work / f"{machine.name}.json"
    asked.write_text(json.dumps(description(DRAWINGS[machine.drawing], machine.built)), encoding="utf-8")
    subprocess.run([str(PYTHON), str(PROGRAM), str(asked)], env=os.environ | ONE_THREAD, check=False)
    if asked.with_suffix(".npz").exists():
        keep(machine, dict(np.load(asked.with_suffix(".npz"))))
        asked.with_suffix(".npz").unlink()
    asked.unlink()


def keep(machine: Solved, arrays: dict[str, np.ndarray]) -> None:
    """One truth as files of the project."""
    (TRUTHS / f"{machine.name}.json").write_text(json.dumps(machine.as_plain()) + "\n", encoding="utf-8")
    rounded = {name: _rounded(arrays[name]) for name in ("no_load", "loaded")}
    np.savez_compressed(TRUTHS / f"{machine.name}.npz", **rounded)


def _rounded(values: np.ndarray) -> np.ndarray:
    """Few digits, so that the files are small and the same on every machine."""
    size = np.max(np.abs(values), axis=-1, keepdims=True)
    step = 10.0 ** (np.ceil(np.log10(np.where(size > 0, size, 1.0))) - DIGITS)
    return np.round(values / step) * step


def main(arguments: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--tune", action="store_true", help="the machines for tuning")
    parser.add_argument("--score", action="store_true", help="the machines for the score")
    parser.add_argument("--work", type=Path, default=Path("results/cache/ngsolve"), help="folder of work")
    chosen = parser.parse_args(arguments)
    machines = sensitivities()
    machines += drawn("tune") if chosen.tune else []
    machines += drawn("score") if chosen.score else []
    solve(machines, chosen.work)


if __name__ == "__main__":
    main()
