"""End effects against formulas that they do not use."""

import numpy as np
import pytest
from scipy.special import ellipe, ellipk

from magnetostatics.end_effects import EndEffects, bundle_radius, end_turn_inductance, fringing_factor
from units import MU_0


def mutual_of_two_rings(radius, distance):
    """Maxwell's M = mu_0 R ((2/k - k) K - (2/k) E) of two equal coaxial rings, k^2 = 4 R^2/(4 R^2 + d^2) [H]."""
    m = 4 * radius**2 / (4 * radius**2 + distance**2)
    k = np.sqrt(m)
    return MU_0 * radius * ((2 / k - k) * ellipk(m) - 2 / k * ellipe(m))


@pytest.mark.parametrize("thickness", (0.05, 0.1, 0.2))
def test_inductance_of_a_ring_is_that_of_two_at_the_mean_distance_of_its_section(thickness):
    """The geometric mean distance of a circle from itself is a exp(-1/4)."""
    radius = 8e-3
    expected = mutual_of_two_rings(radius, thickness * radius * np.exp(-0.25))
    assert end_turn_inductance(radius, thickness * radius, 1, 1) == pytest.approx(expected, rel=2 * thickness**2)


def test_inductance_goes_with_turns_squared_and_coils():
    one = end_turn_inductance(8e-3, 2e-3, 1, 1)
    assert end_turn_inductance(8e-3, 2e-3, 7, 4) == pytest.approx(4 * 49 * one)
    assert 1e-9 < one < 3e-8  # some 10 nH for a ring of 8 mm


def test_torque_and_flux_linkage_of_a_machine():
    ends = EndEffects(0.036, 0.97, 20e-6)
    assert ends.torque(55.5) == pytest.approx(55.5 * 0.036 * 0.97)
    psi = ends.flux_linkage(np.array([0.02, -0.01, -0.01]), 7, np.array([10.0, -5.0, -5.0]))
    assert psi == pytest.approx([0.0050888, -0.0025444, -0.0025444], rel=1e-9)


def test_null_is_the_field_times_the_length():
    assert EndEffects(1.0).torque(55.5) == 55.5
    assert (EndEffects(1.0).flux_linkage(np.ones(3), 1, np.ones(3)) == 1.0).all()


def test_fringing_adds_a_gap_at_either_end():
    assert fringing_factor(0.036, 0.5e-3) * 0.036 == pytest.approx(0.037)


def test_bundle_has_the_area_of_the_coil_side():
    assert np.pi * bundle_radius(50e-6) ** 2 == pytest.approx(50e-6)


@pytest.mark.parametrize("bundle", (0.0, 9e-3))
def test_a_bundle_thicker_than_its_bend_is_refused(bundle):
    with pytest.raises(ValueError, match="thinner than its bend"):
        end_turn_inductance(8e-3, bundle, 1, 1)
