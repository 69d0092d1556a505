"""The linkage of a study in SI: what is searched, how, and which point is taken, or the ratios that are stated."""

from __future__ import annotations

from collections.abc import Callable

from drivetrain.four_bar import FourBar, SwingArm, from_lengths
from drivetrain.linkage_choice import BestAngles, ChoiceRule, Knee, SmallestRatio
from drivetrain.linkage_front import GeneticSettings
from drivetrain.linkage_problem import Box, Limits, LinkageProblem, Travel
from drivetrain.linkage_stage import LinkageSearch
from drivetrain.requirements import InstallationSpace, Linkage
from study.inputs_drive import drive_linkage
from study.needed import needed
from study.schema import LinkageSearchSection, LinkageSection, Study


def linkage_search(study: Study) -> LinkageSearch:
    """Problem, settings and rule of a study that searches its linkage; LinkageError where they contradict."""
    search = needed(study.linkage_search, "linkage_search")
    return LinkageSearch(
        problem=linkage_problem(study),
        settings=GeneticSettings(search.seeds, search.population, search.generations),
        rule=_choice_rule(search),
        stated=stated_hardpoints(_section(study)),
    )


def stated_linkage(study: Study) -> Linkage:
    """The ratios that the study states; 1 for a load on the shaft."""
    if study.drive is not None:
        return drive_linkage(study.drive)
    section = _section(study).si
    return Linkage(section.ratio_nominal, section.ratio_max, section.envelope_radius_max)


def installation_space(study: Study) -> InstallationSpace:
    """The room that the study leaves for the actuator."""
    return InstallationSpace(_section(study).si.envelope_radius_max)


def linkage_problem(study: Study) -> LinkageProblem:
    """Swing arm, boxes, travel and limits."""
    section, search = _section(study).si, needed(study.linkage_search, "linkage_search").si
    return LinkageProblem(
        arm=_arm(_section(study)),
        box_b=Box(complex(*section.hardpoint_b_min), complex(*section.hardpoint_b_max), "B"),
        box_c=Box(complex(*section.hardpoint_c_min), complex(*section.hardpoint_c_max), "C"),
        travel=Travel(-search.travel_rebound, search.travel_bump),
        limits=Limits(
            ratio=search.ratio_limit,
            ratio_spread=search.ratio_spread_limit,
            angle_window=search.angle_window,
            lever_length=search.lever_length_min,
            ratio_weight=search.ratio_weight,
        ),
    )


def stated_hardpoints(section: LinkageSection) -> FourBar | None:
    """The linkage that the study states by hardpoint C and its two lengths, None where it does not."""
    one = section.si
    lengths = (one.link_ab_length, one.link_bc_length)
    if None in (one.hardpoint_a, one.wheel_axle, one.hardpoint_c, *lengths):
        return None
    return from_lengths(_arm(section), complex(*one.hardpoint_c), *lengths)


def _section(study: Study) -> LinkageSection:
    return needed(study.linkage, "linkage")


def _arm(section: LinkageSection) -> SwingArm:
    return SwingArm(complex(*section.si.hardpoint_a), complex(*section.si.wheel_axle))


def _choice_rule(search: LinkageSearchSection) -> ChoiceRule:
    """The rule that the study names, with its number."""
    rules: dict[str, Callable[[], ChoiceRule]] = {
        "smallest_ratio": lambda: SmallestRatio(search.si.angles_worst),
        "best_angles": lambda: BestAngles(search.si.ratio_max),
        "knee": Knee,
    }
    return rules[search.choice]()
