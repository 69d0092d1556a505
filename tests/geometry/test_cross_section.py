"""The meshed cross-section: areas, symmetry, names, probes, and the same mesh every time."""

from math import pi

import numpy as np
import pytest

from geometry.checks import check_machine
from geometry.cross_section import mesh_cross_section
from geometry.errors import GeometryError
from geometry.half_cell import MeshDensity, half_cells
from geometry.magnetisation import ParallelMagnetisation, RadialMagnetisation
from geometry.winding import star_of_slots
from tests.geometry.thesis_machine import MM, machine, section


def areas(mesh):
    a, b, c = (mesh.p[:, mesh.t[i]] for i in range(3))
    u, v = b - a, c - a
    return (u[0] * v[1] - u[1] * v[0]) / 2


def test_hanselman_dimensions_of_the_thesis():
    m = machine()
    assert m.tooth_width == pytest.approx(5.5 * MM)
    assert m.shoe_d1 == m.shoe_d2 == pytest.approx(1.43 * MM)


def test_half_slot_area_of_the_reference():
    assert section().half_slot_area == pytest.approx(100.45e-6, rel=2e-3)  # arcs are polygons in the mesh


@pytest.mark.parametrize("slots", (9, 12, 15, 18, 24))
@pytest.mark.parametrize("whole", (False, True))
def test_sector_fills_its_share_of_the_machine(slots, whole):
    s = section(whole, slots=slots)
    assert areas(s.mesh).min() > 0
    assert areas(s.mesh).sum() * s.sectors == pytest.approx(pi * (42.5 * MM) ** 2, rel=5e-3)


def test_sectors_of_known_machines():
    assert (section().sectors, section().antiperiodic) == (2, True)
    assert (section(slots=9).sectors, section(slots=9).antiperiodic) == (1, False)
    assert (section(slots=15).sectors, section(slots=15).antiperiodic) == (5, False)


def test_every_triangle_has_exactly_one_region():
    s = section()
    counted = np.bincount(np.concatenate(list(s.mesh.subdomains.values())), minlength=s.mesh.nelements)
    assert (counted == 1).all()


def test_regions_stand_where_their_names_say():
    s = section(whole=True)
    centre = s.mesh.p[:, s.mesh.t].mean(axis=1)
    for name, at in (("slot_0_R", 7.5), ("slot_0_L", 22.5), ("slot_11_L", -7.5), ("slot_3_R", 97.5)):
        mean = centre[:, s.mesh.subdomains[name]].mean(axis=1)
        assert np.degrees(np.arctan2(mean[1], mean[0])) == pytest.approx(at, abs=4)
    mean = centre[:, s.mesh.subdomains["magnet_1"]].mean(axis=1)
    assert np.degrees(np.arctan2(mean[1], mean[0])) == pytest.approx(36)


def test_sliding_circle_has_equal_steps_on_both_sides():
    s = section()
    for name in ("stator_slide", "rotor_slide"):
        nodes = np.unique(s.mesh.facets[:, s.mesh.boundaries[name]])
        angles = np.sort(np.arctan2(*s.mesh.p[::-1, nodes]))
        assert np.diff(angles) == pytest.approx(2 * pi / MeshDensity().edges_around(s.machine))


def test_probes_lie_in_teeth_and_back_iron():
    s = section()
    assert [probe.name for probe in s.tooth_probes] == [f"tooth_{k}" for k in range(6)]
    for probe in s.tooth_probes + s.back_iron_probes:
        assert probe.weights.sum() == pytest.approx(1.0)
    across = np.hypot(*(s.tooth_probes[2].points[:, -1] - s.tooth_probes[2].points[:, 0]))
    assert across == pytest.approx(5.5 * MM, rel=0.03)  # Gauss points end short of the flanks


def test_mesh_does_not_depend_on_what_was_meshed_before():
    first = half_cells(machine(), MeshDensity())[0].mesh(machine())
    half_cells(machine(slots=9), MeshDensity())[0].mesh(machine(slots=9))
    again = half_cells(machine(), MeshDensity())[0].mesh(machine())
    assert (first.points == again.points).all() and (first.triangles == again.triangles).all()


def test_magnet_arc_below_one_leaves_room_between_the_magnets():
    s = section(magnet_arc_fraction=0.8)
    magnets = sum(areas(s.mesh)[s.mesh.subdomains[f"magnet_{m}"]].sum() for m in range(5))
    between = areas(s.mesh)[s.mesh.subdomains["between"]].sum()
    assert magnets / (magnets + between) == pytest.approx(0.8, abs=1e-3)


def test_magnetisation_patterns():
    assert ParallelMagnetisation().direction_angle(0.3, 0.1, 0.6) == pytest.approx(0.1)
    assert RadialMagnetisation().direction_angle(0.3, 0.1, 0.6) == pytest.approx(0.3)


@pytest.mark.parametrize(
    "changes, words",
    (
        ({"airgap": -0.5 * MM}, "airgap must be a positive"),
        ({"airgap": float("nan")}, "airgap must be a positive finite"),
        ({"back_iron_width": 6.3 * MM}, "teeth .* wider than the slot pitch .* reduce back_iron_width"),
        ({"back_iron_width": 5.08 * MM}, "shoes of neighbouring teeth touch"),
        ({"rotor_outer_radius": 7.0 * MM, "back_iron_width": 1.5 * MM}, "inside the shaft"),
        ({"stator_outer_radius": 18 * MM}, "bore radius .* must be smaller"),
        ({"rotor_outer_radius": 36 * MM}, "no room is left for copper"),
        ({"slot_opening": 9 * MM}, "slot_opening .* exceeds the slot pitch"),
        ({"magnet_arc_fraction": 1.2}, "neighbouring magnets touch"),
    ),
)
def test_what_cannot_be_built_is_said_with_the_parameter_to_move(changes, words):
    with pytest.raises(GeometryError, match=words):
        check_machine(machine(**changes))


def test_an_infeasible_machine_is_refused_before_meshing():
    with pytest.raises(GeometryError, match="wider than the slot pitch"):
        mesh_cross_section(machine(back_iron_width=7 * MM), star_of_slots(12, 5))
