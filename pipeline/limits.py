"""Optimum torque against the flux-density limit for every reading of it, on the study's own stator and slot count.

Reads the study, writes ``limits.csv`` (reading, limit, torque, back iron, rotor radius; empty where no design holds the
limit). The points are read off a map of this one stator by interpolation; ``optima.csv`` has the refined optimum.
"""

from __future__ import annotations

import sys
from functools import lru_cache

from pipeline.stage import Stage, command, results_folder
from study.read import read_study

OUTPUT = "limits.csv"


def stage_of(study) -> Stage:
    """The comparison of limits of a study."""
    from pipeline.models import FIELD_CODE, FIELD_SECTIONS
    from pipeline.sweep import steel_files

    values, folder = study.subset(*FIELD_SECTIONS), results_folder(study.study.id)
    return Stage("limits", folder, values, steel_files(study), (*FIELD_CODE, "pipeline.limits"), (OUTPUT,))


def solve_point(task: dict) -> list[float] | None:
    """[torque, aligned tooth, worst tooth, limited] of one design; None where it cannot be built."""
    from geometry.machine import GeometryError

    judge, machine = _judge(task["study"], task["reading"]), _machine(task)
    try:
        design = judge.judge(machine)
    except GeometryError:
        return None
    return [design.torque, design.tooth_aligned, design.tooth_worst, design.limited]


@lru_cache(maxsize=2)
def _judge(path: str, reading: str):
    from optimisation.states import READINGS
    from pipeline.models import judge_of

    return judge_of(read_study(path), READINGS[reading])


def _machine(task: dict):
    from pipeline.models import StudyFamily
    from units import MILLIMETRE

    section = read_study(task["study"]).machine
    width, radius = task["back_iron_width_mm"] * MILLIMETRE, task["rotor_outer_radius_mm"] * MILLIMETRE
    return StudyFamily(section).machine(section.slots, section.stator_outer_radius_mm * MILLIMETRE, width, radius)


def tasks_of(study) -> dict[str, dict]:
    """Designs of the map on the grid of the sweep: once in the null state, which serves two readings, once over the period."""
    from pipeline.sweep import grid

    widths, radii = grid(study, 2 * study.machine.stator_outer_radius_mm)
    return {
        f"{reading}, {i}, {k}": {
            "study": str(study.path.resolve()),
            "reading": reading,
            "back_iron_width_mm": float(width),
            "rotor_outer_radius_mm": float(radius),
        }
        for reading in ("every_tooth", "every_tooth_and_back_iron_over_period")
        for i, width in enumerate(widths)
        for k, radius in enumerate(radii)
    }


def table(study, results: dict[str, list | None]):
    """Best torque of every reading and limit."""
    import numpy as np
    import pandas as pd
    from optimisation.design_map import DesignMap
    from pipeline.sweep import grid
    from units import MILLIMETRE

    nothing = [np.nan] * 4
    values = np.array([row or nothing for row in results.values()], dtype=float)
    widths, radii = (x * MILLIMETRE for x in grid(study, 2 * study.machine.stator_outer_radius_mm))
    values = values.reshape(2, len(widths), len(radii), 4)
    null, period = values
    maps = {
        "aligned_tooth": DesignMap(widths, radii, null[..., 0], null[..., 1]),
        "every_tooth": DesignMap(widths, radii, null[..., 0], null[..., 2]),
        "every_tooth_and_back_iron_over_period": DesignMap(widths, radii, period[..., 0], period[..., 3]),
    }
    rows = []
    for reading, design_map in maps.items():
        for limit in study.saturation.limits_compared_T:
            best = design_map.best_point(limit)
            row = {"reading": reading, "limit_T": limit}
            if best is not None:
                row |= {"torque_nominal_Nm_per_m": best.torque, "back_iron_width_mm": best.width / MILLIMETRE}
                row |= {"rotor_outer_radius_mm": best.radius / MILLIMETRE}
            rows.append(row)
    columns = ["reading", "limit_T", "torque_nominal_Nm_per_m", "back_iron_width_mm", "rotor_outer_radius_mm"]
    return pd.DataFrame(rows, columns=columns)


def main(name: str) -> None:
    """Compare the limits of a study."""
    study = read_study(name)

    def work(run):
        from pipeline.parallel import default_workers, run_parallel

        results = run_parallel(solve_point, tasks_of(study), default_workers(), run.checkpoint(), "limits")
        run.write(OUTPUT, lambda path: table(study, results).to_csv(path, index=False))

    stage_of(study).run(work)


if __name__ == "__main__":
    with command():
        main(sys.argv[1])
