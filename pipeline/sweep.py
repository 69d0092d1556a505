"""Map of torque and flux densities over back-iron width and rotor radius, for every slot count and stator diameter.

Reads the study, writes ``design_map.nc``. One task is a few neighbouring rotor radii with all back-iron widths.
"""

from __future__ import annotations

import sys
from contextlib import suppress
from functools import lru_cache
from itertools import product
from pathlib import Path

from pipeline.stage import Stage, command, results_folder
from study.read import read_study

OUTPUT = "design_map.nc"
_RADII_TOGETHER = 5  # of a fine sweep one mesh reaches about so many
_TOLERANCE = 1e-3  # of Newton's method: torque is within 0.03 % of the converged one
VARIABLES = {
    "torque_Nm_per_m": "torque",
    "torque_arkkio_Nm_per_m": "torque_arkkio",
    "tooth_aligned_T": "tooth_aligned",
    "tooth_worst_T": "tooth_worst",
    "back_iron_worst_T": "back_iron_worst",
    "limited_T": "limited",
}


def stage_of(study) -> Stage:
    """The sweep of a study."""
    from pipeline.models import FIELD_CODE, FIELD_SECTIONS

    values = study.subset(*FIELD_SECTIONS)
    values["saturation"] = {"reading": study.saturation.reading}
    return Stage(
        "sweep", results_folder(study.study.id), values, steel_files(study), (*FIELD_CODE, "pipeline.sweep"), (OUTPUT,)
    )


def steel_files(study) -> tuple[Path, ...]:
    """The curve file of the study's steel."""
    from materials.library import steel_file

    return (steel_file(study.materials.steel, study.path.parent),)


def solve_block(task: dict) -> list[list[list[float]]]:
    """All back-iron widths at some rotor radii: [radius][width] -> ``VARIABLES``, NaN where no machine can be built."""
    from math import nan

    from geometry.machine import GeometryError
    from optimisation.design import DesignSolver
    from units import MILLIMETRE

    judge, family = _tools(task["study"])
    outer, machines = task["stator_diameter_mm"] / 2 * MILLIMETRE, {}
    for place in product(task["rotor_outer_radii_mm"], task["back_iron_widths_mm"]):
        with suppress(GeometryError):
            machines[place] = family.machine(task["slots"], outer, place[1] * MILLIMETRE, place[0] * MILLIMETRE)
    designs = dict(zip(machines, DesignSolver(judge).designs(list(machines.values()))))

    def row(radius, width) -> list[float]:
        design = designs.get((radius, width))
        return [getattr(design, name) if design else nan for name in VARIABLES.values()]

    return [[row(radius, width) for width in task["back_iron_widths_mm"]] for radius in task["rotor_outer_radii_mm"]]


@lru_cache(maxsize=1)
def _tools(path: str):
    from magnetostatics.newton import NewtonSettings
    from pipeline.models import StudyFamily, judge_of

    study = read_study(path)
    return judge_of(study, settings=NewtonSettings(_TOLERANCE)), StudyFamily(study.machine)


def grid(study, diameter: float):
    """(back-iron widths, rotor radii) [mm] of one stator diameter [mm], as shares of the stator radius."""
    import numpy as np

    s, radius = study.sweep, diameter / 2
    widths = radius * np.linspace(s.back_iron_fraction_min, s.back_iron_fraction_max, s.back_iron_steps)
    radii = radius * np.linspace(s.rotor_radius_fraction_min, s.rotor_radius_fraction_max, s.rotor_radius_steps)
    return widths, radii


def tasks_of(study) -> dict[str, dict]:
    """Every block of the sweep by its name."""
    tasks = {}
    for slots, diameter in product(study.sweep.slots, study.sweep.stator_diameters_mm):
        widths, radii = grid(study, diameter)
        for first in range(0, len(radii), _RADII_TOGETHER):
            tasks[f"{slots} slots, {diameter:g} mm, radii from {first}"] = {
                "study": str(study.path.resolve()),
                "slots": slots,
                "stator_diameter_mm": diameter,
                "rotor_outer_radii_mm": radii[first : first + _RADII_TOGETHER].tolist(),
                "back_iron_widths_mm": widths.tolist(),
            }
    return tasks


def dataset_of(study, blocks: dict[str, list]):
    """The labelled map from the blocks of ``tasks_of``."""
    import numpy as np
    import xarray as xr

    s = study.sweep
    shape = len(s.slots), len(s.stator_diameters_mm), s.rotor_radius_steps, s.back_iron_steps, len(VARIABLES)
    values = np.concatenate(list(blocks.values())).reshape(shape).swapaxes(2, 3)
    grids = [grid(study, diameter) for diameter in s.stator_diameters_mm]
    dims = ("slots", "stator_diameter_mm", "back_iron", "rotor_radius")
    data = {name: (dims, values[..., k]) for k, name in enumerate(VARIABLES)}
    data["back_iron_width_mm"] = (dims[1:3], np.array([widths for widths, _ in grids]))
    data["rotor_outer_radius_mm"] = ((dims[1], dims[3]), np.array([radii for _, radii in grids]))
    coordinates = {
        "slots": list(s.slots),
        "stator_diameter_mm": list(s.stator_diameters_mm),
        "back_iron_fraction": (
            "back_iron",
            np.linspace(s.back_iron_fraction_min, s.back_iron_fraction_max, s.back_iron_steps),
        ),
        "rotor_radius_fraction": (
            "rotor_radius",
            np.linspace(s.rotor_radius_fraction_min, s.rotor_radius_fraction_max, s.rotor_radius_steps),
        ),
    }
    note = "torque per metre of active length, mean |B| over the probe segments; NaN where no machine can be built"
    return xr.Dataset(data, coordinates, {"reading": study.saturation.reading, "description": note})


def main(name: str) -> None:
    """Run the sweep of a study."""
    study = read_study(name)

    def work(run):
        from pipeline.parallel import default_workers, run_parallel
        from study.usable import check_study

        check_study(study)
        blocks = run_parallel(solve_block, tasks_of(study), default_workers(), run.checkpoint(), "sweep")
        dataset = dataset_of(study, blocks)
        run.note(designs=int(dataset.torque_Nm_per_m.size), not_buildable=int(dataset.torque_Nm_per_m.isnull().sum()))
        run.write(OUTPUT, dataset.to_netcdf)

    stage_of(study).run(work)


if __name__ == "__main__":
    with command():
        main(sys.argv[1])
