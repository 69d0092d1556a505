"""What came out: the designed actuator beside the stated one, which requirements hold, and the vehicle driven with it.

Reads the study and the results of all stages before; writes ``outcome.json`` (features, requirements with their
margins, remedies where one fails, ride with the ideal and with the designed actuator) and figures: axial section,
force-velocity points and histories of the worst case with both actuators (thesis Table 3.12, Fig. 3.28). A requirement
that fails does not fail the stage.
"""

from __future__ import annotations

import json
import sys

from pipeline.feeds import fed, read_result
from pipeline.stage import Stage, command, results_folder
from study.chain import drives
from study.read import read_study

OUTPUT = "outcome.json"
SECTION = {"axial_section": "figures/axial_section.png"}
RIDE = {"outcome_points": "figures/outcome_points.png", "outcome_histories": "figures/outcome_histories.png"}
_LIMIT_SPEEDS = 61  # points of the force-speed limit


def figures_of(study) -> dict[str, str]:
    """Figures of the stage by name; the ride only where a vehicle is run."""
    return SECTION | (RIDE if drives(study) else {})


def stage_of(study) -> Stage:
    """The outcome of a study."""
    from pipeline import flux_map, gearbox, match, requirements, winding

    folder = results_folder(study.study.id)
    names = [match.OUTPUT, winding.OUTPUT, flux_map.MAP, gearbox.OUTPUT]
    names += [requirements.OUTPUT] if drives(study) else []
    values = fed(study).model_dump(mode="json")
    code = ("units", "drivetrain.capability", "vehicle", "gearbox", "electrical", "figures.gearbox", "figures.vehicle")
    code += ("study.convert_vehicle", "study.convert_gearbox", "pipeline.outcome")
    outputs = (OUTPUT, *figures_of(study).values())
    return Stage("outcome", folder, values, tuple(folder / name for name in names), code, outputs)


# ---- the actuator ---------------------------------------------------------------------------------------------------


def design_of(study):
    """``ActuatorDesign`` from match, winding, flux map and gearbox; study: fed."""
    from drivetrain.capability import ActuatorDesign
    from pipeline.flux_map import read_flux_map
    from pipeline.gearbox import OUTPUT as GEARBOX, read_ratio
    from pipeline.match import read_match
    from pipeline.winding import read_per_turn_machine, read_winding
    from study.convert import to_wire, to_winding_limits
    from units import AMPERE_PER_SQUARE_MILLIMETRE, MILLIMETRE

    found, wound, gears = read_match(study), read_winding(study)["chosen"], read_result(study, GEARBOX)
    machine, wire, limits = read_per_turn_machine(study), to_wire(study), to_winding_limits(study)
    return ActuatorDesign(
        flux_map=read_flux_map(study),
        turns=wound["turns"],
        strands=wound["strands"],
        wire_area=wire.area,
        resistivity=wire.resistivity,
        coils_in_series=machine.coils_in_series,
        active_length=machine.active_length,
        end_turn_length=machine.end_turn_length,
        nominal_density=study.sweep.j_nominal_rms_A_per_mm2 * AMPERE_PER_SQUARE_MILLIMETRE,
        overload_density=limits.overload_current_density,
        dc_voltage=limits.dc_voltage,
        transmission_ratio=read_ratio(study),
        stator_outer_radius=found["stator_outer_radius_mm"] * MILLIMETRE,
        rotor_outer_radius=found["rotor_outer_radius_mm"] * MILLIMETRE,
        density=study.match.steel_density_kg_per_m3,
        gearbox_mass=gears["chosen"]["mass_kg"],
        other_mass=study.assembly.casing_mass_kg,
        gearbox_inertia=gears["chosen"]["inertia_fast_shaft_kg_m2"],
    )


def requirements_of(study, layout) -> tuple:
    """Everything that is asked of the actuator, as ``Requirement``."""
    from math import sqrt

    from drivetrain.capability import Requirement
    from units import MILLIMETRE, RPM

    r, match, drive = study.requirements, study.match, study.winding_selection
    at_force, at_power = r.velocity_at_force_peak_m_per_s, r.velocity_at_power_peak_m_per_s
    rows = [
        Requirement("peak force at rest", r.force_peak_N, lambda d: d.force_peak, unit="N"),
        Requirement(f"peak force at {at_force:.3g} m/s", r.force_peak_N, lambda d: d.force_at(at_force)[0], unit="N"),
        Requirement(
            f"peak power at {at_power:.3g} m/s", r.power_peak_W, lambda d: d.force_at(at_power)[0] * at_power, unit="W"
        ),
        Requirement("continuous force", r.force_rms_N, lambda d: d.force_continuous, unit="N"),
        Requirement(
            "regenerative damping", r.maximum_damping_kNs_per_m * 1e3, lambda d: d.regenerative_damping,
            scale=1e3, unit="kNs/m",
        ),
        Requirement(
            "rotor speed", match.speed_max_rad_per_s, lambda d: r.velocity_peak_m_per_s / d.transmission_ratio,
            at_most=True, scale=RPM, unit="rpm",
        ),
        Requirement(
            "phase current, RMS", drive.phase_current_max_rms_A, lambda d: d.limits.current_peak / sqrt(2),
            at_most=True, unit="A",
        ),
        Requirement("active length", match.length_max_mm * MILLIMETRE, lambda d: d.active_length, at_most=True,
                    scale=MILLIMETRE, unit="mm"),
        Requirement("equivalent mass", match.equivalent_mass_max_kg, lambda d: d.equivalent_mass, True, unit="kg"),
    ]  # fmt: skip
    if study.linkage.envelope_radius_max_mm is not None:
        largest = 2 * study.linkage.envelope_radius_max_mm * MILLIMETRE
        rows.append(
            Requirement("diameter", largest, lambda d: layout.diameter, at_most=True, scale=MILLIMETRE, unit="mm")
        )
    return tuple(rows)


def layout_of(study, design, train):
    """``Layout`` of gearbox and machine in their casing."""
    from math import pi

    from gearbox.layout import MachineEnvelope, actuator_layout
    from study.convert_gearbox import to_housing
    from units import MILLIMETRE

    envelope = MachineEnvelope(
        stator_outer_radius=design.stator_outer_radius,
        rotor_outer_radius=design.rotor_outer_radius,
        shaft_radius=study.machine.shaft_radius_mm * MILLIMETRE,
        active_length=design.active_length,
        end_winding_length=design.end_turn_length / pi,  # half circles: their height is their length over pi
    )
    return actuator_layout(train, envelope, to_housing(study.assembly))


def features_of(study, design, layout) -> list[dict]:
    """Rows of thesis Table 3.12: ours and the stated actuator's."""
    from units import MILLIMETRE

    given = study.printed_actuator
    ratio = study.linkage.ratio_nominal_mm_per_rad
    overall = design.transmission_ratio / MILLIMETRE
    rows = [
        ("peak force at the wheel / N", design.force_peak, "force_peak_N"),
        ("peak torque at the slow shaft / Nm", design.force_peak * ratio * MILLIMETRE, "actuator_torque_peak_Nm"),
        ("peak torque of the machine / Nm", design.peak_torque, "machine_torque_peak_Nm"),
        ("equivalent inertia at the wheel / kg", design.equivalent_mass, "equivalent_mass_kg"),
        ("overall transmission ratio / (mm/rad)", overall, None),
        ("gearbox, fast over slow speed", ratio / overall, "gearbox_ratio"),
        ("linkage, nominal / (mm/rad)", ratio, "linkage_ratio_mm_per_rad"),
        ("mass / kg", design.mass, "mass_kg"),
        ("diameter of the envelope / mm", layout.diameter / MILLIMETRE, "diameter_mm"),
        ("length of the envelope / mm", layout.length / MILLIMETRE, "length_mm"),
    ]
    return [{"feature": name, "ours": value, "stated": _stated(given, key)} for name, value, key in rows]


def _stated(given, key):
    if given is None:
        return None
    return getattr(given, key) if key else given.linkage_ratio_mm_per_rad / given.gearbox_ratio


def _checked(requirements, design) -> list[dict]:
    rows = []
    for one in requirements:
        check = one.check(design)
        rows.append(
            {
                "requirement": one.name,
                "needed": one.needed / one.scale,
                "reached": check.reached / one.scale,
                "unit": one.unit,
                "sense": "at most" if one.at_most else "at least",
                "margin_percent": 100 * check.margin,
                "holds": check.holds,
            }
        )
    return rows


def _gear_checks(study) -> list[dict]:
    """The same rows for the safety factors of the gears."""
    from pipeline.gearbox import OUTPUT as GEARBOX

    rows = []
    for one in read_result(study, GEARBOX)["safety"]:
        margin = one["reached"] / one["wanted"] - 1
        row = {"requirement": f"gears, safety {one['kind'].replace('_', ' ')}", "needed": one["wanted"]}
        row |= {"reached": one["reached"], "unit": "", "sense": "at least", "margin_percent": 100 * margin}
        rows.append({**row, "holds": margin >= -1e-3})  # widths are drawn in steps, Miner's sum is met to its rounding
    return rows


def _remedies(design, requirements) -> list[dict]:
    from drivetrain.capability import remedies

    return [
        {
            "requirement": one.requirement.name,
            "input": one.lever.name,
            "unit": one.lever.unit,
            "now": one.lever.value / one.lever.scale,
            "needed": None if one.value is None else one.value / one.lever.scale,
            "change_percent": None if one.value is None else 100 * (one.value / one.lever.value - 1),
            "then fails": ", ".join(one.fails_then) or "nothing else" if one.value is not None else "",
        }
        for one in remedies(design, requirements)
    ]


# ---- the vehicle with it --------------------------------------------------------------------------------------------


def actuator_of(study, design):
    """``vehicle.actuator.Actuator`` with force-speed limit, inertia and friction."""
    import numpy as np
    from vehicle.actuator import Actuator, ForceSpeedLimit

    fastest = study.match.speed_max_rad_per_s * design.transmission_ratio
    speed = np.linspace(0.0, fastest, _LIMIT_SPEEDS)
    limit = ForceSpeedLimit(tuple(speed.tolist()), tuple(design.force_at(speed).tolist()))
    return Actuator(
        limit,
        equivalent_mass=design.equivalent_mass,
        coulomb_friction=study.assembly.coulomb_friction_N,
        viscous_friction=study.assembly.viscous_friction_Ns_per_m,
    )


def worst_case(study) -> tuple[str, str, str]:
    """(part, scenario, damping) that set the peak force."""
    from vehicle.requirements import RANDOM_ROAD

    scenario, damping = read_result(study, "requirements.json")["scenarios"]["force_peak_N"].rsplit(", ", 1)
    part = "road" if scenario.startswith(RANDOM_ROAD) else "overload"
    return part, scenario, damping.removesuffix(" damping")


def driven(study, actuator):
    """(histories of the worst case, summaries on the road), each by actuator: "ideal" and "designed"."""
    from dataclasses import replace

    from pipeline.requirements import run_named, runs_of_part
    from vehicle.indices import summary
    from vehicle.ride import simulate_and_keep

    part, scenario, damping = worst_case(study)
    worst = next(run for run in run_named(study, part, scenario) if run.damping.name == damping)
    pair, road = [worst, replace(worst, actuator=actuator)], runs_of_part(study, "road")
    runs = [*pair, *road, *(replace(run, actuator=actuator) for run in road)]
    together = simulate_and_keep(lambda h: (summary(h), h if any(h.run is one for one in pair) else None), runs)
    summaries = [found for found, _ in together[2:]]
    histories = dict(zip(("ideal", "designed"), (history for _, history in together[:2]), strict=True))
    return histories, {"ideal": summaries[: len(road)], "designed": summaries[len(road) :]}


def ride_table(road: dict) -> list[dict]:
    """Means over the seeds of each damping, ideal and designed actuator beside each other."""
    from pipeline.requirements import mean_of_seeds

    columns = ("comfort_rms_m_per_s2", "road_holding_rms", "stroke_peak_mm", "force_rms_N", "power_mean_W")
    rows = []
    for damping in dict.fromkeys(run.damping for run in road["ideal"]):
        for name, runs in road.items():
            own = [run for run in runs if run.damping == damping]
            rows.append({"damping": damping, "actuator": name, **mean_of_seeds(own, columns)})
    return rows


def worst_table(study, pair: dict) -> list[dict]:
    """The worst case with both actuators."""
    from vehicle.indices import summary

    rows = []
    for name, history in pair.items():
        one = summary(history)
        saturated = _saturated(history) if name == "designed" else 0.0
        rows.append(
            {
                "actuator": name,
                "force_peak_N": abs(one.at_force_peak.force),
                "velocity_peak_m_per_s": abs(one.velocity_peak),
                "stroke_peak_mm": 1e3 * abs(one.stroke_peak),
                "tyre_load_min_N": float(history.tyre_loads[-1].min()),
                "tyre_load_max_N": float(history.tyre_loads[-1].max()),
                "time_saturated_ms": 1e3 * saturated,
            }
        )
    return rows


def _saturated(history) -> float:
    """Time for which the force limit holds back the machine [s]."""
    import numpy as np

    wanted = np.abs(history.run.damping.at(history.velocity))
    held = np.abs(history.actuator_force) < wanted * (1 - 1e-3)
    return float(held.sum() * history.run.scenario.time_step)


def _draw(study, design, layout, pair, actuator):
    """Yield (name, Figure)."""
    from figures import vehicle as draw
    from figures.gearbox import axial_section
    from pipeline.requirements import span_shown
    from units import MILLIMETRE

    title = f"{design.active_length / MILLIMETRE:.1f} mm of active length, {design.mass:.1f} kg"
    yield "axial_section", axial_section(layout, title=title)
    if pair is None:
        return
    required = study.requirements
    points = [("required peak force", required.force_peak_N, required.velocity_at_force_peak_m_per_s)]
    yield "outcome_points", draw.force_velocity_cloud(pair, limit=actuator.limit, required=points)
    yield "outcome_histories", draw.time_histories(pair, span=span_shown(worst_case(study)[0], pair.values()))


def main(name: str) -> None:
    """Sum up the design of a study and drive the vehicle with it."""
    own = read_study(name)
    study = fed(own)

    def work(run):
        from figures.style import save_png
        from pipeline.gearbox import chosen_train

        design, train = design_of(study), chosen_train(study)[0]
        layout = layout_of(study, design, train)
        requirements = requirements_of(study, layout)
        actuator = actuator_of(study, design) if drives(study) else None
        pair, road = driven(study, actuator) if drives(study) else (None, None)
        checks = _checked(requirements, design) + _gear_checks(study)
        outcome = {
            "features": features_of(study, design, layout),
            "requirements": checks,
            "remedies": _remedies(design, requirements),
            "worst_case": ", ".join(worst_case(study)[1:]) if pair else None,
            "worst": worst_table(study, pair) if pair else [],
            "ride": ride_table(road) if road else [],
        }
        for row in checks:
            said = "holds" if row["holds"] else "DOES NOT HOLD"
            print(
                f"outcome: {row['requirement']}: {row['reached']:.4g} {row['unit']}, {row['sense']} "
                f"{row['needed']:.4g} {row['unit']} needed: {said}"
            )
        run.write_text(OUTPUT, json.dumps(outcome, indent=2) + "\n")
        for figure_name, figure in _draw(study, design, layout, pair, actuator):
            run.write(figures_of(study)[figure_name], lambda path, figure=figure: save_png(figure, path))

    stage_of(own).run(work)


if __name__ == "__main__":
    with command():
        main(sys.argv[1])
