"""Lumped impedance against eq. B.4 as printed, the workbench's damper, integration in time, the thesis's numbers."""

from math import pi

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from effects.damper_design import Damper
from electrical.shunted_machine import Bridge, LinearStar, ShortedAtTerminals, Star
from electrical.synchronous_machine import SynchronousMachine
from vehicle.errors import VehicleError
from vehicle.impedance import LumpedActuator
from workbench.models.damper.harmonic_balance import Drive
from workbench.models.damper.model import linear_impedance

TAU = 0.115 / 87.3  # m/rad, thesis table A.1
K_T, R, L, P = 49.3e-3, 68.3e-3, 348.7e-6, 5  # table B.1, pole pairs assumed
MACHINE = SynchronousMachine(P, K_T / (1.5 * P), L, L, R)
FREQUENCY = np.array([0.1, 1.0, 5.0, 20.0, 30.0, 60.0, 150.0])
SHUNTS = np.array([0.465, 0.135, 0.055, 0.0])


def table_b1(circuit):
    return LumpedActuator(MACHINE, circuit, TAU, 5.6, 250.0, 2e5, 50.0)


def printed_b4(frequency, shunt, rectifier):
    s, m, c_eq, k_m, c_m = 2j * pi * frequency, 5.6, 250.0, 2e5, 50.0
    c_e = 2 / 3 * K_T**2 / TAU**2 / (R + shunt + rectifier)
    branch = c_eq + c_e / (s * L / (R + shunt + rectifier) + 1)
    return (s + branch / m) / (s**2 + s / m * (branch + c_m) + k_m / m) * (s * c_m + k_m)


@pytest.mark.parametrize("shunt", SHUNTS)
def test_the_linear_model_is_b4_as_printed(shunt):
    found = table_b1(LinearStar(0.07)).impedance(FREQUENCY, shunt, 0.1)
    assert found == pytest.approx(printed_b4(FREQUENCY, shunt, 0.07), rel=1e-12)


def test_the_linear_model_is_the_damper_of_the_workbench():
    k = (2 / 3) ** 0.5 * K_T / TAU
    damper = Damper(k, R, 5.6, 250.0, L, 2e5, 50.0)
    theirs = linear_impedance(damper, Drive(FREQUENCY, np.full(7, 1e-3), np.full(7, 0.055)))
    assert table_b1(LinearStar()).impedance(FREQUENCY, 0.055, 0.1) == pytest.approx(theirs, rel=1e-12)


def test_the_numbers_that_the_thesis_leads_to():
    shorted = np.abs(table_b1(LinearStar(0.07)).impedance(np.array([1e-3, 1.0, 5.0]), 0.0, 0.1))
    assert shorted / 1e3 == pytest.approx([7.0, 6.8, 4.6], abs=0.05)
    assert table_b1(Star()).natural_frequency == pytest.approx(30.1, abs=0.05)
    nominal = LumpedActuator(MACHINE, Star(), TAU, 5.6, 70.0, 5e5, 100.0)  # Table 4.2
    identified = LumpedActuator(MACHINE, Star(), TAU, 5.6 * 1.1, 70.0 * 1.519, 5e5 * 1.352, 100.0 * 5.452)
    assert (nominal.natural_frequency, identified.natural_frequency) == pytest.approx((47.6, 52.7), abs=0.05)


@pytest.mark.parametrize(
    "circuit, friction, expected",
    (
        (Star(), 0.0, (1751, 4593, 7573, 13671)),
        (Star(0.07), 0.0, (1548, 3417, 4831, 6752)),
    ),
    ids=("M0", "M1"),
)
def test_static_damping_of_table_b1(circuit, friction, expected):
    found = LumpedActuator(MACHINE, circuit, TAU, 5.6, friction).static_damping(SHUNTS)
    assert found == pytest.approx(expected, rel=1e-3)


def test_the_bridge_with_half_the_resistance_a_phase():
    """Six-pulse bridge: K_t 31 to 32 mNm/A, errors 0, +2, -2 % and -43 % at a short circuit of the terminals."""
    machine = SynchronousMachine(P, 31.38e-3 / (1.5 * P), L, L, 34.15e-3)
    found = LumpedActuator(machine, ShortedAtTerminals(Bridge()), TAU, 5.6, 70.0).static_damping(SHUNTS)
    assert 100 * (found / [1370, 3380, 5780, 19570] - 1) == pytest.approx([0, 2, -2, -43], abs=1.0)


def test_a_swinging_synchronous_machine_behind_its_mount_is_that_of_the_equations_over_time():
    """Mass, mount and dq machine integrated together; the rotor's motion there is no sine."""
    device, frequency, top, shunt = table_b1(Star()), 12.0, 0.08, 0.055
    nu, whole = 2 * pi * frequency, R + shunt

    def rates(t, y):
        x, v, i_d, i_q = y
        z, dz = top / nu * np.sin(nu * t), top * np.cos(nu * t)
        omega, torque = P * v / TAU, -float(MACHINE.torque(i_d, i_q))
        push = 2e5 * (z - x) + 50.0 * (dz - v)
        return [v, (push - 250.0 * v - torque / TAU) / 5.6, (-whole * i_d + omega * L * i_q) / L,
                (-whole * i_q - omega * (MACHINE.psi_m + L * i_d)) / L]  # fmt: skip

    time = (12 + np.arange(400) / 400) / frequency
    x, v, *_ = solve_ivp(rates, (0, time[-1]), [0.0] * 4, "LSODA", time, rtol=1e-7, atol=1e-9).y
    force = 2e5 * (top / nu * np.sin(nu * time) - x) + 50.0 * (top * np.cos(nu * time) - v)
    answer = 2 * np.mean(force * np.exp(-1j * nu * time)) / top
    found = complex(device.impedance(frequency, shunt, top))
    assert abs(found - answer) < 0.01 * abs(answer)


def test_what_cannot_be_is_refused():
    with pytest.raises(VehicleError, match="mount stiffness must be above zero"):
        LumpedActuator(MACHINE, Star(), TAU, 5.6, 250.0, 0.0)
