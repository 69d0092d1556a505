"""Magnets that differ from one another."""

from dataclasses import replace
from math import cos, pi, sin

import numpy as np
import pytest
from numpy.testing import assert_allclose

from geometry.defects import DynamicEccentricity, MagnetPosition
from geometry.errors import GeometryError
from geometry.magnetisation import RadialMagnetisation
from magnetostatics.currents import PhaseCurrents
from magnetostatics.flux_linkage import coil_flux_linkage
from materials.magnet import Magnet
from tests.magnetostatics.reference_machine import MATERIALS, model_of, reference_machine
from tests.magnetostatics.whole_machine import whole_model, with_defects

MAGNET = MATERIALS.magnet
IDLE = PhaseCurrents(0.0, (0.0, 0.0, 0.0))


def loads(magnet, number=3):
    return whole_model().like(materials=MATERIALS.with_magnet(number, magnet)).magnet_loads


def test_one_magnet_replaced_leaves_the_others():
    found, base = loads(Magnet(0.65, 1.0)), whole_model().magnet_loads
    assert_allclose(found[3], base[3] / 2, rtol=1e-12)
    assert np.array_equal(np.delete(found, 3, axis=0), np.delete(base, 3, axis=0))


def test_recoil_permeability_of_one_magnet():
    """B_r/(mu_0 mu_r) is what counts as current, and only its own elements become more permeable."""
    model = whole_model().like(materials=MATERIALS.with_magnet(3, Magnet(1.3, 1.1)))
    assert_allclose(model.magnet_loads[3], whole_model().magnet_loads[3] / 1.1, atol=1e-9)
    assert_allclose(model._reluctivity / whole_model()._reluctivity, np.where(in_magnet(model, 3), 1 / 1.1, 1.0))


def in_magnet(model, number):
    return np.isin(np.arange(model.section.mesh.nelements), model.section.mesh.subdomains[f"magnet_{number}"])


@pytest.mark.parametrize("angle", (0.1, -0.3))
def test_axis_of_magnetisation_turns_the_remanence(angle):
    """The load is linear in the vector of the remanence: cos times the drawn one, sin times the one at right angles."""
    straight, across = loads(MAGNET)[3], loads(replace(MAGNET, axis_error=pi / 2))[3]
    expected = cos(angle) * straight + sin(angle) * across
    assert_allclose(loads(replace(MAGNET, axis_error=angle))[3], expected, atol=1e-9 * np.abs(straight).max())


def test_a_magnet_out_of_place_is_magnetised_along_its_own_centre_line():
    section = with_defects(whole_model(), MagnetPosition(3, 0.02)).section
    point = np.array([0.01, 0.01])
    assert section.magnetisation_angle(3, point) == pytest.approx(3 * pi / 5 + 0.02)
    assert section.magnetisation_angle(4, point) == pytest.approx(4 * pi / 5)


def test_radial_magnets_of_an_eccentric_rotor_stay_radial_to_its_centre():
    base = whole_model(magnetisation=RadialMagnetisation())
    moved = with_defects(base, DynamicEccentricity(0.2e-3, 0.7))
    assert_allclose(moved.magnet_loads, base.magnet_loads, atol=1e-6 * np.abs(base.magnet_loads).max())


def test_a_magnet_without_remanence_leaves_its_tooth_with_what_its_neighbours_send():
    """Magnet 0 on tooth 0: more than the 3/4 of the flux are gone, and its coil no longer links the largest."""
    psi = [
        coil_flux_linkage(whole_model().like(materials=materials).solve(IDLE))
        for materials in (MATERIALS, MATERIALS.with_magnet(0, Magnet(0.0, 1.0)))
    ]
    assert abs(psi[1][0]) < 0.25 * psi[0][0]
    assert abs(psi[1][6]) > 0.8 * abs(psi[0][6])


def test_all_magnets_changed_at_once():
    mixed = MATERIALS.with_magnet(3, Magnet(1.0, 1.1)).with_magnets(lambda m: replace(m, remanence=m.remanence / 2))
    assert (mixed.magnet.remanence, mixed.magnet_at(3).remanence, mixed.magnet_at(4).remanence) == (0.65, 0.5, 0.65)


def test_what_cannot_be_is_refused():
    with pytest.raises(GeometryError, match="no magnet 10"):
        whole_model().like(materials=MATERIALS.with_magnet(10, MAGNET))
    with pytest.raises(GeometryError, match="mesh the whole machine"):
        model_of(reference_machine()).like(materials=MATERIALS.with_magnet(3, MAGNET))
