"""Defects of one machine on the mesh of the whole: what moves, what stays, and what adds up to another machine."""

from dataclasses import replace
from math import cos, pi, sin

import numpy as np
import pytest
from numpy.testing import assert_allclose

from geometry.defects import (
    DynamicEccentricity,
    MagnetArc,
    MagnetPosition,
    SlotOpening,
    StaticEccentricity,
    ToothWidth,
    deformed,
    first_rotor_node,
)
from geometry.errors import GeometryError
from geometry.gap import GapHalf
from geometry.morph import Morpher
from tests.geometry.thesis_machine import MM, machine, section

AIRGAP = 0.5 * MM
ALL_KINDS = {
    "static": lambda amount: StaticEccentricity(amount * 0.2 * MM, 0.3),
    "dynamic": lambda amount: DynamicEccentricity(amount * 0.2 * MM, 0.3),
    "magnet position": lambda amount: MagnetPosition(3, amount * 0.02),
    "magnet arc": lambda amount: MagnetArc(3, amount * 0.02),
    "slot opening": lambda amount: SlotOpening(2, amount * 0.5 * MM),
    "tooth width": lambda amount: ToothWidth(2, amount * 0.5 * MM),
}
every_kind = pytest.mark.parametrize("kind", ALL_KINDS)


@pytest.fixture(scope="module")
def whole():
    return section(whole=True)


@pytest.fixture(scope="module")
def with_gaps():
    """Magnets of 0.9 of their pitch."""
    return section(whole=True, magnet_arc_fraction=0.9)


def region(s, name):
    """Corners of the triangles of a region (2, n)."""
    return s.mesh.p[:, np.unique(s.mesh.t[:, s.mesh.subdomains[name]])]


@every_kind
def test_nothing_moves_at_zero(whole, kind):
    assert np.array_equal(deformed(whole, ALL_KINDS[kind](0.0)).mesh.p, whole.mesh.p)


@every_kind
def test_nodes_move_smoothly(whole, kind):
    """In proportion to a small amount: the second difference is a thousandth of the first."""
    step = 1e-3
    forward, back = (deformed(whole, ALL_KINDS[kind](sign * step)).mesh.p for sign in (1, -1))
    assert np.abs(forward + back - 2 * whole.mesh.p).max() < 2e-3 * np.abs(forward - back).max()


@every_kind
def test_the_sliding_circle_stays(whole, kind):
    slides = [np.unique(whole.mesh.facets[:, whole.mesh.boundaries[f"{part}_slide"]]) for part in ("stator", "rotor")]
    moved = deformed(whole, ALL_KINDS[kind](1.0)).mesh.p
    assert np.abs(moved - whole.mesh.p)[:, np.concatenate(slides)].max() < 1e-15


@every_kind
def test_currents_stated_by_density_do_not_feel_a_defect(whole, kind):
    assert deformed(whole, ALL_KINDS[kind](1.0)).half_slot_area == pytest.approx(whole.half_slot_area, rel=1e-12)


def gap_at(s, angle):
    """Distance between the bore and the magnets at an angle [m]."""
    iron, magnets = region(s, "stator_iron"), np.hstack([region(s, f"magnet_{m}") for m in range(10)])
    radii = [np.hypot(*part) for part in (iron, magnets)]
    near = [np.abs(np.angle(np.exp(1j * (np.arctan2(part[1], part[0]) - angle)))) < 0.03 for part in (iron, magnets)]
    return radii[0][near[0]].min() - radii[1][near[1]].max()


@pytest.mark.parametrize("share", (0.2, 0.4))
def test_gap_of_an_eccentric_stator(whole, share):
    """g + e cos(phi - direction), to the second order in e/r and the width of the window."""
    moved = deformed(whole, StaticEccentricity(share * AIRGAP, pi / 6))
    for tooth in range(12):
        expected = AIRGAP * (1 + share * cos(tooth * pi / 6 - pi / 6))
        assert gap_at(moved, tooth * pi / 6) == pytest.approx(expected, abs=0.03 * share * AIRGAP + 1e-6)


@pytest.mark.parametrize("share", (0.2, 0.4))
def test_gap_of_an_eccentric_rotor(whole, share):
    moved = deformed(whole, DynamicEccentricity(share * AIRGAP, pi / 6))
    for tooth in range(12):
        expected = AIRGAP * (1 - share * cos(tooth * pi / 6 - pi / 6))
        assert gap_at(moved, tooth * pi / 6) == pytest.approx(expected, abs=0.03 * share * AIRGAP + 1e-6)


@pytest.mark.parametrize("direction", np.arange(8) * pi / 4)
def test_both_eccentricities_to_forty_per_cent_of_the_gap(whole, direction):
    moved = deformed(whole, StaticEccentricity(0.4 * AIRGAP, direction), DynamicEccentricity(0.4 * AIRGAP, 0.1))
    centres = moved.assembly.stator_centre, moved.assembly.rotor_centre
    assert_allclose(centres[0], 0.4 * AIRGAP * np.array([cos(direction), sin(direction)]))
    assert_allclose(centres[1], 0.4 * AIRGAP * np.array([cos(0.1), sin(0.1)]))


def test_the_parts_move_as_rigid_bodies(whole):
    shift = 0.2 * AIRGAP * np.array([cos(0.7), sin(0.7)])[:, None]
    stator = deformed(whole, StaticEccentricity(0.2 * AIRGAP, 0.7))
    rotor = deformed(whole, DynamicEccentricity(0.2 * AIRGAP, 0.7))
    for name in ("stator_iron", "slot_3_L", "opening"):
        assert_allclose(region(stator, name), region(whole, name) + shift, atol=1e-15)
        assert_allclose(region(rotor, name), region(whole, name), atol=0)
    for name in ("rotor_iron", "shaft", "magnet_3"):
        assert_allclose(region(rotor, name), region(whole, name) + shift, atol=1e-15)
        assert_allclose(region(stator, name), region(whole, name), atol=0)


def areas(s):
    """Of the coil sides by name, and of the slot openings by slot [m^2]."""
    a, b, c = (s.mesh.p[:, s.mesh.t[i]] for i in range(3))
    u, v = b - a, c - a
    area = (u[0] * v[1] - u[1] * v[0]) / 2
    sides = {f"{k}_{side}": area[s.mesh.subdomains[f"slot_{k}_{side}"]].sum() for k in range(12) for side in "RL"}
    opening = s.mesh.subdomains["opening"]
    x, y = (a + b + c)[:, opening]
    slots = np.floor(np.mod(np.arctan2(y, x), 2 * pi) / (pi / 6)).astype(int)
    return sides | dict(enumerate(np.bincount(slots, weights=area[opening])))


def changes(before, after):
    """What has changed of the areas, by more than a thousandth, and by what factor."""
    factors = {name: after[name] / before[name] for name in before}
    return {name: factor for name, factor in factors.items() if abs(factor - 1) > 1e-3}


def test_one_slot_opens_wider(whole):
    """2 mm to 2.5 mm: its opening, and the copper beside its taper by a little, but no other slot."""
    found = changes(areas(whole), areas(deformed(whole, SlotOpening(2, 0.5 * MM))))
    assert found.pop(2) == pytest.approx(1.25, rel=5e-3)
    assert set(found) <= {"2_R", "2_L"}


def test_one_tooth_is_wider(whole):
    """Half a millimetre shared by the coil sides on either side of tooth 2, some 21 mm deep."""
    found = changes(areas(whole), areas(deformed(whole, ToothWidth(2, 0.5 * MM))))
    assert set(found) == {"1_L", "2_R"}
    assert found["1_L"] == pytest.approx(found["2_R"], rel=1e-9)
    assert (1 - found["1_L"]) * whole.half_slot_area == pytest.approx(0.25 * MM * 20.1 * MM, rel=0.05)


def test_the_same_opening_of_all_slots_is_another_machine(whole):
    wider = deformed(whole, *(SlotOpening(slot, 0.3 * MM) for slot in range(12)))
    morpher = Morpher(whole)
    assert_allclose(wider.mesh.p, morpher.to(replace(machine(), slot_opening=2.3 * MM)).mesh.p, atol=1e-12)


def test_the_same_width_of_all_teeth_is_another_machine(whole):
    wider = deformed(whole, *(ToothWidth(tooth, 0.3 * MM) for tooth in range(12)))
    expected = Morpher(whole).to(replace(machine(), tooth_width=machine().tooth_width + 0.3 * MM))
    assert_allclose(wider.mesh.p, expected.mesh.p, atol=1e-12)


def test_the_same_arc_of_all_magnets_is_another_machine(with_gaps):
    """Two spellings of magnets of 0.95 of the pitch: the same edges, if not the same nodes in between."""
    arcs = deformed(with_gaps, *(MagnetArc(m, 0.05 * pi / 5) for m in range(10)))
    expected = Morpher(with_gaps).to(machine(magnet_arc_fraction=0.95))
    for s in (arcs, expected):
        x, y = region(s, "magnet_2")
        assert_allclose(np.ptp(np.arctan2(y, x)), 0.95 * pi / 5, rtol=1e-12)


@pytest.mark.parametrize("base", ("whole", "with_gaps"))
def test_the_same_error_of_all_magnets_turns_them(base, request):
    """Also where they touch and their joints lie midway."""
    s = request.getfixturevalue(base)
    turned = deformed(s, *(MagnetPosition(m, 0.01) for m in range(10)))
    c, n = cos(0.01), sin(0.01)
    for m in range(10):
        expected = np.array([[c, -n], [n, c]]) @ region(s, f"magnet_{m}")
        assert_allclose(region(turned, f"magnet_{m}"), expected, atol=1e-6)  # half of 0.01 twice is not 0.01
    assert turned.magnetisation_angle(4, np.array([0.01, 0.0])) == pytest.approx(4 * pi / 5 + 0.01)


def test_one_magnet_out_of_place_leaves_the_others(with_gaps):
    moved = deformed(with_gaps, MagnetPosition(3, 0.02))
    angle = [np.arctan2(*region(s, "magnet_3")[::-1]) for s in (with_gaps, moved)]
    assert_allclose(angle[1] - angle[0], 0.02, rtol=1e-9)
    for other in (2, 4, 9):
        assert_allclose(region(moved, f"magnet_{other}"), region(with_gaps, f"magnet_{other}"), atol=1e-15)


def test_a_machine_of_other_dimensions_with_defects(whole):
    """Dimensions and defects in one go: the gap of the wider machine, eccentric."""
    moved = Morpher(whole).to(machine(airgap=0.6 * MM), [StaticEccentricity(0.1 * MM, 0.0)])
    assert gap_at(moved, 0.0) == pytest.approx(0.7 * MM, rel=1e-3)
    assert gap_at(moved, pi) == pytest.approx(0.5 * MM, rel=1e-3)


@pytest.mark.parametrize(
    ("defect", "message"),
    (
        (StaticEccentricity(0.26 * MM), "half of the air gap"),
        (DynamicEccentricity(-0.26 * MM), "half of the air gap"),
        (MagnetPosition(10, 0.01), "no magnet 10"),
        (SlotOpening(12, 0.1 * MM), "no slot 12"),
        (SlotOpening(2, 2 * MM), "cut into the teeth"),
        (ToothWidth(-1, 0.1 * MM), "no tooth -1"),
        (MagnetPosition(3, 0.5), "turn over"),
    ),
)
def test_what_cannot_be_is_refused(whole, defect, message):
    with pytest.raises(GeometryError, match=message):
        deformed(whole, defect)


def test_a_sector_is_refused():
    with pytest.raises(GeometryError, match="mesh the whole machine"):
        deformed(section(), StaticEccentricity(0.1 * MM))


def test_a_moved_mesh_is_not_moved_again(whole):
    with pytest.raises(GeometryError, match="moved by defects already"):
        Morpher(deformed(whole, StaticEccentricity(0.1 * MM)))


def test_touching_magnets_do_not_become_others(whole):
    with pytest.raises(GeometryError, match="magnet_arc_fraction"):
        Morpher(whole).to(machine(magnet_arc_fraction=0.95))


@pytest.mark.parametrize("rim", (15.7 * MM, 16.2 * MM))
def test_height_between_eccentric_circles(rim):
    """A point of the circle about h c with the radius r_0 + h D has the height h; its gradient by differences."""
    gap = GapHalf(15.95 * MM, rim, (0.1 * MM, -0.05 * MM))
    angles, heights = np.linspace(0, 2 * pi, 13), np.linspace(0, 1, 5)[:, None]
    circle = (gap.slide_radius + heights * gap.depth) * np.stack([np.cos(angles), np.sin(angles)])[:, None]
    points = circle + heights * np.array(gap.rim_centre)[:, None, None]
    assert_allclose(gap.height(points), np.broadcast_to(heights, points.shape[1:]), atol=1e-12)
    step = 1e-8
    for axis in (0, 1):
        shift = step * np.eye(2)[axis][:, None, None]
        slope = (gap.height(points + shift) - gap.height(points - shift)) / (2 * step)
        assert_allclose(gap.gradient(points)[axis], slope, atol=1e-5 / abs(gap.depth))


def test_stator_nodes_come_first(whole):
    rotor, stator = (whole.mesh.t[:, whole.mesh.subdomains[name]] for name in ("magnet_0", "stator_iron"))
    assert rotor.min() >= first_rotor_node(whole) > stator.max()
