"""Chords of arcs: how far they lie from the circle, and what that does to a machine."""

from math import acos, cos, hypot, pi

import pytest

from geometry.chords import curve_length, natural_edges, with_short_chords
from geometry.parts import Rim
from geometry.plane_mesh import Drawing, triangulate
from tests.magnetostatics.other_machines import V_SHAPE

EDGE = 0.5e-3  # m, on the sliding circle


def sector(radius, angle, size, centre=None):
    """A piece of a disc whose arc is asked for edges of a size [m]."""
    d = Drawing()
    x, y = centre or (0.0, 0.0)
    d.place("centre", x, y, size)
    d.place("start", x + radius, y, size)
    d.place("end", x + radius * cos(angle), y + radius * (1 - cos(angle) ** 2) ** 0.5, size)
    d.path("centre", "start")
    d.arc("start", "end", centre=centre)
    d.path("end", "centre")
    d.region("iron", "centre", "start", "end")
    return d


@pytest.mark.parametrize("radius, angle, centre", [(60e-3, 0.2, None), (3e-3, pi / 2, (0.08, 0.01))])
def test_no_chord_is_further_from_its_arc_than_two_hundredths_of_an_edge_in_the_gap(radius, angle, centre):
    drawing = with_short_chords(sector(radius, angle, 20e-3, centre), EDGE)
    mesh = triangulate(drawing)
    x, y = centre or (0.0, 0.0)
    area = sum(_area(mesh.points[corners]) for corners in mesh.triangles)
    edges = drawing.curves["start", "end"][1]
    assert radius * (1 - cos(angle / edges / 2)) <= 0.02 * EDGE < radius * (1 - cos(angle / (edges - 1) / 2))
    assert 0 < 1 - area / (radius**2 * angle / 2) < 2 * 0.02 * EDGE / radius
    on_arc = [abs(hypot(u - x, v - y) - radius) < 1e-9 for u, v in mesh.points]
    assert sum(on_arc) == edges + 1


def _area(corners):
    (a, b), (c, d), (e, f) = corners
    return ((c - a) * (f - b) - (e - a) * (d - b)) / 2


def test_what_is_fine_enough_stays_as_it_is():
    drawing = with_short_chords(sector(60e-3, 0.2, 0.2e-3), EDGE)
    assert drawing.curves["start", "end"] == (True, None)


def test_edges_and_lengths_of_arcs_about_any_centre():
    """Of 60 mm and 0.2 rad, in edges of 2 mm."""
    drawing = sector(60e-3, 0.2, 2e-3, centre=(0.3, 0.1))
    assert curve_length(drawing, "start", "end") == pytest.approx(12e-3)
    assert natural_edges(drawing, "start", "end") == pytest.approx(6.0)


def test_the_back_iron_of_many_slots_is_round():
    """48 slots on 134.62 mm: one edge for half a slot pitch lies up to 0.07 mm inside of the circle."""
    stator = V_SHAPE.stator
    drawing = stator.draw(Rim(15, EDGE, 2.0))
    edges = drawing.curves["outer", "outer_slot"][1]
    turn = stator.pitch / 2 / (2 * acos(1 - 0.02 * EDGE / stator.outer_radius))
    assert turn <= edges < turn + 1
