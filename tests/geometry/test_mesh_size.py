"""The size of a mesh is known before it is made, and thin parts or few slots do not blow it up."""

from dataclasses import replace
from math import pi

import pytest

from geometry.cross_section import mesh_cross_section
from geometry.errors import GeometryError
from geometry.half_cell import MeshDensity, half_cells
from geometry.machine import Machine, hanselman_machine
from geometry.mesh_size import LARGEST_MESH, check_mesh_size, expected_triangles, expected_unknowns
from geometry.winding import star_of_slots

DETAILED = MeshDensity(gap_edges=360, longest_gap_edge=0.75, gap_layers=2, across_iron=3.0)


def machine(slots=12, pole_pairs=5, **changes) -> Machine:
    drawn = hanselman_machine(
        slots=slots,
        pole_pairs=pole_pairs,
        stator_outer_radius=42.5e-3,
        rotor_outer_radius=15.7e-3,
        back_iron_width=3.3e-3,
        magnet_length=2.5e-3,
        airgap=0.5e-3,
        slot_opening=2e-3,
        shoe_depth_fraction=0.52,
        shoe_aspect_ratio=1.0,
        shaft_radius=5e-3,
    )
    return replace(drawn, **changes)


MACHINES = {
    "reference": machine(),
    "three slots": machine(3, 1),
    "thin teeth": machine(tooth_width=0.3e-3),
    "thin back iron": machine(back_iron_width=0.3e-3, tooth_width=5e-3),
    "thin shoes": machine(6, 2, tooth_width=3e-3, shoe_d1=0.05e-3, shoe_d2=0.05e-3),
    "many slots": machine(48, 4, tooth_width=1e-3, slot_opening=0.5e-3),
    "narrow gap": machine(airgap=0.05e-3),
}


@pytest.mark.parametrize("drawn", MACHINES.values(), ids=MACHINES.keys())
@pytest.mark.parametrize("density", [MeshDensity(), DETAILED], ids=["sweep", "detailed"])
def test_the_estimate_is_right_within_a_factor_of_three(drawn, density):
    for cell in half_cells(drawn, density):
        found = len(cell.mesh(drawn).triangles)
        assert found / 3 < expected_triangles(cell, drawn) < 3 * found


@pytest.mark.parametrize("slots, pole_pairs", [(3, 1), (6, 1), (6, 2), (12, 5)])
@pytest.mark.parametrize("depth", [0.05e-3, 0.3e-3, 1.144e-3])
def test_a_shoe_over_a_wide_angle_does_not_cut_through_the_bore(slots, pole_pairs, depth):
    """A straight taper over 50 degrees of a flat shoe would: the outline crossed itself and was never meshed."""
    drawn = machine(slots, pole_pairs, tooth_width=3e-3, shoe_d1=depth, shoe_d2=depth)
    section = mesh_cross_section(drawn, star_of_slots(slots, pole_pairs))
    (x, u, s), (y, v, t) = section.mesh.p[:, section.mesh.t]
    areas = ((u - x) * (t - y) - (s - x) * (v - y)) / 2
    assert areas.min() > 0
    assert areas.sum() == pytest.approx(pi * drawn.stator_outer_radius**2 / section.sectors, rel=0.01)


def test_the_taper_of_usual_machines_starts_at_the_opening():
    assert not machine().taper_touches_shoe and machine(3, 1).taper_touches_shoe
    assert machine().taper_angle == machine().opening_top_angle


def test_thin_teeth_refine_the_teeth_and_nothing_else():
    thin = expected_unknowns(machine(tooth_width=0.3e-3), MeshDensity(), 2)
    assert thin < 12 * expected_unknowns(machine(), MeshDensity(), 2)


TOO_LARGE = {
    "elements": (machine(), MeshDensity(across_iron=80.0), "reduce across_iron"),
    "edges": (machine(), MeshDensity(gap_edges=50000), "reduce gap_edges"),
    "gap": (machine(airgap=2e-6), MeshDensity(), "enlarge airgap"),
    "tooth": (machine(tooth_width=0.02e-3), MeshDensity(), "enlarge tooth_width"),
    "slots and poles": (machine(360, 179, tooth_width=0.1e-3, slot_opening=0.1e-3), MeshDensity(), "360 and 358 meet"),
}


@pytest.mark.parametrize("drawn, density, advice", TOO_LARGE.values(), ids=TOO_LARGE.keys())
def test_a_mesh_that_nobody_can_solve_is_refused_with_what_to_change(drawn, density, advice):
    with pytest.raises(GeometryError, match=advice) as caught:
        check_mesh_size(drawn, density)
    assert "000 unknowns, more than the 300 000" in str(caught.value)


def test_meshing_asks_first():
    with pytest.raises(GeometryError, match="reduce across_iron"):
        mesh_cross_section(machine(), star_of_slots(12, 5), MeshDensity(across_iron=80.0))


def test_the_machines_of_the_studies_are_far_from_the_limit():
    assert expected_unknowns(machine(), MeshDensity()) < LARGEST_MESH / 20


@pytest.mark.parametrize("drawn", [m for m in MACHINES.values()], ids=MACHINES.keys())
def test_the_drawn_half_slot_has_the_area_of_the_meshed_one(drawn):
    layout = star_of_slots(drawn.slots, drawn.pole_pairs)
    meshed = mesh_cross_section(drawn, layout, DETAILED).half_slot_area
    assert drawn.half_slot_area == pytest.approx(meshed, rel=0.02 if drawn.slots == 3 else 2e-3)
