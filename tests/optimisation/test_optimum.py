"""The constrained optimum against the bracket of two readings, from two starting points."""

import pytest

from optimisation.constrained_optimum import NoOptimumError, find_optimum
from optimisation.gradient_optimum import find_optimum_by_gradients
from optimisation.states import READINGS
from pipeline.models import StudyFamily, judge_of
from study.read import read_study

LIMIT = 1.2  # T
# field-model.md of the design: (w_bi, R_ro) [mm] and torque [Nm/m] at 42.5 mm, 12 slots, interpolated on its own grid
BRACKET = {"aligned_tooth": 55.6, "every_tooth": 46.4}
STARTS = {
    "aligned_tooth": ((2.68e-3, 13.9e-3), (3.0e-3, 15.0e-3)),
    "every_tooth": ((4.0e-3, 15.9e-3), (3.7e-3, 15.0e-3)),
}


@pytest.fixture(scope="module")
def study():
    return read_study("motorcycle")


@pytest.mark.parametrize("reading", BRACKET)
def test_optimum_reproduces_the_bracket_from_two_starts(study, reading):
    family, judge = StudyFamily(study.machine), judge_of(study, READINGS[reading])
    found = [find_optimum(judge, family, 12, 42.5e-3, LIMIT, start) for start in STARTS[reading]]
    for optimum in found:
        assert optimum.limit_binds
        assert optimum.design.limited == pytest.approx(LIMIT, rel=1e-3)
        assert optimum.design.torque == pytest.approx(BRACKET[reading], rel=0.015)
    assert found[0].design.torque == pytest.approx(found[1].design.torque, rel=2e-3)


@pytest.mark.parametrize("slots, start", ((12, (2.75e-3, 14.2e-3)), (9, (2.7e-3, 17.2e-3))))
def test_gradients_and_quadratics_find_the_same_optimum(study, slots, start):
    arguments = judge_of(study), StudyFamily(study.machine), slots, 42.5e-3, LIMIT, start
    by_gradients, by_quadratics = find_optimum_by_gradients(*arguments), find_optimum(*arguments)
    assert by_gradients.design.torque == pytest.approx(by_quadratics.design.torque, rel=1e-3)
    assert by_gradients.design.limited == pytest.approx(LIMIT, rel=1e-3)
    assert by_gradients.limit_binds


def test_a_limit_that_does_not_bind_is_said_so(study):
    judge = judge_of(study)
    optimum = find_optimum(judge, StudyFamily(study.machine), 12, 42.5e-3, 3.0, (2.3e-3, 17.0e-3))
    assert not optimum.limit_binds
    assert optimum.design.limited < 2.0


def test_where_nothing_can_be_built_there_is_no_optimum(study):
    with pytest.raises(NoOptimumError, match="too few designs"):
        find_optimum(judge_of(study), StudyFamily(study.machine), 12, 42.5e-3, LIMIT, (8e-3, 14e-3))
