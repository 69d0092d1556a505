"""What an actuator can do: a linear flux map against closed forms, and batches of designs against single ones."""

from dataclasses import replace
from math import inf, sqrt

import numpy as np
import pytest

from drivetrain.asked import (
    ActiveLength,
    ContinuousEffort,
    ControlledDamping,
    Diameter,
    EquivalentMass,
    LowSpeedDamping,
    PeakEffort,
    PeakEffortAtRest,
    PeakPower,
    PhaseCurrent,
    RotorSpeed,
)
from drivetrain.capability import together
from drivetrain.output import Shaft, Wheel
from drivetrain.remedies import (
    DIRECT_DRIVE_LEVERS,
    ActiveLengthLever,
    TransmissionLever,
    TurnsLever,
    VoltageLever,
    remedies,
)
from electrical.braking import strongest_braking
from electrical.dq import DriveLimits, torque_speed_envelope
from tests.drivetrain.linear_machine import (
    AMPERES,
    LENGTH,
    POLES,
    STRANDS,
    TURNS,
    actuator,
    closed_form,
)
from units import FACTORS

EVERY = (PeakEffortAtRest(1.0), PeakEffort(1.0, 2.0), PeakPower(1.0, 3.0), ContinuousEffort(1.0), LowSpeedDamping(1.0),
         ControlledDamping(1.0, 2.0), RotorSpeed(1.0, 3.0), PhaseCurrent(1.0), ActiveLength(1.0), EquivalentMass(1.0),
         Diameter(1.0, 0.1))  # fmt: skip


@pytest.fixture(scope="module")
def design():
    return actuator()


def test_efforts_are_those_of_the_constant_parameters(design):
    plain = closed_form()
    assert design.effort_peak == pytest.approx(1.5 * POLES * plain.psi_m * AMPERES / 2e-3, rel=1e-9)
    assert design.effort_continuous == pytest.approx(1.5 / 2e-3, rel=1e-12)
    speed = np.array([0.5, 2.0, 4.0])
    expected = torque_speed_envelope(plain, DriveLimits.from_dc_bus(AMPERES, 48.0), speed / 2e-3).torque / 2e-3
    assert design.effort_over(speed) == pytest.approx(np.nan_to_num(expected), rel=1e-4)
    assert design.effort_at(-2.0) == pytest.approx(expected[1], rel=1e-4)


def test_a_longer_machine_is_cooled_by_the_same_casing_and_a_shorter_one_has_less_to_cool(design):
    efforts = replace(design, active_length=LENGTH * np.array([0.5, 1.0, 2.0])).effort_continuous
    assert efforts == pytest.approx(design.effort_continuous * np.array([0.5, 1.0, 2**0.5]))


def test_the_envelope_at_rest_is_the_stated_peak(design):
    assert design.effort_at(0.0) == pytest.approx(design.effort_peak, rel=1e-6)


def test_damping_and_inertia_are_their_formulas(design):
    plain = closed_form()
    constant = 1.5 * POLES * plain.psi_m
    assert design.low_speed_damping == pytest.approx(2 * constant**2 / (3 * plain.resistance * 4e-6), rel=1e-6)
    assert design.equivalent_mass == pytest.approx((8e-4 * LENGTH + 2e-6) / 4e-6)
    assert design.phase_current_rms == pytest.approx(AMPERES / sqrt(2))


@pytest.mark.parametrize("requirement", EVERY, ids=lambda one: type(one).__name__)
def test_a_batch_reads_as_its_designs_do(design, requirement):
    longer, rewound = replace(design, active_length=0.06), TurnsLever().moved(design, 5.0)
    several = [design, longer, rewound, replace(design, dc_voltage=30.0), replace(design, transmission_ratio=3e-3)]
    batch = np.broadcast_to(requirement.reached(together(several)), len(several))
    assert batch == pytest.approx([float(requirement.reached(one)) for one in several], rel=1e-9)


def test_controlled_damping_is_that_of_the_wound_machine(design):
    """At rest the peak effort over the speed; where the voltage rules, what the search finds on the wound machine."""
    assert ControlledDamping(1.0, 1e-3).reached(design) == pytest.approx(design.effort_peak / 1e-3, rel=1e-3)
    limits = DriveLimits.from_dc_bus(AMPERES, 48.0)
    wound = strongest_braking(closed_form(), limits, np.array([6.0 / 2e-3])).torque[0]
    assert design.braking_at(6.0) == pytest.approx(wound / 2e-3, rel=1e-6)
    assert wound / 2e-3 > 1.01 * design.effort_at(6.0), "the resistance helps a brake and hinders a motor"


# ---- requirements ---------------------------------------------------------------------------------------------------


def test_margins_on_both_sides(design):
    least = PeakEffortAtRest(0.8 * design.effort_peak).check(design)
    most = ActiveLength(0.8 * LENGTH).check(design)
    assert least.holds and least.margin == pytest.approx(0.25)
    assert not most.holds and most.margin == pytest.approx(-0.25)


@pytest.mark.parametrize("requirement", EVERY[:5], ids=lambda one: type(one).__name__)
def test_nothing_asked_for_holds_without_a_division(design, requirement):
    check = replace(requirement, needed=0.0).check(design)
    assert check.holds and check.margin == inf


def test_words_and_units_are_those_of_the_output():
    wheel, shaft = Wheel(), Shaft()
    assert PeakEffort(1.0, 1.64).name(wheel) == "peak force at 1.64 m/s"
    assert PeakEffort(1.0, 100 * FACTORS["rpm"]).name(shaft) == "peak torque at 100 rpm"
    assert PeakEffort(1.0, 2500 * FACTORS["rpm"]).name(shaft) == "peak torque at 2500 rpm"
    for one in EVERY:
        assert one.unit(wheel) in FACTORS and one.unit(shaft) in FACTORS
        assert "force" not in one.name(shaft) and "wheel" not in one.name(shaft)


# ---- remedies -------------------------------------------------------------------------------------------------------


def found_by(design, *requirements):
    """Remedies by the lever's type."""
    checks = [one.check(design) for one in requirements]
    return {type(one.lever): one for one in remedies(design, checks)}


def test_a_remedy_is_the_least_that_helps(design):
    wanted, short = PeakEffortAtRest(1.2 * design.effort_peak), ActiveLength(1.1 * LENGTH)
    found = found_by(design, wanted, short)
    assert found[ActiveLengthLever].value == pytest.approx(1.2 * LENGTH, rel=5e-3)
    assert found[ActiveLengthLever].fails_then == (short,)
    assert found[TransmissionLever].value == pytest.approx(2e-3 / 1.2, rel=5e-3)
    assert found[VoltageLever].value is None  # voltage does nothing at rest
    moved = ActiveLengthLever().moved(design, found[ActiveLengthLever].value)
    assert wanted.check(moved).holds and not wanted.check(design).holds


def test_remedies_at_speed_are_those_of_one_search_after_the_other(design):
    wanted = PeakEffort(1.1 * float(design.effort_at(3.0)), 3.0)
    for one in found_by(design, wanted).values():
        assert one.value is None or wanted.check(one.lever.moved(design, one.value)).holds
        back = None if one.value is None else one.now * (one.value / one.now) ** 0.95
        assert back is None or not wanted.check(one.lever.moved(design, back)).holds


def test_rewinding_keeps_the_copper_and_trades_voltage_for_current(design):
    half = TurnsLever().moved(design, TURNS / 2)
    assert half.turns * half.strands == pytest.approx(TURNS * STRANDS)
    assert half.effort_peak == pytest.approx(design.effort_peak, rel=1e-6)
    assert half.phase_current_rms == pytest.approx(2 * design.phase_current_rms)
    assert half.effort_at(3.0) == pytest.approx(replace(design, dc_voltage=96.0).effort_at(3.0), rel=1e-4)


def test_what_holds_needs_no_remedy(design):
    assert found_by(design, PeakEffortAtRest(0.5 * design.effort_peak)) == {}


def test_a_direct_drive_keeps_its_ratio(design):
    checks = [PeakEffortAtRest(1.2 * design.effort_peak).check(design)]
    moved = {type(one.lever) for one in remedies(design, checks, DIRECT_DRIVE_LEVERS)}
    assert TransmissionLever not in moved and ActiveLengthLever in moved
