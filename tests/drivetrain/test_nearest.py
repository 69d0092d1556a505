"""The nearest design in which everything holds: powers of the levers in closed form, an optimiser beside, bounds."""

import numpy as np
import pytest

from drivetrain.asked import EquivalentMass, LowSpeedDamping, PeakEffort, PeakEffortAtRest, PeakPower, RotorSpeed
from drivetrain.nearest import nearest_design
from drivetrain.remedies import LEVER_RANGE, LEVERS, ActiveLengthLever, TransmissionLever, VoltageLever
from tests.drivetrain.linear_machine import actuator


@pytest.fixture(scope="module")
def design():
    return actuator()


def factors(found):
    return np.array([move.value / move.now for move in found.moves])


def test_a_power_of_two_levers_is_shared_between_them(design):
    """The effort goes with length / ratio: each takes the square root."""
    found = nearest_design(design, [PeakEffortAtRest(2 * design.effort_peak)], LEVERS)
    assert found.holds
    assert factors(found) == pytest.approx([np.sqrt(2), 1 / np.sqrt(2), 1.0, 1.0], rel=1e-3)


def test_nothing_moves_where_everything_holds(design):
    found = nearest_design(design, [PeakEffortAtRest(0.9 * design.effort_peak)], LEVERS)
    assert found.holds and factors(found) == pytest.approx(np.ones(4), abs=1e-6)


def test_no_other_design_of_many_is_nearer_and_holds(design):
    """Among ten thousand drawn at random, with the voltage, the speed and the inertia in play."""
    effort, power = float(design.effort_at(2.0)), float(design.effort_at(4.0)) * 4.0
    asked = [PeakEffort(1.3 * effort, 2.0), PeakPower(1.2 * power, 4.0), EquivalentMass(1.05 * design.equivalent_mass),
             RotorSpeed(1.2 * 4.0 / 2e-3, 4.0)]  # fmt: skip
    levers = (ActiveLengthLever(), TransmissionLever(), VoltageLever())
    found = nearest_design(design, asked, levers)
    assert found.holds and not all(one.check(design).holds for one in asked)
    reached = np.linalg.norm(np.log(factors(found)))
    x = np.random.default_rng(3).uniform(-1, 1, (10000, 3)) * np.log(LEVER_RANGE)
    nearer = x[np.linalg.norm(x, axis=1) < 0.99 * reached]
    others = design
    for lever, logarithms in zip(levers, nearer.T):
        others = lever.moved(others, lever.value(design) * np.exp(logarithms))
    assert len(nearer) > 100
    assert not np.all([one.met(one.reached(others)) for one in asked], axis=0).any()


def test_where_none_holds_the_shortfall_is_least_and_shared(design):
    """Twenty times the effort with a tenth of the inertia: length up and ratio down help one and harm the other."""
    asked = [PeakEffortAtRest(20 * design.effort_peak), EquivalentMass(design.equivalent_mass / 10)]
    found = nearest_design(design, asked, (ActiveLengthLever(), TransmissionLever()))
    margins = [one.margin for one in found.checks]
    assert not found.holds and max(margins) < 0
    length, ratio = np.meshgrid(*[np.exp(np.linspace(-1, 1, 81) * np.log(LEVER_RANGE))] * 2)
    others = ActiveLengthLever().moved(TransmissionLever().moved(design, 2e-3 * ratio.ravel()), 0.04 * length.ravel())
    best = np.min([others.effort_peak / asked[0].needed - 1, 1 - others.equivalent_mass / asked[1].needed], axis=0)
    assert min(margins) >= best.max() - 1e-3
    assert found.impossible.requirements == tuple(asked), "that there is none is proved, by no more than is true"
    assert 0.9 < found.impossible.shortfall <= -best.max() + 1e-9


def test_a_demand_of_nothing_is_no_demand(design):
    assert nearest_design(design, [LowSpeedDamping(0.0), PeakEffortAtRest(1.0)], LEVERS).holds
