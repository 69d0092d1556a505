"""Proofs that no design holds everything: closed forms where a bound bites, silence where it does not, soundness."""

from math import sqrt

import numpy as np
import pytest

from drivetrain import asked as demands
from drivetrain.nearest import NearestDesign
from drivetrain.output import Wheel
from drivetrain.proof import ceilings, impossibility
from drivetrain.remedies import DIRECT_DRIVE_LEVERS, LEVER_RANGE, LEVERS
from report.outcome import nearest_in_words
from tests.drivetrain.linear_machine import actuator


@pytest.fixture(scope="module")
def design():
    return actuator()


def bus_power(design, volts, amperes_rms):
    """3/2 (U / sqrt(3)) sqrt(2) I [W]."""
    return 1.5 * volts / sqrt(3) * sqrt(2) * amperes_rms


def at_the_bus(design, share):
    """A power of so many times what three times the bus voltage gives at a current limit, at 5 m/s."""
    limit = 0.8 * design.phase_current_rms
    power = share * bus_power(design, LEVER_RANGE * design.dc_voltage, limit)
    return [demands.PeakPower(power, 5.0), demands.PhaseCurrent(limit)]


# ---- the electric power ---------------------------------------------------------------------------------------------


def test_more_power_than_bus_and_current_give_is_impossible(design):
    """1.2 times as much: shared between power and current, each misses by 1 - 1/sqrt(1.2)."""
    asked = at_the_bus(design, 1.2)
    proof = impossibility(design, asked, LEVERS)
    assert proof.requirements == tuple(asked)
    assert proof.shortfall == pytest.approx(1 - 1 / sqrt(1.2), rel=1e-6)


def test_a_little_less_power_proves_nothing(design):
    assert impossibility(design, at_the_bus(design, 0.95), LEVERS) is None


def test_the_peak_effort_at_a_speed_is_a_power_too(design):
    power, current = at_the_bus(design, 1.2)
    proof = impossibility(design, [demands.PeakEffort(power.needed / 5.0, 5.0), current], LEVERS)
    assert proof.shortfall == pytest.approx(1 - 1 / sqrt(1.2), rel=1e-6)


# ---- efforts, lengths, speeds ---------------------------------------------------------------------------------------


def test_an_effort_beyond_every_length_and_ratio(design):
    """Three times the length and a third of the ratio give nine times the effort: ten times misses by a tenth."""
    proof = impossibility(design, [demands.PeakEffortAtRest(10 * design.effort_peak)], LEVERS)
    assert proof.shortfall == pytest.approx(0.1, rel=1e-6)


def test_an_effort_with_a_rotor_that_may_not_turn_faster(design):
    """The ratio fixed by the speed, three times the length: four times the effort is shared with the speed."""
    speed = demands.RotorSpeed(3.0 / design.transmission_ratio, 3.0)
    proof = impossibility(design, [demands.PeakEffortAtRest(4 * design.effort_peak), speed], LEVERS)
    assert proof.shortfall == pytest.approx(1 - sqrt(3 / 4), rel=1e-6) and len(proof.requirements) == 2


def test_a_direct_drive_has_no_ratio_to_move(design):
    assert impossibility(design, [demands.PeakEffortAtRest(4 * design.effort_peak)], LEVERS) is None
    found = impossibility(design, [demands.PeakEffortAtRest(4 * design.effort_peak)], DIRECT_DRIVE_LEVERS)
    assert found.shortfall == pytest.approx(1 / 4, rel=1e-6)


def test_what_asks_for_nothing_proves_nothing(design):
    assert impossibility(design, [demands.LowSpeedDamping(0.0)], LEVERS) is None


# ---- soundness ------------------------------------------------------------------------------------------------------


def drawn(design, count=60):
    """Designs anywhere in the range of the levers."""
    x = np.random.default_rng(5).uniform(-1, 1, (count, len(LEVERS))) * np.log(LEVER_RANGE)
    batch = design
    for lever, logarithms in zip(LEVERS, x.T):
        batch = lever.moved(batch, lever.value(design) * np.exp(logarithms))
    return batch


def every(design, hard):
    """All demands, each so many times what the design reaches."""
    at = {name: float(np.squeeze(value)) for name, value in (
        ("effort", design.effort_at(1.0)), ("braking", design.braking_at(0.5)), ("power", design.effort_at(2.0) * 2.0),
        ("damping", design.low_speed_damping), ("mass", design.equivalent_mass),
    )}  # fmt: skip
    return [
        demands.PeakEffortAtRest(hard * design.effort_peak), demands.PeakEffort(hard * at["effort"], 1.0),
        demands.PeakPower(hard * at["power"], 2.0), demands.ContinuousEffort(hard * design.effort_continuous),
        demands.LowSpeedDamping(hard * at["damping"]), demands.ControlledDamping(hard * at["braking"] / 0.5, 0.5),
        demands.RotorSpeed(2000.0 / hard, 3.0), demands.PhaseCurrent(design.phase_current_rms / hard),
        demands.ActiveLength(0.06 / hard), demands.EquivalentMass(at["mass"] / hard),
    ]  # fmt: skip


def test_nothing_reaches_beyond_its_ceilings(design):
    others = drawn(design)
    factors = {lever: lever.value(others) / lever.value(design) for lever in LEVERS}
    for one in every(design, 1.0):
        reached = one.reached(others)
        for ceiling in ceilings(one, design):
            value = ceiling.best * np.prod([factors[lever] ** power for lever, power in ceiling.powers], axis=0)
            apart = (reached / value - 1) * (-1 if one.at_most else 1)
            assert apart.max() < 1e-6, one


@pytest.mark.parametrize("hard", (0.5, 3.0))
def test_no_design_of_many_is_better_than_a_proof_allows(design, hard):
    asked, others = every(design, hard), drawn(design)
    margins = np.array([one.margin(one.reached(others)) for one in asked]).min(axis=0)
    proof = impossibility(design, asked, LEVERS)
    if proof is None:
        assert hard < 1.5, "the demands contradict each other from somewhere on"
    else:
        assert margins.max() <= -proof.shortfall + 1e-9


def test_the_sums_are_tight_where_they_are_made(design):
    """Equivalent mass and damping have a sum in them: at the present length the bound is the value itself."""
    mass = demands.EquivalentMass(float(design.equivalent_mass) / 9.0 / 1.5)
    # ratio to three times: a ninth, length to a third
    proof = impossibility(design, [mass, demands.ActiveLength(1.0)], LEVERS)
    exact = (design.rotor_inertia_per_length * design.active_length / 3 + design.gearbox_inertia) / (
        design.rotor_inertia_per_length * design.active_length + design.gearbox_inertia
    )
    assert proof is None and exact < 1 / 1.5
    beyond = demands.EquivalentMass(0.8 * exact * float(design.equivalent_mass) / 9.0)
    assert impossibility(design, [beyond], LEVERS).shortfall == pytest.approx(0.2, rel=1e-6)


# ---- in words -------------------------------------------------------------------------------------------------------


def test_the_outcome_says_what_is_proved_and_what_is_not(design):
    asked = at_the_bus(design, 1.2)
    checks = tuple(one.check(design) for one in asked)
    said = nearest_in_words(NearestDesign((), checks, impossibility(design, asked, LEVERS)), Wheel())
    assert "There is none, by bounds" in said and "8.7 % at least" in said
    assert "peak power at 5 m/s, phase current, RMS contradict each other" in said
    assert "was searched for and is not proved" in nearest_in_words(NearestDesign((), checks), Wheel())
