"""The linkage for people: the front as a table, front, motion and side view as figures, and the report's section."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pandas as pd

from drivetrain.linkage_front import ParetoFront, Standing
from drivetrain.linkage_stage import LinkageFront, LinkageInMotion, LinkageSearch
from drivetrain.requirements import Linkage
from figures.files import File, figure_file, picture_name, table_file
from figures.linkage import linkage_motion, linkage_side_view, pareto_front
from figures.report import Picture, Section, Table
from units import DEGREE, FACTORS, MILLIMETRE

FRONT = "linkage_front.csv"
_RATIO = FACTORS["mm_per_rad"]
_PLACES = ("x_B_mm", "y_B_mm", "x_C_mm", "y_C_mm")


def files(found: LinkageFront) -> Iterator[File]:
    """Table of the front and the figures."""
    problem, built = found.front.problem, found.built
    yield table_file(FRONT, front_table(found.front))
    yield figure_file("linkage_front", pareto_front(found.front, found.chosen, others=_others(found)))
    motions = {"chosen": built.motion} | ({"stated": found.stated.built.motion} if found.stated is not None else {})
    yield figure_file("linkage_motion", linkage_motion(motions, angle_window=problem.limits.angle_window))
    view = linkage_side_view(built.linkage, built.motion, boxes=(problem.box_b, problem.box_c))
    yield figure_file("linkage_view", view)


def section(found: LinkageFront, search: LinkageSearch) -> Section:
    """The linkage that is built."""
    text = (
        f"{len(found.front.objectives)} linkages of the Pareto front, {len(search.settings.seeds)} seeds merged and "
        "sharpened."
    )
    return Section(
        "Linkage",
        (
            text,
            Picture(picture_name("linkage_front"), "The front, the choice, and where hardpoints lie in their boxes."),
            f"Decision: {found.reason}.",
            Table(_linkages(found), "Linkages over the wheel travel; margin: of the angles to their limits."),
            *_verdict(found),
            Picture(picture_name("linkage_motion"), "Ratio and transmission angles over the wheel travel."),
            Picture(picture_name("linkage_view"), "Side view over the wheel travel."),
        ),
    )


def remarks(found: LinkageFront) -> Iterator[str]:
    """What the run says at once: the choice."""
    yield f"{found.built.ratio_nominal / _RATIO:.1f} mm/rad, {found.reason}"


def stated_section(linkage: Linkage) -> Section:
    """The linkage of a study that states its ratios."""
    text = (
        f"Stated in the study file: {linkage.ratio_nominal / _RATIO:g} mm/rad in the nominal position, "
        f"{linkage.ratio_max / _RATIO:g} mm/rad at most."
    )
    return Section("Linkage", (text,))


def front_table(front: ParetoFront) -> pd.DataFrame:
    """The front in drawing units, one row a linkage; objective 2 in rad^2."""
    motion = front.linkages.motion(front.problem.travel.values)
    columns = {
        "objective_1": front.objectives[:, 0],
        "objective_2": front.objectives[:, 1],
        "ratio_nominal_mm_per_rad": front.nominal_ratios / _RATIO,
        "ratio_max_mm_per_rad": motion.transmission_ratio.max(axis=-1) / _RATIO,
        "gamma_min_deg": motion.gamma.min(axis=-1) / DEGREE,
        "gamma_max_deg": motion.gamma.max(axis=-1) / DEGREE,
        "lambda_min_deg": motion.lambda_.min(axis=-1) / DEGREE,
        "lambda_max_deg": motion.lambda_.max(axis=-1) / DEGREE,
        "lever_length_mm": front.linkages.lever_length / MILLIMETRE,
    }
    places = dict(zip(_PLACES, (front.designs / MILLIMETRE).T, strict=True))
    return pd.DataFrame({**columns, **places, "seed": front.seed})


def _others(found: LinkageFront) -> list[tuple[str, Standing]]:
    return [] if found.stated is None else [("stated in the study", found.stated.standing)]


def _linkages(found: LinkageFront) -> pd.DataFrame:
    window = found.front.problem.limits.angle_window
    rows = [_row("chosen", found.built, window)]
    if found.stated is not None:
        rows.append(_row("stated in the study", found.stated.built, window))
    return pd.DataFrame(rows)


def _row(name: str, one: LinkageInMotion, window: float) -> dict[str, object]:
    ratio_min, ratio_max = one.ratio_range
    return {
        "linkage": name,
        "ratio_nominal_mm_per_rad": one.ratio_nominal / _RATIO,
        "ratio_min_mm_per_rad": ratio_min / _RATIO,
        "ratio_max_mm_per_rad": ratio_max / _RATIO,
        "link_ab_length_mm": float(one.linkage.coupler_length / MILLIMETRE),
        "link_bc_length_mm": float(one.linkage.lever_length / MILLIMETRE),
        **_angles("gamma", one.gamma_range),
        **_angles("lambda", one.lambda_range),
        "margin_deg": (window - one.angle_deviation) / DEGREE,
    }


def _angles(name: str, ends: tuple[float, float]) -> dict[str, float]:
    return {f"{name}_min_deg": ends[0] / DEGREE, f"{name}_max_deg": ends[1] / DEGREE}


def _verdict(found: LinkageFront) -> tuple[str, ...]:
    """How much better the front is than a stated linkage that it dominates."""
    if found.stated is None or not found.stated.standing.dominated:
        return ()
    parts = [text for text in (_level_ratio(found), _level_angles(found.stated.standing)) if text]
    return (f"The stated linkage is dominated{': ' + ', '.join(parts) if parts else ''}.",)


def _level_ratio(found: LinkageFront) -> str:
    """The ratio of the front at the stated angles, where the first objective is the nominal ratio itself."""
    limits, stated = found.front.problem.limits, found.stated
    if stated is None or limits.ratio_weight != 1 or np.isnan(stated.standing.first_at_same_second):
        return ""
    level, own = stated.standing.first_at_same_second * limits.ratio / _RATIO, stated.built.ratio_nominal / _RATIO
    return f"at its angles the front has {level:.1f} instead of {own:.1f} mm/rad"


def _level_angles(place: Standing) -> str:
    """The angles of the front at the stated first objective."""
    if np.isnan(place.second_at_same_first):
        return ""
    level, own = place.second_at_same_first, place.objectives[1]
    return f"at its ratio an angle objective of {level:.3f} instead of {own:.3f} rad²"
