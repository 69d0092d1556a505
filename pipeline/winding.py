"""Turns and wires in hand of the matched machine, from its field solution.

Reads the study and ``match.json``, writes ``windings.csv`` (every pair that fits, the chosen one marked) and ``winding.json``
(the machine solved again, its per-turn values, the choice and its reason).
"""

from __future__ import annotations

import json
import sys

from pipeline.feeds import fed
from pipeline.stage import Stage, StageError, command, results_folder
from study.read import read_study

TABLE, OUTPUT = "windings.csv", "winding.json"


def stage_of(study) -> Stage:
    """The winding selection of a study."""
    from pipeline.match import OUTPUT as MATCH
    from pipeline.models import FIELD_CODE, FIELD_SECTIONS

    folder = results_folder(study.study.id)
    values = fed(study).subset(*FIELD_SECTIONS, "requirements", "winding_selection")
    code = (*FIELD_CODE, "electrical", "pipeline.feeds", "pipeline.winding")
    return Stage("winding", folder, values, (folder / MATCH,), code, (TABLE, OUTPUT))


def matched_machine(study):
    """The machine of ``match.json``."""
    from pipeline.match import read_match
    from pipeline.models import StudyFamily
    from units import MILLIMETRE

    found = read_match(study)
    lengths = (
        found[f"{name}_mm"] * MILLIMETRE for name in ("stator_outer_radius", "back_iron_width", "rotor_outer_radius")
    )
    return StudyFamily(study.machine).machine(found["slots"], *lengths)


def solve_per_turn(study, model) -> dict:
    """Per-turn values at the nominal and the overload current density."""
    from magnetostatics.per_turn import per_turn_values
    from optimisation.states import null_angle
    from pipeline.models import nominal_amplitude, overload_amplitude

    first, packing = null_angle(model.section.machine, model.section.layout), study.winding.packing_factor
    nominal, overload = (
        per_turn_values(model, f(study), packing, first) for f in (nominal_amplitude, overload_amplitude)
    )
    return {"nominal": nominal, "overload": overload}


def per_turn_machine(study, model, overload):
    """``PerTurnMachine`` of the matched active length."""
    from electrical.end_turn import end_turn_length
    from electrical.winding_selection import PerTurnMachine
    from pipeline.match import read_match
    from units import MILLIMETRE

    machine, layout = model.section.machine, model.section.layout
    return PerTurnMachine(
        pole_pairs=machine.pole_pairs,
        coils_in_series=layout.coils_in_series,
        half_slot_area=model.section.half_slot_area * model.section.half_slots_per_coil_side,
        active_length=read_match(study)["active_length_mm"] * MILLIMETRE,
        end_turn_length=end_turn_length(
            slots=machine.slots,
            shoe_top_radius=machine.shoe_top_radius,
            slot_bottom_radius=machine.slot_bottom_radius,
            tooth_width=machine.tooth_width,
        ),
        flux_linkage=overload.flux_linkage,
        inductance_d=overload.inductance_d,
        inductance_q=overload.inductance_q,
        overload_torque=overload.torque,
        overload_ampere_turns=overload.ampere_turns,
    )


def read_per_turn_machine(study):
    """``PerTurnMachine`` of a finished stage."""
    from electrical.winding_selection import PerTurnMachine

    return PerTurnMachine(**read_winding(study)["machine"])


def read_winding(study) -> dict:
    """The outcome of a finished stage."""
    return json.loads((results_folder(study.study.id) / OUTPUT).read_text(encoding="utf-8"))


def row(winding, chosen: bool) -> dict:
    """One winding in drawing units."""
    from units import MICROHENRY, MILLIOHM, RPM

    return {
        "turns": winding.turns,
        "strands": winding.strands,
        "chosen": chosen,
        "fullest": winding.fullest,
        "packing": winding.packing,
        "current_rms_A": winding.current_rms,
        "current_peak_A": winding.current_peak,
        "phase_to_phase_resistance_mOhm": winding.phase_to_phase_resistance / MILLIOHM,
        "phase_to_phase_inductance_uH": winding.phase_to_phase_inductance / MICROHENRY,
        "torque_constant_mNm_per_A": winding.torque_constant * 1e3,
        "peak_torque_Nm": winding.peak_torque,
        "base_speed_rpm": winding.base_speed / RPM,
        "power_at_base_speed_W": winding.power_at_base_speed,
        "maximum_power_W": winding.maximum_power,
        "speed_at_maximum_power_rpm": winding.speed_at_maximum_power / RPM,
    }


def choose(study, machine):
    """``WindingChoice`` for a ``PerTurnMachine``, against the requirements that feed the match."""
    from electrical.winding_selection import select_winding
    from pipeline.match import read_match
    from study.convert import to_winding_limits, to_winding_requirement, to_wire
    from units import MILLIMETRE

    ratio = read_match(study)["transmission_ratio_mm_per_rad"] * MILLIMETRE
    return select_winding(machine, to_wire(study), to_winding_limits(study), to_winding_requirement(fed(study), ratio))


def main(name: str) -> None:
    """Select the winding of a study's matched machine."""
    study = read_study(name)

    def work(run):
        import dataclasses

        import pandas as pd
        from electrical.winding_selection import WindingError
        from pipeline.models import field_model
        from study.convert import to_mesh_density

        model = field_model(study, matched_machine(study), to_mesh_density(study.mesh))
        values = solve_per_turn(study, model)
        machine = per_turn_machine(study, model, values["overload"])
        try:
            choice = choose(study, machine)
        except WindingError as error:
            raise StageError(f"no winding: {error}") from None
        print(f"winding: {choice.reason}")
        table = pd.DataFrame([row(winding, winding == choice.chosen) for winding in choice.table])
        outcome = {
            "chosen": row(choice.chosen, True),
            "reason": choice.reason,
            "machine": dataclasses.asdict(machine),
            "per_turn": {name: dataclasses.asdict(value) for name, value in values.items()},
        }
        run.write(TABLE, lambda path: table.to_csv(path, index=False))
        run.write_text(OUTPUT, json.dumps(outcome, indent=2) + "\n")

    stage_of(study).run(work)


if __name__ == "__main__":
    with command():
        main(sys.argv[1])
