"""Turning ring and magnets against equilibrium, integrals over small pieces and textbook cases."""

from __future__ import annotations

from dataclasses import replace
from math import hypot, pi

import numpy as np
import pytest
from numpy.testing import assert_allclose

from materials.strength import CARBON_SLEEVE, MPA
from mechanics.retention import Glue, MagnetRing, Sleeve
from mechanics.rotating_ring import RotatingRing
from tests.magnetostatics.reference_machine import reference_machine

RING = RotatingRing(inner=10e-3, outer=50e-3, density=7700.0, poisson_ratio=0.3, speed=2000.0, rim_pull=8e6)


def test_the_ring_is_in_equilibrium():
    """d(r sigma_r)/dr - sigma_phi + rho omega^2 r^2 = 0 at every radius; the bore is free, the rim is pulled."""
    r = np.linspace(RING.inner, RING.outer, 4001)
    slope = np.gradient(r * RING.radial_stress(r), r, edge_order=2)
    rest = slope - RING.hoop_stress(r) + RING.density * RING.speed**2 * r**2
    assert_allclose(rest, 0.0, atol=1e-4 * RING.largest_stress)
    assert RING.radial_stress(RING.inner) == pytest.approx(0.0, abs=1.0)
    assert RING.radial_stress(RING.outer) == pytest.approx(RING.rim_pull)


def test_the_strains_of_the_ring_fit_together():
    """The radial strain is the slope of the displacement u = r epsilon_phi."""
    r, nu = np.linspace(RING.inner, RING.outer, 4001), RING.poisson_ratio
    radial, hoop = RING.radial_stress(r), RING.hoop_stress(r)
    slope = np.gradient(r * (hoop - nu * radial), r, edge_order=2)
    assert_allclose(slope, radial - nu * hoop, atol=1e-4 * RING.largest_stress)


def test_textbook_cases_of_the_ring():
    """A small hole doubles the stress of the full disk; a thin ring has rho v^2."""
    full_disk = (3 + 0.3) / 8 * 7700 * 2000**2 * 50e-3**2
    assert replace(RING, inner=1e-7, rim_pull=0.0).largest_stress == pytest.approx(2 * full_disk, rel=1e-6)
    thin = replace(RING, inner=49.99e-3, rim_pull=0.0)
    assert thin.largest_stress == pytest.approx(7700 * (2000 * 50e-3) ** 2, rel=1e-3)
    assert replace(RING, inner=49.5e-3, speed=0.0).largest_stress == pytest.approx(8e6 * 50 / 0.5, rel=0.01)


def test_the_ring_by_hand():
    """0.825 7700 2000^2 (0.05^2 + 0.7/3.3 0.01^2) = 64.06 MPa, and 2 8 MPa 25/24 of the rim: 16.67 MPa."""
    assert RING.largest_stress == pytest.approx((64.06 + 16.67) * MPA, rel=1e-3)


MAGNETS = MagnetRing(reference_machine(magnet_arc_fraction=0.8), 7500.0, 40e-3, 3000.0, 6.0)


def test_the_pull_of_a_magnet_is_that_of_its_pieces():
    m = MAGNETS.machine
    half = 0.8 * pi / 10
    radii = m.rotor_core_radius + m.magnet_length * (np.arange(400) + 0.5) / 400
    angles = -half + 2 * half * (np.arange(400) + 0.5) / 400
    radius, angle = np.meshgrid(radii, angles)
    mass = 7500.0 * 40e-3 * radius * (m.magnet_length / 400) * (2 * half / 400)
    assert MAGNETS.pull == pytest.approx((mass * radius * 3000.0**2 * np.cos(angle)).sum(), rel=1e-5)
    rim = 2 * half * m.rotor_core_radius * 40e-3
    assert MAGNETS.tension == pytest.approx((mass * radius * 3000.0**2).sum() / rim, rel=1e-5)
    assert MAGNETS.mean_rim_pull == pytest.approx(0.8 * MAGNETS.tension)


def test_the_bond_takes_the_torque_over_its_face():
    """6 Nm at 13.2 mm on 0.8 of 2 pi 13.2 mm 40 mm: 454.5 N on 2654 mm^2."""
    assert MAGNETS.shear == pytest.approx(454.5 / 2654e-6, rel=1e-3)


GLUE = Glue(10 * MPA, 8 * MPA, 3.0)


def test_glue_by_hand():
    (check,) = GLUE.checks(MAGNETS)
    assert check.load == pytest.approx(hypot(MAGNETS.tension / 10e6, MAGNETS.shear / 8e6))
    assert check.reached == pytest.approx(1 / check.load) and check.holds
    assert GLUE.rim_pull(MAGNETS) == MAGNETS.mean_rim_pull


@pytest.mark.parametrize("change", ({"speed": 6000.0}, {"torque": 150.0}))
def test_glue_fails_by_speed_and_by_torque(change):
    (check,) = GLUE.checks(replace(MAGNETS, **change))
    assert not check.holds and check.margin < 0


SLEEVE = Sleeve(CARBON_SLEEVE, 0.3e-3, 300 * MPA, 1.2)


def test_a_sleeve_by_hand():
    """r = 15.85 mm at 3000 rad/s: rho v^2 = 1580 47.55^2 = 3.572 MPa; it presses with (300 - 3.572) 0.3/15.85 MPa."""
    hoop, press = SLEEVE.checks(MAGNETS)
    assert hoop.load == pytest.approx(303.572 * MPA, rel=1e-5) and hoop.limit == 1100 * MPA
    assert press.limit == pytest.approx(296.428 * MPA * 0.3 / 15.85, rel=1e-5)
    assert press.load == pytest.approx(MAGNETS.mean_rim_pull * 13.2 / 15.7)
    assert hoop.holds and press.holds and SLEEVE.rim_pull(MAGNETS) == 0.0


def test_a_sleeve_carries_its_magnets_no_further_than_its_prestress():
    fast = replace(MAGNETS, speed=6500.0)
    hoop, press = SLEEVE.checks(fast)
    assert hoop.holds and not press.holds
    loose = replace(SLEEVE, prestress=1 * MPA)
    assert loose.checks(MAGNETS)[1].limit == 0.0 and not loose.checks(MAGNETS)[1].holds


def test_a_sleeve_can_be_too_tight():
    hoop, press = replace(SLEEVE, prestress=1000 * MPA).checks(MAGNETS)
    assert not hoop.holds and press.holds


def test_the_resultant_of_a_wide_magnet_is_less_than_its_pieces_together():
    """sin(arc/2) of the arc/2: the pieces pull apart."""
    wide = replace(MAGNETS, machine=reference_machine(pole_pairs=1, slots=3, magnet_arc_fraction=1.0))
    whole = wide.tension * pi * wide.machine.rotor_core_radius * wide.active_length
    assert wide.pull == pytest.approx(whole * 2 / pi)
