"""Skew by slices against the factors of its harmonics."""

from dataclasses import replace
from math import pi, sqrt

import numpy as np
import pytest
from numpy.testing import assert_allclose

from magnetostatics.currents import PhaseCurrents
from magnetostatics.flux_linkage import phase_flux_linkage
from magnetostatics.model import OperatingPoint
from magnetostatics.skew import continuous_skew, skew_factor, skewed, skewed_waveform, stepped_skew, with_held_currents
from magnetostatics.torque import arkkio_torque
from tests.magnetostatics.reference_machine import TIGHT, model_of, reference_machine
from units import DEGREE

PERIOD = 6 * DEGREE  # of the cogging of 12 slots and 10 poles
ANGLES = PERIOD * np.arange(12) / 12


def wave(order, angles):
    return np.cos(order * angles + 0.4)


@pytest.mark.parametrize("order", (60, 120, 180))
@pytest.mark.parametrize("steps", (2, 3, 5))
def test_steps_damp_a_harmonic_by_their_factor(order, steps):
    offsets, weights = stepped_skew(4 * DEGREE, steps)
    mean = sum(w * wave(order, ANGLES + offset) for offset, w in zip(offsets, weights))
    assert_allclose(mean, skew_factor(order, 4 * DEGREE, steps) * wave(order, ANGLES), atol=1e-12)


@pytest.mark.parametrize("order", (5, 30, 60))  # up to 3.1 rad in the skew
def test_gauss_slices_stand_for_a_continuous_skew(order):
    offsets, weights = continuous_skew(3 * DEGREE)
    mean = sum(w * wave(order, ANGLES + offset) for offset, w in zip(offsets, weights))
    assert_allclose(mean, skew_factor(order, 3 * DEGREE) * wave(order, ANGLES), atol=1e-7)


def test_a_waveform_is_damped_harmonic_by_harmonic():
    values = np.stack([wave(60, ANGLES) + 0.3 * wave(120, ANGLES) + 1.0, wave(180, ANGLES)])
    found = skewed_waveform(values, PERIOD, stepped_skew(4 * DEGREE, 3))
    k = {order: skew_factor(order, 4 * DEGREE, 3) for order in (60, 120, 180)}
    first = k[60] * wave(60, ANGLES) + 0.3 * k[120] * wave(120, ANGLES) + 1.0
    assert_allclose(found, np.stack([first, k[180] * wave(180, ANGLES)]), atol=1e-12)


def test_skew_by_a_period_of_the_cogging_removes_it():
    assert skew_factor(60, PERIOD) == pytest.approx(0.0, abs=1e-15)
    assert skew_factor(120, PERIOD, 2) == pytest.approx(-1.0)  # two steps leave every second harmonic


def test_no_skew_changes_nothing():
    model, point = model_of(reference_machine(), settings=TIGHT), OperatingPoint(-0.36, 6e6 * sqrt(2))
    for slices in (stepped_skew(0.0, 1), continuous_skew(0.0, 1)):
        assert skewed(model, point, slices, arkkio_torque) == pytest.approx(arkkio_torque(model.solve(point)), rel=1e-9)


def test_cogging_of_a_machine_skewed_by_its_period():
    """What is left of 1.2 Nm/m: mesh noise and what five Gauss slices leave of the first harmonic."""
    model, idle = model_of(reference_machine(), settings=TIGHT), PhaseCurrents(1.3 * DEGREE, (0.0, 0.0, 0.0))
    assert abs(arkkio_torque(model.solve(idle))) > 1.0
    assert abs(skewed(model, idle, continuous_skew(PERIOD), arkkio_torque)) < 0.02


def test_flux_linkage_of_a_skewed_machine_falls_by_the_factor_of_its_order():
    """Order 5, skew 12 degrees: 0.9549 of the fundamental, by fields of slices over half an electrical period."""
    model, skew, count = model_of(reference_machine(), settings=TIGHT), 12 * DEGREE, 6
    angles = pi / 5 * np.arange(count) / count

    def fundamental(read):
        psi = np.array([read(PhaseCurrents(float(angle), (0.0, 0.0, 0.0)))[0] for angle in angles])
        return abs(psi @ np.exp(-5j * angles))

    straight = fundamental(lambda point: phase_flux_linkage(model.solve(point)))
    slanted = fundamental(lambda point: skewed(model, point, stepped_skew(skew, 2), phase_flux_linkage))
    assert slanted / straight == pytest.approx(skew_factor(5, skew, 2), rel=5e-3)


def test_slices_keep_the_currents_of_the_middle():
    """Torque of slices at held currents; currents that followed each slice would keep the load angle."""
    model, point = model_of(reference_machine(), settings=TIGHT), OperatingPoint(-0.36, 6e6 * sqrt(2))
    held = with_held_currents(point, model)
    assert_allclose(model.load(held), model.load(point), rtol=1e-12)
    turned = replace(held, angle=0.3)
    assert_allclose(turned.ampere_turns(model.section), point.ampere_turns(model.section), rtol=1e-12)
    mean = skewed(model, point, stepped_skew(12 * DEGREE, 2), arkkio_torque)
    ends = [arkkio_torque(model.solve(replace(held, angle=-0.36 + sign * 3 * DEGREE))) for sign in (-1, 1)]
    assert mean == pytest.approx(np.mean(ends), rel=1e-6)
