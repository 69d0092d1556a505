"""Fields of the reference machine and of the matched machine, and both over one electrical period.

Reads the study and ``match.json``, writes for each machine ``rotation_<machine>.csv`` (torque by both routes, torque
without current, every probe over the rotor angle) and fields ``<machine>_<state>.vtu`` for ParaView or ``make inspect``.
"""

from __future__ import annotations

import sys
from functools import lru_cache

from pipeline.stage import Stage, command, results_folder
from study.read import read_study

MACHINES = ("reference", "matched")
STATES = ("no_current", "nominal", "overload")
_STEPS = 144  # over one electrical period: twelve in a period of the cogging of 12 slots and 10 poles
ROTATIONS = {machine: f"rotation_{machine}.csv" for machine in MACHINES}
FIELDS = {(machine, state): f"{machine}_{state}.vtu" for machine in MACHINES for state in STATES}


def stage_of(study) -> Stage:
    """The detailed fields of a study."""
    from pipeline.match import OUTPUT as MATCH
    from pipeline.models import FIELD_CODE, FIELD_SECTIONS

    folder = results_folder(study.study.id)
    code = (*FIELD_CODE, "figures.export", "figures.whole_field", "pipeline.fields", "pipeline.winding")
    outputs = (*ROTATIONS.values(), *FIELDS.values())
    return Stage("fields", folder, study.subset(*FIELD_SECTIONS), (folder / MATCH,), code, outputs)


def machine_of(study, name: str):
    """The study's own machine, or the one the match arrived at."""
    from pipeline.winding import matched_machine
    from study.convert import to_machine

    return to_machine(study.machine) if name == "reference" else matched_machine(study)


def null_points(study, model) -> dict:
    """The states that are written as fields, all in the null position."""
    from magnetostatics.model import OperatingPoint
    from optimisation.states import null_angle, null_current_angle
    from pipeline.models import nominal_amplitude, overload_amplitude

    machine, layout, packing = model.section.machine, model.section.layout, study.winding.packing_factor
    angle, gamma = null_angle(machine, layout), null_current_angle(machine, layout)
    amplitudes = (0.0, nominal_amplitude(study), overload_amplitude(study))
    return {state: OperatingPoint(angle, amplitude, gamma, packing) for state, amplitude in zip(STATES, amplitudes)}


def solve_angle(task: dict) -> dict:
    """One row of the rotation table."""
    from magnetostatics.model import OperatingPoint
    from magnetostatics.probes import probe_reader
    from magnetostatics.torque import arkkio_torque, maxwell_torque
    from pipeline.models import nominal_amplitude
    from units import DEGREE

    study, model = _model(task["study"], task["machine"], detailed=False)
    angle, packing = task["angle_deg"] * DEGREE, study.winding.packing_factor
    idle = model.solve(OperatingPoint(angle, 0.0, 0.0, packing))
    loaded = model.solve(OperatingPoint(angle, nominal_amplitude(study), 0.0, packing), start=idle)
    return {
        "angle_mech_deg": task["angle_deg"],
        "torque_arkkio_Nm_per_m": arkkio_torque(loaded),
        "torque_maxwell_Nm_per_m": maxwell_torque(loaded),
        "torque_no_current_Nm_per_m": arkkio_torque(idle),
        **{f"{name}_T": value for name, value in probe_reader(model).read(loaded).items()},
    }


@lru_cache(maxsize=2)
def _model(path: str, machine: str, detailed: bool):
    from pipeline.models import detail_density, field_model
    from study.convert import to_mesh_density

    study = read_study(path)
    density = detail_density(study) if detailed else to_mesh_density(study.mesh)
    return study, field_model(study, machine_of(study, machine), density)


def tasks_of(study) -> dict[str, dict]:
    """Every machine at every angle of one electrical period, from the null position on."""
    from optimisation.states import null_angle
    from pipeline.models import layout_of
    from units import DEGREE

    tasks = {}
    for name in MACHINES:
        machine = machine_of(study, name)
        first, step = null_angle(machine, layout_of(study, machine.slots)) / DEGREE, 360 / machine.pole_pairs / _STEPS
        for k in range(_STEPS + 1):
            task = {"study": str(study.path.resolve()), "machine": name, "angle_deg": first + k * step}
            tasks[f"{name}, {task['angle_deg']:g} deg"] = task
    return tasks


def torque_error(study, machine: str) -> float:
    """Bound of the mesh error of the torques in a rotation table [Nm/m], by one refinement in the null position."""
    from magnetostatics.mesh_error import torque_with_error

    _, model = _model(str(study.path.resolve()), machine, detailed=False)
    return torque_with_error(model, null_points(study, model)["nominal"])[1]


def _write_rotations(study, run, rows: dict[str, dict]) -> None:
    import pandas as pd

    for name in MACHINES:
        own = [row for key, row in rows.items() if key.startswith(name)]
        first = ["angle_mech_deg", *(f"torque_{what}_Nm_per_m" for what in ("arkkio", "maxwell", "error", "no_current"))]
        table = pd.DataFrame(own).assign(torque_error_Nm_per_m=torque_error(study, name))
        probes = sorted((c for c in table if c not in first), key=lambda c: (c.split("_")[0], int(c.split("_")[-2])))
        run.write(ROTATIONS[name], lambda path, table=table[first + probes]: table.to_csv(path, index=False))


def _write_fields(study, run) -> None:
    from figures.export import write_vtu

    for name in MACHINES:
        _, model = _model(str(study.path.resolve()), name, detailed=True)
        for state, point in null_points(study, model).items():
            solution = model.solve(point)
            run.note(**{f"newton_{name}_{state}": list(solution.newton.residuals)})
            run.write(FIELDS[name, state], lambda path, solution=solution: write_vtu(path, solution))


def main(name: str) -> None:
    """Solve the detailed fields of a study."""
    study = read_study(name)

    def work(run):
        from pipeline.parallel import default_workers, run_parallel

        _write_rotations(study, run, run_parallel(solve_angle, tasks_of(study), default_workers(), run.checkpoint(), "fields"))
        _write_fields(study, run)

    stage_of(study).run(work)


if __name__ == "__main__":
    with command():
        main(sys.argv[1])
