"""Report of the linkage: table of the front, figures, the stated linkage and its verdict."""

from dataclasses import replace

import numpy as np
import pytest

from drivetrain.four_bar import SwingArm, from_lengths
from drivetrain.linkage_choice import SmallestRatio
from drivetrain.linkage_front import GeneticSettings
from drivetrain.linkage_problem import Box, Limits, LinkageProblem, Travel
from drivetrain.linkage_stage import LinkageSearch, linkage_stage
from drivetrain.requirements import Linkage
from figures.report import Picture, Table
from report import linkage as report
from units import DEGREE, MILLIMETRE

MM = MILLIMETRE
ARM = SwingArm((218.0 + 0.9j) * MM, (572.2 - 121.7j) * MM)
PROBLEM = LinkageProblem(
    arm=ARM,
    box_b=Box(0j, (220 + 170j) * MM, "B"),
    box_c=Box((40 + 110j) * MM, (50 + 140j) * MM, "C"),
    travel=Travel(-20 * MM, 140 * MM),
    limits=Limits(ratio=350 * MM, ratio_spread=20 * MM, angle_window=50 * DEGREE, lever_length=45 * MM),
)
QUICK = GeneticSettings(seeds=(1,), population=24, generations=10, sharpened_points=6)
PRINTED = from_lengths(ARM, (46.6 + 134.7j) * MM, 195.3 * MM, 53.3 * MM)
SEARCH = LinkageSearch(PROBLEM, QUICK, SmallestRatio(1.116), PRINTED)


@pytest.fixture(scope="module")
def found():
    return linkage_stage(SEARCH)


def words(section):
    return " ".join(part for part in section.content if isinstance(part, str))


def test_the_front_is_a_table_in_drawing_units(found):
    table = report.front_table(found.front)
    assert len(table) == len(found.front.objectives)
    assert table.x_C_mm.between(40 - 1e-9, 50 + 1e-9).all() and (table.lever_length_mm > 45 - 1e-6).all()
    assert table.ratio_nominal_mm_per_rad.to_numpy() == pytest.approx(350 * table.objective_1.to_numpy())
    assert (table.gamma_min_deg >= 40 - 1e-6).all() and (table.lambda_max_deg <= 140 + 1e-6).all()


def test_files_are_the_table_and_the_pictures_of_the_section(found, tmp_path):
    files = list(report.files(found))
    shown = {part.image for part in report.section(found, SEARCH).content if isinstance(part, Picture)}
    assert {file.name for file in files} == shown | {report.FRONT} and len(shown) == 3
    for file in files:
        file.write(tmp_path / "one")
        assert (tmp_path / "one").stat().st_size > 0


def test_the_stated_linkage_is_a_row_and_a_verdict(found):
    section = report.section(found, SEARCH)
    (table,) = [part.frame for part in section.content if isinstance(part, Table)]
    stated = table.set_index("linkage").loc["stated in the study"]
    assert stated.ratio_nominal_mm_per_rad == pytest.approx(169.857, abs=1e-3)
    assert (stated.link_ab_length_mm, stated.link_bc_length_mm) == pytest.approx((195.3, 53.3))
    assert stated.margin_deg == pytest.approx(10.465, abs=1e-3)
    assert "The stated linkage is dominated: at its angles the front has" in words(section)
    assert "instead of 169.9 mm/rad" in words(section)


def test_the_ratio_is_compared_only_where_it_is_the_objective(found):
    half = replace(PROBLEM, limits=replace(PROBLEM.limits, ratio_weight=0.5))
    other = replace(found, front=replace(found.front, problem=half))
    assert "mm/rad" not in words(report.section(other, SEARCH)) and "dominated" in words(report.section(other, SEARCH))


@pytest.mark.parametrize("beyond", ["first_at_same_second", "second_at_same_first"])
def test_where_the_front_ends_nothing_is_compared(found, beyond):
    place = replace(found.stated.standing, **{beyond: np.nan})
    said = words(report.section(replace(found, stated=replace(found.stated, standing=place)), SEARCH))
    assert "dominated: at its" in said and "nan" not in said


def test_without_a_stated_linkage_there_is_one_row(found):
    alone = replace(found, stated=None)
    section = report.section(alone, SEARCH)
    (table,) = [part.frame for part in section.content if isinstance(part, Table)]
    assert table.linkage.tolist() == ["chosen"] and "dominated" not in words(section)
    assert len(list(report.files(alone))) == 4


def test_stated_ratios_have_a_section_of_their_own():
    assert "115 mm/rad in the nominal position, 120 mm/rad at most" in words(
        report.stated_section(Linkage(0.115, 0.120, None))
    )
