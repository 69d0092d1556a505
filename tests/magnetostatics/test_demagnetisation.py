"""Flux density along the magnetisation: exact fields of slotless rings, shares by hand, a finer mesh, a whole turn."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from numpy.testing import assert_allclose

from geometry.half_cell import MeshDensity
from geometry.magnetisation import ParallelMagnetisation, RadialMagnetisation
from magnetostatics.demagnetisation import MagnetFlux, magnet_flux, magnet_map
from magnetostatics.flux_map import map_angles, operating_point
from magnetostatics.model import FieldModel, OperatingPoint
from materials.magnet_grade import load_grade
from tests.magnetostatics.reference_machine import MATERIALS, SWEEP, model_of, reference_machine
from tests.physics.slotless_ring import EXACT, RING, Ring, ring_section
from units import MILLIMETRE

COARSE = MeshDensity(gap_edges=60, gap_layers=1, across_iron=1.0)
GRADE, HOT = load_grade("N42SH"), 120.0
HOT_MAGNETS = replace(MATERIALS, magnet=GRADE.magnet_at(HOT))
OVERLOAD = 850.0  # A, ampere-turns of a coil of the reference machine at 20 A/mm^2


@pytest.mark.parametrize("permeability", (1.0, 1.05, 1.2))
def test_the_working_point_of_a_magnet_in_a_smooth_gap(permeability):
    """A ring so large that it is plane: B_m = B_r / (1 + mu_r g / l_m), here between poles so wide that their ends do
    not count; the curvature that is left is 4 mm over 1.57 m."""
    radius = 100 * RING.rotor_outer_radius
    machine = replace(
        RING,
        rotor_outer_radius=radius,
        shaft_radius=radius - 30 * MILLIMETRE,
        stator_outer_radius=radius + 22 * MILLIMETRE,
        back_iron_width=20 * MILLIMETRE,
        magnetisation=RadialMagnetisation(),
    )
    ring = Ring(machine, recoil_permeability=permeability, iron_permeability=1e9)
    model = FieldModel(ring_section(machine, 40), ring.materials, EXACT)
    seen = magnet_flux(model.solve(OperatingPoint(0.0)))
    x, y = model.magnet_elements(0).points
    middle = np.abs(np.arctan2(y, x)) < 0.25 * machine.pole_pitch
    gap = machine.slot_bottom_radius - machine.rotor_outer_radius
    assert_allclose(seen.values[0][middle], 1.3 / (1 + permeability * gap / machine.magnet_length), rtol=3e-3)


@pytest.mark.parametrize("magnetisation", (RadialMagnetisation(), ParallelMagnetisation()))
def test_the_flux_along_the_magnetisation_is_that_of_the_series(magnetisation):
    """Point by point in the middle half of a magnet, where smoothed series have converged."""
    ring = Ring(replace(RING, magnetisation=magnetisation), recoil_permeability=1.05)
    model = FieldModel(ring_section(ring.machine, 12, 2), ring.materials, EXACT)
    seen = magnet_flux(model.solve(OperatingPoint(0.0))).values[0]
    x, y = model.magnet_elements(0).points
    middle = np.flatnonzero(np.abs(np.arctan2(y, x)).ravel() < 0.25 * ring.machine.pole_pitch)[::83]
    exact = [exact_along(ring, x.ravel()[k], y.ravel()[k]) for k in middle]
    assert len(middle) > 5
    assert_allclose(seen.ravel()[middle], exact, atol=2e-3)


def exact_along(ring, x, y, highest=400):
    """B . m of the exact field at a point of magnet 0, its series smoothed by Lanczos' factors."""
    radius, angle = np.hypot(x, y), np.arctan2(y, x)
    radial = tangential = 0.0
    for order in range(5, highest, 10):
        wave = np.sinc(order / highest) * np.exp(1j * order * angle)
        field = ring.field(order)
        radial += (field.radial(radius) * wave).real
        tangential += (field.tangential(radius) * wave).real
    tilt = angle if ring.parallel else 0.0  # of the radius against the magnetisation
    return radial * np.cos(tilt) - tangential * np.sin(tilt)


def test_shares_of_a_magnet_by_hand():
    """Two magnets of two elements of 1 and 3 mm^2, one point each."""
    seen = MagnetFlux(np.array([[[0.1, 0.5]], [[0.3, 0.2]]]), np.array([[1.0, 3.0]]))
    assert [seen.share_below(knee) for knee in (0.1, 0.15, 0.25, 0.4, 0.6)] == [0, 1 / 8, 4 / 8, 5 / 8, 1]
    assert [seen.exceeded(share) for share in (0.0, 0.1, 0.2, 0.55, 0.9)] == [0.1, 0.1, 0.2, 0.3, 0.5]
    assert seen.least == 0.1 and seen.smallest.tolist() == [[0.1, 0.2]]


def smallest_over(model, angles, i_d, i_q):
    """The smallest in one magnet over rotor angles."""
    seen = [magnet_flux(model.solve(operating_point(model, float(angle), i_d, i_q))) for angle in angles]
    return MagnetFlux(np.min([one.smallest for one in seen], axis=0)[None], seen[0].areas)


@pytest.fixture(scope="module")
def machine():
    return reference_machine()


def test_sixty_degrees_and_all_magnets_are_one_magnet_over_a_turn(machine):
    """The first magnet of the whole machine, turned step by step until the teeth repeat: 60 degrees, two slots."""
    sector, whole = (model_of(machine, COARSE, whole=one, materials=HOT_MAGNETS) for one in (False, True))
    first, steps = map_angles(sector, 4), 4 * 5
    found = smallest_over(sector, first, -300.0, OVERLOAD)
    turn = first[0] + pi / 3 * np.arange(steps) / steps
    seen = [magnet_flux(whole.solve(operating_point(whole, float(angle), -300.0, OVERLOAD))) for angle in turn]
    assert_allclose(np.min([one.values[0] for one in seen], axis=0), found.values[0], atol=2e-3)


def test_the_share_beyond_the_knee_is_that_of_a_finer_mesh(machine):
    """To one point of a hundred, on the mesh of the check against one of half its edge lengths."""
    meshes = (MeshDensity(360, 0.75, 2, 3.0), MeshDensity(720, 0.375, 3, 6.0))
    models = [model_of(machine, density, materials=HOT_MAGNETS) for density in meshes]
    shares = [
        smallest_over(model, map_angles(model, 3), -OVERLOAD, 0.0).share_below(GRADE.knee_at(HOT)) for model in models
    ]
    assert 0.01 < shares[1] and shares[0] == pytest.approx(shares[1], abs=0.01)


def test_the_map_has_the_values_of_the_points(machine):
    """Linear in an element: the mean of its corners is that of its points."""
    model = model_of(machine, SWEEP, materials=HOT_MAGNETS)
    seen = magnet_flux(model.solve(OperatingPoint(0.0)))
    drawn = magnet_map(model, seen, 0.5)
    assert_allclose(drawn.flux.mean(axis=0), seen.values.mean(axis=1).ravel(), atol=1e-12)
    angle = np.arctan2(drawn.corners[1], drawn.corners[0])[:, : seen.values.shape[2]].mean()
    assert angle == pytest.approx(0.5, abs=1e-2), "the first magnet lies on the x axis and is turned"
