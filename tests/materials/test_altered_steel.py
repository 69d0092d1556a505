"""Laws around another law: consistent with themselves, with their definitions, and with the law at their null."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from materials.altered_steel import ScaledReluctivity, ScaledSaturation, hardened, stacked
from materials.errors import MaterialError
from materials.library import load_steel
from materials.reluctivity import LinearReluctivity
from units import MU_0

STEEL = load_steel("35PN270")
FIELDS = np.array([0.0, 3.0, 50.0, 300.0, 4e3, 6e4, 1e6])  # A/m
FLUX = np.linspace(0.0, 2.6, 300)  # T, into deep saturation
LAWS = {
    "stacked": stacked(STEEL, 0.95),
    "hardened": hardened(STEEL, 3.0),
    "hardened here and there": hardened(STEEL, np.linspace(1.0, 3.0, len(FLUX))),
    "strength": ScaledReluctivity(STEEL, 1.3),
    "saturation": ScaledSaturation(STEEL, 0.97),
    "both": stacked(ScaledSaturation(STEEL, 0.97), 0.95),
}
every_law = pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)


def polarisation(law, h):
    return law.flux_density(h) - MU_0 * h


@every_law
def test_flux_density_inverts_field_strength(law):
    assert_allclose(law.flux_density(law.field_strength(FLUX)), FLUX, atol=1e-12)
    assert_allclose(law.field_strength(-FLUX), -law.field_strength(FLUX))


@every_law
def test_reluctivity_is_field_over_flux_density(law):
    assert_allclose(law.nu(FLUX**2) * FLUX, law.field_strength(FLUX), rtol=1e-12)


@every_law
def test_derivative_of_reluctivity(law):
    b2, step = FLUX**2, 1e-7
    slope = (law.nu(b2 + step) - law.nu(np.abs(b2 - step))) / (2 * step)
    found = law.nu_and_derivative(b2)[1]
    assert_allclose(found[2:], slope[2:], rtol=1e-4, atol=1e-6 * np.abs(found).max())


@every_law
def test_energy_is_the_integral_of_field_strength(law):
    step = 1e-6
    slope = (law.energy_density(FLUX + step) - law.energy_density(np.abs(FLUX - step))) / (2 * step)
    assert_allclose(slope[1:], law.field_strength(FLUX)[1:], rtol=1e-5, atol=1e-2)


def test_stack_of_steel_and_insulation():
    """At the same H the fluxes add up in proportion to the thicknesses, and so do the energies."""
    law = stacked(STEEL, 0.95)
    assert_allclose(law.flux_density(FIELDS), 0.95 * STEEL.flux_density(FIELDS) + 0.05 * MU_0 * FIELDS, rtol=1e-14)
    energy = 0.95 * STEEL.energy_density(STEEL.flux_density(FIELDS)) + 0.05 * MU_0 / 2 * FIELDS**2
    assert_allclose(law.energy_density(law.flux_density(FIELDS)), energy, rtol=1e-10)


def test_stack_of_a_linear_material():
    """mu_r of the mixture: 0.9 * 1000 + 0.1."""
    assert_allclose(stacked(LinearReluctivity(1000.0), 0.9).nu(np.array([0.0, 4.0])), 1 / (MU_0 * 900.1), rtol=1e-13)


def test_hardened_steel_needs_more_field_for_the_same_polarisation():
    assert_allclose(polarisation(hardened(STEEL, 3.0), 3 * FIELDS), polarisation(STEEL, FIELDS), atol=1e-12)
    assert polarisation(hardened(STEEL, 3.0), 1e7) == pytest.approx(STEEL.saturation_polarisation, rel=1e-3)


def test_saturation_polarisation_is_scaled_and_initial_permeability_kept():
    law = ScaledSaturation(STEEL, 0.9)
    assert polarisation(law, 1e8) == pytest.approx(0.9 * STEEL.saturation_polarisation, rel=1e-4)
    assert law.nu(0.0) == STEEL.nu(0.0)


@pytest.mark.parametrize("law", (stacked(STEEL, 1.0), ScaledSaturation(STEEL, 1.0), ScaledReluctivity(STEEL, 1.0)))
def test_null_is_the_law_itself(law):
    for found, expected in zip(law.nu_and_derivative(FLUX**2), STEEL.nu_and_derivative(FLUX**2)):
        assert np.array_equal(found, expected)


def test_hardness_of_one_is_the_law_to_rounding():
    for found, expected in zip(hardened(STEEL, 1.0).nu_and_derivative(FLUX**2), STEEL.nu_and_derivative(FLUX**2)):
        assert_allclose(found, expected, rtol=1e-9)


@pytest.mark.parametrize(
    "wrong",
    (
        lambda: stacked(STEEL, 0.0),
        lambda: stacked(STEEL, 1.1),
        lambda: hardened(STEEL, -1.0),
        lambda: ScaledSaturation(STEEL, 0.0),
    ),
)
def test_impossible_steels_are_refused(wrong):
    with pytest.raises(MaterialError):
        wrong()
