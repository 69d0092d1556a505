"""The shorted machine over time on a map in closed form that ripples over the angle."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.braking_in_time import SECTOR, TurningMachine, damping_over_time
from electrical.braking import short_circuit
from electrical.wound_machine import WoundMachine
from tests.electrical.analytic_map import MATCHED, POLE_PAIRS, Saturating, flux_map
from tests.electrical.wires import series_star, wire_of

PLAIN = flux_map(Saturating(), points=25)
MAP = replace(PLAIN, data=PLAIN.data.assign(psi_0=("order", np.zeros(5))))  # as a study's map, which has more in it
WOUND = WoundMachine(MATCHED.machine, 4, 1, series_star(30, 5, wire_of(0.2e-6)), 0.04)
AT = np.array([-12.0, 7.0])  # A


@pytest.fixture(scope="module")
def machine():
    return TurningMachine(WOUND, MAP)


@pytest.mark.parametrize("speed", [20.0, 200.0])
def test_it_settles_where_the_steady_state_of_the_mean_is(machine, speed):
    """The ripple of this map is small: 0.1 mWb/m, 5 Nm/m."""
    mean = WOUND.on_map(MAP.data)
    steady = float(short_circuit(mean, np.array([speed])).damping[0])
    assert damping_over_time(machine, mean, speed) == pytest.approx(steady, rel=2e-3)


def test_flux_and_slopes_belong_together(machine):
    """By differences, over angle and both currents."""
    step = 1e-5
    for along, (angle, i) in enumerate(((step, [0, 0]), (0.0, [step, 0]), (0.0, [0, step]))):
        ahead, behind = (machine._psi(0.3 + sign * angle, AT + sign * np.array(i)) for sign in (1, -1))
        assert (ahead - behind) / (2 * step) == pytest.approx(machine._psi(0.3, AT, along=along), rel=1e-5, abs=1e-9)


def test_the_map_is_met_at_its_own_points(machine):
    data = MAP.data
    angle = float(data["angle"][2]) * POLE_PAIRS
    at = data.isel(angle=2, id=4, iq=20)
    i = np.array([float(at["id"]), float(at["iq"])]) / WOUND.equivalent_turns
    assert machine.torque(angle, i) == pytest.approx(0.04 * float(at["torque"]), rel=1e-9)
    assert machine._psi(angle, i) == pytest.approx(
        30 * 0.04 * np.array([at["psi_d"], at["psi_q"]], dtype=float), rel=1e-9
    )
    assert machine.torque(angle + SECTOR, i) == pytest.approx(machine.torque(angle, i))
