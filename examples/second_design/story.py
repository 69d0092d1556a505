"""Designed, built, measured, diagnosed, corrected, designed again. Run: python -m examples.second_design.story [folder]

Every step is a command that a user would give. The bench needs GetDP (Debian: getdp); what it read stands in measured/.
"""

from __future__ import annotations

import shlex
import subprocess
import sys
from pathlib import Path

HERE = Path("examples/second_design")
STUDY = HERE / "pump.toml"
FIRST, SECOND = Path("results/second-design"), Path("results/second-design-learned")

DESIGN = f"airgap run {STUDY}"
DRAFT = f"airgap campaign-from {STUDY} --dq --out {{folder}}/first"
MEASURE = f"python -m examples.second_design.bench {{folder}}/first {FIRST}"
DIAGNOSE = "airgap diagnose {folder}/first --out {folder}/bench"
CORRECT = "airgap ledger {folder}/first --out {folder}/bench"
DESIGN_AGAIN = f"airgap run {STUDY} --with {{folder}}/bench/model.toml --out {SECOND}"
DRAFT_AGAIN = f"airgap campaign-from {STUDY} --dq --results {SECOND} --out {{folder}}/second"
MEASURE_AGAIN = f"python -m examples.second_design.bench {{folder}}/second {SECOND}"

STEPS = (DESIGN, DRAFT, MEASURE, DIAGNOSE, CORRECT, DESIGN_AGAIN, DRAFT_AGAIN, MEASURE_AGAIN)


def tell(folder: Path) -> None:
    """Give every command in turn; a wrong end of one ends the story."""
    for step in STEPS:
        command = step.format(folder=folder)
        print(f"\n$ {command}", flush=True)
        subprocess.run(_in_this_environment(command), check=True)


def _in_this_environment(command: str) -> list[str]:
    """The words of a command with this interpreter, which knows the project."""
    first, *rest = shlex.split(command)
    return [sys.executable, "-m", "pipeline.cli", *rest] if first == "airgap" else [sys.executable, *rest]


if __name__ == "__main__":
    tell(Path(sys.argv[1] if len(sys.argv) > 1 else "results/examples/second_design"))
