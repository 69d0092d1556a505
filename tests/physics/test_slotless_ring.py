"""The field solver against exact series of a slotless surface-magnet ring (Zhu and Howe 1993, own derivation)."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from math import pi

import numpy as np
import pytest
from numpy.testing import assert_allclose

from geometry.magnetisation import HalbachMagnetisation, ParallelMagnetisation, RadialMagnetisation
from magnetostatics.flux_linkage import phase_flux_linkage
from magnetostatics.model import FieldModel, OperatingPoint
from magnetostatics.torque import arkkio_torque, maxwell_torque
from tests.physics.ring_series import Layer, magnet_harmonic, solve_layers, zhu_howe_radial
from tests.physics.slotless_ring import (
    EXACT,
    POLE_PAIRS,
    Ring,
    SheetModel,
    exact_flux_linkage,
    exact_radial_harmonic,
    radial_harmonic,
    ring_section,
    winding_harmonic,
    with_machine,
)
from units import DEGREE

pytestmark = pytest.mark.physics

SHEET = 3e4 * np.exp(0.3j)  # A/m, about that of the slotted machine at 6 A/mm^2; any phase
BETWEEN_NODES = 1.7 * DEGREE  # the rotor-side gap is sheared by three tenths of an edge
PERMEABILITIES = (1.0, 1.05)
both_magnetisations = pytest.mark.parametrize("magnetisation", (ParallelMagnetisation(), RadialMagnetisation()))
both_permeabilities = pytest.mark.parametrize("permeability", PERMEABILITIES)


def ring_of(magnetisation, permeability, **changes):
    return with_machine(Ring(recoil_permeability=permeability), magnetisation=magnetisation, **changes)


@cache
def section_of(machine, edges_per_half_slot=6, gap_layers=1):
    return ring_section(machine, edges_per_half_slot, gap_layers)


@pytest.mark.parametrize("arc", (1.0, 0.8))
@pytest.mark.parametrize("order", (5, 15, 35))
@both_permeabilities
@both_magnetisations
def test_own_series_agrees_with_zhu_and_howe(magnetisation, permeability, order, arc):
    """Two derivations of one field; theirs is for infinitely permeable iron, ours takes 1e9."""
    parallel = isinstance(magnetisation, ParallelMagnetisation)
    radial, tangential = magnet_harmonic(order, POLE_PAIRS, 1.3, arc, parallel)
    core, magnet, bore, r = 13.2e-3, 15.7e-3, 20e-3, 16e-3
    layers = (
        Layer(8e-3, core, 1e9),
        Layer(core, magnet, permeability, radial, tangential),
        Layer(magnet, bore),
        Layer(bore, 26e-3, 1e9),
    )
    expected = zhu_howe_radial(order, POLE_PAIRS, 1.3, arc, parallel, permeability, core, magnet, bore, r)
    assert_allclose(solve_layers(order, layers).radial(r), expected, rtol=1e-8)


def test_torque_of_the_series_is_the_force_on_the_sheet():
    """Maxwell stress in the gap equals -integral R B_r K R dphi over the sheet, with B_r of the magnets alone."""
    ring = Ring()
    m = ring.machine
    force = -pi * m.slot_bottom_radius**2 * (SHEET * np.conj(ring.field(5).radial(m.slot_bottom_radius))).real
    assert_allclose(ring.field(5, sheet=SHEET).torque(m.mid_gap_radius), force, rtol=1e-12)


@pytest.mark.parametrize("angle", (0.0, BETWEEN_NODES))
@both_permeabilities
@both_magnetisations
def test_first_harmonic_in_the_gap(magnetisation, permeability, angle):
    """Size and phase of the first harmonic of B_r, rotor on the nodes and between them."""
    ring = ring_of(magnetisation, permeability)
    solution = FieldModel(section_of(ring.machine), ring.materials, EXACT).solve(OperatingPoint(angle))
    assert_allclose(radial_harmonic(solution, 5), exact_radial_harmonic(ring, 5, angle=angle), rtol=2e-6)


@both_magnetisations
def test_magnets_that_cover_two_thirds_of_a_pole(magnetisation):
    """Air between magnets of mu_r = 1: the series still holds; first, third (none when radial) and fifth harmonic."""
    ring = ring_of(magnetisation, 1.0, magnet_arc_fraction=2 / 3)
    solution = FieldModel(section_of(ring.machine), ring.materials, EXACT).solve(OperatingPoint(BETWEEN_NODES))
    found = [radial_harmonic(solution, k) for k in (5, 15, 25)]
    exact = [exact_radial_harmonic(ring, k, angle=BETWEEN_NODES) for k in (5, 15, 25)]
    assert_allclose(found, exact, rtol=1e-4, atol=1e-4 * abs(exact[0]))


@pytest.mark.parametrize("angle", (0.0, BETWEEN_NODES))
def test_an_ideal_halbach_ring_has_one_harmonic_on_the_side_of_the_gap(angle):
    """M = B_r (cos(p phi), -sin(p phi)) in polar components: exact, and hardly any flux in the core."""
    ring = ring_of(HalbachMagnetisation(), 1.0)
    solution = FieldModel(section_of(ring.machine, 12, 2), ring.materials, EXACT).solve(OperatingPoint(angle))
    core, magnet, *outside = ring.layers(5, angle=angle)
    turned, gap = ring.remanence * np.exp(-5j * angle), (ring.machine.mid_gap_radius, ring.machine.stator_inner_radius)
    exact = solve_layers(5, (core, replace(magnet, radial=turned, tangential=1j * turned), *outside))
    found = [radial_harmonic(solution, k) for k in (5, 15, 25)]
    assert_allclose(found[0], exact.ring_mean(exact.radial, *gap), rtol=1e-5)
    assert max(map(abs, found[1:])) < 1e-4 * abs(found[0])
    assert abs(exact.radial(0.9 * ring.machine.rotor_core_radius)) < 0.1 * abs(found[0])


@pytest.mark.parametrize("iron", (20.0, 1e3))
def test_iron_of_finite_permeability(iron):
    """Iron that needs field strength of its own, down to a permeability where a fifth of the flux is lost in it."""
    ring = Ring(recoil_permeability=1.05, iron_permeability=iron)
    solution = FieldModel(section_of(ring.machine), ring.materials, EXACT).solve(OperatingPoint(BETWEEN_NODES))
    assert_allclose(radial_harmonic(solution, 5), exact_radial_harmonic(ring, 5, angle=BETWEEN_NODES), rtol=1e-5)


@pytest.mark.parametrize("route", (arkkio_torque, maxwell_torque))
@pytest.mark.parametrize("angle", (0.0, BETWEEN_NODES))
@both_permeabilities
@both_magnetisations
def test_torque_of_a_sinusoidal_current_sheet(magnetisation, permeability, angle, route):
    """Only the first harmonic of the magnets meets the sheet; the series gives the torque in closed form."""
    ring = ring_of(magnetisation, permeability)
    model = SheetModel(section_of(ring.machine, 12, 2), ring.materials, EXACT, sheet=SHEET)
    exact = ring.field(5, angle=angle, sheet=SHEET).torque(ring.machine.mid_gap_radius)
    assert_allclose(route(model.solve(OperatingPoint(angle))), exact, rtol=1e-3)


@pytest.mark.parametrize("route", (arkkio_torque, maxwell_torque))
def test_no_torque_without_current(route):
    """A smooth ring has no cogging, wherever its rotor stands."""
    ring = Ring()
    model = FieldModel(section_of(ring.machine, 12, 2), ring.materials, EXACT)
    rated = abs(ring.field(5, sheet=SHEET).torque(ring.machine.mid_gap_radius))
    for angle in (0.0, 0.25 * DEGREE, BETWEEN_NODES):
        assert abs(route(model.solve(OperatingPoint(angle)))) < 1e-3 * rated


ORDERS = range(5, 1000, 10)


@pytest.fixture(scope="module")
def wound():
    """The ring with the currents of its winding in the copper, and the exact field of every order."""
    ring = Ring(recoil_permeability=1.05)
    section = section_of(ring.machine, 12, 2)
    point = OperatingPoint(BETWEEN_NODES, 30e6, 0.4, packing_factor=0.3)
    densities = 0.3 * point.phase_densities(POLE_PAIRS, section.layout.phase_axis)
    fields = [ring.field(k, angle=point.angle, current=winding_harmonic(section.layout, densities, k)) for k in ORDERS]
    return ring, FieldModel(section, ring.materials, EXACT).solve(point), fields


@pytest.mark.parametrize("route", (arkkio_torque, maxwell_torque))
def test_torque_of_the_winding(wound, route):
    """Conventions of winding, currents, angle and torque together, against the series summed over 100 orders."""
    ring, solution, fields = wound
    exact = sum(field.torque(ring.machine.mid_gap_radius) for field in fields)
    assert_allclose(route(solution), exact, rtol=1e-3)


def test_flux_linkage_of_the_winding(wound):
    ring, solution, fields = wound
    exact = exact_flux_linkage(ring, solution.model.section.layout, fields)
    assert_allclose(phase_flux_linkage(solution), exact, rtol=2e-4, atol=2e-4 * np.abs(exact).max())


def test_motoring_torque_on_the_q_axis_is_positive(wound):
    """gamma = 0 puts all current on the q axis: torque per current is largest there and turns the rotor forwards."""
    ring, _, _ = wound
    model = FieldModel(section_of(ring.machine), ring.materials, EXACT)
    torques = [arkkio_torque(model.solve(OperatingPoint(0.0, 8e6, gamma))) for gamma in (-pi / 6, 0.0, pi / 6, pi)]
    assert torques[1] > max(torques[0], torques[2]) > 0
    assert_allclose(torques[0], torques[2], rtol=2e-3)
    assert_allclose(torques[3], -torques[1], rtol=1e-9)
