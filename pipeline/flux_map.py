"""Flux map of the matched machine with its winding, and what it does over speed.

Reads the study, ``match.json`` and ``winding.json``; writes ``flux_map.nc`` (per turn and metre, over currents and
rotor angle), ``flux_map_export.mat`` and ``.npz`` (the wound machine for other programs), ``flux_map_envelope.csv``
(torque over speed, MTPA and MTPV) and ``flux_map.json`` (base speeds beside those of the constant parameters). A task is
one angle.
"""

from __future__ import annotations

import json
import sys
from functools import lru_cache

from pipeline.stage import Stage, command, results_folder
from study.read import read_study

MAP, ENVELOPE, OUTPUT = "flux_map.nc", "flux_map_envelope.csv", "flux_map.json"
EXPORTS = ("flux_map_export.mat", "flux_map_export.npz")
_ANGLES = 10  # over 60 electrical degrees; the mean over them is free of harmonics below the 60th
_CURRENTS = 11  # along i_d and along i_q >= 0
_MARGIN = 1.05  # reach of the map over the ampere-turns of the winding
_SPEEDS = 151


def stage_of(study) -> Stage:
    """The flux map of a study."""
    from pipeline import match, winding
    from pipeline.models import FIELD_CODE, FIELD_SECTIONS

    folder = results_folder(study.study.id)
    code = (*FIELD_CODE, "electrical", "pipeline.winding", "pipeline.flux_map")
    values = study.subset(*FIELD_SECTIONS, "winding_selection", "flux_map")
    files = (folder / match.OUTPUT, folder / winding.OUTPUT)
    return Stage("flux_map", folder, values, files, code, (MAP, *EXPORTS, ENVELOPE, OUTPUT))


def reach_of(chosen: dict) -> float:
    """Largest ampere-turns of the map [A] for the winding of ``winding.json``."""
    return _MARGIN * chosen["turns"] * chosen["current_peak_A"]


def solve_angle(task: dict) -> dict:
    """All currents at one rotor angle."""
    from magnetostatics import flux_map

    model, grid = _model(task["study"], task["reach"])
    return flux_map.solve_angle(model, task["angle"], grid)


@lru_cache(maxsize=1)
def _model(path: str, reach: float):
    from magnetostatics.flux_map import CurrentGrid
    from pipeline.models import field_model
    from pipeline.winding import matched_machine
    from study.convert import to_mesh_density

    study = read_study(path)
    model = field_model(study, matched_machine(study), to_mesh_density(study.mesh))
    return model, CurrentGrid.motoring(reach, study.flux_map.currents or _CURRENTS)


def tasks_of(study, angles, reach: float) -> dict[str, dict]:
    """Every rotor angle by its name."""
    path = str(study.path.resolve())
    return {f"angle {k}": {"study": path, "angle": float(angle), "reach": reach} for k, angle in enumerate(angles)}


def machines(study, data):
    """The wound machine as its flux map, and as the constant parameters that its winding was chosen by."""
    from electrical.flux_map_machine import FluxMapMachine
    from pipeline.winding import choose, read_per_turn_machine

    per_turn = read_per_turn_machine(study)
    winding = choose(study, per_turn).chosen
    field = FluxMapMachine.from_per_turn(
        data, turns=winding.turns, active_length=per_turn.active_length, resistance=winding.phase_resistance
    )
    return field, winding.machine(per_turn.pole_pairs)


def drive_limits(study, chosen: dict):
    """Phase current of the chosen winding and the phase voltage of the bus."""
    from electrical.synchronous_machine import DriveLimits

    return DriveLimits.from_dc_bus(chosen["current_peak_A"], study.winding_selection.dc_bus_voltage_V)


def envelope_table(study, field, constant, limits):
    """Torque over speed of the flux map and of the constant parameters, and the MTPV current of the flux map."""
    import numpy as np
    import pandas as pd
    from electrical import flux_map_limits, synchronous_machine
    from units import RPM

    speed = np.linspace(0.0, study.winding_selection.speed_max_rpm * RPM, _SPEEDS)
    mapped = flux_map_limits.torque_speed_envelope(field, limits, speed)
    plain = synchronous_machine.torque_speed_envelope(constant, limits, speed)
    i_d, i_q = flux_map_limits.mtpv_currents(field, limits.voltage_peak, speed)
    columns = {"speed_rpm": speed / RPM}
    for name, envelope in (("field", mapped), ("constant", plain)):
        columns |= {f"torque_{name}_Nm": envelope.torque, f"power_{name}_W": envelope.power}
        columns |= {f"i_d_{name}_A": envelope.i_d, f"i_q_{name}_A": envelope.i_q}
        columns |= {f"voltage_{name}_V": envelope.voltage_peak}
    return pd.DataFrame({**columns, "i_d_mtpv_A": i_d, "i_q_mtpv_A": i_q})


def summary(field, constant, limits) -> dict:
    """Full-current values of the flux map and of the constant parameters, in drawing units."""
    from electrical import flux_map_limits, synchronous_machine
    from units import RPM

    def values(machine, module):
        i_d, i_q = module.mtpa_currents(machine, limits.current_peak)
        on_q = synchronous_machine.corner_speed(machine, limits, 0.0, limits.current_peak)
        return {
            "mtpa_i_d_A": float(i_d),
            "mtpa_i_q_A": float(i_q),
            "mtpa_torque_Nm": float(machine.torque(i_d, i_q)),
            "base_speed_rpm": float(module.base_speed(machine, limits)) / RPM,
            "q_axis_torque_Nm": float(machine.torque(0.0, limits.current_peak)),
            "q_axis_corner_speed_rpm": float(on_q) / RPM,
        }

    return {
        "current_peak_A": limits.current_peak,
        "voltage_peak_V": limits.voltage_peak,
        "field": values(field, flux_map_limits),
        "constant": values(constant, synchronous_machine),
    }


def torque_error(study, chosen: dict, i_d: float, i_q: float) -> float:
    """What the mesh may have put the torque at one current [A] off by [Nm], bounded in the first rotor position."""
    from magnetostatics.flux_map import map_angles, operating_point
    from magnetostatics.mesh_error import torque_with_error
    from pipeline.winding import read_per_turn_machine

    model, _ = _model(str(study.path.resolve()), reach_of(chosen))
    point = operating_point(model, map_angles(model, 1)[0], chosen["turns"] * i_d, chosen["turns"] * i_q)
    return torque_with_error(model, point)[1] * read_per_turn_machine(study).active_length


def read_flux_map(study):
    """The map of a finished stage."""
    import xarray as xr

    with xr.open_dataset(results_folder(study.study.id) / MAP) as data:
        return data.load()


def _solve(study, chosen: dict, run):
    from magnetostatics.flux_map import map_angles, mirrored, to_dataset
    from pipeline.parallel import default_workers, run_parallel

    reach = reach_of(chosen)
    model, grid = _model(str(study.path.resolve()), reach)
    angles = map_angles(model, study.flux_map.angles or _ANGLES)
    rows = run_parallel(solve_angle, tasks_of(study, angles, reach), default_workers(), run.checkpoint(), "flux map")
    data = to_dataset(model, grid, angles, list(rows.values()))
    iterations = data.iterations
    run.note(solves=iterations.size, newton_iterations=int(iterations.sum()), most_iterations=int(iterations.max()))
    return mirrored(data)


def main(name: str) -> None:
    """Solve the flux map of a study's matched machine."""
    study = read_study(name)

    def work(run):
        from electrical.flux_map_export import flux_tables, write_mat, write_npz
        from pipeline.winding import read_winding

        chosen = read_winding(study)["chosen"]
        data = _solve(study, chosen, run)
        field, constant = machines(study, data)
        limits = drive_limits(study, chosen)
        tables = flux_tables(field)
        run.write(MAP, data.to_netcdf)
        for output, writer in zip(EXPORTS, (write_mat, write_npz), strict=True):
            run.write(output, lambda path, writer=writer: writer(path, tables))
        table = envelope_table(study, field, constant, limits)
        run.write(ENVELOPE, lambda path: table.to_csv(path, index=False))
        found = summary(field, constant, limits)
        best = found["field"]
        best["mtpa_torque_error_Nm"] = torque_error(study, chosen, best["mtpa_i_d_A"], best["mtpa_i_q_A"])
        print("flux_map: {mtpa_torque_Nm:.3f} ± {mtpa_torque_error_Nm:.3f} Nm at full current "
              "(± bounds the error of the mesh)".format(**best))  # fmt: skip
        run.write_text(OUTPUT, json.dumps(found, indent=2) + "\n")

    stage_of(study).run(work)


if __name__ == "__main__":
    with command():
        main(sys.argv[1])
