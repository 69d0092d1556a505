"""Moved meshes: exact on the first machine, on the outline of others, refused when triangles turn over."""

import numpy as np
import pytest

from geometry.errors import GeometryError
from geometry.morph import Morpher
from tests.geometry.thesis_machine import MM, machine, section


@pytest.fixture(scope="module")
def base():
    return section()


def test_moving_onto_the_same_machine_moves_nothing(base):
    assert np.abs(Morpher(base).to(machine()).mesh.p - base.mesh.p).max() < 1e-15


@pytest.mark.parametrize(
    "changes",
    (
        {"back_iron_width": 4.0 * MM},
        {"rotor_outer_radius": 14.5 * MM},
        {"airgap": 0.7 * MM},
        {"slot_opening": 1.5 * MM},
    ),
)
def test_moved_regions_have_the_areas_of_a_new_mesh(base, changes):
    moved, new = Morpher(base).to(machine(**changes)), section(**changes)
    for name in ("stator_iron", "slot_0_R", "magnet_0", "rotor_iron", "opening", "gap"):
        assert area(moved, name) == pytest.approx(area(new, name), rel=5e-3)


def area(s, name):
    a, b, c = (s.mesh.p[:, s.mesh.t[i, s.mesh.subdomains[name]]] for i in range(3))
    u, v = b - a, c - a
    return ((u[0] * v[1] - u[1] * v[0]) / 2).sum()


def test_the_sliding_circle_stays_equally_spaced(base):
    moved = Morpher(base).to(machine(rotor_outer_radius=15.0 * MM))
    nodes = np.unique(moved.mesh.facets[:, moved.mesh.boundaries["stator_slide"]])
    x, y = moved.mesh.p[:, nodes]
    assert np.hypot(x, y) == pytest.approx(15.25 * MM)
    assert np.ptp(np.diff(np.sort(np.arctan2(y, x)))) < 1e-12


def test_nodes_move_smoothly_with_a_dimension(base):
    morpher, step = Morpher(base), 1e-6
    forward, back = (morpher.to(machine(back_iron_width=3.3 * MM + d)).mesh.p for d in (step, -step))
    curvature = np.abs(forward + back - 2 * base.mesh.p).max()
    assert curvature < 1e-3 * np.abs(forward - back).max()


def test_too_far_is_refused(base):
    with pytest.raises(GeometryError, match="mesh"):
        Morpher(base).to(machine(stator_outer_radius=22 * MM, back_iron_width=1.5 * MM, rotor_outer_radius=18 * MM))
    with pytest.raises(GeometryError, match="same slots and poles"):
        Morpher(base).to(machine(slots=9))
