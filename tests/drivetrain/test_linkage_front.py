"""Pareto front of linkages: against other optimisers, against the printed design, choice rules, impossible boxes."""

import time
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import differential_evolution

from drivetrain.four_bar import FourBar, LinkageError, SwingArm, from_lengths
from drivetrain.linkage_choice import BestAngles, Knee, SmallestRatio
from drivetrain.linkage_front import GeneticSettings, pareto_front, standing
from drivetrain.linkage_problem import CONSTRAINTS, Box, Limits, LinkageProblem, Travel
from drivetrain.pareto import non_dominated
from units import DEGREE, MILLIMETRE

MM = MILLIMETRE
QUICK = GeneticSettings(seeds=(1,), population=24, generations=10, sharpened_points=6)
PRINTED = (96.3915, 153.7184, 46.6, 134.7)  # mm, B from the lengths of thesis Table 3.9


def thesis_problem(**changes):
    """Thesis Tables 3.1 and 3.8 with the axle below the pivot, limits of the text to eqs 3.43-3.49."""
    problem = LinkageProblem(
        arm=SwingArm((218.0 + 0.9j) * MM, (572.2 - 121.7j) * MM),
        box_b=Box(0j, (220 + 170j) * MM, "B"),
        box_c=Box((40 + 110j) * MM, (50 + 140j) * MM, "C"),
        travel=Travel(-20 * MM, 140 * MM),
        limits=Limits(ratio=350 * MM, ratio_spread=20 * MM, angle_window=50 * DEGREE, lever_length=45 * MM),
    )
    return replace(problem, **changes)


def score(problem, *designs_mm):
    return problem.score(problem.linkage(np.array(designs_mm) * MM))


@pytest.fixture(scope="module")
def solved():
    """The front of four seeds and its CPU time [s]."""
    start = time.process_time()
    front = pareto_front(thesis_problem())
    return front, time.process_time() - start


@pytest.fixture
def front(solved):
    return solved[0]


@pytest.fixture
def printed():
    return from_lengths(thesis_problem().arm, (46.6 + 134.7j) * MM, 195.3 * MM, 53.3 * MM)


def test_four_seeds_take_less_than_twenty_seconds(solved):
    assert solved[1] < 20


def test_the_front_reaches_or_dominates_the_reference_front(front):
    """An independent run: f1 from 0.345 to 1.0, f2 from 0.153 to 1.709, 160.2 mm/rad and 1.030 level with the print."""
    first, second = front.objectives.T
    assert first[0] < 0.345 and first[-1] == pytest.approx(1.0, abs=1e-3)
    assert front.second_at(0.345) <= 1.709 and second[-1] <= 0.153
    assert front.second_at(0.48531) == pytest.approx(1.030, abs=5e-4)
    assert front.first_at(1.11574) * 350 == pytest.approx(160.2, abs=0.05)


def test_the_front_is_feasible_ordered_and_non_dominated(front):
    assert front.problem.score(front.linkages).feasible.all()
    assert (np.diff(front.objectives[:, 0]) > 0).all() and (np.diff(front.objectives[:, 1]) < 0).all()


@pytest.mark.parametrize("level", [0.42, 0.75])
def test_differential_evolution_finds_no_better_angles_at_the_same_ratio(front, level):
    problem = front.problem
    lower, upper = problem.bounds

    def penalised(unit):
        scores = problem.score(problem.linkage(lower + unit.T * (upper - lower)))
        first, second = np.nan_to_num(scores.objectives, nan=9.0).T
        excess = np.maximum(np.column_stack([first - level, scores.constraints]), 0).sum(axis=1)
        return np.where(excess > 0, 1e3 * (1 + excess), second)

    found = differential_evolution(
        penalised,
        [(0, 1)] * 4,
        vectorized=True,
        updating="deferred",
        popsize=25,
        maxiter=250,
        tol=1e-10,
        rng=5,
        polish=False,
    )
    assert front.second_at(level) <= found.fun * (1 + 2e-4)
    assert front.second_at(level) == pytest.approx(found.fun, rel=5e-3)


def test_no_random_linkage_dominates_the_front(front):
    lower, upper = front.problem.bounds
    designs = lower + np.random.default_rng(0).random((20000, 4)) * (upper - lower)
    scores = front.problem.score(front.problem.linkage(designs))
    own = scores.objectives[scores.feasible]
    assert len(own) > 500 and (own[:, 0] >= front.objectives[0, 0]).all()
    assert (own[:, 1] >= np.interp(own[:, 0], *front.objectives.T) - 1e-4).all()


def test_non_dominated_is_the_pairwise_definition():
    points = np.random.default_rng(3).integers(0, 12, (60, 2)).astype(float)
    kept = {tuple(p) for p in points[non_dominated(points)]}
    better = [any((q <= p).all() and (q < p).any() for q in points) for p in points]
    assert kept == {tuple(p) for p, worse in zip(points, better, strict=True) if not worse}


def test_the_printed_design_is_dominated(front, printed):
    found = standing(front, printed)
    assert found.feasible and found.dominated
    assert found.objectives == pytest.approx((169.857 / 350, 1.1157), abs=2e-4)
    assert found.second_at_same_first == pytest.approx(1.030, abs=1e-3)
    assert found.first_at_same_second * 350 == pytest.approx(160.2, abs=0.1)


def test_a_point_of_the_front_is_not_dominated(front):
    assert not standing(front, front.linkage(40)).dominated


def test_equal_seeds_give_equal_fronts():
    first, second = (pareto_front(thesis_problem(), QUICK) for _ in range(2))
    assert np.array_equal(first.designs, second.designs) and set(first.seed) == {1}


def test_the_spread_can_be_the_first_objective():
    limits = replace(thesis_problem().limits, ratio_weight=0.0)
    spread = score(thesis_problem(limits=limits), PRINTED).objectives[0, 0]
    assert spread == pytest.approx(3.56 / 20, abs=1e-3)


def test_travel_positions_are_enough():
    fine = replace(thesis_problem().travel, positions=801)
    coarse, exact = (score(p, PRINTED).objectives for p in (thesis_problem(), thesis_problem(travel=fine)))
    assert coarse == pytest.approx(exact, rel=1e-4)


# ---- constraints ----------------------------------------------------------------------------------------------------


def violated(design_mm):
    scores = score(thesis_problem(), design_mm)
    return {name for name, value in zip(CONSTRAINTS, scores.constraints[0], strict=True) if value > 0}


def test_the_printed_design_is_feasible():
    assert violated(PRINTED) == set()


def test_a_short_lever_is_refused_and_a_longer_one_is_not():
    assert violated((46.6 + 40 * 0.97, 134.7 + 40 * 0.243, 46.6, 134.7)) == {"length of the lever BC"}


def test_angles_count_at_both_ends():
    """lambda of this linkage has a harmless maximum and a minimum below 40 degrees, which a maximum alone lets pass."""
    design = (86.9, 113.7, 67.8, 60.3)
    motion = thesis_problem().linkage(np.array(design) * MM).motion(thesis_problem().travel.values)
    assert motion.lambda_.max() / DEGREE > 40 > motion.lambda_.min() / DEGREE
    assert violated(design) == {"transmission angle lambda at its smallest"}


def test_what_does_not_close_is_infeasible_and_has_no_objectives():
    scores = score(thesis_problem(), (190.0, 30.0, 150.0, 60.0))
    assert np.isnan(scores.objectives).all() and scores.constraints[0, -1] > 0 and not scores.feasible[0]


# ---- choice ---------------------------------------------------------------------------------------------------------


def test_rules_pick_what_they_say(front):
    first, second = front.objectives.T
    smallest = SmallestRatio(1.1157).pick(front)
    assert second[smallest] <= 1.1157 < second[smallest - 1]
    best = BestAngles(170 * MM).pick(front)
    assert first[best] * 350 <= 170 < first[best + 1] * 350
    knee = Knee().pick(front)
    low, high = front.objectives.min(axis=0), front.objectives.max(axis=0)
    distance = 1 - ((front.objectives - low) / (high - low)).sum(axis=1)
    assert distance[knee] == distance.max() > 0.2


def test_rules_that_exclude_everything_say_so(front):
    with pytest.raises(LinkageError, match="angles as good as f2 = 0.1; the best reaches 0.15"):
        SmallestRatio(0.1).pick(front)
    with pytest.raises(LinkageError, match="nominal ratio of 100 mm/rad or less; the smallest is 120.5"):
        BestAngles(100 * MM).pick(front)


# ---- wrong input ----------------------------------------------------------------------------------------------------


def test_a_box_without_linkages_names_the_constraint_in_the_way():
    far = Box((60 + 125j) * MM, (62 + 127j) * MM, "B")
    with pytest.raises(LinkageError, match="the length of the lever BC is .* mm below its 45 mm: widen the boxes"):
        pareto_front(thesis_problem(box_b=far), QUICK)


def test_a_travel_that_no_linkage_closes_over_is_said():
    tiny_b = Box((190 + 30j) * MM, (190.5 + 30.5j) * MM, "B")
    near_c = Box((159.8 + 64.8j) * MM, (160 + 65j) * MM, "C")
    with pytest.raises(LinkageError, match="no linkage with B and C .* the links lack .* mm to close over the travel"):
        pareto_front(thesis_problem(box_b=tiny_b, box_c=near_c), QUICK)


def test_a_box_turned_over_is_refused():
    with pytest.raises(LinkageError, match="box of hardpoint C needs its lower left corner"):
        Box((50 + 110j) * MM, (40 + 140j) * MM, "C")


def test_a_travel_without_the_nominal_position_is_refused():
    with pytest.raises(LinkageError, match="from below to above the nominal position"):
        Travel(20 * MM, 140 * MM)


def test_settings_and_weights_are_checked():
    with pytest.raises(LinkageError, match="one seed, four individuals"):
        GeneticSettings(seeds=())
    with pytest.raises(LinkageError, match="weight of the nominal ratio"):
        Limits(0.35, 0.02, 1.0, 0.045, ratio_weight=1.5)


def test_a_mirrored_lever_is_told_apart():
    """The other assembly of the printed links turns the lever the other way: its ratio is negative."""
    arm, c = thesis_problem().arm, (46.6 + 134.7j) * MM
    b = from_lengths(arm, c, 195.3 * MM, 53.3 * MM).hardpoint_b
    line = (c - arm.hardpoint_a) / abs(c - arm.hardpoint_a)
    other = arm.hardpoint_a + line**2 * np.conj(b - arm.hardpoint_a)
    assert FourBar(arm, other, c).motion(np.zeros(1)).transmission_ratio[0] < 0
