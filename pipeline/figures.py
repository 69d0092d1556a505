"""All figures of a study as PNG files.

Reads the study and the results of the stages before, writes ``figures/<name>.png``. The report shows them in reading order.
"""

from __future__ import annotations

import sys

from pipeline.feeds import fed
from pipeline.stage import Stage, command, results_folder
from study.read import read_study

NAMES = (
    "cross_section_reference",
    "cross_section_matched",
    "field_reference_nominal",
    "field_matched_nominal",
    "field_matched_overload",
    "rotation_reference",
    "rotation_matched",
    "design_map",
    "design_maps",
    "limits",
    "fits",
    "match_curves",
    "match_over_radius",
    "torque_speed",
    "force_velocity",
)
FILES = {name: f"figures/{name}.png" for name in NAMES}


def stage_of(study) -> Stage:
    """The figures of a study."""
    from pipeline import fields, fits, gearbox, limits, match, optima, sweep, winding

    folder = results_folder(study.study.id)
    inputs = [
        sweep.OUTPUT,
        optima.OUTPUT,
        limits.OUTPUT,
        fits.OUTPUT,
        match.TABLE,
        match.OUTPUT,
        gearbox.OUTPUT,
        winding.TABLE,
        winding.OUTPUT,
    ]
    inputs += [*fields.ROTATIONS.values(), *fields.FIELDS.values()]
    values = {name: value for name, value in fed(study).model_dump(mode="json").items() if name != "study"}
    code = ("figures", "geometry", "drivetrain", "electrical", "pipeline.match", "pipeline.winding", "pipeline.figures")
    return Stage("figures", folder, values, tuple(folder / name for name in inputs), code, tuple(FILES.values()))


def draw(study):
    """Yield (name, Figure) for every figure, in reading order."""
    yield from _sections(study)
    yield from _fields(study)
    yield from _rotations(study)
    yield from _designs(study)
    yield from _matches(study)
    yield from _windings(study)


def _sections(study):
    from figures.cross_section import cross_section
    from geometry.cross_section import mesh_cross_section
    from optimisation.states import null_angle
    from pipeline.fields import MACHINES, machine_of
    from pipeline.models import layout_of

    for name in MACHINES:
        machine = machine_of(study, name)
        layout = layout_of(study, machine.slots)
        yield f"cross_section_{name}", cross_section(mesh_cross_section(machine, layout), null_angle(machine, layout))


def _fields(study):
    from figures.export import read_vtu
    from figures.field_map import field_map
    from pipeline.fields import FIELDS

    for machine, state in (("reference", "nominal"), ("matched", "nominal"), ("matched", "overload")):
        yield f"field_{machine}_{state}", field_map(read_vtu(results_folder(study.study.id) / FIELDS[machine, state]))


def _rotations(study):
    import pandas as pd
    from figures.rotation import rotation
    from optimisation.states import null_angle, q_axis_angle
    from pipeline.fields import ROTATIONS, machine_of
    from pipeline.models import layout_of
    from units import DEGREE

    for name, file in ROTATIONS.items():
        machine = machine_of(study, name)
        layout = layout_of(study, machine.slots)
        angles = {
            "null_angle_deg": null_angle(machine, layout) / DEGREE,
            "q_axis_angle_deg": q_axis_angle(machine, layout) / DEGREE,
        }
        yield f"rotation_{name}", rotation(pd.read_csv(results_folder(study.study.id) / file), **angles)


def _designs(study):
    import pandas as pd
    import xarray as xr
    from figures.design_map import design_map, design_maps
    from figures.fits import fits
    from figures.limits import limits

    folder = results_folder(study.study.id)
    with xr.open_dataset(folder / "design_map.nc") as data:
        maps = data.load()
    optima, reading = pd.read_csv(folder / "optima.csv"), (study.saturation.reading, study.saturation.limit_T)
    slots, diameter = shown_design(study)
    yield "design_map", design_map(maps, optima, slots, diameter, *reading)
    yield "design_maps", design_maps(maps, optima, slots, *reading)
    table = pd.read_csv(folder / "limits.csv")
    yield "limits", limits(table, chosen_reading=reading[0], chosen_limit_T=reading[1])
    yield "fits", fits(optima, pd.read_csv(folder / "fits.csv"))


def shown_design(study) -> tuple[int, float]:
    """Slot count and grid diameter [mm] closest to the matched machine, for the map that is shown large."""
    from pipeline.match import read_match

    found = read_match(study)
    diameters = study.sweep.stator_diameters_mm
    return found["slots"], min(diameters, key=lambda d: abs(d - 2 * found["stator_outer_radius_mm"]))


def _matches(study):
    import numpy as np
    import pandas as pd
    from figures.match import match_curves, match_over_radius
    from pipeline.match import TABLE, Matcher, read_match
    from units import MILLIMETRE

    matcher, found = Matcher.of(study), read_match(study)
    chosen = matcher.match_at(found["slots"], study.match.overload_torque, found["stator_outer_radius_mm"] * MILLIMETRE)
    low, best = chosen.ratio_bounds[0], chosen.transmission_ratio
    curves = matcher.curves(chosen.section, np.linspace(0.9 * low, 2.2 * best, 161))
    yield "match_curves", match_curves(curves, chosen, length_limit=study.match.length_max_mm * MILLIMETRE)
    mark = {
        name: found[name]
        for name in ("slots", "stator_outer_radius_mm", "transmission_ratio_mm_per_rad", "active_length_mm", "cost")
    }
    mark["overload"] = study.match.overload_torque
    table = pd.read_csv(results_folder(study.study.id) / TABLE)
    yield "match_over_radius", match_over_radius(table, best=pd.DataFrame([mark]))


def _windings(study):
    import numpy as np
    from electrical.synchronous_machine import DriveLimits, operating_map, torque_speed_envelope
    from figures.winding import RequiredPoint, WheelPoint, force_velocity, torque_speed
    from pipeline.gearbox import read_ratio
    from pipeline.winding import choose, read_per_turn_machine
    from study.convert import to_winding_limits, to_winding_requirement

    machine = read_per_turn_machine(study)
    choice, limits = choose(study, machine), to_winding_limits(study)
    ratio = read_ratio(study)
    required = to_winding_requirement(study, ratio)
    shown = {f"{w.turns} turns, {w.strands} wires": w for w in _neighbours(choice)}
    speeds = np.linspace(0, limits.maximum_speed, 241)
    envelopes = {
        name: torque_speed_envelope(
            w.machine(machine.pole_pairs), DriveLimits.from_dc_bus(w.current_peak, limits.dc_voltage), speeds
        )
        for name, w in shown.items()
    }
    title = f"{choice.chosen.turns} turns, {choice.chosen.strands} wires"
    yield (
        "torque_speed",
        torque_speed(envelopes, title, (RequiredPoint("peak force", required.base_speed, required.torque),)),
    )
    drive = DriveLimits.from_dc_bus(choice.chosen.current_peak, limits.dc_voltage)
    speed, torque = np.meshgrid(speeds, np.linspace(0, choice.chosen.peak_torque, 121))
    plane = operating_map(choice.chosen.machine(machine.pole_pairs), drive, torque, speed)
    r = study.requirements
    demands = (
        WheelPoint("peak force", r.velocity_at_force_peak_m_per_s, r.force_peak_N),
        WheelPoint("peak power", r.velocity_at_power_peak_m_per_s, r.force_at_power_peak_N),
        WheelPoint("nominal (RMS)", r.velocity_rms_m_per_s, r.force_rms_N),
    )
    yield "force_velocity", force_velocity(plane, ratio, title=title, required=demands, limits=drive)


def _neighbours(choice) -> list:
    """The chosen winding, those with one turn more and less, and the one that would meet the requirement."""
    near = [w for w in choice.fullest if abs(w.turns - choice.chosen.turns) <= 1]
    extra = [choice.unrestricted] if choice.unrestricted is not None and choice.unrestricted not in near else []
    return near + extra


def main(name: str) -> None:
    """Draw the figures of a study."""
    study = fed(read_study(name))

    def work(run):
        from figures.style import save_png
        from tqdm import tqdm

        for figure_name, figure in tqdm(draw(study), total=len(NAMES), desc="figures"):
            run.write(FILES[figure_name], lambda path, figure=figure: save_png(figure, path))

    stage_of(study).run(work)


if __name__ == "__main__":
    with command():
        main(sys.argv[1])
