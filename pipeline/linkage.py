"""Pareto front of linkages, the one that is built and why, and where the stated one stands (thesis Fig. 3.14).

Reads the study, writes ``linkage_front.csv``, ``linkage.json`` (the choice, its ratios and angles over the wheel
travel, the stated linkage beside it) and figures. Several seeds of NSGA-II, merged and sharpened by gradients.
"""

from __future__ import annotations

import json
import sys

from pipeline.feeds import LINKAGE as OUTPUT
from pipeline.stage import Stage, StageError, command, results_folder
from study.chain import searches_linkage
from study.read import read_study

FRONT = "linkage_front.csv"
FIGURES = {
    "linkage_front": "figures/linkage_front.png",
    "linkage_motion": "figures/linkage_motion.png",
    "linkage_view": "figures/linkage_view.png",
}
_CODE = ("drivetrain.four_bar", "drivetrain.linkage_problem", "drivetrain.linkage_front", "drivetrain.linkage_choice")
CODE = ("units", *_CODE, "figures.style", "figures.linkage", "study.convert_linkage", "pipeline.linkage")


def figures_of(study) -> dict[str, str]:
    """Figures of the stage by name; none where the linkage is stated."""
    return FIGURES if searches_linkage(study) else {}


def stage_of(study) -> Stage:
    """The linkage of a study."""
    values = study.subset("chain", "linkage", "linkage_search")
    outputs = (OUTPUT, FRONT, *FIGURES.values())
    return Stage("linkage", results_folder(study.study.id), values, (), CODE, outputs)


def front_of(study):
    """``LinkageFront`` of a study."""
    from drivetrain.linkage_front import pareto_front
    from study.convert_linkage import to_genetic_settings, to_linkage_problem

    return pareto_front(to_linkage_problem(study), to_genetic_settings(study.linkage_search))


def table_of(front):
    """The front in drawing units, one row a linkage."""
    import numpy as np
    import pandas as pd
    from units import DEGREE, MILLIMETRE

    motion = front.linkages.motion(front.problem.travel.values)
    ratio = front.linkages.motion(np.zeros(1)).transmission_ratio[:, 0]
    places = dict(zip(("x_B_mm", "y_B_mm", "x_C_mm", "y_C_mm"), (front.designs / MILLIMETRE).T, strict=True))
    return pd.DataFrame(
        {
            "objective_1": front.objectives[:, 0],
            "objective_2": front.objectives[:, 1],
            "ratio_nominal_mm_per_rad": ratio / MILLIMETRE,
            "ratio_max_mm_per_rad": motion.transmission_ratio.max(axis=-1) / MILLIMETRE,
            "gamma_min_deg": motion.gamma.min(axis=-1) / DEGREE,
            "gamma_max_deg": motion.gamma.max(axis=-1) / DEGREE,
            "lambda_min_deg": motion.lambda_.min(axis=-1) / DEGREE,
            "lambda_max_deg": motion.lambda_.max(axis=-1) / DEGREE,
            "lever_length_mm": front.linkages.lever_length / MILLIMETRE,
            **places,
            "seed": front.seed,
        }
    )


def described(linkage, travel) -> dict:
    """One linkage in drawing units: hardpoints, lengths, ratios and angles over the travel."""
    from units import DEGREE, MILLIMETRE

    motion, nominal = linkage.motion(travel), linkage.motion([0.0])
    ratio = motion.transmission_ratio / MILLIMETRE
    return {
        "hardpoint_b_mm": _coordinates(linkage.hardpoint_b),
        "hardpoint_c_mm": _coordinates(linkage.hardpoint_c),
        "link_ab_length_mm": float(linkage.coupler_length / MILLIMETRE),
        "link_bc_length_mm": float(linkage.lever_length / MILLIMETRE),
        "ratio_nominal_mm_per_rad": float(nominal.transmission_ratio[0] / MILLIMETRE),
        "ratio_min_mm_per_rad": float(ratio.min()),
        "ratio_max_mm_per_rad": float(ratio.max()),
        "gamma_deg": [float(motion.gamma.min() / DEGREE), float(motion.gamma.max() / DEGREE)],
        "lambda_deg": [float(motion.lambda_.min() / DEGREE), float(motion.lambda_.max() / DEGREE)],
    }


def _coordinates(point: complex) -> list[float]:
    from units import MILLIMETRE

    return [float(point.real / MILLIMETRE), float(point.imag / MILLIMETRE)]


def section_of(chosen: dict) -> dict:
    """The keys of [linkage] that the choice replaces."""
    names = ("ratio_nominal_mm_per_rad", "ratio_max_mm_per_rad", "link_ab_length_mm", "link_bc_length_mm")
    return {**{name: chosen[name] for name in names}, "hardpoint_c_mm": tuple(chosen["hardpoint_c_mm"])}


def against_front(front, linkage) -> dict:
    """A stated linkage against the front: by how much it is dominated."""
    from dataclasses import asdict

    from drivetrain.linkage_front import standing
    from units import MILLIMETRE

    place = standing(front, linkage)
    limit = front.problem.limits.ratio / MILLIMETRE
    weight_on_ratio = front.problem.limits.ratio_weight == 1
    found = {**described(linkage, front.problem.travel.values), **asdict(place)}
    if weight_on_ratio:  # the first objective is then the nominal ratio itself
        found["ratio_at_same_angles_mm_per_rad"] = place.first_at_same_second * limit
    return found


def _draw(front, chosen, linkage, printed):
    """Yield (name, Figure)."""
    from drivetrain.linkage_front import standing
    from figures import linkage as draw

    travel, problem = front.problem.travel.values, front.problem
    others = [("stated in the study", standing(front, printed))] if printed is not None else []
    yield "linkage_front", draw.pareto_front(front, chosen, others=others)
    motions = {"chosen": linkage.motion(travel)}
    motions |= {"stated": printed.motion(travel)} if printed is not None else {}
    yield "linkage_motion", draw.linkage_motion(motions, angle_window=problem.limits.angle_window)
    boxes = (problem.box_b, problem.box_c)
    yield "linkage_view", draw.linkage_side_view(linkage, motions["chosen"], boxes=boxes)


def main(name: str) -> None:
    """Search the linkage of a study."""
    study = read_study(name)
    if not searches_linkage(study):
        print("linkage: stated in the study, no front is searched")
        return

    def work(run):
        from drivetrain.four_bar import LinkageError
        from figures.style import save_png
        from study.convert_linkage import to_choice_rule, to_stated_linkage

        try:
            front, rule = front_of(study), to_choice_rule(study.linkage_search)
            chosen, printed = rule.pick(front), to_stated_linkage(study.linkage)
            linkage = front.linkage(chosen)
            found = described(linkage, front.problem.travel.values)
            beside = against_front(front, printed) if printed is not None else None
        except LinkageError as error:
            raise StageError(f"no linkage: {error}") from None
        outcome = {"section": section_of(found), "chosen": found, "row": chosen, "reason": rule.reason}
        outcome |= {"objectives": front.objectives[chosen].tolist(), "points": len(front.objectives)}
        outcome["stated"] = beside
        print(f"linkage: {found['ratio_nominal_mm_per_rad']:.1f} mm/rad, {rule.reason}")
        run.note(points=len(front.objectives), seeds=study.linkage_search.seeds)
        run.write(FRONT, lambda path: table_of(front).to_csv(path, index=False))
        run.write_text(OUTPUT, json.dumps(outcome, indent=2) + "\n")
        for figure_name, figure in _draw(front, chosen, linkage, printed):
            run.write(FIGURES[figure_name], lambda path, figure=figure: save_png(figure, path))

    stage_of(study).run(work)


if __name__ == "__main__":
    with command():
        main(sys.argv[1])
