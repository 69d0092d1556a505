"""Steel damaged along its edges: how much of it, where, and what that does."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from geometry.half_cell import MeshDensity
from magnetostatics.cut_edge import CutEdge, damaged_share
from magnetostatics.flux_linkage import phase_flux_linkage
from magnetostatics.model import OperatingPoint
from magnetostatics.torque import arkkio_torque
from materials.errors import MaterialError
from materials.reluctivity import LinearReluctivity
from tests.magnetostatics.reference_machine import (
    MATERIALS,
    STEEL,
    SWEEP,
    TIGHT,
    model_of,
    reference_machine,
    section_of,
)
from units import MU_0

POINT = OperatingPoint(-0.36, 8.485e6)
REGION = "stator_iron"
RESOLVED = MeshDensity(gap_edges=360, across_iron=10.0)  # elements of the depth of the damage


def areas(section):
    a, b, c = (section.mesh.p[:, section.mesh.t[i, section.mesh.subdomains[REGION]]] for i in range(3))
    u, v = b - a, c - a
    return np.abs(u[0] * v[1] - u[1] * v[0]) / 2


def perimeter(m):
    """Of the stator iron by its dimensions: bore, openings, tapers, flanks, slot bottoms, outer circle [m]."""
    tip = np.arcsin(m.opening_width / 2 / m.stator_inner_radius)
    tip_top = m.slot_pitch / 2 - np.arcsin(m.opening_width / 2 / (m.stator_inner_radius + m.shoe_d1))
    top = (m.stator_inner_radius + m.shoe_d1) * np.exp(1j * tip_top)
    shoe = m.shoe_top_radius * np.exp(1j * np.arcsin(m.tooth_width / 2 / m.shoe_top_radius))
    end = m.slot_bottom_radius * np.exp(1j * np.arcsin(m.tooth_width / 2 / m.slot_bottom_radius))
    bore = m.stator_inner_radius * np.exp(1j * (m.slot_pitch / 2 - tip))
    straight = abs(top - bore) + abs(shoe - top) + abs(end - shoe)
    arcs = np.angle(bore) * m.stator_inner_radius + (m.slot_pitch / 2 - np.angle(end)) * m.slot_bottom_radius
    return 2 * m.slots * (straight + arcs) + 2 * np.pi * m.stator_outer_radius


@pytest.mark.parametrize("whole", (False, True))
@pytest.mark.parametrize("depth", (0.1e-3, 0.3e-3, 0.5e-3))
def test_damaged_area_is_a_third_of_the_strip_along_the_edges(depth, whole):
    """integral of (1 - x/delta)^2 over the strip is delta/3 per length of edge, corners apart."""
    section = section_of(reference_machine(), SWEEP, whole)
    damaged = section.sectors * damaged_share(section, REGION, depth) @ areas(section)
    assert damaged == pytest.approx(depth / 3 * perimeter(reference_machine()), rel=2e-2)


def test_damaged_area_does_not_depend_on_the_mesh():
    sections = [section_of(reference_machine(), density) for density in (SWEEP, RESOLVED)]
    damaged = [damaged_share(s, REGION, 0.5e-3) @ areas(s) for s in sections]
    assert damaged[1] == pytest.approx(damaged[0], rel=2e-3)


def test_ends_of_a_sector_are_no_cut_edges():
    """In the sector every tooth is damaged as in the whole machine."""
    sector, whole = (section_of(reference_machine(), SWEEP, flag) for flag in (False, True))
    assert damaged_share(sector, REGION, 0.5e-3) == pytest.approx(
        damaged_share(whole, REGION, 0.5e-3)[: len(sector.mesh.subdomains[REGION])], abs=1e-9
    )


def test_elements_far_from_the_edges_are_sound():
    section = section_of(reference_machine())
    share = damaged_share(section, REGION, 0.3e-3)
    radius = np.hypot(*section.mesh.p[:, section.mesh.t[:, section.mesh.subdomains[REGION]]])  # of the corners
    outer, slot_bottom = 42.5e-3, 42.5e-3 - 3.3e-3
    middle = (radius < outer - 0.3e-3).all(axis=0) & (radius > slot_bottom + 0.3e-3).all(axis=0)  # inside the back iron
    assert middle.any() and share[middle].max() == 0.0
    assert 0 <= share.min() and share.max() < 1


def test_the_law_of_an_element():
    """Linear steel: permeability (1 - s eta) of the sound one, but for mu_0."""
    section, depth, severity = section_of(reference_machine()), 0.5e-3, 0.4
    law = CutEdge(LinearReluctivity(1000.0), depth, severity).in_region(section, REGION)
    share = damaged_share(section, REGION, depth)
    expected = MU_0 * (1 + 999.0 * (1 - severity * share))
    assert_allclose(1 / law.nu(np.full((3, len(share)), 0.49)), np.broadcast_to(expected, (3, len(share))), rtol=1e-10)


def test_no_severity_is_the_steel_itself():
    assert CutEdge(STEEL, 0.5e-3, 0.0).in_region(section_of(reference_machine()), REGION) is STEEL


def effect(density, severity=0.5, depth=0.5e-3, amplitude=8.485e6):
    """Change of torque [Nm/m] and of the first phase's flux linkage [Wb/m]."""
    sound = model_of(reference_machine(), density, settings=TIGHT)
    cut = sound.like(materials=replace(MATERIALS, stator_steel=CutEdge(STEEL, depth, severity)))
    fields = [model.solve(replace(POINT, current_density=amplitude)) for model in (cut, sound)]
    return np.subtract(*[(arkkio_torque(field), phase_flux_linkage(field)[0]) for field in fields])


def test_damage_costs_torque_and_flux_smoothly():
    """Both fall, in a share of a few thousandths, in proportion to a small severity."""
    small, double = effect(SWEEP, 0.05), effect(SWEEP, 0.1)
    assert (double < 0).all()
    assert_allclose(double, 2 * small, rtol=0.05)
    assert -5e-3 * 55 < effect(SWEEP)[0] < 0


@pytest.mark.parametrize("amplitude", (8.485e6, 28e6))
def test_effect_on_a_mesh_coarser_than_the_depth(amplitude):
    """Within 12 % of that on elements of half a millimetre, where flux and damage share an element."""
    assert_allclose(effect(SWEEP, amplitude=amplitude), effect(RESOLVED, amplitude=amplitude), rtol=0.12)


def test_impossible_damage_is_refused():
    with pytest.raises(MaterialError, match="depth"):
        CutEdge(STEEL, 0.0, 0.5)
    with pytest.raises(MaterialError, match="below 1"):
        CutEdge(STEEL, 0.5e-3, 1.0)
