"""Least current for each torque and speed: a linear map against closed forms, and a map against its envelope."""

import numpy as np
import pytest

from electrical.dq import DriveLimits, operating_map, torque_speed_envelope
from electrical.flux_map_machine import FluxMapMachine
from electrical.synchronous_machine import SynchronousMachine

PLAIN = SynchronousMachine(5, 7.5e-3, 85e-6, 95e-6, 14e-3)
LIMITS = DriveLimits(120.0, 27.7)
TORQUE, SPEED = np.linspace(0.0, 6.4, 17), np.linspace(0.0, 1400.0, 15)


@pytest.fixture(scope="module")
def plane():
    i = np.linspace(-130.0, 130.0, 15)
    machine = FluxMapMachine(5, i, i, *PLAIN.flux_linkage(*np.meshgrid(i, i, indexing="ij")), PLAIN.resistance)
    return machine, operating_map(machine, LIMITS, TORQUE[:, None], SPEED)


def test_currents_are_those_of_the_constant_parameters(plane):
    expected = operating_map(PLAIN, LIMITS, TORQUE[:, None], SPEED[None, :])
    both = np.isfinite(expected.i_q) & np.isfinite(plane[1].i_q)
    assert both.sum() > 150 and (np.isfinite(expected.i_q) == np.isfinite(plane[1].i_q)).mean() > 0.97
    assert plane[1].current_peak[both] == pytest.approx(expected.current_peak[both], rel=5e-3, abs=0.1)
    assert plane[1].voltage_peak[both] == pytest.approx(expected.voltage_peak[both], rel=5e-3, abs=0.05)


def test_the_currents_give_the_torque_within_the_limits(plane):
    machine, found = plane
    reached = np.isfinite(found.i_q)
    torque = machine.torque(found.i_d[reached], found.i_q[reached])
    assert torque == pytest.approx(found.torque[reached], rel=2e-3, abs=0.01)
    assert found.voltage_peak[reached].max() <= 27.7 * 1.002 and found.current_peak[reached].max() <= 120.0 * 1.0001


def reluctance():
    """Saturates along d, no magnets; the field's rounding on it."""
    i_d, i_q = np.linspace(0.0, 130.0, 9), np.linspace(-130.0, 130.0, 15)
    d, q = np.meshgrid(i_d, i_q, indexing="ij")
    rounding = 1e-15 * np.random.default_rng(1).standard_normal(d.shape)
    return FluxMapMachine(5, i_d, i_q, 0.02 * np.tanh(d / 60.0) + rounding, 60e-6 * q, 7.5e-3)


def test_no_torque_takes_no_current(plane):
    """Without magnets no current on the q axis alone makes a torque, and the least of them is none."""
    for machine in (plane[0], reluctance()):
        found = operating_map(machine, LIMITS, np.array([[0.0], [1.0]]), np.array([0.0, 50.0]))
        assert found.current_peak[0] == pytest.approx([0.0, 0.0], abs=1e-4)
        assert (found.current_peak[1] > 1.0).all()


def test_the_edge_is_the_envelope(plane):
    machine, found = plane
    envelope = torque_speed_envelope(machine, LIMITS, SPEED).torque
    largest = np.nanmax(np.where(np.isfinite(found.i_q), found.torque, np.nan), axis=0)
    assert (largest <= envelope * (1 + 1e-6)).all()
    within = envelope < TORQUE[-1]  # elsewhere the plane ends below the envelope
    assert within.sum() > 5 and (envelope - largest)[within].max() < TORQUE[1] * 1.05
