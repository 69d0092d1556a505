"""Masses and inertias of the drawn parts against a meshed machine, against bodies of one material and the thesis."""

from math import pi

import numpy as np
import pytest

from drivetrain.masses import CopperBars, DrawnParts, PartMaterials, SteelCylinder, part_masses
from geometry.cross_section import mesh_cross_section
from geometry.half_cell import MeshDensity
from geometry.winding import star_of_slots
from units import MILLIMETRE

MATERIALS = PartMaterials(7650.0, 7500.0, 8900.0, 7800.0, 0.95)
LENGTH = 36 * MILLIMETRE
FINE = MeshDensity(gap_edges=720, longest_gap_edge=0.5, across_iron=6)


def meshed(machine):
    """Mass [kg] and inertia [kg m^2] of every part of 36 mm of the machine, triangle by triangle."""
    section = mesh_cross_section(machine, star_of_slots(machine.slots, machine.pole_pairs, 2), FINE)
    corners = section.mesh.p[:, section.mesh.t]
    (ax, bx, cx), (ay, by, cy) = corners
    area = np.abs((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)) / 2
    sides = corners + np.roll(corners, 1, axis=1)
    square = (sides**2).sum(axis=(0, 1)) / 12  # mean of r^2 over a triangle: that of its edges' middles
    iron, copper = 7650 * 0.95, 0.3 * 8900
    densities = {"stator_iron": iron, "rotor_iron": iron, "magnet_": 7500, "shaft": 7800, "slot_": copper}
    found = {}
    for start, density in densities.items():
        cells = np.concatenate([where for name, where in section.mesh.subdomains.items() if name.startswith(start)])
        mass = section.sectors * density * LENGTH * area[cells]
        found[start] = mass.sum(), mass @ square[cells]
    return found, section.half_slot_area


@pytest.fixture(scope="module")
def machine(thesis):
    return thesis.section.machine


def test_parts_are_those_of_the_meshed_regions(machine):
    mesh, area = meshed(machine)
    found = part_masses(machine, LENGTH, CopperBars(0.3 * area, 24, 0.0), MATERIALS)
    assert found.stator_laminations == pytest.approx(mesh["stator_iron"][0], rel=2e-3)
    assert found.magnets == pytest.approx(mesh["magnet_"][0], rel=2e-3)
    assert found.magnets_inertia == pytest.approx(mesh["magnet_"][1], rel=2e-3)
    assert found.copper == pytest.approx(mesh["slot_"][0], rel=2e-3)
    core = [mesh["shaft"][k] + mesh["rotor_iron"][k] for k in range(2)]  # the mesh draws the shaft with few chords
    assert found.shaft + found.rotor_laminations == pytest.approx(core[0], rel=2e-3)
    assert found.shaft_inertia + found.rotor_laminations_inertia == pytest.approx(core[1], rel=2e-3)
    assert found.rotor_inertia == pytest.approx(sum(mesh[k][1] for k in ("shaft", "rotor_iron", "magnet_")), rel=2e-3)


def test_of_one_material_the_rotor_is_a_cylinder(thesis):
    steel = DrawnParts(PartMaterials(7800.0, 7800.0, 8900.0, 7800.0, 1.0), packing=0.3)
    cylinder = SteelCylinder(7800.0)
    inertia = cylinder.rotor_inertia(thesis.section, LENGTH)
    assert steel.rotor_inertia(thesis.section, LENGTH) == pytest.approx(inertia, rel=1e-12)


def test_the_cylinder_is_that_of_the_thesis(thesis):
    """1.57 kg and 5.16 kg at 2.261 mm/rad and 35.5 mm."""
    cylinder = SteelCylinder(7800.0)
    assert cylinder.mass(thesis.section, 35.5e-3) == pytest.approx(1.57, abs=0.005)
    assert cylinder.rotor_inertia(thesis.section, 35.5e-3) / 2.261e-3**2 == pytest.approx(5.16, abs=0.02)


def test_the_drawn_parts_are_a_quarter_lighter_than_the_cylinder(thesis):
    parts = DrawnParts(MATERIALS, packing=0.3).parts(thesis.section, LENGTH)
    assert 0.65 < parts.total / SteelCylinder(7800.0).mass(thesis.section, LENGTH) < 0.8
    assert parts.total == pytest.approx(sum(mass for _, mass, _ in parts.rows[:-1]), rel=1e-12)
    assert parts.rotor_inertia == pytest.approx(sum(inertia for *_, inertia in parts.rows[:-1]), rel=1e-12)


def test_copper_has_two_ends_to_a_turn(thesis):
    """One coil: two sides and two end turns; as the wire of the phase resistance."""
    section = thesis.section
    bars = section.copper(0.3)
    wire = 3 * section.coils_in_series * 2 * (LENGTH + section.end_turn_length)  # length of one turn of all coils
    assert bars.volume(LENGTH) == pytest.approx(0.3 * section.coil_side_area * wire, rel=1e-12)
    assert DrawnParts(MATERIALS, 0.3).parts(section, LENGTH).copper == pytest.approx(8900 * bars.volume(LENGTH))


def test_stacking_counts_for_laminations_alone(machine):
    bars = CopperBars(30e-6, 24, 16e-3)
    full, loose = (
        part_masses(machine, LENGTH, bars, PartMaterials(7650.0, 7500.0, 8900.0, 7800.0, k)) for k in (1.0, 0.9)
    )
    assert loose.stator_laminations == pytest.approx(0.9 * full.stator_laminations, rel=1e-12)
    assert loose.rotor_laminations_inertia == pytest.approx(0.9 * full.rotor_laminations_inertia, rel=1e-12)
    assert (loose.magnets, loose.shaft, loose.copper) == (full.magnets, full.shaft, full.copper)
    assert full.shaft == pytest.approx(7800 * pi * machine.shaft_radius**2 * LENGTH)
