"""Planets that fit: phases of their teeth, distance of their tips, outlines without overlap, tips clear of fillets."""

import numpy as np
import pytest
from matplotlib.path import Path

from gearbox.errors import GearError
from gearbox.involute import Gear
from gearbox.outline import gear_outline, planet_phases, ring_phases, stage_outlines
from gearbox.planetary_set import PlanetarySet, equally_spaced, planetary_set, share_a_factor
from units import MILLIMETRE

MM = MILLIMETRE


def gears_of(sun, planet, ring, planets):
    return PlanetarySet(*(Gear(z, 0.0, MM, 0.0) for z in (sun, planet, -ring)), 1.0, planets)


@pytest.mark.parametrize("planets", [3, 4, 5])
def test_planets_can_be_put_in_where_every_one_asks_for_the_same_ring(planets):
    """Brute force: turn each planet into the sun, look where it wants the ring's teeth."""
    for sun in range(11, 24):
        for ring in range(50, 80):
            pitch = 2 * np.pi / ring
            asked = ring_phases(gears_of(sun, 20, ring, planets)) / pitch
            agree = np.allclose((asked - asked[0] + 0.5) % 1, 0.5, atol=1e-9)
            assert agree == equally_spaced(sun, -ring, planets), (sun, ring)


def test_common_factors():
    assert share_a_factor(14, 46) and not share_a_factor(46, -109)
    assert share_a_factor([14, 15], [49, 49]).tolist() == [True, False]


def test_gap_between_planets_from_their_centres(printed):
    centres = printed.centre_distance * np.exp(2j * np.pi * np.arange(3) / 3)
    gap = abs(centres[1] - centres[0]) - 2 * printed.planet.tip_radius
    assert printed.planet_gap == pytest.approx(gap, rel=1e-12) and gap / MM == pytest.approx(3.59, abs=0.01)


def test_drawn_teeth_mesh_without_overlap(printed):
    """No corner of sun or ring lies inside a planet by more than the chord error of the drawing."""
    outlines = stage_outlines(printed)
    for planet in outlines.planets:
        inside = Path(np.column_stack([planet.real, planet.imag]) / MM)
        for other in (outlines.sun, outlines.ring):
            points = np.column_stack([other.real, other.imag]) / MM
            deep = inside.contains_points(points, radius=-0.004) & inside.contains_points(points, radius=0.004)
            assert not deep.any()


def test_drawn_tooth_has_its_thickness(printed):
    outline = gear_outline(printed.planet)
    angle = np.angle(outline[np.isclose(np.abs(outline), printed.planet.tip_radius, rtol=1e-9)])
    first = np.sort(np.abs(angle))[:2]
    assert first.sum() * printed.planet.tip_radius == pytest.approx(printed.planet.tip_thickness, rel=1e-9)


def test_sun_tooth_faces_planet_space(printed):
    at = 2 * np.pi * np.arange(3) / 3
    sun_phase = at * 14 / (2 * np.pi) % 1
    planet_phase = (at + np.pi - planet_phases(printed)) * 46 / (2 * np.pi) % 1
    assert (sun_phase + planet_phase) % 1 == pytest.approx(np.full(3, 0.5))


def test_tips_keep_clearance_and_stay_off_the_fillets(printed):
    for mesh in (printed.sun_mesh, printed.ring_mesh):
        assert min(mesh.root_clearances) >= 0.25 * 0.75 * MM * (1 - 1e-9)
        assert min(mesh.flank_margins) >= -1e-12


def test_teeth_that_cannot_reach_each_other_are_named():
    with pytest.raises(GearError, match="teeth 14, 30, -109 of module 0.75 mm cannot mesh"):
        planetary_set((14, 30, -109), (0.4, 0.0), 0.75 * MM)
