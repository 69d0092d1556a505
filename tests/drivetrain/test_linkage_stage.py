"""The linkage stage on a short search: what is built and why, its angles, the stated linkage, what others read."""

from dataclasses import replace

import numpy as np
import pytest

from drivetrain.four_bar import LinkageError, SwingArm, from_lengths
from drivetrain.linkage_choice import Knee, SmallestRatio
from drivetrain.linkage_front import GeneticSettings
from drivetrain.linkage_problem import Box, Limits, LinkageProblem, Travel
from drivetrain.linkage_stage import LinkageSearch, chosen_linkage, in_motion, linkage_stage
from drivetrain.requirements import InstallationSpace
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
PRINTED = from_lengths(ARM, (46.6 + 134.7j) * MM, 195.3 * MM, 53.3 * MM)
QUICK = GeneticSettings(seeds=(1,), population=24, generations=10, sharpened_points=6)
SEARCH = LinkageSearch(PROBLEM, QUICK, SmallestRatio(1.116), PRINTED)


@pytest.fixture(scope="module")
def found():
    return linkage_stage(SEARCH)


def test_the_rule_of_the_search_decides(found):
    first, second = found.front.objectives.T
    assert second[found.chosen] <= 1.116 < second[found.chosen - 1]
    assert "no worse than f2 = 1.116" in found.reason
    assert linkage_stage(replace(SEARCH, rule=Knee())).chosen == Knee().pick(found.front)


def test_what_is_built_is_the_chosen_point(found):
    built = found.built
    assert built.ratio_nominal == pytest.approx(found.nominal_ratios[found.chosen])
    assert built.ratio_nominal == pytest.approx(found.front.objectives[found.chosen, 0] * 0.350)
    smallest, largest = built.ratio_range
    assert smallest < built.ratio_nominal < largest
    assert built.angle_deviation <= 50 * DEGREE
    squares = sum((angle - np.pi / 2) ** 2 for angle in (*built.gamma_range, *built.lambda_range))
    assert squares == pytest.approx(found.front.objectives[found.chosen, 1], rel=1e-9), "objective f2 (3.44)"


def test_the_stated_linkage_stands_beside_the_front(found):
    stated = found.stated
    assert stated.built.ratio_nominal == pytest.approx(0.16986, abs=1e-5)
    assert stated.standing.objectives[0] == pytest.approx(stated.built.ratio_nominal / 0.350)
    assert linkage_stage(replace(SEARCH, stated=None)).stated is None


def test_stages_behind_read_two_ratios_and_the_room(found):
    linkage = chosen_linkage(found, InstallationSpace(0.06))
    assert (linkage.ratio_nominal, linkage.ratio_max) == (found.built.ratio_nominal, found.built.ratio_range[1])
    assert linkage.envelope_radius_max == 0.06
    assert chosen_linkage(found, InstallationSpace(None)).envelope_radius_max is None


def test_a_box_without_a_linkage():
    box = Box((60 + 125j) * MM, (62 + 127j) * MM, "B")
    with pytest.raises(LinkageError, match="where the miss is smallest, .* widen the boxes"):
        linkage_stage(replace(SEARCH, problem=replace(PROBLEM, box_b=box)))


def test_a_rule_that_excludes_every_point():
    with pytest.raises(LinkageError, match="allow more"):
        linkage_stage(replace(SEARCH, rule=SmallestRatio(0.01)))


def test_a_stated_linkage_that_comes_apart_is_said():
    with pytest.raises(LinkageError, match="do not close at a wheel travel of"):
        in_motion(from_lengths(ARM, (46.6 + 134.7j) * MM, 160 * MM, 60 * MM), PROBLEM)
