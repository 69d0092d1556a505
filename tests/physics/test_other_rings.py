"""Rotors of other kinds in a stator that the field does not see, against exact series: magnets and a ring of iron."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from geometry.half_cell import MeshDensity
from geometry.magnetisation import HalbachMagnetisation, ParallelMagnetisation, RadialMagnetisation
from geometry.parts import ComposedMachine
from geometry.rotors.surface_magnets import SurfaceMagnets
from magnetostatics.currents import PhaseCurrents
from magnetostatics.model import FieldModel, MachineMaterials
from magnetostatics.newton import NewtonSettings
from materials.magnet import Magnet
from materials.reluctivity import LinearReluctivity
from tests.magnetostatics.other_machines import OUTRUNNER, STATOR, section_of
from tests.physics.ring_series import Layer, magnet_harmonic, solve_layers
from tests.physics.slotless_ring import radial_harmonic

pytestmark = pytest.mark.physics

FINE = MeshDensity(gap_edges=720, longest_gap_edge=1.0, gap_layers=3, across_iron=2.0)
IRON, REMANENCE = 500.0, 1.2
AXIS = 1e-4  # m, where the innermost layer begins in the place of the axis
INSIDE = ComposedMachine(STATOR, SurfaceMagnets(10, 15.7e-3, 2.5e-3, 5.0e-3, 0.8, ParallelMagnetisation()))
PATTERNS = {"parallel": ParallelMagnetisation(), "radial": RadialMagnetisation(), "halbach": HalbachMagnetisation()}


def turn_of(machine):
    """How fast the direction of a magnet falls behind the radius."""
    pattern, outside = machine.rotor.magnetisation, machine.rotor.rim_radius > machine.stator.rim_radius
    if isinstance(pattern, HalbachMagnetisation):
        return -machine.pole_pairs if outside else machine.pole_pairs
    return 1 if isinstance(pattern, ParallelMagnetisation) else 0


def layers(machine, order, angle):
    """From the axis out: what the field sees, magnets of the permeability of air."""
    rotor = machine.rotor
    magnets = magnet_harmonic(order, machine.pole_pairs, REMANENCE, rotor.arc_fraction, turn_of(machine))
    radial, tangential = (one * np.exp(-1j * order * angle) for one in magnets)
    if rotor.rim_radius < machine.stator.rim_radius:
        return (
            Layer(AXIS, rotor.shaft_radius),
            Layer(rotor.shaft_radius, rotor.core_radius, IRON),
            Layer(rotor.core_radius, rotor.outer_radius, 1.0, radial, tangential),
            Layer(rotor.outer_radius, machine.stator.outer_radius),
        )
    back = rotor.inner_radius + rotor.magnet_length
    return (
        Layer(AXIS, rotor.inner_radius),
        Layer(rotor.inner_radius, back, 1.0, radial, tangential),
        Layer(back, back + rotor.back_iron_width, IRON),
        Layer(back + rotor.back_iron_width, rotor.air_radius),
    )


def solved(machine, angle, density=FINE):
    unseen, iron = LinearReluctivity(1.0), LinearReluctivity(IRON)
    materials = MachineMaterials(unseen, iron, Magnet(REMANENCE, 1.0))
    model = FieldModel(section_of(machine, density), materials, NewtonSettings(1e-9))
    return model.solve(PhaseCurrents(angle, (0.0, 0.0, 0.0)))


def exact_harmonic(machine, order, angle):
    inner, outer = sorted((machine.mid_gap_radius, machine.stator.rim_radius))
    found = solve_layers(order, layers(machine, order, angle))
    return found.ring_mean(found.radial, inner, outer)


@pytest.mark.parametrize("pattern", PATTERNS)
@pytest.mark.parametrize("drawn", (OUTRUNNER, INSIDE), ids=("outside", "inside"))
def test_harmonics_of_the_flux_density_in_the_gap(drawn, pattern):
    """First, third and fifth, of magnets that leave air between them, in a thin cup with air around it."""
    machine = replace(drawn, rotor=replace(drawn.rotor, magnetisation=PATTERNS[pattern]))
    angle, orders = 0.0137, drawn.pole_pairs * np.array([1, 3, 5])
    solution = solved(machine, angle)
    exact = np.array([exact_harmonic(machine, int(k), angle) for k in orders])
    assert_allclose([radial_harmonic(solution, k) for k in orders], exact, atol=3e-4 * abs(exact[0]))


@pytest.mark.parametrize("turn", (0, 1, 6, -6), ids=("radial", "parallel", "halbach", "halbach outside"))
@pytest.mark.parametrize("arc", (0.6, 1.0))
@pytest.mark.parametrize("order", (6, 18, 30))
def test_series_of_magnets_is_that_of_their_directions(order, arc, turn):
    """Its integral over one magnet; a magnet of the other polarity adds as much."""
    half = arc * np.pi / 12
    place, weight = np.polynomial.legendre.leggauss(80)
    magnet = REMANENCE * np.exp(-1j * turn * half * place)
    wave = 12 / np.pi * half * weight * np.exp(-1j * order * half * place)
    expected = np.sum(magnet.real * wave), np.sum(magnet.imag * wave)
    assert_allclose(magnet_harmonic(order, 6, REMANENCE, arc, turn), expected, atol=1e-13)


def fundamental_error(machine, edges):
    """Relative, of the flux density in the gap; layers of the gap and elements across the iron follow the edges."""
    density = MeshDensity(gap_edges=edges, longest_gap_edge=1.0, gap_layers=3 * edges // 720, across_iron=edges / 360)
    exact = exact_harmonic(machine, machine.pole_pairs, 0.0)
    return abs(radial_harmonic(solved(machine, 0.0, density), machine.pole_pairs) / exact - 1)


@pytest.mark.parametrize("pattern", PATTERNS)
def test_error_falls_with_the_edges_around_the_gap(pattern):
    """Fourfold with three times as many; not ninefold, as of straight edges for arcs: cup and air do not follow."""
    machine = replace(OUTRUNNER, rotor=replace(OUTRUNNER.rotor, magnetisation=PATTERNS[pattern]))
    coarse, fine = (fundamental_error(machine, edges) for edges in (240, 720))
    assert fine < coarse / 4 and fine < 1e-4
