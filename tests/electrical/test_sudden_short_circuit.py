"""The first peak of a sudden short circuit: the textbook estimate without resistance, a closed form with it."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import expm

from electrical.flux_map_machine import FluxMapMachine
from electrical.sudden_short_circuit import first_peak
from tests.drivetrain.linear_machine import POLES, closed_form, on_map
from tests.electrical.analytic_map import Saturating
from tests.electrical.analytic_map import flux_map as saturating_map

SPEED, START = 1500.0, (-10.0, -80.0)  # rad/s; A


@pytest.fixture(scope="module")
def plain():
    return closed_form()


@pytest.fixture(scope="module")
def linear():
    return on_map()


@pytest.mark.parametrize("start", [(0.0, 0.0), (0.0, 80.0), (0.0, -80.0), START])
def test_without_resistance_it_is_the_estimate(linear, plain, start):
    """i_d = -(psi_m + |psi_0|) / L_d, |psi_0| of the current before; from no load on twice the steady current."""
    size = np.hypot(*plain.flux_linkage(*start))
    i_d, i_q = first_peak(replace(linear, resistance=0.0), SPEED, *start)
    assert i_d == pytest.approx(-(plain.psi_m + size) / plain.inductance_d, rel=1e-4)
    assert abs(i_q) < 0.01 * abs(i_d)


def test_with_resistance_it_is_the_matrix_exponential(linear, plain):
    """L di/dtheta = M i + e, solved in closed form around its steady state, of all angles the smallest i_d."""
    drag = plain.resistance / (POLES * SPEED)
    motion = np.array([[-drag, plain.inductance_q], [-plain.inductance_d, -drag]]) / plain.inductance_d
    steady = np.linalg.solve(motion, [0.0, plain.psi_m / plain.inductance_d])
    swings = [steady + expm(angle * motion) @ (np.array(START) - steady) for angle in np.linspace(0, 2 * np.pi, 721)]
    exact = min(swings, key=lambda i: i[0])
    found = first_peak(linear, SPEED, *START)
    assert found[0] == pytest.approx(exact[0], rel=1e-4) and found[1] == pytest.approx(exact[1], abs=1.0)
    assert drag > 0.05 * plain.inductance_d, "else the resistance counts for nothing"
    assert found[0] > first_peak(replace(linear, resistance=0.0), SPEED, *START)[0]


def test_a_saturating_machine_keeps_its_flux_linkage():
    """Without resistance its size stays what it was, whatever the inductances."""
    data = saturating_map(Saturating(), points=25).data
    machine = FluxMapMachine.from_per_turn(data, turns=30, active_length=0.04, resistance=0.0)
    i_d, i_q = first_peak(machine, SPEED, 10.0, 5.0)
    before, after = (machine.continued_flux_linkage(np.array([i]).T) for i in ((10.0, 5.0), (i_d, i_q)))
    assert np.hypot(*after) == pytest.approx(np.hypot(*before), rel=1e-4)
