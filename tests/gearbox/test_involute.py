"""Involute gears: identities, contact along the line of action walked step by step, the printed gear set."""

from dataclasses import replace

import numpy as np
import pytest

from gearbox.involute import (
    ISO_53_A,
    Gear,
    Mesh,
    centre_distance,
    inverse_involute,
    involute,
    shift_sum,
    working_angle,
)
from gearbox.planetary_set import planetary_set
from units import DEGREE, MILLIMETRE

MM = MILLIMETRE


@pytest.fixture(params=["sun_mesh", "ring_mesh"])
def mesh(request, printed):
    return getattr(printed, request.param)


def test_inverse_involute_turns_the_involute_back():
    angles = np.linspace(1, 60, 60) * DEGREE
    assert inverse_involute(involute(angles)) == pytest.approx(angles, rel=1e-12)
    assert inverse_involute(0.0) == 0 and np.isnan(inverse_involute(-0.01))


def test_tabulated_involute():
    """inv 20 degrees = 0.014904, inv 14.5 degrees = 0.005545, of every gear handbook."""
    assert (involute(20 * DEGREE), involute(14.5 * DEGREE)) == pytest.approx((0.014904, 0.005545), abs=1e-6)


def test_teeth_and_spaces_fill_the_working_pitch_circle(mesh):
    """Without backlash the teeth of both gears together are one pitch thick where they roll."""
    alpha_w = mesh.working_pressure_angle
    widths = []
    for gear in (mesh.pinion, mesh.wheel):
        radius = gear.base_radius / np.cos(alpha_w)
        widths.append(2 * radius * gear.half_tooth_angle(radius))
    pitch = 2 * np.pi * mesh.pinion.base_radius / np.cos(alpha_w) / mesh.pinion.teeth
    assert sum(widths) == pytest.approx(pitch, rel=1e-12)


def test_contact_ratio_is_the_path_of_contact_walked_in_steps(mesh):
    """Points of the common tangent of the base circles that lie within both tip circles, over the base pitch."""
    a, alpha_w, side = mesh.centre_distance, mesh.working_pressure_angle, mesh.wheel.side
    pinion_centre, wheel_centre = 0.0, side * a
    pitch_point = mesh.pinion.base_radius / np.cos(alpha_w)
    step = 1e-4 * mesh.base_pitch
    along = np.arange(-30000, 30001) * step
    points = pitch_point + along * np.exp(1j * (np.pi / 2 - alpha_w)) * 1.0
    on_pinion = np.abs(points - pinion_centre) <= mesh.pinion.tip_radius
    on_wheel = side * np.abs(points - wheel_centre) <= side * mesh.wheel.tip_radius
    walked = np.count_nonzero(on_pinion & on_wheel) * step / mesh.base_pitch
    assert mesh.contact_ratio == pytest.approx(walked, abs=3e-4)
    assert sum(mesh.addendum_contact_ratios) == pytest.approx(mesh.contact_ratio, rel=1e-12)


def test_the_normal_at_the_pitch_point_touches_both_base_circles(mesh):
    """Curvatures of both flanks at the pitch point are r_b tan(alpha_w); relative curvature from them."""
    tan = np.tan(mesh.working_pressure_angle)
    pinion, wheel = mesh.pinion.base_radius * tan, mesh.wheel.base_radius * tan
    assert mesh.wheel_curvature(pinion) == pytest.approx(wheel, rel=1e-12)
    expected = 1 / (1 / pinion + mesh.wheel.side / wheel)
    assert mesh.relative_curvature(pinion) == pytest.approx(expected, rel=1e-12)


def test_curvature_is_the_unwound_thread(mesh):
    gear = mesh.pinion
    angle = gear.pressure_angle_at(gear.tip_radius)
    assert mesh.pinion_curvature_at_tip == pytest.approx(gear.base_radius * np.tan(angle), rel=1e-12)


def test_standard_pair():
    """20 and 40 teeth without shift: centre distance 30 m, contact ratio 1.64 (handbook), working angle 20 degrees."""
    gears = [Gear(z, 0.0, MM, (z / 2 + 1) * MM) for z in (20, 40)]
    pair = Mesh(*gears, centre_distance(20, 40, 0.0, MM, ISO_53_A.pressure_angle))
    assert pair.centre_distance == pytest.approx(30 * MM)
    assert pair.working_pressure_angle == pytest.approx(20 * DEGREE)
    assert pair.contact_ratio == pytest.approx(1.64, abs=0.005)
    assert pair.root_clearances == pytest.approx((0.25 * MM, 0.25 * MM))


def test_undercut_begins_at_seventeen_teeth():
    """z = 2 / sin^2(20 degrees) = 17.1 for the rack with a straight dedendum of one module."""
    rack = replace(ISO_53_A, fillet_radius=0.25 / (1 - np.sin(20 * DEGREE)))
    assert rack.straight_dedendum == pytest.approx(1.0)
    shifts = [Gear(z, 0.0, MM, 0.0, rack).least_shift for z in (17, 18)]
    assert shifts[0] > 0 > shifts[1]


def test_the_fillet_starts_at_the_base_circle_where_undercut_begins():
    gear = Gear(12, 0.0, MM, 0.0)
    assert replace(gear, shift=gear.least_shift).form_curvature == pytest.approx(0.0, abs=1e-15)


def test_shift_sum_is_the_inverse_of_the_centre_distance():
    alpha = ISO_53_A.pressure_angle
    for z_1, z_2, total in ((14, 46, 0.559), (46, -109, 0.844), (20, 30, -0.3)):
        distance = centre_distance(z_1, z_2, total, MM, alpha)
        assert shift_sum(z_1, z_2, distance, MM, alpha) == pytest.approx(total, abs=1e-10)
        assert np.cos(working_angle(z_1, z_2, total, alpha)) * distance == pytest.approx(
            abs(z_1 + z_2) * MM / 2 * np.cos(alpha)
        )


def test_the_printed_gear_set_follows_from_its_teeth_and_shifts(printed):
    """Thesis Table 3.11 and the text to it: a 22.9 mm, ring shift 0.768, 1/8.8, contact ratios 1.4 and 1.8."""
    assert printed.centre_distance / MM == pytest.approx(22.9, abs=0.01)
    assert printed.ring.shift == pytest.approx(0.768, abs=1e-3)
    assert printed.ratio == pytest.approx(8.8, abs=0.02) and printed.ratio**2 == pytest.approx(77.19, abs=0.005)
    assert printed.sun_mesh.contact_ratio == pytest.approx(1.4, abs=0.05)
    assert printed.ring_mesh.contact_ratio == pytest.approx(1.8, abs=0.05)


def test_a_batch_is_its_members(printed):
    many = planetary_set(([14, 15], [46, 47], [-109, -114]), ([0.483, 0.7], [0.076, 0.4]), 0.75 * MM)
    assert many.at(0).ring_mesh.contact_ratio == pytest.approx(printed.ring_mesh.contact_ratio, rel=1e-14)
    assert many.at(1).centre_distance == many.centre_distance[1]
