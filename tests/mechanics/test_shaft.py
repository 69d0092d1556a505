"""Shafts and bearings by hand, and a spring that is too soft for its magnets."""

from __future__ import annotations

from dataclasses import replace
from math import inf, pi, sqrt

import pytest

from materials.errors import MaterialError
from materials.strength import GEAR_STEEL, MPA, SHAFT_STEEL, StrengthBySection
from mechanics.bearings import Bearing
from mechanics.shaft import BentShaft, equivalent_stress, torsion_stress
from units import FACTORS, RPM

SHAFT = BentShaft(diameter=20e-3, span=200e-3, youngs_modulus=210e9, rotor_mass=2.0, magnetic_stiffness=0.0)


def test_torsion_and_von_mises_by_hand():
    """16 100 Nm/(pi (20 mm)^3) = 63.66 MPa; with 100 MPa of bending sqrt(100^2 + 3 63.66^2) = 148.9 MPa."""
    assert torsion_stress(100.0, 20e-3) == pytest.approx(63.66 * MPA, rel=1e-4)
    assert equivalent_stress(100 * MPA, 63.66 * MPA) == pytest.approx(148.86 * MPA, rel=1e-4)


def test_the_shaft_by_hand():
    """I = 7854 mm^4: k = 48 210e9 7.854e-9/0.2^3 = 9.896 N/um; 2 kg on it swing with 2224 rad/s."""
    assert SHAFT.stiffness == pytest.approx(9.896e6, rel=1e-4)
    assert SHAFT.critical_speed == pytest.approx(sqrt(9.896e6 / 2), rel=1e-4)
    assert SHAFT.deflection(98.96, 0.0) == pytest.approx(10e-6, rel=1e-4)
    assert SHAFT.bearing_load(98.96, 0.0) == pytest.approx(49.48)
    assert SHAFT.bending_stress(98.96, 0.0) == pytest.approx(98.96 * 0.05 / (pi * 8e-6 / 32), rel=1e-9)


def test_the_magnetic_pull_softens_the_shaft():
    soft = replace(SHAFT, magnetic_stiffness=0.75 * SHAFT.stiffness)
    assert soft.critical_speed == pytest.approx(SHAFT.critical_speed / 2)
    y, e = soft.deflection(50.0, 0.1e-3), 0.1e-3
    assert soft.stiffness * y == pytest.approx(50.0 + soft.magnetic_stiffness * (e + y)), "spring against pull and load"
    assert soft.bearing_load(50.0, e) == pytest.approx(soft.stiffness * y / 2)


def test_a_shaft_that_is_softer_than_the_pull_has_no_rest():
    hopeless = replace(SHAFT, magnetic_stiffness=1.01 * SHAFT.stiffness)
    assert hopeless.critical_speed == 0.0
    assert hopeless.deflection(0.0, 1e-6) == hopeless.bending_stress(0.0, 1e-6) == inf


def test_the_life_of_a_bearing_by_the_table():
    """C/P = 10 is 1000 million turns, at 1000 rpm 16667 h (ISO 281)."""
    life = Bearing(14e3, None).rating_life(1400.0, 1000 * RPM)
    assert life / FACTORS["h"] == pytest.approx(16667, rel=1e-4)
    assert Bearing(14e3, None).rating_life(2800.0, 1000 * RPM) == pytest.approx(life / 8)
    assert Bearing(14e3, None).rating_life(1400.0, 0.0) == inf


def test_strength_falls_with_the_diameter_and_ends_with_the_table():
    assert [SHAFT_STEEL.at(d) / MPA for d in (10e-3, 16e-3, 16.1e-3, 60e-3)] == pytest.approx([900, 900, 750, 650])
    assert GEAR_STEEL.at(20e-3) == 785 * MPA
    assert StrengthBySection.stated(5.0).at(1e3) == 5.0
    with pytest.raises(MaterialError, match="shaft of 300 mm, its table ends at 250 mm: state mechanics.shaft_yield"):
        SHAFT_STEEL.at(0.3)
