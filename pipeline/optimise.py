"""The loop closed: radius, slots, active length, ratio and linkage together, beside the design found stage by stage.

Reads the study and the results of fits, match and linkage; writes ``optimise.csv`` (the reported front, every point
solved by the field), ``optimise.json`` (what the stage-by-stage design leaves on the table), ``optimise.html``
and a figure.
"""

from __future__ import annotations

import json
import sys
from dataclasses import dataclass
from functools import lru_cache, partial

from pipeline.feeds import fed
from pipeline.stage import Stage, StageError, command, results_folder
from study.chain import searches_linkage
from study.read import read_study

TABLE, OUTPUT, PAGE, FIGURE = "optimise.csv", "optimise.json", "optimise.html", "figures/whole_designs.png"
_SEED, _POPULATION, _GENERATIONS = 1, 120, 120
_REPORTED = 12  # points of the front that are solved by the field
_IDLE_RADII = 5  # of each slot count, at which the idle loss is solved


def stage_of(study) -> Stage:
    """The search over all stages at once."""
    from pipeline import fits, linkage, match
    from pipeline.models import FIELD_CODE, FIELD_SECTIONS

    folder = results_folder(study.study.id)
    files = (folder / fits.OUTPUT, folder / match.OUTPUT)
    files += (folder / linkage.FRONT,) if searches_linkage(study) else ()
    used = ("requirements", "linkage", "linkage_search", "match", "winding_selection")
    values = fed(study).subset(*FIELD_SECTIONS, *used)
    code = (*FIELD_CODE, "drivetrain", "electrical", "losses", "figures.whole_design", "pipeline.match")
    return Stage("optimise", folder, values, files, (*code, "pipeline.optimise"), (TABLE, OUTPUT, PAGE, FIGURE))


# ---- the problem ----------------------------------------------------------------------------------------------------


def problem_of(study, section_at):
    """``WholeProblem`` of a fed study; section_at: (slots, stator outer radius [m]) -> ``RoadSection``."""
    from drivetrain.match import damping_constraint
    from drivetrain.whole_design import RoadDemand, SectionTable, WholeProblem, road_loss
    from pipeline.match import Matcher
    from units import MILLIMETRE

    matcher, match = Matcher.of(study), study.match
    required, limits, copper = matcher.demands
    demand = RoadDemand(required.force_rms, required.velocity_rms, copper, study.machine.poles // 2)
    radii = _radii(study, matcher)
    return WholeProblem(
        section_at=SectionTable(section_at, study.sweep.slots, radii),
        slots=study.sweep.slots,
        radii=radii,
        lengths=(0.1 * limits.active_length, limits.active_length),
        linkage_ratios=tuple(ratio * MILLIMETRE for ratio in _linkage_ratios(study)),
        constraints_of=matcher.constraints,
        gearbox=matcher.gearbox,
        damping_of=lambda section: damping_constraint(section, required, copper),
        loss_of=partial(road_loss, demand=demand),
        targets=(match.mass_max_kg, match.equivalent_mass_max_kg),
    )


def _radii(study, matcher) -> tuple[tuple[float, float], ...]:
    """Range of the stator radius [m] of each slot count: that of the fits."""
    from units import MILLIMETRE

    ranges = [matcher.fits[slots, "torque_nominal_Nm_per_m"].x_range for slots in study.sweep.slots]
    return tuple((low * MILLIMETRE, high * MILLIMETRE) for low, high in ranges)


def _linkage_ratios(study) -> tuple[float, float]:
    """Nominal ratios [mm/rad] of the front's linkages whose angles are no worse than those of the chosen one."""
    import pandas as pd
    from pipeline.linkage import FRONT

    chosen = study.linkage.ratio_nominal_mm_per_rad
    if not searches_linkage(study):
        return chosen, chosen
    table = pd.read_csv(results_folder(study.study.id) / FRONT)
    return chosen, float(table.ratio_nominal_mm_per_rad.max())


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


# ---- field solutions ------------------------------------------------------------------------------------------------


def solve_idle(task: dict) -> list[float]:
    """Hysteresis, eddy and excess term of the idle loss of one machine, magnets included; see ``RoadSection``."""
    study, model = _task_model(task)
    return _idle_terms(study, model)


def solve_section(task: dict) -> list[float]:
    """Torque per length at the nominal and the overload current [Nm/m], half-slot area [m^2], and the idle loss."""
    from magnetostatics.per_turn import mean_torque
    from pipeline.models import nominal_amplitude, overload_amplitude

    study, model = _task_model(task)
    packing = study.winding.packing_factor
    torques = [mean_torque(model, of(study), packing) for of in (nominal_amplitude, overload_amplitude)]
    area = model.section.half_slot_area * model.section.half_slots_per_coil_side
    return [*torques, area, *_idle_terms(study, model)]


def _task_model(task: dict):
    from pipeline.models import StudyFamily, field_model
    from study.convert import to_mesh_density

    study = _study(task["study"])
    lengths = (task[name] for name in ("stator_outer_radius", "back_iron_width", "rotor_outer_radius"))
    machine = StudyFamily(study.machine).machine(task["slots"], *lengths)
    return study, field_model(study, machine, to_mesh_density(study.mesh))


def _idle_terms(study, model) -> list[float]:
    from losses.map import field_losses
    from magnetostatics.model import OperatingPoint
    from materials.iron_loss import iron_loss_law

    point = OperatingPoint(0.0, 0.0, 0.0, study.winding.packing_factor)
    found = field_losses(model, point, iron_loss_law(study.materials.loss_grade))
    total = found.stator + found.rotor + found.magnet
    return [float(total.hysteresis), float(total.eddy), float(total.excess)]


@lru_cache(maxsize=1)
def _study(path: str):
    return read_study(path)


def _solved(function, study, sections, run, name: str) -> list[list[float]]:
    """The results of a task for every cross-section, on all cores."""
    from pipeline.parallel import default_workers, run_parallel

    names = ("slots", "stator_outer_radius", "back_iron_width", "rotor_outer_radius")
    shared = {"study": str(study.path.resolve())}
    tasks = {f"{name} {k}": {**shared, **{n: getattr(one, n) for n in names}} for k, one in enumerate(sections)}
    return list(run_parallel(function, tasks, default_workers(), run.checkpoint(), f"optimise, {name}").values())


def sections_of_the_fits(study, run):
    """(slots, stator outer radius [m]) -> ``RoadSection`` from the fits, its idle loss a parabola over the radius."""
    from dataclasses import asdict

    import numpy as np
    from drivetrain.whole_design import RoadSection
    from pipeline.match import Matcher

    matcher, overload = Matcher.of(study), study.match.overload_torque
    samples = [
        matcher.section(slots, overload, radius)
        for slots, ends in zip(study.sweep.slots, _radii(study, matcher), strict=True)
        for radius in np.linspace(*ends, _IDLE_RADII)
    ]
    terms = np.array(_solved(solve_idle, study, samples, run, "idle loss")).reshape(-1, _IDLE_RADII, 3)
    radii = np.array([one.stator_outer_radius for one in samples]).reshape(-1, _IDLE_RADII)
    parabolas = {n: np.polyfit(x, y, 2) for n, x, y in zip(study.sweep.slots, radii, terms, strict=True)}

    def section_at(slots, radius):
        idle = (float(np.polyval(one, radius)) for one in parabolas[slots].T)
        return RoadSection(**asdict(matcher.section(slots, overload, radius)), **dict(zip(_IDLE, idle, strict=True)))

    return section_at


_IDLE = ("idle_hysteresis", "idle_eddy", "idle_excess")
_SOLVED = ("torque_per_length_nominal", "torque_per_length_overload", "half_slot_area", *_IDLE)


def solved_sections(study, problem, designs, run) -> list:
    """The cross-sections of designs with torques, slot area and idle loss from the field in the place of the fits."""
    from dataclasses import replace

    sections = [problem.section_at(one.slots, one.stator_outer_radius) for one in designs]
    found = _solved(solve_section, study, sections, run, "design")
    pairs = zip(sections, found, strict=True)
    return [replace(one, **dict(zip(_SOLVED, numbers, strict=True))) for one, numbers in pairs]


# ---- what is asked, and what comes out ------------------------------------------------------------------------------


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


@dataclass(frozen=True)
class Outcome:
    """What the searches found.

    staged: (design, values) found stage by stage; bettered: [(question, objective, design, values)]; front: [(design,
    values)], all by the model
    """

    staged: tuple
    bettered: list
    front: list

    @property
    def shown(self) -> list[tuple]:
        """[(name, design, values)] of the designs that the field solves: staged, bettered, and some of the front."""
        from drivetrain.whole_design import spread

        rows = [("stage by stage", *self.staged)]
        rows += [(question, *pair) for question, _, *pair in self.bettered]
        return rows + [(f"front {k}", *pair) for k, pair in enumerate(spread(self.front, _REPORTED), start=1)]

    @property
    def gains(self) -> list[dict]:
        """What the stages leave on the table, one row a question."""
        return [_gain(self.staged[1], *one) for one in self.bettered]


def _gain(before, question, objective, design, values) -> dict:
    old, new = before.objectives[objective], values.objectives[objective]
    row = {"what is bettered": question, "stage by stage": old, "together": new}
    row |= {"change_percent": 100 * (new / old - 1), "slots": design.slots}
    return {**row, "stator_diameter_mm": 2e3 * design.stator_outer_radius}


def searched(problem, staged) -> Outcome:
    """The front, and the staged design bettered in one objective at a time; StageError where no design is feasible."""
    from drivetrain import whole_design as whole
    from optimisation.polynomial_fits import FitRefused

    settings = {"seed": _SEED, "population": _POPULATION, "generations": _GENERATIONS}
    try:
        front, before = whole.front(problem, start=staged, **settings), problem.values(staged)
    except FitRefused as error:
        raise StageError(f"no front: {error}") from None
    if not front:
        raise StageError(
            "no front: no design meets match.mass_max_kg, match.equivalent_mass_max_kg and the damping together; "
            "relax one of them."
        )
    bettered = [
        (question, k, *whole.improved(problem, staged, k, allowed))
        for question, k, allowed in questions(before.objectives)
    ]
    return Outcome((staged, before), bettered, front)


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


def tables(study, problem, found: Outcome, run):
    """(designs solved by the field, the whole front by the model), in drawing units."""
    import pandas as pd

    sections = solved_sections(study, problem, [design for _, design, _ in found.shown], run)
    solved = [
        row(name, design, model, problem.values(design, section))
        for (name, design, model), section in zip(found.shown, sections, strict=True)
    ]
    modelled = [row("", design, values, values) for design, values in found.front]
    return pd.DataFrame(solved), pd.DataFrame(modelled)


_TEXT = (
    "Slot count, radius, active length, ratio and linkage are varied together against the design that match and "
    "linkage arrived at one after the other. The model is that of the match: fits of the cross-section, scaling laws "
    "of the gears. The loss on the road is copper loss of the RMS force and idle loss of iron and magnets at the RMS "
    "velocity. Copper loss alone would be the inverse of the damping reserve; the idle loss is smaller with a larger "
    "transmission ratio, which turns the rotor more slowly, and sets the two against each other."
)


def idle_share(study, front) -> str:
    """How much of the loss on the road is not the inverse of the damping reserve; front: table of ``row``."""
    required = study.requirements
    copper = required.force_rms_N**2 / (front.damping_reserve * required.maximum_damping_kNs_per_m * 1e3)
    share = 100 * (1 - copper / front.road_loss_W)
    return f"Idle loss is {share.min():.0f} to {share.max():.0f} % of the loss on the road over the front."


def _page(path, gains, table, figure, share: str, title: str) -> None:
    import pandas as pd
    from figures.report import Picture, Section, Table, write_report

    caption = "Mass in kg, inertia in kg, reserve over the required damping, loss in W."
    solved = "Designs solved by the field. Constraint excess above 0: the fits promised too much."
    sections = (
        Section("What the stages leave on the table", (_TEXT, Table(pd.DataFrame(gains), caption))),
        Section("The front", (share, Picture(figure, "Every pair of objectives."), Table(table, solved))),
    )
    write_report(path, sections, title=title, subtitle="All stages optimised together")


def _said(gains, table, front) -> list[str]:
    apart = (table.damping_reserve / table.damping_reserve_of_the_fits - 1).abs().max()
    lines = [
        f"{one['what is bettered']}: {one['stage by stage']:.4g} stage by stage, {one['together']:.4g} together "
        f"({one['change_percent']:+.1f} %)"
        for one in gains
    ]
    return [*lines, f"{len(front)} designs, {len(table)} solved; the fits are off by up to {apart:.1%}"]


def work(study, run) -> None:
    """Search, solve and write; study: fed."""
    from figures.style import save_png
    from figures.whole_design import whole_designs
    from pipeline.losses import loss_grade_of

    loss_grade_of(study, None)
    problem = problem_of(study, sections_of_the_fits(study, run))
    found = searched(problem, staged_design(study))
    table, modelled = tables(study, problem, found, run)
    figure = whole_designs(modelled, table.iloc[1:], table.iloc[0])
    share = idle_share(study, modelled)
    for line in (*_said(found.gains, table, found.front), share):
        print(f"optimise: {line}")
    counts = {"front": len(found.front), "solved": len(table)}
    run.note(**counts, seed=_SEED, population=_POPULATION, generations=_GENERATIONS)
    run.write(TABLE, lambda path: table.to_csv(path, index=False))
    run.write_text(OUTPUT, json.dumps({"gains": found.gains, **counts}, indent=2) + "\n")
    run.write(PAGE, lambda path: _page(path, found.gains, table, figure, share, study.study.title))
    run.write(FIGURE, lambda path: save_png(figure, path))


def main(name: str) -> None:
    """Optimise a study over all stages at once."""
    own = read_study(name)
    stage_of(own).run(partial(work, fed(own)))


if __name__ == "__main__":
    with command():
        main(sys.argv[1])
