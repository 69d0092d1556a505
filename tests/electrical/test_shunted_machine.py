"""The driven machine over a shunt, against time integration, closed limits, a bridge without smoothing and energy."""

from math import pi, sqrt

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from electrical.shunted_machine import Bridge, LinearStar, ShortedAtTerminals, Star, seen_in_a_line, steady_fundamental
from electrical.synchronous_machine import SynchronousMachine

P, K_T, L, R = 5, 49.3e-3, 348.7e-6, 68.3e-3  # thesis table B.1; its pole pairs are not printed
MACHINE = SynchronousMachine(P, K_T / (1.5 * P), L, L, R)
SALIENT = SynchronousMachine(P, K_T / (1.5 * P), 2.5e-4, 4.5e-4, R)


def integrated(machine, frequency, top_speed, shunt):
    """-T_1 / W by LSODA on the currents, after all transients."""
    whole, nu = machine.resistance + shunt, 2 * pi * frequency

    def rates(t, i):
        omega = machine.pole_pairs * top_speed * np.cos(nu * t)
        psi_d, psi_q = machine.flux_linkage(*i)
        return [(-whole * i[0] + omega * psi_q) / machine.inductance_d,
                (-whole * i[1] - omega * psi_d) / machine.inductance_q]  # fmt: skip

    periods = int(np.ceil(14 * frequency * machine.inductance_q / whole)) + 1
    time = (periods + np.arange(512) / 512) / frequency
    solved = solve_ivp(rates, (0, time[-1]), [0.0, 0.0], "LSODA", time, rtol=1e-8, atol=1e-8)
    return -2 * np.mean(machine.torque(*solved.y) * np.exp(-1j * nu * time)) / top_speed


@pytest.mark.parametrize("machine", (MACHINE, SALIENT), ids=("round", "salient"))
@pytest.mark.parametrize("frequency, top_speed, shunt", ((15.0, 60.0, 0.0), (40.0, 150.0, 0.135), (60.0, 5.0, 0.055)))
def test_the_swinging_machine_is_that_of_the_dq_equations(machine, frequency, top_speed, shunt):
    found = Star().dynamic_damping(machine, frequency, top_speed, shunt)
    assert complex(found) == pytest.approx(integrated(machine, frequency, top_speed, shunt), rel=1e-5)


def test_small_swings_are_those_of_b4_and_slow_ones_those_of_3_70():
    small = Star().dynamic_damping(MACHINE, np.array([1.0, 30.0, 100.0]), 1e-3, 0.0)
    assert small == pytest.approx(K_T * K_T * 2 / 3 / (R + 2j * pi * np.array([1.0, 30.0, 100.0]) * L), rel=1e-6)
    slow = Star().dynamic_damping(MACHINE, 0.02, np.array([10.0, 40.0, 200.0]), 0.0)
    closed = Star().slope(MACHINE, 0.0) * steady_fundamental(np.array([10.0, 40.0, 200.0]), R / (P * L))
    assert slow.real == pytest.approx(closed, rel=1e-3)


def test_far_from_small_the_commutator_machine_is_far_off():
    """At 15 Hz and 3 mm the printed B.4 brakes more than ten times too hard when shorted."""
    top = 2 * pi * 15 * 3e-3 / (0.115 / 87.3)
    ratio = LinearStar().dynamic_damping(MACHINE, 15.0, top, 0.0) / Star().dynamic_damping(MACHINE, 15.0, top, 0.0)
    assert abs(complex(ratio)) > 10


def test_the_largest_torque_is_the_same_over_every_shunt():
    """Eq. 3.70 at its pole: K_t K_e / (2 p L), 353 N at the wheel of the thesis, whatever the resistance."""
    for shunt in (0.0, 0.055, 0.465):
        torque = Star().torque(MACHINE, (R + shunt) / (P * L), shunt)
        assert torque / (0.115 / 87.3) == pytest.approx(352.75, rel=1e-4)


def test_the_star_takes_all_power_into_its_resistances():
    speed, shunt = np.array([20.0, 300.0, 2000.0]), 0.135
    omega, whole = P * speed, R + shunt
    scale = SALIENT.psi_m * omega / (whole**2 + omega**2 * SALIENT.inductance_d * SALIENT.inductance_q)
    copper = 1.5 * whole * ((omega * SALIENT.inductance_q * scale) ** 2 + (whole * scale) ** 2)
    assert Star().torque(SALIENT, speed, shunt) * speed == pytest.approx(copper, rel=1e-12)


def test_the_bridge_is_that_of_six_switches_without_smoothing():
    """A resistive load without inductance: the highest phase feeds it, the lowest takes it back; mean square."""
    stiff = SynchronousMachine(P, K_T / (1.5 * P), 1e-12, 1e-12, 1e-6)  # no commutation to speak of
    angle = 2 * pi * (np.arange(20000) + 0.5) / 20000
    emf = P * stiff.psi_m * 100.0 * np.cos(angle + np.array([[0.0], [2 * pi / 3], [-2 * pi / 3]]))
    power = np.mean((emf.max(axis=0) - emf.min(axis=0)) ** 2) / 0.2
    assert Bridge().torque(stiff, 100.0, 0.2) * 100.0 == pytest.approx(power, rel=2e-3)  # the ripple is 0.17 % of it


def test_the_overlap_costs_voltage_and_no_power():
    """What the commutation leaves of the mean voltage, times the current, is the power at the shaft."""
    speed = np.array([100.0, 500.0])
    current = Bridge(0.4).current(MACHINE, speed, 0.135)
    left = 3 / pi * P * speed * (sqrt(3) * MACHINE.psi_m - L * current)
    assert Bridge(0.4).torque(MACHINE, speed, 0.135) * speed == pytest.approx(left * current, rel=1e-12)


def test_a_drop_leaves_a_dead_band_and_a_straight_line_below_it():
    bridge, speed = Bridge(0.4), np.array([0.0, 5.0, 20.0, 40.0])
    still = SynchronousMachine(P, K_T / (1.5 * P), 1e-12, 1e-12, R)
    torque = bridge.torque(still, speed, 0.2)
    assert torque[0] == torque[1] == 0  # E_0 is below 0.8 V
    slope, intercept = np.polyfit(speed[2:], torque[2:], 1)
    assert intercept < 0 and slope == pytest.approx(bridge.slope(still, 0.2), rel=1e-8)


def test_a_slow_bridge_swings_with_the_fundamental_of_its_steady_torque():
    found = complex(Bridge(0.4).dynamic_damping(MACHINE, 1.0, 100.0, 0.2))
    theta = np.linspace(0, 2 * pi, 100001)
    torque = Bridge(0.4).torque(MACHINE, 100.0 * np.abs(np.cos(theta)), 0.2) * np.abs(np.cos(theta))
    assert found == pytest.approx(np.trapezoid(torque, theta) / pi / 100.0, rel=1e-3)


def test_a_short_circuit_of_the_terminals_knows_no_bridge():
    circuit = ShortedAtTerminals(Bridge(0.4))
    assert circuit.slope(MACHINE, np.array([0.0, 0.1])) == pytest.approx(
        [Star().slope(MACHINE, 0.0), Bridge(0.4).slope(MACHINE, 0.1)]
    )


def test_seen_in_a_line_it_brakes_with_k_squared_over_r():
    machine = seen_in_a_line(30.557, R, L)
    assert Star().slope(machine, 0.465) == pytest.approx(30.557**2 / (R + 0.465))
    assert sqrt(machine.torque_constant * machine.psi_m) == pytest.approx(30.557)
