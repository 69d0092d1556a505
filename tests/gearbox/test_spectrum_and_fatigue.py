"""Load spectra, rainflow of the ASTM example, S-N lines, Miner's sum at constant and stepped amplitude."""

import numpy as np
import pytest

from gearbox.errors import GearError
from gearbox.fatigue import miner_sum, spectrum_safety
from gearbox.material import CASE_HARDENED_FLANK, CASE_HARDENED_ROOT, LifeLine
from gearbox.spectrum import (
    LoadSpectrum,
    cycles_per_revolution,
    gaussian_spectrum,
    largest_swing,
    rainflow,
    reversals,
    spectrum_from_history,
)
from units import DEGREE

LINES = [CASE_HARDENED_FLANK, CASE_HARDENED_ROOT, LifeLine(1e3, 2.0, 1e6, 1e9, 1.0)]


def history(samples=20001):
    time = np.linspace(0, 100, samples)
    torque = 80 * np.sin(2 * np.pi * 1.3 * time) + 40 * np.sin(2 * np.pi * 0.31 * time + 1)
    return torque, torque / 90


def test_revolutions_of_a_history_are_kept():
    torque, speed = history()
    spectrum = spectrum_from_history(torque, speed, class_width=10, duration=3600.0, swing=0.1)
    assert spectrum.revolutions.sum() == pytest.approx(np.abs(speed).mean() * 3600 / (2 * np.pi), rel=1e-12)
    assert spectrum.share.sum() == pytest.approx(1.0)


def test_classes_are_on_the_safe_side_and_close_in():
    torque, speed = history()
    exact = np.sqrt(np.mean(torque**2))
    rms = [spectrum_from_history(torque, speed, class_width=w, duration=1, swing=1).rms_torque for w in (20, 5, 1)]
    assert rms[0] > rms[1] > rms[2] > exact and rms[2] == pytest.approx(exact, rel=0.01)


def test_shares_are_the_time_in_each_class():
    """A triangle spends equal times in equal classes."""
    torque = np.abs(np.linspace(-100, 100, 400001)[1:-1])
    spectrum = spectrum_from_history(torque, np.ones_like(torque), class_width=10, duration=1, swing=1)
    assert spectrum.torque.tolist() == [10 * k for k in range(1, 11)]
    assert spectrum.share == pytest.approx(np.full(10, 0.1), abs=1e-4)


def test_gaussian_stand_in():
    spectrum = gaussian_spectrum(50.0, 0.6, class_width=0.5, duration=1.0, swing=1.0)
    assert spectrum.rms_torque == pytest.approx(50.0, rel=0.01)
    above = spectrum.share[spectrum.torque > 100.5].sum()
    assert above == pytest.approx(0.0455, abs=0.002)  # two standard deviations
    assert (spectrum.share * spectrum.speed).sum() == pytest.approx(0.6 * np.sqrt(2 / np.pi), rel=0.01)


def test_a_transmission_scales_torque_and_speed_oppositely():
    spectrum = gaussian_spectrum(50.0, 0.6, class_width=5, duration=10.0, swing=0.1).scaled(1 / 8, 8)
    other = gaussian_spectrum(50.0, 0.6, class_width=5, duration=10.0, swing=0.1)
    assert (spectrum.torque * spectrum.speed) == pytest.approx(other.torque * other.speed)
    assert spectrum.revolutions == pytest.approx(8 * other.revolutions) and spectrum.swing == pytest.approx(0.8)


def test_cycles_of_the_sun_of_the_thesis():
    """Eq. 3.123 by hand: 3 planets, half an alternation, 7.6 degrees, 109/14 turns: 3 * 0.5 * 360/59.17 = 9.126."""
    assert cycles_per_revolution(3, 0.5, 7.6 * DEGREE, 109 / 14) == pytest.approx(9.126, abs=1e-3)
    assert cycles_per_revolution(3, 0.5, 2.0, 109 / 14) == 1.5
    assert cycles_per_revolution(1, 1.0, np.inf, 1.0) == 1.0


def test_rainflow_of_the_astm_example():
    """ASTM E1049-85, fig. 6: -2 1 -3 5 -1 3 -4 4 -2."""
    cycles = rainflow([-2, 1, -3, 5, -1, 3, -4, 4, -2])
    counted = {size: cycles[cycles[:, 0] == size, 2].sum() for size in (3, 4, 6, 8, 9)}
    assert counted == {3: 0.5, 4: 1.5, 6: 0.5, 8: 1.0, 9: 0.5}
    assert cycles[:, 2].sum() == 4.0


def test_rainflow_of_a_sine_is_its_cycles():
    cycles = rainflow(2.0 + 3.0 * np.sin(np.linspace(0, 2 * np.pi * 50, 100001)))
    full = cycles[cycles[:, 0] > 5.9]
    assert full[:, 2].sum() == pytest.approx(50, abs=1) and full[:, 1] == pytest.approx(2.0, abs=1e-3)


def test_reversals_and_swing():
    assert reversals([0, 1, 1, 2, 0, 0, 3]).tolist() == [0, 2, 0, 3]
    assert largest_swing([0.0, 0.3, -0.2, 0.1]) == pytest.approx(0.5) and largest_swing([1.0]) == 0


@pytest.mark.parametrize("line", LINES)
def test_life_and_strength_are_inverse(line):
    cycles = np.geomspace(line.first * 1.01, line.knee * 0.99, 20)
    assert line.cycles(line.factor(cycles)) == pytest.approx(cycles, rel=1e-9)
    assert line.factor(line.first / 10) == line.strength and line.factor(line.last * 10) == line.last_strength
    assert line.cycles(line.last_strength * 0.99) == np.inf and line.cycles(line.strength * 1.01) == 0


def test_published_slopes():
    """ISO 6336-6: exponents of the finite-life lines of case-hardened steel, pitting 13.22, root 8.74."""
    for line, exponent in ((CASE_HARDENED_FLANK, 13.22), (CASE_HARDENED_ROOT, 8.74)):
        assert np.log(line.knee / line.first) / np.log(line.strength) == pytest.approx(exponent, abs=0.01)


@pytest.mark.parametrize("line", LINES)
def test_constant_amplitude_is_the_line_itself(line):
    """One class: damage n/N, and the safety factor is the S-N line at its cycles over the stress."""
    cycles = np.geomspace(line.first * 2, line.knee, 7)
    stress = np.full(7, 0.8)
    assert spectrum_safety(line, stress[None], cycles[None]) == pytest.approx(line.factor(cycles) / 0.8, rel=1e-8)
    level = line.factor(1e5)
    assert miner_sum(line, np.array([level]), np.array([2.5e4])) == pytest.approx(0.25, rel=1e-9)


def test_two_classes_add_their_damages():
    line = CASE_HARDENED_ROOT
    stress, cycles = line.factor(np.array([1e4, 1e6])), np.array([3e3, 4e5])
    assert miner_sum(line, stress, cycles) == pytest.approx(0.3 + 0.4, rel=1e-9)


def test_on_a_straight_line_the_safety_factor_is_the_root_of_the_damage():
    """Within the finite-life slope D(S) = S^k D(1), so S = D(1)^(-1/k)."""
    line = CASE_HARDENED_ROOT
    stress, cycles = np.array([1.4, 1.3]), np.array([2e4, 5e4])
    exponent = np.log(line.knee / line.first) / np.log(line.strength)
    expected = miner_sum(line, stress, cycles) ** (-1 / exponent)
    assert spectrum_safety(line, stress, cycles) == pytest.approx(expected, rel=1e-8)


def test_classes_without_cycles_do_no_damage():
    assert miner_sum(CASE_HARDENED_ROOT, np.array([9.0, 0.5]), np.array([0.0, 1e3])) == 0.0


@pytest.mark.parametrize(
    "torque, share, duration, message",
    [
        ([10.0], [0.9], 1.0, "sum of 0.9"),
        ([0.0], [1.0], 1.0, "torques above 0"),
        ([10.0], [1.0], 0.0, "positive duration"),
    ],
)
def test_wrong_spectra_are_refused(torque, share, duration, message):
    with pytest.raises(GearError, match=message):
        LoadSpectrum(np.array(torque), np.array(share), np.ones(1), duration, 1.0)


def test_a_history_of_other_length_is_refused():
    with pytest.raises(GearError, match=r"found \(3,\) torques, \(2,\) speeds"):
        spectrum_from_history([1, 2, 3], [1, 2], class_width=1, duration=1, swing=1)
