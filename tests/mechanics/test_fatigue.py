"""Cycles, Goodman's mean stress and Miner's sum by hand, and the fatigue of shaft, suns and laminations in service."""

from dataclasses import replace
from math import pi, sqrt

import numpy as np
import pytest

from materials.strength import MPA
from mechanics.fatigue import (
    FatigueStrength,
    LoadCycles,
    cycles_from_rest,
    recorded_cycles,
    reversed_cycles,
    together,
)
from report import mechanics as report
from tests.mechanics.a_rotor import GEARS, INPUTS, MACHINE, TEETH, strength
from units import FACTORS

STEEL = FatigueStrength(tensile=1000 * MPA, share=0.45, notch=2.0)
LIFE = INPUTS.fatigue.life
STEP = 1e-3  # s
TIME = np.arange(0.0, 10.0, STEP)


def check(found, part):
    return next(one for one in found.checks if one.part == part)


@pytest.mark.parametrize(
    ("number", "factor"), ((1e6, 1.0), (1e5, 0.1 ** (1 / 5)), (32e6, 32 ** (1 / 9))), ids=("knee", "few", "many")
)
def test_a_reversed_amplitude_counts_by_its_number(number, factor):
    """Slope 5 up to the knee, 9 beyond it."""
    assert STEEL.acting(reversed_cycles(150 * MPA, number)) == pytest.approx(2 * 150 * MPA * factor, rel=1e-6)


def test_a_mean_stress_counts_by_goodman():
    """100 about 400 of 1000 MPa: as 100 / 0.6 reversed; a mean at the tensile strength leaves nothing."""
    cycles = LoadCycles(np.array([100 * MPA]), np.array([400 * MPA]), np.array([1e6]))
    assert STEEL.acting(cycles) == pytest.approx(2 * 100 * MPA / 0.6, rel=1e-6)
    assert STEEL.acting(replace(cycles, mean=np.array([1000 * MPA]))) > 100 * STEEL.endured
    (at_rest,) = STEEL.equivalent(cycles_from_rest(500 * MPA, 1.0)) / MPA
    assert at_rest == pytest.approx(2 * 250 / 0.75)


def test_two_amplitudes_are_added_by_miner():
    """At 1.2 and 1.1 times the endured amplitude 10^6 / 1.2^5 and 10^6 / 1.1^5 cycles are endured; half of either."""
    blocks = [reversed_cycles(s * STEEL.endured / 2, 0.5e6 / s**5) for s in (1.2, 1.1)]
    assert STEEL.acting(together(blocks)) == pytest.approx(STEEL.endured, rel=1e-6)


def test_a_history_returns_over_the_life():
    """3 about 1, at 5 Hz, for 1000 s."""
    cycles = recorded_cycles(1.0 + 3.0 * np.sin(2 * pi * 5 * TIME), STEP, 1000.0)
    full = cycles.amplitude > 2.9
    assert cycles.number[full].sum() == pytest.approx(5000, rel=0.03)
    assert cycles.mean[full] == pytest.approx(1.0, abs=0.05)


# ---- the parts ------------------------------------------------------------------------------------------------------


def driven(torque=0.0, speed=0.0, **changes):
    """The outcome under a torque [Nm] and a speed [rad/s] that swing at 5 Hz."""
    wave = np.sin(2 * pi * 5 * TIME)
    return strength(torque=torque * wave, speed=speed * wave, step=STEP, **changes)


def over_life(frequency):
    """Of a reversed amplitude, as many times a second as frequency [Hz], beyond the knee."""
    return (frequency * LIFE / 1e6) ** (1 / 9)


def test_a_sun_is_tired_by_the_torque_of_its_stage():
    stress = sqrt(3) * 16 * 0.5 * TEETH.ratio / (pi * (2 * TEETH.sun.root_radius) ** 3)
    slow = check(driven(torque=0.5), "sun of stage 1, fatigue")
    assert slow.load == pytest.approx(2 * stress * over_life(5.0), rel=2e-3)
    assert slow.limit == 0.40 * 1180 * MPA


def test_the_shaft_is_tired_by_its_turns_bent():
    """Without torque by bending alone, with every turn."""
    found = driven(speed_rms=40.0)
    bending = 32 * found.bearing_load * found.shaft.span / 2 / (pi * (2 * MACHINE.shaft_radius) ** 3)
    turns = over_life(40.0 / (2 * pi))
    assert check(found, "rotor shaft, fatigue").load == pytest.approx(2 * bending * turns, rel=0.02)
    assert check(driven(torque=3.0), "rotor shaft, fatigue").load > 5 * bending


def test_laminations_are_tired_by_the_square_of_the_speed():
    """From rest to the largest speed and back at twice the frequency, half of it amplitude and half mean."""
    found = driven(speed=1600.0)
    stress = check(found, "laminations of the rotor, at the bore").load / 1.2**2
    expected = stress / (1 - stress / 2 / (400 * MPA)) * over_life(10.0)
    assert check(found, "laminations of the rotor, fatigue").load == pytest.approx(expected, rel=2e-3)
    assert check(driven(), "laminations of the rotor, fatigue").reached == pytest.approx(1e3)


def test_without_a_history_the_peak_torque_comes_and_goes():
    """Sun of stage 1: 379 MPa at 4 Nm, 10^5 times."""
    found = strength(step=0.0)
    peak = check(found, "sun of stage 1, at its root circle").load
    assert check(found, "sun of stage 1, fatigue").load == pytest.approx(2 * peak * 0.1**0.2, rel=1e-6)
    assert not check(found, "sun of stage 1, fatigue").holds


@pytest.mark.parametrize(
    ("part", "change"),
    (
        ("rotor shaft, fatigue", {"torque": 60.0}),
        ("sun of stage 1, fatigue", {"torque": 4.0}),
        ("sun of stage 2, fatigue", {"torque": 20.0}),
        ("laminations of the rotor, fatigue", {"speed": 12000.0}),
    ),
)
def test_every_part_can_be_tired(part, change):
    assert check(driven(torque=0.5, speed=100.0), part).holds and not check(driven(**change), part).holds


def test_the_report_says_what_the_cycles_are():
    recorded, stated = (report.section(found, GEARS).content[0] for found in (driven(torque=0.5), strength(step=0.0)))
    assert f"rainflow and repeated for {LIFE / FACTORS['h']:g} h" in recorded
    assert "1e+05 peak torques there and back" in stated
