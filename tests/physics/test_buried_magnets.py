"""Buried magnets in iron that the field does not see, against the currents on their sides between two grounded circles.

A magnet of remanence B_r along d is a sheet of current -B_r d . t / mu_0 on its outline, t along it counter-clockwise.
One line of it, I at radius s and angle phi, between circles a and R of A = 0 gives for s < r

    A = mu_0 I / pi  sum_n g_n cos n(theta - phi),  g_n = (s^n - a^2n s^-n) (R^2n r^-n - r^n) / (2n (R^2n - a^2n))
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from geometry.half_cell import MeshDensity
from geometry.parts import Rim
from magnetostatics.currents import PhaseCurrents
from magnetostatics.newton import NewtonSettings
from materials.magnet import Magnet
from materials.reluctivity import LinearReluctivity
from tests.magnetostatics.other_machines import RIBBED, TWO_LAYERS, V_SHAPE, model_of
from tests.physics.slotless_ring import radial_harmonic

pytestmark = pytest.mark.physics

FINE = MeshDensity(gap_edges=720, longest_gap_edge=2.5, gap_layers=2, across_iron=4.0)
REMANENCE, ANGLE = 1.2, 0.0137
PLACES, WEIGHTS = np.polynomial.legendre.leggauss(40)


def halves(machine):
    """Corners (n,) of the magnets of half a pole, counter-clockwise, and their directions, all as complex numbers."""
    drawing = machine.rotor.draw(Rim(30, 1e-3, 2.0))
    for layer in range(machine.rotor.magnets_per_pitch // 2):
        names = drawing.regions[f"magnet_{layer}" if layer else "magnet"][0]
        corners = np.array([complex(*drawing.points[name][:2]) for name in names])
        area = (np.conj(corners) * np.roll(corners, -1)).imag.sum()
        which = machine.rotor.magnets_per_pitch // 2 + layer
        yield corners[:: int(np.sign(area))], np.exp(1j * machine.rotor.direction(0.0, 0.0, which))


def side_sum(corners, direction, order, inner):
    """mu_0/pi times the integral of (s^n - a^2n s^-n) exp(-j n phi) dI over the outline of a magnet, a = inner."""
    start, side = corners[:, None], (np.roll(corners, -1) - corners)[:, None]
    place = start + side * (1 + PLACES) / 2
    sheet = -REMANENCE / np.pi * (np.conj(direction) * side).real / 2 * WEIGHTS
    s, wave = np.abs(place), np.exp(-1j * order * np.angle(place))
    return (sheet * (s**order - inner ** (2 * order) / s**order) * wave).sum()


def exact_harmonic(machine, order):
    """Of B_r over the stator half of the gap; poles of both signs add up at odd multiples of their pairs."""
    inner, outer = machine.rotor.grounded_radius, machine.stator.grounded_radius
    low, high = machine.mid_gap_radius, machine.stator.rim_radius
    unit = sum(
        side_sum(points, along, order, inner)
        for corners, direction in halves(machine)
        for points, along in ((corners, direction), (np.conj(corners)[::-1], np.conj(direction)))
    )
    r = (low + high) / 2 + (high - low) / 2 * PLACES
    shape = (outer ** (2 * order) * r**-order - r**order) / (2 * order * (outer ** (2 * order) - inner ** (2 * order)))
    mean = (high - low) * (WEIGHTS * shape).sum() / (high**2 - low**2)  # of A/r over the area
    return machine.poles * 1j * order * unit * mean * np.exp(-1j * order * ANGLE)


@pytest.mark.parametrize("machine", (V_SHAPE, RIBBED, TWO_LAYERS), ids=("V", "rib", "two layers"))
def test_harmonics_of_the_flux_density_in_the_gap(machine):
    """First, third and fifth of the poles."""
    model = model_of(machine, FINE, LinearReluctivity(1.0), Magnet(REMANENCE, 1.0), settings=NewtonSettings(1e-9))
    solution = model.solve(PhaseCurrents(ANGLE, (0.0, 0.0, 0.0)))
    orders = machine.pole_pairs * np.array([1, 3, 5])
    exact = np.array([exact_harmonic(machine, int(k)) for k in orders])
    found = np.array([radial_harmonic(solution, k) for k in orders])
    assert_allclose(found, exact, atol=2e-4 * abs(exact[0]))
