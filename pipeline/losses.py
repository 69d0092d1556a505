"""Electrical losses of the wound machine over torque and speed: copper, iron, magnets (thesis Fig. 4.5), efficiency.

    python -m pipeline.losses motorcycle M235-35A        # the loss data that stand for the study's steel

Reads the study, ``match.json`` and ``winding.json``, writes ``loss_map.nc`` (torque x speed), ``losses.json`` (what the
numbers rest on, best efficiency) and ``figures/losses.png``. The loss grade is an argument, or ``materials.loss_grade``
of the study; none is assumed.
"""

from __future__ import annotations

import json
import sys
from functools import lru_cache

from pipeline.stage import Stage, StageError, command, results_folder
from study.read import read_study

OUTPUT, FACTS, FIGURE = "loss_map.nc", "losses.json", "figures/losses.png"
_TORQUES, _SPEEDS = 161, 121
_LARGEST = 1.02  # of the winding's peak ampere-turns: the corner of the map lies on the current limit


def stage_of(study, loss_grade: str) -> Stage:
    """The loss map of a study with the loss data of a grade."""
    from pipeline.match import OUTPUT as MATCH
    from pipeline.models import FIELD_CODE, FIELD_SECTIONS
    from pipeline.winding import OUTPUT as WINDING

    folder = results_folder(study.study.id)
    values = study.subset(*FIELD_SECTIONS, "winding_selection") | {"loss_grade": loss_grade}
    code = (*FIELD_CODE, "electrical", "losses", "figures.losses", "pipeline.winding", "pipeline.losses")
    return Stage("losses", folder, values, (folder / MATCH, folder / WINDING), code, (OUTPUT, FACTS, FIGURE))


def loss_grade_of(study, stated: str | None) -> str:
    """The grade whose loss data are used: the one stated, or the study's; StageError without one."""
    from materials.errors import MaterialError
    from materials.iron_loss import iron_loss_law

    try:
        return iron_loss_law(stated or study.materials.loss_grade).grade
    except MaterialError as error:
        raise StageError(f"no losses for steel {study.materials.steel}: {error}") from None


def solve_point(task: dict) -> list:
    """Numbers of ``FieldLosses`` at one current."""
    from dataclasses import astuple

    from losses.map import current_point, field_losses
    from materials.iron_loss import iron_loss_law

    study, model = _model(task["study"])
    point = current_point(model.section, task["direct_A"], task["quadrature_A"], study.winding.packing_factor)
    return [float(x) for part in astuple(field_losses(model, point, iron_loss_law(task["loss_grade"]))) for x in part]


@lru_cache(maxsize=1)
def _model(path: str):
    from pipeline.models import field_model
    from pipeline.winding import matched_machine
    from study.convert import to_mesh_density

    study = read_study(path)
    return study, field_model(study, matched_machine(study), to_mesh_density(study.mesh))


def tasks_of(study, loss_grade: str, largest: float) -> dict[str, dict]:
    """One task a current of the grid up to ``largest`` peak ampere-turns of a coil [A]."""
    from losses.map import grid

    shared = {"study": str(study.path.resolve()), "loss_grade": loss_grade}
    return {f"d {d:.0f} A, q {q:.0f} A": {**shared, "direct_A": d, "quadrature_A": q} for d, q in grid(largest)}


def table_from(largest: float, results: list[list[float]]):
    """``FieldLossTable`` from the results of ``solve_point``."""
    from losses.iron import FrequencyTerms
    from losses.map import FieldLosses, table_of

    return table_of(largest, [FieldLosses(*(FrequencyTerms(*row[k : k + 3]) for k in (0, 3, 6))) for row in results])


def wound_machine(study, choice):
    """``WoundMachine`` of the chosen winding."""
    from losses.copper import WoundMachine
    from pipeline.models import layout_of
    from pipeline.winding import matched_machine, read_per_turn_machine
    from study.convert import to_wire

    machine, chosen = matched_machine(study), choice.chosen
    length, area = read_per_turn_machine(study).active_length, to_wire(study).area
    return WoundMachine(machine, layout_of(study, machine.slots), chosen.turns, chosen.strands, area, length)


def operating_plane(study, choice):
    """Currents over torque (outermost) and speed, up to the limits of the winding selection (``OperatingMap``)."""
    import numpy as np
    from electrical.synchronous_machine import DriveLimits, operating_map
    from pipeline.winding import read_per_turn_machine
    from study.convert import to_winding_limits

    limits, chosen = to_winding_limits(study), choice.chosen
    drive = DriveLimits.from_dc_bus(chosen.current_peak, limits.dc_voltage)
    motor = chosen.machine(read_per_turn_machine(study).pole_pairs)
    torques = np.linspace(0, chosen.peak_torque, _TORQUES)
    speed, torque = np.meshgrid(np.linspace(0, limits.maximum_speed, _SPEEDS), torques)
    reached = operating_map(motor, drive, torque, speed)
    last = np.flatnonzero(np.isfinite(reached.i_q).any(axis=0))[-1]  # speeds beyond are out of reach at any torque
    top = min(last + 1, _SPEEDS - 1) / (_SPEEDS - 1) * limits.maximum_speed
    speed, torque = np.meshgrid(np.linspace(0, top, _SPEEDS), torques)
    return operating_map(motor, drive, torque, speed)


def dataset(losses):
    """The map as a labelled data set in drawing units."""
    import xarray as xr
    from units import RPM

    names = {"copper_W": losses.copper, "stator_iron_W": losses.stator_iron, "rotor_iron_W": losses.rotor_iron}
    names |= {"magnet_W": losses.magnet, "total_W": losses.total, "efficiency": losses.efficiency}
    coordinates = {"torque_Nm": losses.torque[:, 0], "speed_rpm": losses.speed[0] / RPM}
    return xr.Dataset({name: (("torque_Nm", "speed_rpm"), values) for name, values in names.items()}, coordinates)


def summary(study, law, wound, resistance, data) -> dict:
    """What the map rests on, and its best point."""
    from dataclasses import asdict

    from units import MILLIOHM

    best = data.efficiency.where(data.efficiency == data.efficiency.max(), drop=True)
    return {
        "steel": study.materials.steel,
        "loss_grade": law.grade,
        "loss_data_are_of_another_grade": law.grade != study.materials.steel,
        "loss_law": asdict(law),
        "phase_resistance_mOhm": resistance / MILLIOHM,
        "winding_temperature_degC": study.winding_selection.winding_temperature_degC,
        "end_turn_share_of_copper": wound.end_turn_share,
        "best_efficiency": float(data.efficiency.max()),
        "best_torque_Nm": float(best.torque_Nm[0]),
        "best_speed_rpm": float(best.speed_rpm[0]),
    }


def main(name: str, stated_grade: str | None = None) -> None:
    """Map the losses of a study's wound machine."""
    study = read_study(name)
    grade = loss_grade_of(study, stated_grade)

    def work(run):
        from figures.losses import loss_maps
        from figures.style import save_png
        from losses.map import loss_map
        from materials.iron_loss import iron_loss_law
        from pipeline.parallel import default_workers, run_parallel
        from pipeline.winding import choose, read_per_turn_machine
        from study.convert import winding_resistivity

        choice = choose(study, read_per_turn_machine(study))
        wound, law = wound_machine(study, choice), iron_loss_law(grade)
        largest = _LARGEST * choice.chosen.turns * choice.chosen.current_peak
        tasks = tasks_of(study, grade, largest)
        results = run_parallel(solve_point, tasks, default_workers(), run.checkpoint(), "losses")
        resistance = wound.phase_resistance(winding_resistivity(study))
        table = table_from(largest, list(results.values()))
        data = dataset(loss_map(operating_plane(study, choice), wound, table, resistance))
        facts = summary(study, law, wound, resistance, data)
        title = f"{wound.turns} turns, {wound.strands} wires; iron loss data of {law.grade} for {study.materials.steel}"
        run.write(OUTPUT, lambda path: data.to_netcdf(path))
        run.write_text(FACTS, json.dumps(facts, indent=2) + "\n")
        run.write(FIGURE, lambda path: save_png(loss_maps(data, title), path))

    stage_of(study, grade).run(work)


if __name__ == "__main__":
    with command():
        main(*sys.argv[1:3])
