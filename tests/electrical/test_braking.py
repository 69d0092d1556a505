"""Braking on a flux map: closed forms of a linear machine, a simulation over time of a saturating one, and bounds."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import minimize

from electrical.braking import holds_up_to, short_circuit, strongest_braking
from electrical.dq import DriveLimits, torque_speed_envelope
from electrical.flux_map_machine import FluxMapMachine
from electrical.short_circuit import shaft_damping
from tests.drivetrain.linear_machine import POLES, closed_form, flux_map, on_map
from tests.electrical.analytic_map import Saturating
from tests.electrical.analytic_map import flux_map as saturating_map

SPEEDS = np.geomspace(1.0, 3000.0, 41)


@pytest.fixture(scope="module")
def plain():
    return closed_form()


@pytest.fixture(scope="module")
def linear():
    return on_map()


def test_a_shorted_linear_machine_brakes_by_its_electrical_pole(linear, plain):
    found, omega = short_circuit(linear, SPEEDS), POLES * SPEEDS
    impedance = plain.resistance**2 + (omega * plain.inductance_d) ** 2
    assert found.torque == pytest.approx(1.5 * POLES * plain.psi_m**2 * omega * plain.resistance / impedance, rel=1e-9)
    assert found.i_d == pytest.approx(-(omega**2) * plain.inductance_q * plain.psi_m / impedance, rel=1e-9)


def test_slow_it_is_the_damping_without_inductance(linear, plain):
    slow = short_circuit(linear, np.array([1e-3])).damping[0]
    assert slow == pytest.approx(
        shaft_damping(torque_constant=plain.torque_constant, phase_resistance=plain.resistance)
    )


def test_the_largest_torque_is_at_the_electrical_pole(linear, plain):
    pole = plain.resistance / (POLES * plain.inductance_d)
    fine = pole * np.linspace(0.9, 1.1, 201)
    assert fine[np.argmax(short_circuit(linear, fine).torque)] == pytest.approx(pole, rel=2e-3)


@pytest.fixture(scope="module")
def machine():
    """One that saturates."""
    data = saturating_map(Saturating(), points=25).data
    return FluxMapMachine.from_per_turn(data, turns=30, active_length=0.04, resistance=0.05)


@pytest.mark.parametrize("speed", [2.0, 20.0, 60.0, 200.0])
def test_it_is_where_a_simulation_over_time_settles(machine, speed):
    """L di/dt = -R i + omega J psi from no current on, over 60 time constants; the first swing leaves the map."""
    omega = machine.pole_pairs * speed

    def rate(_, i):
        psi_d, psi_q = machine.continued_flux_linkage(i[:, None])[:, 0]
        volts = [-machine.resistance * i[0] + omega * psi_q, -machine.resistance * i[1] - omega * psi_d]
        return np.linalg.solve(machine.continued_inductances(i[:, None])[:, :, 0], volts)

    settled = solve_ivp(rate, (0.0, 0.8), [0.0, 0.0], method="DOP853", rtol=1e-8, atol=1e-8).y[:, -1]
    torque = -float(machine.torque(*settled))
    assert short_circuit(machine, np.array([speed])).torque[0] == pytest.approx(torque, rel=1e-4)


def test_beyond_the_map_nothing_is_said(linear):
    small = FluxMapMachine.from_per_turn(
        flux_map(reach=600.0), turns=8, active_length=0.04, resistance=linear.resistance
    )
    found = short_circuit(small, SPEEDS)
    assert np.isfinite(found.torque[0]) and np.isnan(found.torque[-1])
    inside = np.isfinite(found.torque)
    assert found.torque[inside] == pytest.approx(short_circuit(linear, SPEEDS[inside]).torque, rel=1e-9)


def test_the_strongest_braking_of_a_machine_without_resistance_is_its_motoring_envelope(plain):
    ideal, limits = replace(plain, resistance=0.0), DriveLimits(100.0, 20.0)
    speed = np.linspace(10.0, 2000.0, 12)
    motoring = torque_speed_envelope(ideal, limits, speed).torque
    assert strongest_braking(ideal, limits, speed).torque == pytest.approx(motoring, rel=2e-3)


@pytest.mark.parametrize("speed", [5.0, 300.0, 900.0])
def test_the_strongest_braking_is_that_of_an_optimiser(plain, speed):
    limits = DriveLimits(100.0, 20.0)
    found = strongest_braking(plain, limits, np.array([speed]))
    volts = lambda i: 20.0**2 - np.sum(np.square(plain.voltage(i[0], i[1], speed)))  # noqa: E731
    amperes = lambda i: 100.0**2 - i @ i  # noqa: E731
    best = minimize(
        lambda i: float(plain.torque(*i)), [-20.0, -20.0], method="SLSQP", options={"ftol": 1e-12, "maxiter": 500},
        constraints=[{"type": "ineq", "fun": volts}, {"type": "ineq", "fun": amperes}],
    )  # fmt: skip
    assert found.torque[0] == pytest.approx(-best.fun, rel=2e-3)
    assert volts([found.i_d[0], found.i_q[0]]) >= -1e-6 and found.current_peak[0] <= 100.0 * (1 + 1e-9)


def test_shorted_phases_are_never_stronger(linear):
    """They are one of the points inside both limits, where their current is."""
    limits = DriveLimits(100.0, 20.0)
    shorted = short_circuit(linear, SPEEDS)
    allowed = shorted.current_peak <= 100.0
    assert allowed.any()
    assert np.all(strongest_braking(linear, limits, SPEEDS).torque[allowed] >= shorted.torque[allowed] * (1 - 2e-3))


def test_a_demand_holds_up_to_where_the_damping_first_falls_below_it():
    speed = np.array([1.0, 2.0, 3.0, 4.0])
    assert holds_up_to(speed, np.array([9.0, 8.0, 4.0, 9.0]), 6.0) == pytest.approx(2.5)
    assert holds_up_to(speed, np.array([9.0, 8.0, 7.0, 6.0]), 6.0) == 4.0
    assert holds_up_to(speed, np.array([5.0, 8.0, 7.0, 6.0]), 6.0) == 0.0
    assert holds_up_to(speed, np.array([9.0, 8.0, np.nan, 9.0]), 4.0) == pytest.approx(2.5)
