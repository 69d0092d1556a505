"""The current round a delta against the differential equation that it solves, and what the choice makes of it."""

from dataclasses import replace
from math import hypot, pi, sin

import numpy as np
import pytest
import xarray as xr
from scipy.integrate import solve_ivp

from electrical.circulating import ZeroSequence
from electrical.winding_connection import Delta, Star, WindingConnection
from electrical.winding_selection import WindingError, evaluate_windings, with_circulation
from electrical.winding_stage import winding_stage
from electrical.wound_machine import WoundMachine
from tests.electrical.analytic_map import DEMAND, GOOD, INPUTS, MATCHED, flux_map
from tests.electrical.test_winding_selection import LENGTH, LIMITS, THESIS
from tests.electrical.wires import given_lengths, series_star

SPEED = 400.0  # rad/s, electrical
RESISTANCE, INDUCTANCE = 2.4e-3, 1.5e-6  # of one turn and one metre, ohm/m and H/m
LINKAGE = {3: 2e-4, 9: 5e-5}  # Wb/m
ORDERS = np.array(list(LINKAGE))
AXIS = np.linspace(-1e4, 1e4, 3)
FLAT = np.array([amplitude * np.ones((3, 3)) for amplitude in LINKAGE.values()])
ZERO = ZeroSequence(ORDERS, AXIS, AXIS, FLAT, INDUCTANCE)


@pytest.mark.physics
def test_the_loss_is_that_of_the_loop_over_time():
    """3 R i + 3 L di/dt + 3 dpsi_0/dt = 0 integrated from rest until it repeats itself."""

    def slope(t, i):
        emf = sum(-n * SPEED * psi * sin(n * SPEED * t + n) for n, psi in LINKAGE.items())
        return -(RESISTANCE * i + emf) / INDUCTANCE

    period = 2 * pi / SPEED / 3
    times = np.linspace(20 * period, 21 * period, 2001)
    found = solve_ivp(slope, (0, times[-1]), [0.0], t_eval=times, rtol=1e-9, atol=1e-9).y[0]
    over_time = 3 * RESISTANCE * np.trapezoid(found**2, times) / period
    assert float(ZERO.loss(0.0, 0.0, SPEED, RESISTANCE)) == pytest.approx(over_time, rel=1e-5)


def test_slow_it_rises_with_the_square_of_the_speed_and_fast_it_stays():
    slow, faster, fast, fastest = ZERO.loss(0.0, 0.0, np.array([1e-3, 2e-3, 1e8, 2e8]), RESISTANCE)
    assert faster / slow == pytest.approx(4.0, rel=1e-6) and fastest == pytest.approx(fast, rel=1e-6)
    largest = 1.5 * RESISTANCE * sum(psi**2 for psi in LINKAGE.values()) / INDUCTANCE**2
    assert fast == pytest.approx(largest, rel=1e-6)


def test_it_follows_the_current_of_the_map():
    """psi_0 rises with the q axis; NaN stays NaN."""
    table = 1e-4 * (1 + np.abs(np.linspace(-1, 1, 5)))[None, None, :] * np.ones((1, 2, 1))
    data = xr.Dataset(
        {"psi_0": (("order", "id", "iq"), table), "l_0": 0.0},
        {"order": [3], "id": [-100.0, 100.0], "iq": np.linspace(-100.0, 100.0, 5)},
    )
    zero = ZeroSequence.from_per_turn(data)
    idle, half, none = zero.loss(0.0, np.array([0.0, 50.0, np.nan]), SPEED, RESISTANCE)
    assert idle == pytest.approx(1.5 * (3 * SPEED * 1e-4) ** 2 / RESISTANCE)
    assert half == pytest.approx(1.5**2 * idle) and np.isnan(none)


@pytest.mark.physics
def test_neither_turns_nor_paths_change_the_share():
    """144 wires in three deltas, against a triangle written out: N_t turns in series, R of the real phase."""
    made = [(12, 12, 1), (24, 6, 2), (6, 24, 1)]
    designs = tuple(series_star(t, n, connection=WindingConnection(a, Delta())) for t, n, a in made)
    valued = evaluate_windings(THESIS, LIMITS, designs, given_lengths(3, LENGTH))
    shares = [one.circulating_share for one in with_circulation(THESIS, ZERO, valued, 6e6, SPEED / 5)]
    assert shares == pytest.approx([shares[0]] * 3)
    resistance = designs[0].connection.phase_resistance(valued[0].phase_resistance)
    current = [
        n * SPEED * 12 * LENGTH * psi / hypot(resistance, n * SPEED * 144 * LENGTH * INDUCTANCE)
        for n, psi in LINKAGE.items()
    ]
    coil = 2**0.5 * 6e6 * 12 * designs[0].wire.area
    assert shares[0] == pytest.approx(sum(i**2 for i in current) / coil**2)


def mapped(third):
    """A map whose psi_0 is a third harmonic of this amplitude [Wb/m], at no zero-sequence inductance."""
    found = flux_map()
    table = np.full((1, found.data.sizes["id"], found.data.sizes["iq"]), third)
    return replace(found, data=found.data.assign(psi_0=(("order", "id", "iq"), table), l_0=0.0, order=[3]))


def test_a_quiet_delta_may_be_chosen_and_a_loud_one_is_not():
    free = replace(INPUTS, limits=replace(INPUTS.limits, phase_current_rms=400.0), closings=(Star(), Delta()))
    star = winding_stage(mapped(1e-6), MATCHED, DEMAND, replace(free, closings=(Star(),)), GOOD)
    quiet, loud = (winding_stage(mapped(third), MATCHED, DEMAND, free, GOOD) for third in (1e-6, 2e-3))
    assert quiet.chosen.design.connection == WindingConnection(1, Delta())
    assert 0 < quiet.chosen.circulating_share < 0.05
    assert loud.chosen.design == star.chosen.design and loud.chosen.circulating_share == 0.0
    refused = next(one for one in loud.alternatives if one.winding.design.connection.closing == Delta())
    assert refused.winding.circulating_share > 0.05 and "round the delta loses" in refused.verdict


def test_delta_alone_and_too_loud_is_refused():
    with pytest.raises(WindingError, match="allow star"):
        winding_stage(mapped(2e-3), MATCHED, DEMAND, replace(INPUTS, closings=(Delta(),)), GOOD)


def test_the_wound_machine_loses_it_by_its_own_resistance():
    """Per turn and metre 1.5 (3 w psi)^2 / R_1, w electrical, without inductance; none in a star."""
    made = {closing: series_star(12, 12, connection=WindingConnection(1, closing)) for closing in (Star(), Delta())}
    star, delta = (WoundMachine(MATCHED.machine, 4, 1, design, LENGTH) for design in made.values())
    data, current = mapped(1e-4).data, np.array([0.0, 20.0])
    assert star.circulating_loss(data, 0.0, current, 100.0).tolist() == [0.0, 0.0]
    resistance = (
        4 * 12 * 2 * (LENGTH + delta.end_turn_length) * made[Star()].wire.resistivity / (12 * made[Star()].wire.area)
    )
    emf = 3 * 500.0 * 12 * LENGTH * 1e-4  # of each real phase
    expected = 3 * emf**2 / 2 / resistance
    assert delta.circulating_loss(data, 0.0, current, 100.0) == pytest.approx([expected] * 2)
