"""Copper loss of the printed winding."""

from dataclasses import replace
from math import sqrt

import pytest

from electrical.resistance import copper_resistivity
from electrical.wound_machine import WoundMachine
from losses.copper import copper_loss
from tests.electrical.wires import HALF_MILLIMETRE, series_star
from tests.losses.conftest import machine
from units import MILLIMETRE, MILLIOHM

WIRE = HALF_MILLIMETRE.area
PRINTED = WoundMachine(machine(), 4, 1, series_star(7, 22), 41 * MILLIMETRE)


def with_resistivity(resistivity):
    return replace(PRINTED, design=series_star(7, 22, replace(HALF_MILLIMETRE, resistivity=resistivity)))


@pytest.mark.reference
def test_resistance_of_the_printed_winding():
    """24.96 mOhm phase to phase at 20 degC by eq. 3.82; the printed 27.4 mOhm is this copper at 45 degC."""
    assert 2 * PRINTED.phase_resistance == pytest.approx(24.96 * MILLIOHM, rel=1e-3)
    warm = with_resistivity(copper_resistivity(44.9))
    assert 2 * warm.phase_resistance == pytest.approx(27.4 * MILLIOHM, rel=1e-3)


@pytest.mark.reference
def test_loss_of_the_printed_machine():
    """27.4 mOhm phase to phase at 86 A RMS: three phases of 13.7 mOhm, 304 W; the same at any angle of the current."""
    peak, resistance = 86 * sqrt(2), 27.4 * MILLIOHM / 2
    assert copper_loss(resistance, 0.0, peak) == pytest.approx(3 * resistance * 86**2) == pytest.approx(304.0, rel=1e-3)
    assert copper_loss(resistance, -0.6 * peak, 0.8 * peak) == pytest.approx(304.0, rel=1e-3)


@pytest.mark.physics
def test_loss_is_current_density_squared_times_copper():
    """rho J^2 times the copper volume, end turns included: the same power by another route."""
    rho, j_rms = copper_resistivity(80.0), 6e6
    hot = with_resistivity(rho)
    peak = hot.current_peak(j_rms)
    assert peak == pytest.approx(sqrt(2) * j_rms * 22 * WIRE)
    volume = 12 * 7 * 22 * WIRE * 2 * (PRINTED.active_length + PRINTED.end_turn_length)
    assert copper_loss(hot.phase_resistance, 0.0, peak) == pytest.approx(rho * j_rms**2 * volume, rel=1e-12)


def test_end_turns():
    assert PRINTED.end_turn_length == pytest.approx(16.30 * MILLIMETRE, rel=1e-3)
    assert PRINTED.end_turn_share == pytest.approx(0.2845, rel=1e-3)
    distributed = replace(PRINTED, coil_pitch=3)
    assert distributed.end_turn_length == pytest.approx(71.2 * MILLIMETRE, rel=1e-3)
