"""Rotors of other kinds in a stator that the field does not see, against exact series: magnets and a ring of iron."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from geometry.half_cell import MeshDensity
from geometry.magnetisation import ParallelMagnetisation, RadialMagnetisation
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
PATTERNS = {"parallel": ParallelMagnetisation(), "radial": RadialMagnetisation()}


def layers(machine, order, angle):
    """From the axis out: what the field sees, magnets of the permeability of air."""
    rotor, parallel = machine.rotor, isinstance(machine.rotor.magnetisation, ParallelMagnetisation)
    magnets = magnet_harmonic(order, machine.pole_pairs, REMANENCE, rotor.arc_fraction, parallel)
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


def solved(machine, angle):
    unseen, iron = LinearReluctivity(1.0), LinearReluctivity(IRON)
    materials = MachineMaterials(unseen, iron, Magnet(REMANENCE, 1.0))
    model = FieldModel(section_of(machine, FINE), materials, NewtonSettings(1e-9))
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
