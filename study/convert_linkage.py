"""The linkage of a study as the objects of ``drivetrain``: what is searched, how, and which point is taken."""

from __future__ import annotations

from drivetrain.four_bar import FourBar, SwingArm, from_lengths
from drivetrain.linkage_choice import BestAngles, ChoiceRule, Knee, SmallestRatio
from drivetrain.linkage_front import GeneticSettings
from drivetrain.linkage_problem import Box, Limits, LinkageProblem, Travel
from study.schema import LinkageSearchSection, LinkageSection, Study
from units import DEGREE, MILLIMETRE


def to_point(coordinates_mm: tuple[float, float]) -> complex:
    """x + jy [m]."""
    return complex(*coordinates_mm) * MILLIMETRE


def to_linkage_problem(study: Study) -> LinkageProblem:
    """Swing arm, boxes, travel and limits; LinkageError where they contradict each other."""
    section, search = study.linkage, study.linkage_search
    return LinkageProblem(
        arm=_arm(section),
        box_b=Box(to_point(section.hardpoint_b_min_mm), to_point(section.hardpoint_b_max_mm), "B"),
        box_c=Box(to_point(section.hardpoint_c_min_mm), to_point(section.hardpoint_c_max_mm), "C"),
        travel=Travel(-search.travel_rebound_mm * MILLIMETRE, search.travel_bump_mm * MILLIMETRE),
        limits=Limits(
            ratio=search.ratio_limit_mm_per_rad * MILLIMETRE,
            ratio_spread=search.ratio_spread_limit_mm_per_rad * MILLIMETRE,
            angle_window=search.angle_window_deg * DEGREE,
            lever_length=search.lever_length_min_mm * MILLIMETRE,
            ratio_weight=search.ratio_weight,
        ),
    )


def _arm(section: LinkageSection) -> SwingArm:
    return SwingArm(to_point(section.hardpoint_a_mm), to_point(section.wheel_axle_mm))


def to_genetic_settings(search: LinkageSearchSection) -> GeneticSettings:
    """Seeds, population and generations of the search."""
    return GeneticSettings(search.seeds, search.population, search.generations)


def to_choice_rule(search: LinkageSearchSection) -> ChoiceRule:
    """The rule that the study names, with its number."""
    rules = {
        "smallest_ratio": lambda: SmallestRatio(search.angles_worst_rad2),
        "best_angles": lambda: BestAngles(search.ratio_max_mm_per_rad * MILLIMETRE),
        "knee": Knee,
    }
    return rules[search.choice]()


def to_stated_linkage(section: LinkageSection) -> FourBar | None:
    """The linkage that the study states by hardpoint C and its two lengths, None where it does not."""
    stated = (section.hardpoint_a_mm, section.wheel_axle_mm, section.hardpoint_c_mm)
    lengths = (section.link_ab_length_mm, section.link_bc_length_mm)
    if None in (*stated, *lengths):
        return None
    return from_lengths(_arm(section), to_point(section.hardpoint_c_mm), *(length * MILLIMETRE for length in lengths))
