"""The wound machine on its flux map: windings with saturation, currents and voltages in the force-velocity plane.

Reads the study, ``flux_map.nc``, ``gearbox.json`` and ``winding.json``; writes ``windings_field.csv`` (base speed, powers
and torque of neighbouring windings from the flux map beside those of constant parameters), ``drive.json`` (the winding
that the flux map would choose) and figures (thesis Fig. 3.27).
"""

from __future__ import annotations

import json
import sys

from pipeline.feeds import fed
from pipeline.stage import Stage, command, results_folder
from study.read import read_study

WINDINGS, OUTPUT = "windings_field.csv", "drive.json"
FIGURES = {
    "flux_map": "figures/flux_map.png",
    "field_envelope": "figures/field_envelope.png",
    "force_velocity_field": "figures/force_velocity_field.png",
}
_NEIGHBOURS = 3  # turns either side of the chosen winding
_SPEEDS, _TORQUES = 121, 81


def stage_of(study) -> Stage:
    """The drive of a study."""
    from pipeline import flux_map, gearbox, winding

    folder = results_folder(study.study.id)
    values = fed(study).subset("requirements", "winding_selection", "sweep", "winding")
    files = tuple(folder / name for name in (flux_map.MAP, flux_map.ENVELOPE, gearbox.OUTPUT, winding.OUTPUT))
    code = ("units", "electrical", "figures.style", "figures.flux_map", "figures.winding", "pipeline.drive")
    return Stage("drive", folder, values, files, code, (WINDINGS, OUTPUT, *FIGURES.values()))


def wound(study, data, winding):
    """``FluxMapMachine`` of a winding."""
    from electrical.flux_map_machine import FluxMapMachine
    from pipeline.winding import read_per_turn_machine

    length = read_per_turn_machine(study).active_length
    return FluxMapMachine.from_per_turn(
        data, turns=winding.turns, active_length=length, resistance=winding.phase_resistance
    )


def neighbours(choice, data) -> list:
    """Full slots with a few turns more or less whose ampere-turns lie in the map."""
    reach = min(-float(data["id"].min()), float(data["iq"].max()))
    near = [one for one in choice.fullest if abs(one.turns - choice.chosen.turns) <= _NEIGHBOURS]
    return [one for one in near if one.turns * one.current_peak <= reach]


def on_the_map(study, data, winding):
    """The winding with base speed, powers and peak torque from the flux map."""
    from dataclasses import replace

    import numpy as np
    from electrical import flux_map_limits as limits_of
    from electrical.synchronous_machine import DriveLimits

    section, machine = study.winding_selection, wound(study, data, winding)
    limits = DriveLimits.from_dc_bus(winding.current_peak, section.dc_bus_voltage_V)
    torque = float(machine.torque(*limits_of.mtpa_currents(machine, limits.current_peak)))
    base = float(limits_of.base_speed(machine, limits))
    speed = np.linspace(0.0, _largest_speed(study), _SPEEDS)
    power = np.nan_to_num(limits_of.torque_speed_envelope(machine, limits, speed).power)
    best = int(np.argmax(power))
    return replace(
        winding,
        peak_torque=torque,
        base_speed=base,
        power_at_base_speed=base * torque,
        maximum_power=float(power[best]),
        speed_at_maximum_power=float(speed[best]),
    )


def _largest_speed(study) -> float:
    from units import RPM

    return study.winding_selection.speed_max_rpm * RPM


def chosen_by_map(windings: list, requirement, current_rms: float):
    """The rule of ``electrical.winding_selection`` on the values of the flux map."""
    affordable = [one for one in windings if one.current_rms <= current_rms * (1 + 1e-9)]
    meeting = [one for one in affordable if one.satisfies(requirement)]
    if meeting:
        return min(meeting, key=lambda one: (one.current_rms, -one.base_speed))
    return max(affordable, key=lambda one: one.base_speed)


def _table(pairs: list, chosen):
    """Windings with both sets of values."""
    import pandas as pd
    from units import RPM

    return pd.DataFrame(
        [
            {
                "turns": plain.turns,
                "strands": plain.strands,
                "current_rms_A": plain.current_rms,
                "base_speed_field_rpm": field.base_speed / RPM,
                "base_speed_constant_rpm": plain.base_speed / RPM,
                "power_at_base_speed_field_W": field.power_at_base_speed,
                "power_at_base_speed_constant_W": plain.power_at_base_speed,
                "maximum_power_field_W": field.maximum_power,
                "maximum_power_constant_W": plain.maximum_power,
                "peak_torque_field_Nm": field.peak_torque,
                "peak_torque_constant_Nm": plain.peak_torque,
                "chosen": plain.turns == chosen.turns,
            }
            for plain, field in pairs
        ]
    )


def _outcome(pairs: list, chosen, requirement, limit: float) -> dict:
    from units import RPM

    plain, field = next(pair for pair in pairs if pair[0].turns == chosen.turns)
    other = chosen_by_map([pair[1] for pair in pairs], requirement, limit)
    same = other.turns == chosen.turns
    said = "the flux map chooses the same winding" if same else (
        f"on the flux map {other.turns} turns of {other.strands} wires would be chosen, "
        f"base speed {other.base_speed / RPM:.0f} rpm"
    )  # fmt: skip
    return {
        "base_speed_rpm": field.base_speed / RPM,
        "base_speed_difference": plain.base_speed / field.base_speed - 1,
        "power_at_base_speed_W": field.power_at_base_speed,
        "maximum_power_W": field.maximum_power,
        "maximum_power_difference": plain.maximum_power / field.maximum_power - 1,
        "peak_torque_Nm": field.peak_torque,
        "peak_torque_difference": plain.peak_torque / field.peak_torque - 1,
        "turns_by_map": other.turns,
        "strands_by_map": other.strands,
        "comparison": said,
    }


def _draw(study, data, chosen, ratio: float):
    """Yield (name, Figure)."""
    import numpy as np
    import pandas as pd
    from electrical.flux_map_limits import mtpa_currents
    from electrical.flux_map_operating import operating_map
    from electrical.synchronous_machine import DriveLimits
    from figures import flux_map as draw
    from figures.winding import WheelPoint, force_velocity
    from pipeline.flux_map import ENVELOPE

    machine = wound(study, data, chosen)
    limits = DriveLimits.from_dc_bus(chosen.current_peak, study.winding_selection.dc_bus_voltage_V)
    envelope = pd.read_csv(results_folder(study.study.id) / ENVELOPE)
    title = f"{chosen.turns} turns, {chosen.strands} wires"
    mtpa = mtpa_currents(machine, np.linspace(0.0, chosen.current_peak, 61))
    yield "flux_map", draw.flux_maps(machine, mtpa, envelope, chosen.current_peak)
    yield "field_envelope", draw.field_envelope(envelope, title=title)
    torque = float(machine.torque(*mtpa_currents(machine, chosen.current_peak)))
    plane = operating_map(
        machine, limits, np.linspace(0, torque, _TORQUES), np.linspace(0, _largest_speed(study), _SPEEDS)
    )
    required = study.requirements
    demands = (
        WheelPoint("peak force", required.velocity_at_force_peak_m_per_s, required.force_peak_N),
        WheelPoint("peak power", required.velocity_at_power_peak_m_per_s, required.force_at_power_peak_N),
        WheelPoint("nominal (RMS)", required.velocity_rms_m_per_s, required.force_rms_N),
    )
    yield "force_velocity_field", force_velocity(plane, ratio, title=title, required=demands, limits=limits)


def main(name: str) -> None:
    """Value the windings of a study on its flux map."""
    own = read_study(name)
    study = fed(own)

    def work(run):
        from figures.style import save_png
        from pipeline.flux_map import read_flux_map
        from pipeline.gearbox import read_ratio
        from pipeline.winding import choose, read_per_turn_machine
        from study.convert import to_winding_limits, to_winding_requirement

        data, choice = read_flux_map(study), choose(study, read_per_turn_machine(study))
        ratio = read_ratio(study)
        pairs = [(one, on_the_map(study, data, one)) for one in neighbours(choice, data)]
        requirement, limits = to_winding_requirement(study, ratio), to_winding_limits(study)
        outcome = _outcome(pairs, choice.chosen, requirement, limits.phase_current_rms)
        print(f"drive: {outcome['comparison']}; base speed {outcome['base_speed_rpm']:.0f} rpm")
        run.write(WINDINGS, lambda path: _table(pairs, choice.chosen).to_csv(path, index=False))
        run.write_text(OUTPUT, json.dumps(outcome, indent=2) + "\n")
        for figure_name, figure in _draw(study, data, choice.chosen, ratio):
            run.write(FIGURES[figure_name], lambda path, figure=figure: save_png(figure, path))

    stage_of(own).run(work)


if __name__ == "__main__":
    with command():
        main(sys.argv[1])
