"""The loop closed: radius, slots, active length, ratio and linkage together, beside the design found stage by stage.

Reads the study and the results of fits, match and linkage; writes ``optimise.csv`` (the reported front, every point
solved by the field), ``optimise.json`` (what the stage-by-stage design leaves on the table), ``optimise.html``
and a figure.
"""

from __future__ import annotations

import json
import sys
from functools import lru_cache

from pipeline.feeds import fed
from pipeline.stage import Stage, StageError, command, results_folder
from study.chain import searches_linkage
from study.read import read_study

TABLE, OUTPUT, PAGE, FIGURE = "optimise.csv", "optimise.json", "optimise.html", "figures/whole_designs.png"
_SEED, _POPULATION, _GENERATIONS = 1, 120, 120
_REPORTED = 12  # points of the front that are solved by the field


def stage_of(study) -> Stage:
    """The search over all stages at once."""
    from pipeline import fits, linkage, match
    from pipeline.models import FIELD_CODE, FIELD_SECTIONS

    folder = results_folder(study.study.id)
    files = (folder / fits.OUTPUT, folder / match.OUTPUT)
    files += (folder / linkage.FRONT,) if searches_linkage(study) else ()
    used = ("requirements", "linkage", "linkage_search", "match", "winding_selection")
    values = fed(study).subset(*FIELD_SECTIONS, *used)
    code = (*FIELD_CODE, "drivetrain", "electrical", "figures.whole_design", "pipeline.match", "pipeline.optimise")
    return Stage("optimise", folder, values, files, code, (TABLE, OUTPUT, PAGE, FIGURE))


def problem_of(study):
    """``WholeProblem`` with the fits as the model of the machine; study: fed."""
    from drivetrain.match import damping_constraint
    from drivetrain.whole_design import WholeProblem
    from pipeline.match import Matcher
    from study import convert
    from units import MILLIMETRE

    matcher, match = Matcher.of(study), study.match
    required, copper = convert.to_actuator_requirements(study.requirements), convert.to_copper_loading(study)
    ranges = [matcher.fits[slots, "torque_nominal_Nm_per_m"].x_range for slots in study.sweep.slots]

    def section_at(slots, radius):
        return matcher.section(slots, match.overload_torque, radius)

    return WholeProblem(
        section_at=section_at,
        slots=study.sweep.slots,
        radii=tuple((low * MILLIMETRE, high * MILLIMETRE) for low, high in ranges),
        lengths=(0.1 * match.length_max_mm * MILLIMETRE, match.length_max_mm * MILLIMETRE),
        linkage_ratios=_linkage_ratios(study),
        constraints_of=matcher.constraints,
        gearbox=matcher.gearbox,
        damping_of=lambda section: damping_constraint(section, required, copper),
        loss_of=lambda section, design: road_loss(section, design, required.force_rms, copper),
        targets=(match.mass_max_kg, match.equivalent_mass_max_kg),
    )


def _linkage_ratios(study) -> tuple[float, float]:
    """Nominal ratios [m/rad] of the front's linkages whose angles are no worse than those of the chosen one."""
    import pandas as pd
    from pipeline.linkage import FRONT
    from units import MILLIMETRE

    chosen = study.linkage.ratio_nominal_mm_per_rad
    if not searches_linkage(study):
        return chosen * MILLIMETRE, chosen * MILLIMETRE
    table = pd.read_csv(results_folder(study.study.id) / FRONT)
    return chosen * MILLIMETRE, float(table.ratio_nominal_mm_per_rad.max()) * MILLIMETRE


def road_loss(section, design, force: float, copper) -> float:
    """Copper loss at the RMS force [W]; iron loss is left out.

    P = 6 N_c k_cp A_s (l + l_et) rho J^2,  J = J_nom F tau_t / (r l)
    """
    torque = force * design.transmission_ratio
    density = copper.nominal_current_density * torque / (section.torque_per_length_nominal * design.active_length)
    volume = 6 * section.coils_in_series * copper.packing * section.half_slot_area
    return volume * (design.active_length + section.end_turn_length) * copper.resistivity * density**2


def staged_design(study):
    """The design of match and linkage as a ``WholeDesign``."""
    from drivetrain.whole_design import WholeDesign
    from pipeline.match import read_match
    from units import MILLIMETRE

    found = read_match(study)
    return WholeDesign(
        found["slots"],
        found["stator_outer_radius_mm"] * MILLIMETRE,
        found["active_length_mm"] * MILLIMETRE,
        found["transmission_ratio_mm_per_rad"] * MILLIMETRE,
        study.linkage.ratio_nominal_mm_per_rad * MILLIMETRE,
    )


def solve_section(task: dict) -> list[float]:
    """Torque per length at the nominal and the overload current [Nm/m] and half-slot area [m^2] of one machine."""
    from magnetostatics.per_turn import per_turn_values
    from pipeline.models import StudyFamily, field_model, nominal_amplitude, overload_amplitude
    from study.convert import to_mesh_density

    study = _study(task["study"])
    lengths = (task[name] for name in ("stator_outer_radius", "back_iron_width", "rotor_outer_radius"))
    machine = StudyFamily(study.machine).machine(task["slots"], *lengths)
    model, packing = field_model(study, machine, to_mesh_density(study.mesh)), study.winding.packing_factor
    torques = [per_turn_values(model, of(study), packing).torque for of in (nominal_amplitude, overload_amplitude)]
    return [*torques, model.section.half_slot_area * model.section.half_slots_per_coil_side]


@lru_cache(maxsize=1)
def _study(path: str):
    return read_study(path)


def solved_sections(study, problem, designs, run) -> list:
    """The cross-sections of designs with torques and slot area from the field in the place of the fits."""
    from dataclasses import replace

    from pipeline.parallel import default_workers, run_parallel

    path, sections = str(study.path.resolve()), [problem.section_at(d.slots, d.stator_outer_radius) for d in designs]
    names = ("slots", "stator_outer_radius", "back_iron_width", "rotor_outer_radius")
    tasks = {
        f"design {k}": {"study": path, **{name: getattr(one, name) for name in names}} for k, one in enumerate(sections)
    }
    found = run_parallel(solve_section, tasks, default_workers(), run.checkpoint(), "optimise")
    keys = ("torque_per_length_nominal", "torque_per_length_overload", "half_slot_area")
    pairs = zip(sections, found.values(), strict=True)
    return [replace(one, **dict(zip(keys, numbers, strict=True))) for one, numbers in pairs]


def row(name: str, design, model, field) -> dict:
    """One design in drawing units: objectives of the model and of the field."""
    from units import MILLIMETRE

    keys = ("mass_kg", "equivalent_mass_kg", "damping_reserve", "road_loss_W")
    return {
        "design": name,
        "slots": design.slots,
        "stator_diameter_mm": 2 * design.stator_outer_radius / MILLIMETRE,
        "active_length_mm": design.active_length / MILLIMETRE,
        "transmission_ratio_mm_per_rad": design.transmission_ratio / MILLIMETRE,
        "linkage_ratio_mm_per_rad": design.linkage_ratio / MILLIMETRE,
        **dict(zip(keys, field.objectives, strict=True)),
        "damping_reserve_of_the_fits": model.objectives[2],
        "road_loss_of_the_fits_W": model.objectives[3],
        "constraint_excess_percent": 100 * max(field.constraints),
    }


def questions(before) -> list[tuple]:
    """(what is asked, objective, what the others may come to) against the objectives of the stage-by-stage design.

    First each objective with the other three no worse; then mass and inertia with a damping reserve of 1 and a free
    loss, which is all that the requirements ask for.
    """
    from math import inf

    from drivetrain.whole_design import OBJECTIVES

    mass, inertia, _, _ = before
    found = [(f"{name.replace('_', ' ')}, the other three no worse", k, before) for k, name in enumerate(OBJECTIVES)]
    bare = (mass, inertia, 1.0, inf)
    found.append(("mass, inertia no worse, damping as required", 0, bare))
    found.append(("equivalent mass, mass no worse, damping as required", 1, bare))
    return found


def left_on_the_table(problem, staged) -> list:
    """[(question, objective, design, values)]: what a search over everything betters against the staged design."""
    from drivetrain.whole_design import improved

    before = problem.values(staged).objectives
    return [(question, k, *improved(problem, staged, k, allowed)) for question, k, allowed in questions(before)]


def _gains(before, bettered) -> list[dict]:
    rows = []
    for question, objective, design, values in bettered:
        old, new = before.objectives[objective], values.objectives[objective]
        row = {"what is bettered": question, "stage by stage": old, "together": new}
        row |= {"change_percent": 100 * (new / old - 1), "slots": design.slots}
        rows.append({**row, "stator_diameter_mm": 2e3 * design.stator_outer_radius})
    return rows


def _page(path, gains, table, figure, title: str) -> None:
    from figures.report import Picture, Section, Table, write_report
    import pandas as pd

    text = (
        "Slot count, radius, active length, ratio and linkage are varied together against the design that match and "
        "linkage arrived at one after the other. The model is that of the match: fits of the cross-section, scaling laws "
        "of the gears. Copper loss is that of the RMS force; iron loss is left out, so that the loss is the inverse of "
        "the damping reserve: both are the squared torque per ampere over the resistance."
    )
    caption = "Mass in kg, inertia in kg, reserve over the required damping, loss in W."
    sections = (
        Section("What the stages leave on the table", (text, Table(pd.DataFrame(gains), caption))),
        Section(
            "The front",
            (
                Picture(figure, "Every pair of objectives."),
                Table(table, "Designs solved by the field. Constraint excess above 0: the fits promised too much."),
            ),
        ),
    )
    write_report(path, sections, title=title, subtitle="All stages optimised together")


def main(name: str) -> None:
    """Optimise a study over all stages at once."""
    own = read_study(name)
    study = fed(own)

    def work(run):
        import pandas as pd
        from drivetrain import whole_design as whole
        from figures.style import save_png
        from figures.whole_design import whole_designs
        from optimisation.polynomial_fits import FitRefused

        try:
            problem, staged = problem_of(study), staged_design(study)
            settings = {"seed": _SEED, "population": _POPULATION, "generations": _GENERATIONS}
            front = whole.front(problem, start=staged, **settings)
            if not front:
                raise StageError(
                    "no front: no design meets match.mass_max_kg, match.equivalent_mass_max_kg and the damping "
                    "together; relax one of them."
                )
            before, bettered = problem.values(staged), left_on_the_table(problem, staged)
        except FitRefused as error:
            raise StageError(f"no front: {error}") from None
        shown = [("stage by stage", staged, before)]
        shown += [(question, design, values) for question, _, design, values in bettered]
        shown += [(f"front {k}", *pair) for k, pair in enumerate(whole.spread(front, _REPORTED), start=1)]
        sections = solved_sections(study, problem, [design for _, design, _ in shown], run)
        rows = [
            row(name, design, model, problem.values(design, section))
            for (name, design, model), section in zip(shown, sections, strict=True)
        ]
        table, gains = pd.DataFrame(rows), _gains(before, bettered)
        modelled = pd.DataFrame([row("", design, values, values) for design, values in front])
        figure = whole_designs(modelled, table.iloc[1:], table.iloc[0])
        for line in gains:
            print(
                f"optimise: {line['what is bettered']}: {line['stage by stage']:.4g} stage by stage, "
                f"{line['together']:.4g} together ({line['change_percent']:+.1f} %)"
            )
        apart = (table.damping_reserve / table.damping_reserve_of_the_fits - 1).abs().max()
        print(f"optimise: {len(front)} designs, {len(table)} solved; the fits are off by up to {apart:.1%}")
        run.note(front=len(front), largest_difference_of_the_fits=float(apart), **settings)
        run.write(TABLE, lambda path: table.to_csv(path, index=False))
        run.write_text(OUTPUT, json.dumps({"gains": gains, "front": len(front), "solved": len(table)}, indent=2) + "\n")
        run.write(PAGE, lambda path: _page(path, gains, table, figure, study.study.title))
        run.write(FIGURE, lambda path: save_png(figure, path))

    stage_of(own).run(work)


if __name__ == "__main__":
    with command():
        main(sys.argv[1])
