"""How well the eight parameters of thesis table 4.2 are identified from loops of another integrator, over many seeds.

    python -m benchmarks.identification        # some minutes; writes results/reference/benchmarks/identification.csv

The stroke is known exactly in the first two cases; in the third it has noise of its own, which the fit takes for the
truth, so that the intervals say too little.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pandas as pd

from bench.force_loops import NOMINAL, ForceLoop, identify_loops
from bench.identification import Identification
from benchmarks.virtual_benches.actuator_loops import TRANSMISSION, Drive, Loop, Truth, loop_of

OUT = Path("results/reference/benchmarks/identification.csv")
SEEDS = 20
NOISE = 3.0  # N, of the force: 0.06 % of a load cell of 5 kN
STROKE_NOISE = 1e-6  # m, white, after the filter that a velocity needs
# Two seconds each: with half a second the play, of 9 um, is known to 2.7 % only
DRIVES = (Drive(15, 3e-3, 0, 2.0), Drive(15, 3e-3, 4000, 2.0), Drive(5, 8e-3, 4000, 2.0), Drive(8, 5e-3, 2000, 2.0),
          Drive(30, 1e-3, 0, 2.0))  # fmt: skip


@dataclass(frozen=True)
class Case:
    """name: in the table; truth: what made the loops; stroke_noise: standard deviation [m]."""

    name: str
    truth: Truth
    stroke_noise: float = 0.0


CASES = (
    Case("table 4.2", Truth()),
    Case("table 4.2, play of 0.2 mm", replace(Truth(), play=2e-4)),
    Case("table 4.2, noise of the stroke", Truth(), STROKE_NOISE),
)


def record(loop: Loop, drive: Drive, case: Case, rng: np.random.Generator) -> ForceLoop:
    """The loop with noise drawn anew."""
    stroke = loop.stroke + case.stroke_noise * rng.standard_normal(len(loop.time))
    force = loop.force + NOISE * rng.standard_normal(len(loop.time))
    return ForceLoop(f"{drive.frequency:g} Hz", loop.time, stroke, loop.velocity, loop.current, force)


def fits(case: Case) -> list[Identification]:
    """One identification a seed."""
    loops = [loop_of(case.truth, drive, 0.0, np.random.default_rng(0)) for drive in DRIVES]
    found = []
    for seed in range(SEEDS):
        rng = np.random.default_rng(seed)
        records = [record(loop, drive, case, rng) for loop, drive in zip(loops, DRIVES)]
        found.append(identify_loops(records, NOMINAL, TRANSMISSION, NOISE)[0])
    return found


def rows(case: Case) -> list[Mapping[str, object]]:
    """One parameter a row: errors and coverage over the seeds."""
    found = fits(case)
    return [_row(case, found, place, name, value) for place, (name, value) in enumerate(case.truth.sought.items())]


def _row(case: Case, found: list[Identification], place: int, name: str, value: float) -> Mapping[str, object]:
    mine = [one.found[place] for one in found]
    errors = np.array([one.value / value - 1 for one in mine])
    inside = [one.interval[0] < value < one.interval[1] for one in mine]
    return {
        "case": case.name,
        "parameter": name,
        "worst_error_percent": 100 * float(np.abs(errors).max()),
        "mean_error_percent": 100 * float(errors.mean()),
        "rms_error_percent": 100 * float(np.sqrt(np.mean(errors**2))),
        "stated_deviation_percent": 100 * float(np.mean([one.deviation for one in mine])),
        "inside_90": f"{sum(inside)} of {len(inside)}",
        "memory": float(np.mean([one.memory for one in found])),
    }


def main() -> None:
    """All cases, and their table."""
    table = pd.DataFrame([row for case in CASES for row in rows(case)])
    OUT.parent.mkdir(parents=True, exist_ok=True)
    table.to_csv(OUT, index=False, float_format="%.4g")
    print(table.to_string(index=False))


if __name__ == "__main__":
    main()
