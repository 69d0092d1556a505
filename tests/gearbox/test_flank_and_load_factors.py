"""Contact stress: a textbook example, Hertz, the standard's form of Z_B; load factors: published tolerances."""

from math import pi, sqrt

import numpy as np
import pytest

from gearbox.flank import (
    Lubrication,
    contact_ratio_factor,
    contact_stress,
    hertz_stress,
    lubricant_factor,
    permissible_contact_stress,
    pitch_velocity,
    roughness_factor,
    single_contact_factors,
    velocity_factor,
    zone_factor,
)
from gearbox.involute import ISO_53_A, BasicRack, Gear, Mesh, centre_distance
from gearbox.load_factors import (
    Quality,
    helix_deviation,
    load_factors,
    pitch_deviation,
    profile_deviation,
    tooth_stiffness,
)
from gearbox.material import CASE_HARDENED_FLANK, CASE_HARDENED_MQ
from units import MILLIMETRE

MM, MPA = MILLIMETRE, 1e6
INCH, POUND, PSI = 25.4 * MM, 4.4482216, 6894.757


def standard_pair(z_1, z_2, module):
    gears = [Gear(z, 0.0, module, (z / 2 + 1) * module) for z in (z_1, z_2)]
    return Mesh(*gears, centre_distance(z_1, z_2, 0.0, module, ISO_53_A.pressure_angle))


def test_elasticity_and_zone_factor():
    """Z_E 189.8 sqrt(MPa), Z_H 2.495 at 20 degrees without shift: ISO 6336-2."""
    assert CASE_HARDENED_MQ.elasticity_factor / sqrt(MPA) == pytest.approx(189.8, abs=0.05)
    assert zone_factor(standard_pair(20, 40, MM)) == pytest.approx(2.495, abs=0.001)


# ---- ISO/TR 6336-30:2017, example 1: helical pair of module 8 mm, 17 and 103 teeth, case-hardened ------------------


@pytest.mark.parametrize(("cycles", "printed"), [(1.080e9, 0.910), (1.783e8, 0.962)])
def test_life_factor_of_the_worked_example(cycles, printed):
    assert CASE_HARDENED_FLANK.factor(cycles) == pytest.approx(printed, abs=5e-4)


def test_film_factors_of_the_worked_example():
    """320 mm^2/s at 40 degrees, 2.664 m/s; the permissible stress of the pinion is 1338.5 MPa with Z_NT and Z_R."""
    oil = Lubrication(320e-6, 4e-6, 20e-6)
    assert lubricant_factor(oil) == pytest.approx(1.0474, abs=1e-4)
    assert velocity_factor(2.664) == pytest.approx(0.96911, abs=2e-5)
    product = lubricant_factor(oil) * velocity_factor(2.664) * 0.96599 * CASE_HARDENED_FLANK.factor(1.080e9)
    assert CASE_HARDENED_MQ.contact_limit * product / MPA == pytest.approx(1338.5, abs=0.5)


def test_tooth_stiffness_of_the_worked_example():
    """c' = 12.370 N/(mm um) is of the helical teeth: cos(15.8 degrees) times that of the virtual spur gears."""
    rack = BasicRack(addendum=1.0, dedendum=1.4, fillet_radius=0.39, pressure_angle=np.radians(20))  # ISO 53, type D
    gears = [Gear(z, x, 8 * MM, (z / 2 + 1 + x) * 8 * MM, rack) for z, x in ((18.905, 0.145), (114.543, 0.0))]
    distance = centre_distance(18.905, 114.543, 0.145, 8 * MM, rack.pressure_angle)
    single, _ = tooth_stiffness(Mesh(*gears, distance), 1e6)
    assert single / 1e9 * np.cos(np.radians(15.8)) == pytest.approx(12.370, rel=1e-3)


def test_textbook_contact_stress():
    """Shigley's Mechanical Engineering Design, example 14-4: 17 and 52 teeth, P = 10/in, 1.5 in wide, 164.8 lbf.

    Its stress without load factors is 70 360 psi / sqrt(1.377 * 1.043 * 1.22); C_p is 2300 sqrt(psi) and AGMA has no
    Z_eps.
    """
    mesh = standard_pair(17, 52, INCH / 10)
    elastic = 2300 * sqrt(PSI)
    stress = contact_stress(mesh, 164.8 * POUND, 1.5 * INCH, elastic) / contact_ratio_factor(mesh)
    assert stress / PSI == pytest.approx(70_360 / sqrt(1.377 * 1.043 * 1.22), rel=2e-3)


@pytest.mark.parametrize("name", ["sun_mesh", "ring_mesh"])
def test_contact_stress_is_hertz_at_the_pitch_point(printed, name):
    mesh, material = getattr(printed, name), CASE_HARDENED_MQ
    force, width = 2000.0, 12 * MM
    normal = force / np.cos(mesh.pinion.rack.pressure_angle)
    pitch = mesh.pinion.base_radius * np.tan(mesh.working_pressure_angle)
    stress = contact_stress(mesh, force, width, material.elasticity_factor) / contact_ratio_factor(mesh)
    assert stress == pytest.approx(hertz_stress(mesh, normal, width, pitch, material), rel=1e-12)


def test_single_contact_factor_is_the_standards_formula(printed):
    """M_1 of ISO 6336-2 in tip and base diameters."""
    mesh = printed.sun_mesh
    first, second, eps = mesh.pinion, mesh.wheel, mesh.contact_ratio
    root_1 = sqrt((first.tip_radius / first.base_radius) ** 2 - 1)
    root_2 = sqrt((second.tip_radius / second.base_radius) ** 2 - 1)
    tan = np.tan(mesh.working_pressure_angle)
    m_1 = tan / sqrt((root_1 - 2 * pi / first.teeth) * (root_2 - (eps - 1) * 2 * pi / second.teeth))
    m_2 = tan / sqrt((root_2 - 2 * pi / second.teeth) * (root_1 - (eps - 1) * 2 * pi / first.teeth))
    assert single_contact_factors(mesh) == (pytest.approx(max(1, m_1)), pytest.approx(max(1, m_2)))
    assert m_1 > 1


def test_the_ring_side_is_stressed_less(printed):
    force, width = 2000.0, 12 * MM
    sun, ring = (contact_stress(m, force, width, 1.0) for m in (printed.sun_mesh, printed.ring_mesh))
    assert ring < 0.6 * sun


def test_oil_and_roughness_factors_are_one_for_the_test_gears():
    """ISO 6336-2: 100 mm2/s at 50 degrees, 167.5 at 40; 10 m/s; R_z 3 um on 10 mm curvature radius."""
    oil = Lubrication(167.5e-6, 3e-6, 10e-6)
    mesh = standard_pair(40, 40, MM)
    curvature = mesh.pinion.base_radius * np.tan(mesh.working_pressure_angle) / 2
    mesh = standard_pair(40, 40, MM * 10e-3 / curvature)
    assert lubricant_factor(oil) == pytest.approx(1.0, abs=1e-4)
    assert velocity_factor(10.0) == pytest.approx(1.0, abs=0.005)
    assert roughness_factor(mesh, oil) == pytest.approx(1.0, rel=1e-9)
    limit = permissible_contact_stress(mesh, CASE_HARDENED_MQ, oil, 10.0)
    assert limit == pytest.approx(1500 * MPA * lubricant_factor(oil) * velocity_factor(10.0))


# ---- load factors ---------------------------------------------------------------------------------------------------


def test_tolerances_are_those_of_the_tables():
    """ISO 1328-1:1995, grade 5: d 5-20, m 0.5-2, b 4-10 mm at the geometric means of the ranges; sqrt 2 a grade."""
    size = (1.0 * MM, 10.0 * MM)
    assert pitch_deviation(*size, 5) * 1e6 == pytest.approx(4.7, abs=0.05)
    assert profile_deviation(*size, 5) * 1e6 == pytest.approx(3.5, abs=0.06)
    assert helix_deviation(10.0 * MM, 6.3 * MM, 5) * 1e6 == pytest.approx(6.1, abs=0.06)
    assert pitch_deviation(*size, 7) == pytest.approx(2 * pitch_deviation(*size, 5))


def test_stiffness_is_near_the_standards_mean_values():
    """ISO 6336-1 method C for 1.2 < eps < 1.9: c' = 14, c_gamma = 20 N/(mm um)."""
    single, mean = tooth_stiffness(standard_pair(25, 75, 3 * MM), 200e3)
    assert single / 1e9 == pytest.approx(14, rel=0.12) and mean / 1e9 == pytest.approx(20, rel=0.12)
    light, _ = tooth_stiffness(standard_pair(25, 75, 3 * MM), 50e3)
    assert light == pytest.approx(single / 2)


def factors(printed, *, width=12 * MM, force=3300.0, speed=10.0, quality=Quality()):
    return load_factors(printed.sun_mesh, width, force, speed, 7800.0, quality)


def test_speed_adds_dynamic_load_and_rest_none(printed):
    found = [float(factors(printed, speed=speed).dynamic) for speed in (0.0, 10.0, 1000.0)]
    assert found[0] == 1.0 and 1.0 < found[1] < found[2] < 1.5


def test_better_gears_carry_more_evenly(printed):
    coarse, fine = (factors(printed, quality=Quality(grade=grade)) for grade in (8, 4))
    assert coarse.face_contact > fine.face_contact > 1 and coarse.transverse_contact >= fine.transverse_contact >= 1
    assert 1 < coarse.face_root < coarse.face_contact


def test_misalignment_of_a_light_load_is_bounded_by_the_root_rule(printed):
    """K_Hbeta by hand for 300 N/mm, and continuous where the half-width rule takes over at 2."""
    mesh, width = printed.sun_mesh, 12 * MM
    _, mean = tooth_stiffness(mesh, 300e3)
    error = 0.85 * helix_deviation(2 * mesh.wheel.reference_radius, width, 6)
    dynamic = factors(printed, force=300e3 * width, speed=0.0)
    assert dynamic.face_contact == pytest.approx(1 + 0.85 * mean * error / (2 * 300e3), rel=1e-12)
    forces = np.geomspace(1300, 2400, 4001)
    face = factors(printed, force=forces, speed=0.0, quality=Quality(grade=9)).face_contact
    assert np.abs(np.diff(face)).max() < 2e-3 * face.max() and face.min() < 2 < face.max()


def test_external_factors_multiply(printed):
    plain, shared = factors(printed), factors(printed, quality=Quality(load_sharing=1.2, application=1.25))
    assert (shared.external, plain.external) == (pytest.approx(1.5), 1.0)
    assert shared.contact == pytest.approx(1.5 * shared.dynamic * shared.face_contact * shared.transverse_contact)


def test_pitch_velocity_is_that_of_rolling(printed):
    mesh = printed.sun_mesh
    rolling = printed.centre_distance * 14 / 60
    assert pitch_velocity(mesh, 100.0) == pytest.approx(100.0 * rolling, rel=1e-12)
