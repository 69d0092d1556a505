"""What all three phases share: its symmetry over the angle, its harmonics and its inductance, on a coarse field."""

from math import cos, pi

import numpy as np
import pytest
import xarray as xr

from magnetostatics.currents import PhaseCurrents
from magnetostatics.flux_linkage import phase_flux_linkage
from magnetostatics.flux_map import flux_torque_and_zero_sequence, mirrored, operating_point
from magnetostatics.flux_map_stage import kept_model
from magnetostatics.zero_sequence import (
    harmonics_of_half_period,
    harmonics_of_period,
    with_zero_sequence,
    zero_sequence_inductance,
)
from tests.magnetostatics.test_flux_map_stage import CASE

AMPERE_TURNS = 400.0


@pytest.fixture(scope="module")
def model():
    return kept_model(CASE, CASE.family.reference)


def psi_0(model, electrical, i_d=0.0, i_q=0.0):
    """Beyond the axis of phase A by an electrical angle [rad]."""
    angle = (model.section.layout.phase_axis + electrical) / 5
    return flux_torque_and_zero_sequence(model.solve(operating_point(model, angle, i_d, i_q)))["psi_0"]


@pytest.mark.physics
def test_it_turns_round_after_sixty_degrees(model):
    here, there = (psi_0(model, angle, -100.0, AMPERE_TURNS) for angle in (0.2, 0.2 + pi / 3))
    assert abs(here) > 1e-4 and there == pytest.approx(-here, rel=2e-3)


@pytest.mark.physics
def test_the_sense_of_the_torque_mirrors_it(model):
    motoring, braking = psi_0(model, 0.3, 0.0, AMPERE_TURNS), psi_0(model, -0.3, 0.0, -AMPERE_TURNS)
    assert motoring == pytest.approx(braking, rel=2e-3)


@pytest.mark.physics
def test_the_inductance_is_the_slope_of_the_flux_linkage(model):
    """A current in all three phases at once, solved in the saturated field, against the tangent without current."""
    angle, small = model.section.layout.phase_axis / 5, 5.0
    solution = model.solve(operating_point(model, angle, 0.0, 0.0))
    plus, minus = (
        np.mean(phase_flux_linkage(model.solve(PhaseCurrents(angle, (i, i, i), 1.0)))) for i in (small, -small)
    )
    assert zero_sequence_inductance(solution) == pytest.approx((plus - minus) / (2 * small), rel=1e-4)


def test_harmonics_of_a_known_wave():
    e = pi / 3 * np.arange(10) / 10
    orders, amplitudes = harmonics_of_half_period(2.0 * np.cos(3 * e + 0.4) - 0.5 * np.sin(15 * e))
    assert orders.tolist() == [3, 9, 15, 21, 27]
    assert amplitudes == pytest.approx([2.0, 0.0, 0.5, 0.0, 0.0], abs=1e-12)


def test_even_harmonics_where_poles_are_not_alike():
    e = 2 * pi / 3 * np.arange(12) / 12
    orders, amplitudes = harmonics_of_period(2.0 * np.cos(3 * e + 0.4) - 0.5 * np.sin(6 * e) + 7.0)
    assert orders.tolist() == [3, 6, 9, 12, 15]
    assert amplitudes == pytest.approx([2.0, 0.5, 0.0, 0.0, 0.0], abs=1e-12)


def test_a_mirrored_map_has_its_amplitudes_on_both_sides():
    """psi_0 = (1 + i_q/10) cos(3 e) over i_q >= 0, and an inductance without axes."""
    e, i = pi / 3 * np.arange(4) / 4, np.array([0.0, 1.0, 2.0])
    wave = np.array([cos(3 * x) for x in e])[:, None, None] * np.ones((1, 3, 1)) * (1 + i / 10)
    names = ("psi_d", "psi_q", "torque", "psi_0")
    data = xr.Dataset(
        {name: (("angle", "id", "iq"), wave) for name in names},
        {"angle": e / 5, "id": i, "iq": i},
        {"pole_pairs": 5, "phase_axis": 0.0, "period": np.pi / 3},
    )
    found = mirrored(with_zero_sequence(data, 3e-7))
    assert found.psi_0.sel(order=3, id=1.0).values == pytest.approx([1.2, 1.1, 1.0, 1.1, 1.2])
    assert found.psi_0.sel(order=9).values == pytest.approx(0.0, abs=1e-12)
    assert float(found.l_0) == 3e-7 and found.l_0.dims == ()
