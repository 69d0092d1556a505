"""The outline that parts are ordered by is that of the mesh that was solved, closed and without superfluous points."""

from dataclasses import replace
from itertools import pairwise
from math import pi

import numpy as np
import pytest

from geometry.areas import part_areas
from geometry.cross_section import mesh_cross_section
from geometry.outline import Arc, Line, outline_of
from geometry.winding import star_of_slots
from tests.geometry.thesis_machine import MM, machine

THESIS = machine()
MACHINES = {
    "thesis": THESIS,
    "short magnets": replace(THESIS, magnet_arc_fraction=0.8),
    "nine slots": replace(THESIS, slots=9, tooth_width=7 * MM, stator_outer_radius=30 * MM),
    "wide shoes": replace(THESIS, slots=3, pole_pairs=1, shoe_d1=0.5 * MM, shoe_d2=0.5 * MM, tooth_width=8 * MM),
}


@pytest.fixture(params=MACHINES, name="drawn")
def _drawn(request):
    return MACHINES[request.param], outline_of(MACHINES[request.param])


def parts(outline):
    return (outline.stator, outline.rotor, outline.shaft, *outline.magnets, *outline.coil_sides.values())


def test_the_whole_has_the_areas_of_its_copies(drawn):
    made, outline = drawn
    found = part_areas(made)
    assert outline.stator.area == pytest.approx(found.stator_laminations, rel=1e-12)
    assert outline.rotor.area == pytest.approx(found.rotor_laminations, rel=1e-12)
    assert outline.shaft.area == pytest.approx(found.shaft, rel=1e-12)
    assert sum(magnet.area for magnet in outline.magnets) == pytest.approx(found.magnets, rel=1e-12)
    for side in outline.coil_sides.values():
        assert side.area == pytest.approx(found.half_slot, rel=1e-12)
        assert side.area == pytest.approx(made.half_slot_area, rel=1e-12)


def test_contours_are_closed_and_run_round_their_part(drawn):
    _, outline = drawn
    for part in parts(outline):
        areas = [contour.area for contour in part.contours]
        assert part.area > 0 and sum(area > 0 for area in areas) == 1, "one contour outside, the others are holes"
        for contour in part.contours:
            for one, other in pairwise([*contour.curves, contour.curves[0]]):
                assert abs(one.end - other.start) < 1e-12


def test_no_curve_goes_on_into_the_next(drawn):
    made, outline = drawn
    slots, outer = sorted(outline.stator.contours, key=lambda contour: contour.area)
    flat = 2 if made.taper_touches_shoe else 0
    assert len(slots.curves) == (8 + flat) * made.slots  # bore, opening, taper, flank, bottom and the same way back
    assert outer.curves[0].is_circle and len(outer.curves) == 1
    assert [contour.curves[0].is_circle for contour in outline.rotor.contours] == [True, True]
    assert all(len(magnet.contours[0].curves) == 4 for magnet in outline.magnets)


def test_parts_lie_where_the_winding_and_the_field_have_them():
    outline = outline_of(THESIS)
    middle = np.mean([curve.start for curve in outline.magnets[3].contours[0].curves])
    assert np.angle(middle) == pytest.approx(3 * THESIS.pole_pitch)
    for side, share in (("R", 0.0), ("L", 0.5)):
        points = [curve.start for curve in outline.coil_sides[4, side].contours[0].curves]
        angles = np.angle(points) / THESIS.slot_pitch - 4
        assert angles.min() > share - 1e-9 and angles.max() < share + 0.5 + 1e-9


def distance(curve, points):
    """Of points (n,) x + jy from a curve [m]."""
    if isinstance(curve, Line):
        along = (points - curve.start) / (curve.end - curve.start)
        return np.abs(points - curve.start - np.clip(along.real, 0, 1) * (curve.end - curve.start))
    reach = np.angle(points / np.exp(1j * (curve.first + curve.sweep / 2)))
    radial = np.abs(np.abs(points) - curve.radius)
    ends = np.minimum(np.abs(points - curve.start), np.abs(points - curve.end))
    return np.where(np.abs(reach) <= abs(curve.sweep) / 2 + 1e-12, radial, ends)


def test_every_node_of_the_mesh_between_iron_and_air_lies_on_the_outline():
    """What was solved and what is cut are one."""
    section = mesh_cross_section(THESIS, star_of_slots(12, 5), whole=True)
    mesh, iron = section.mesh, np.zeros(section.mesh.nelements, dtype=bool)
    iron[mesh.subdomains["stator_iron"]] = True
    left, right = mesh.f2t
    rim = np.where(right < 0, iron[left], iron[left] != iron[right])
    points = np.unique(mesh.p[:, mesh.facets[:, rim]].reshape(2, -1), axis=1)
    curves = [curve for contour in outline_of(THESIS).stator.contours for curve in contour.curves]
    away = np.min([distance(curve, points[0] + 1j * points[1]) for curve in curves], axis=0)
    assert points.shape[1] > 300 and away.max() < 1e-9


def test_swept_areas_are_those_of_a_triangle_and_a_sector():
    assert Line(1 + 0j, 2j).swept == pytest.approx(1.0)
    assert Arc(2.0, 0.3, pi / 2).swept == pytest.approx(pi)
    assert Arc(2.0, 0.3, -pi / 2).swept == pytest.approx(-pi)
