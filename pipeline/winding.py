"""Turns and wires in hand of the matched machine, and the active length that they need behind the real gears.

Reads the study, ``match.json`` and ``gearbox.json``, writes ``windings.csv`` (every pair that fits, the chosen one
marked) and ``winding.json`` (the machine solved again, its per-turn values, the choice and its reason, the length).
"""

from __future__ import annotations

import json
import sys

from pipeline.feeds import fed
from pipeline.stage import Stage, StageError, command, results_folder
from study.read import read_study

TABLE, OUTPUT = "windings.csv", "winding.json"
_ROUNDS = 4  # of choosing a winding and giving it its length; two are enough unless the choice changes with the length
_SAME_LENGTH = 1e-6  # relative
# Share by which the torque of the field may be off: 0.2 % by the mesh, the rest by six rotor positions and by reading
# the flux map between its currents, on which the outcome is judged.
_TORQUE_DOUBT = 0.005
_CURRENT_ANGLES = (0.0, 10.0, 20.0, 30.0, 40.0)  # degrees; the largest torque is read off a parabola


def stage_of(study) -> Stage:
    """The winding selection of a study."""
    from pipeline.gearbox import OUTPUT as GEARBOX
    from pipeline.match import OUTPUT as MATCH
    from pipeline.models import FIELD_CODE, FIELD_SECTIONS

    folder = results_folder(study.study.id)
    values = fed(study).subset(*FIELD_SECTIONS, "requirements", "linkage", "match", "winding_selection")
    code = (*FIELD_CODE, "electrical", "drivetrain.constraints", "drivetrain.final_length", "pipeline.feeds")
    files = (folder / MATCH, folder / GEARBOX)
    return Stage("winding", folder, values, files, (*code, "pipeline.winding"), (TABLE, OUTPUT))


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
    """``WindingChoice`` for a ``PerTurnMachine``, against the requirements that feed the match.

    The torque is not asked of the winding: the length is made for it.
    """
    from dataclasses import replace

    from electrical.winding_selection import select_winding
    from pipeline.gearbox import read_ratio
    from study.convert import to_winding_limits, to_winding_requirement, to_wire

    requirement = replace(to_winding_requirement(fed(study), read_ratio(study)), torque=0.0)
    return select_winding(machine, to_wire(study), to_winding_limits(study), requirement)


# ---- the length -----------------------------------------------------------------------------------------------------


def largest_torque(model, amplitude: float, packing: float) -> float:
    """Torque per metre at the best current angle [Nm/m], mean over the rotor position."""
    import numpy as np
    from magnetostatics.per_turn import mean_torque
    from units import DEGREE

    torques = np.array([mean_torque(model, amplitude, packing, angle * DEGREE) for angle in _CURRENT_ANGLES])
    best = int(np.clip(torques.argmax(), 1, len(torques) - 2))
    before, top, after = torques[best - 1 : best + 2]
    bend = before - 2 * top + after
    shift = np.clip((before - after) / (2 * bend), -1, 1) if bend < 0 else 0.0
    return float(top - (before - after) * shift / 4)


def length_needs(study, model, machine, winding) -> list:
    """What the wound machine must be long for, as ``LengthNeed``; study: fed.

    Forces count where the linkage ratio is largest, so that they hold over the whole wheel travel; the damping, where
    the study enforces it, in the nominal position, as in the match.
    """
    from drivetrain.constraints import winding_damping
    from drivetrain.final_length import LengthNeed, length_for_damping, length_for_force
    from pipeline.gearbox import read_ratio
    from pipeline.models import nominal_amplitude, overload_amplitude

    required, linkage = study.requirements, study.linkage
    nominal = read_ratio(study)
    largest = nominal * linkage.ratio_max_mm_per_rad / linkage.ratio_nominal_mm_per_rad

    def torque(amplitude, packing):
        return (1 - _TORQUE_DOUBT) * largest_torque(model, amplitude, packing)

    needs = [
        LengthNeed(name, length_for_force(force, largest, torque(amplitude(study), winding.packing)))
        for name, force, amplitude in (
            ("the peak force", required.force_peak_N, overload_amplitude),
            ("the RMS force", required.force_rms_N, nominal_amplitude),
        )
    ]
    if not study.match.enforce_damping:
        return needs
    reached = winding_damping(
        torque_constant=winding.no_load_torque_constant,
        phase_resistance=winding.phase_resistance,
        transmission_ratio=nominal,
    )
    lengths = {"length": machine.active_length, "end_turn_length": machine.end_turn_length}
    damping = required.maximum_damping_kNs_per_m * 1e3
    return [*needs, LengthNeed("the damping", length_for_damping(damping, reached=reached, **lengths))]


def wound_to_length(study, model, machine):
    """(machine with its final length, ``WindingChoice``, ``FinalLength``): the two are chosen in turns; study: fed."""
    from dataclasses import replace

    from drivetrain.final_length import final_length
    from units import MILLIMETRE

    needs = {}  # by turns and wires: they do not know the length that they start from
    longest = study.match.length_max_mm * MILLIMETRE
    for _ in range(_ROUNDS):
        choice = choose(study, machine)
        key = choice.chosen.turns, choice.chosen.strands
        needs[key] = needs.get(key) or length_needs(study, model, machine, choice.chosen)
        found = final_length(needs[key], longest)
        if abs(found.length / machine.active_length - 1) < _SAME_LENGTH:
            return machine, choice, found
        machine = replace(machine, active_length=found.length)
    return machine, choose(study, machine), found


def length_reason(found, matched: float, length: float, winding, packing: float) -> str:
    """Why the final length differs from the matched one, both [m]."""
    from units import MILLIMETRE

    short = "; the longest that is allowed, too short for it" if found.short else ""
    return (
        f"{length / MILLIMETRE:.1f} mm of active length instead of the {matched / MILLIMETRE:.2f} mm of the match, "
        f"set by {found.set_by.name}{short}. The match counts on a packing factor of {packing:g} and on a ratio that "
        f"is any number; {winding.turns} turns of {winding.strands} wires fill {winding.packing:.3f}, the teeth give "
        "their own ratio, and the torque is that of the field at the best current angle, less "
        f"{100 * _TORQUE_DOUBT:g} % for what it is trusted to."
    )


def main(name: str) -> None:
    """Select the winding of a study's matched machine."""
    own = read_study(name)
    study = fed(own)

    def work(run):
        import dataclasses

        import pandas as pd
        from electrical.winding_selection import WindingError
        from pipeline.models import field_model
        from study.convert import to_mesh_density
        from units import MILLIMETRE

        model = field_model(study, matched_machine(study), to_mesh_density(study.mesh))
        values = solve_per_turn(study, model)
        matched = per_turn_machine(study, model, values["overload"])
        try:
            machine, choice, found = wound_to_length(study, model, matched)
        except WindingError as error:
            raise StageError(f"no winding: {error}") from None
        lengths = (matched.active_length, machine.active_length)
        why = length_reason(found, *lengths, choice.chosen, study.winding.packing_factor)
        print(f"winding: {choice.reason} {why}")
        table = pd.DataFrame([row(winding, winding == choice.chosen) for winding in choice.table])
        outcome = {
            "chosen": row(choice.chosen, True),
            "reason": choice.reason,
            "length": {"reason": why, "matched_mm": lengths[0] / MILLIMETRE, "final_mm": lengths[1] / MILLIMETRE},
            "machine": dataclasses.asdict(machine),
            "per_turn": {name: dataclasses.asdict(value) for name, value in values.items()},
        }
        run.write(TABLE, lambda path: table.to_csv(path, index=False))
        run.write_text(OUTPUT, json.dumps(outcome, indent=2) + "\n")

    stage_of(own).run(work)


if __name__ == "__main__":
    with command():
        main(sys.argv[1])
