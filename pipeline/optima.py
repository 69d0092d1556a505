"""Constrained optimum of every slot count and stator diameter, refined with the field solver beyond the grid.

Reads the study and ``design_map.nc``, writes ``optima.csv``: the best design under the flux-density limit, its torque per
metre at the nominal and at the overload current density (solved, and scaled linearly from nominal as in eq. 3.68).
"""

from __future__ import annotations

import sys
from functools import lru_cache

from pipeline.stage import Stage, StageError, command, results_folder
from study.read import read_study

OUTPUT = "optima.csv"
COLUMNS = (
    "slots",
    "stator_diameter_mm",
    "stator_outer_radius_mm",
    "back_iron_width_mm",
    "rotor_outer_radius_mm",
    "tooth_width_mm",
    "half_slot_area_mm2",
    "torque_nominal_Nm_per_m",
    "torque_nominal_error_Nm_per_m",
    "torque_nominal_arkkio_Nm_per_m",
    "torque_overload_Nm_per_m",
    "torque_overload_error_Nm_per_m",
    "torque_overload_linear_Nm_per_m",
    "limited_T",
    "limit_T",
    "limit_binds",
    "tooth_worst_T",
    "back_iron_worst_T",
    "reading",
    "field_solutions",
    "newton_iterations",
)


def stage_of(study) -> Stage:
    """The refined optima of a study."""
    from pipeline.models import FIELD_CODE, FIELD_SECTIONS
    from pipeline.sweep import OUTPUT as MAP, steel_files

    folder = results_folder(study.study.id)
    files = (folder / MAP, *steel_files(study))
    return Stage("optima", folder, study.subset(*FIELD_SECTIONS), files, (*FIELD_CODE, "pipeline.optima"), (OUTPUT,))


def read_map(study, slots: int, diameter: float, variable: str = "limited_T"):
    """``DesignMap`` of one slot count and stator diameter [mm]; ``variable`` is the limited flux density."""
    import xarray as xr
    from optimisation.design_map import DesignMap
    from pipeline.sweep import OUTPUT as MAP
    from units import MILLIMETRE

    with xr.open_dataset(results_folder(study.study.id) / MAP) as data:
        one = data.sel(slots=slots, stator_diameter_mm=diameter).load()
    widths, radii = one.back_iron_width_mm.values * MILLIMETRE, one.rotor_outer_radius_mm.values * MILLIMETRE
    return DesignMap(widths, radii, one.torque_Nm_per_m.values, one[variable].values)


def solve_optimum(task: dict) -> dict | None:
    """The refined optimum of one slot count and diameter as a row of the table; None where the limit cannot be held."""
    from optimisation.constrained_optimum import find_optimum
    from pipeline.models import StudyFamily, judge_of, overload_amplitude
    from units import MILLIMETRE

    study = _study(task["study"])
    start = read_map(study, task["slots"], task["stator_diameter_mm"]).best_point(study.saturation.limit_T)
    if start is None:
        return None
    judge = judge_of(study)
    radius = task["stator_diameter_mm"] / 2 * MILLIMETRE
    limit = study.saturation.limit_T
    optimum = find_optimum(judge, StudyFamily(study.machine), task["slots"], radius, limit, (start.width, start.radius))
    overloaded = judge.at_amplitude(overload_amplitude(study))
    machine = optimum.design.machine
    errors = judge.torque_error(machine), overloaded.torque_error(machine)
    return _row(study, task, optimum, overloaded.judge(machine), errors)


@lru_cache(maxsize=1)
def _study(path: str):
    return read_study(path)


def _row(study, task, optimum, overload, errors) -> dict:
    from units import MILLIMETRE, SQUARE_MILLIMETRE

    design, machine = optimum.design, optimum.design.machine
    ratio = study.sweep.j_overload_rms_A_per_mm2 / study.sweep.j_nominal_rms_A_per_mm2
    values = (
        task["slots"],
        task["stator_diameter_mm"],
        task["stator_diameter_mm"] / 2,
        machine.back_iron_width / MILLIMETRE,
        machine.rotor_outer_radius / MILLIMETRE,
        machine.tooth_width / MILLIMETRE,
        design.coil_side_area / SQUARE_MILLIMETRE,
        design.torque,
        errors[0],
        design.torque_arkkio,
        overload.torque,
        errors[1],
        design.torque * ratio,
        design.limited,
        study.saturation.limit_T,
        optimum.limit_binds,
        design.tooth_worst,
        design.back_iron_worst,
        study.saturation.reading,
        optimum.solves,
        design.newton_iterations,
    )
    return dict(zip(COLUMNS, values, strict=True))


def tasks_of(study) -> dict[str, dict]:
    """One task for each slot count and stator diameter."""
    path = str(study.path.resolve())
    return {
        f"{slots} slots, {diameter:g} mm": {"study": path, "slots": slots, "stator_diameter_mm": diameter}
        for slots in study.sweep.slots
        for diameter in study.sweep.stator_diameters_mm
    }


def main(name: str) -> None:
    """Refine the optima of a study."""
    study = read_study(name)

    def work(run):
        import pandas as pd
        from pipeline.parallel import default_workers, run_parallel

        rows = run_parallel(solve_optimum, tasks_of(study), default_workers(), run.checkpoint(), "optima")
        without = [name for name, row in rows.items() if row is None]
        found = [row for row in rows.values() if row is not None]
        if without:
            print(
                f"optima: no design holds {study.saturation.limit_T:g} T ({study.saturation.reading}) for {'; '.join(without)}"
            )
        if not found:
            raise StageError(
                f"no design of the sweep holds the limit of {study.saturation.limit_T:g} T read as "
                f"{study.saturation.reading}: raise saturation.limit_T or widen the sweep."
            )
        run.note(without_optimum=without, constraint_tolerance=2e-4)
        run.write(OUTPUT, lambda path: pd.DataFrame(found, columns=COLUMNS).to_csv(path, index=False))

    stage_of(study).run(work)


if __name__ == "__main__":
    with command():
        main(sys.argv[1])
