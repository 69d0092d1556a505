"""The iron-loss law: what it was fitted to, how well, and that it asks for a grade."""

import numpy as np
import pytest

from materials.errors import MaterialError
from materials.iron_loss import EXCESS_OF_SINE, LAWS, classical_eddy, fit_iron_loss, iron_loss_law

POUND = 0.45359237  # kg


# Errors of the law at single points of each table, relative: 0.2 T up, the three largest of each grade and three typical.
# (frequency [Hz], peak [T]) -> error; the measured values behind them are in the cited tables.
RESIDUALS = {
    "M235-35A": {(100, 0.3): -0.090, (400, 0.4): -0.091, (50, 1.0): 0.090, (50, 1.5): -0.040, (400, 1.5): -0.009, (1000, 1.0): 0.004},
    "M19": {(50, 0.3): -0.144, (150, 0.3): -0.118, (200, 0.3): -0.104, (60, 1.5): -0.021, (400, 1.0): 0.000, (1000, 1.0): 0.035},
    "M400-50A": {(100, 0.4): -0.105, (100, 0.3): -0.105, (50, 0.2): 0.100, (50, 1.5): 0.003, (400, 1.0): -0.030, (2500, 1.0): -0.015},
}
# The law there, W/kg, so that a changed coefficient is seen.
AT_ONE_TESLA_AND_400_HZ = {"M235-35A": 16.44, "M19": 18.63, "M400-50A": 34.84}
# Guaranteed limits at 1.5 T: EN 10106 at 50 Hz; ASTM A677 for 0.36 mm M19 at 60 Hz, 1.74 W/lb. Typical sheet is below them.
GUARANTEED = {"M235-35A": (50, 2.35), "M19": (60, 1.74 / POUND), "M400-50A": (50, 4.00)}


@pytest.mark.reference
@pytest.mark.parametrize("grade", LAWS)
def test_law_gives_the_documented_numbers(grade):
    law = LAWS[grade]
    assert law.specific_loss(400.0, 1.0) == pytest.approx(AT_ONE_TESLA_AND_400_HZ[grade], rel=1e-3)
    assert law.rms_error < 0.051
    assert max(abs(error) for error in RESIDUALS[grade].values()) == pytest.approx(law.largest_error, abs=1e-3)


@pytest.mark.reference
@pytest.mark.parametrize("grade", LAWS)
def test_typical_sheet_keeps_its_guarantee(grade):
    frequency, limit = GUARANTEED[grade]
    assert 0.8 * limit < LAWS[grade].specific_loss(frequency, 1.5) < limit


@pytest.mark.parametrize("grade", ["M235-35A", "M400-50A"])
def test_eddy_term_is_near_the_classical_one(grade):
    """At 1 T within a factor 0.7 to 1.3 of the sheet without skin effect (resistivity 0.52 and 0.42 uOhm m assumed)."""
    thickness, resistivity = {"M235-35A": (0.35e-3, 0.52e-6), "M400-50A": (0.5e-3, 0.42e-6)}[grade]
    law = LAWS[grade]
    assert 0.7 < law.eddy * (1 + law.saturation) / classical_eddy(thickness, resistivity, law.density) < 1.3


def test_classical_eddy_is_the_textbook_one():
    """sigma d^2/24 times the squared peak of dB/dt, per volume."""
    thickness, resistivity, density, frequency, peak = 0.35e-3, 0.5e-6, 7650.0, 333.0, 1.2
    per_volume = thickness**2 / resistivity / 24 * (2 * np.pi * frequency * peak) ** 2
    assert classical_eddy(thickness, resistivity, density) * density * (frequency * peak) ** 2 == pytest.approx(per_volume)


def test_excess_constant_is_the_mean_of_a_cosine():
    phase = np.linspace(0, 2 * np.pi, 200_000, endpoint=False)
    assert EXCESS_OF_SINE == pytest.approx((np.abs(2 * np.pi * np.cos(phase)) ** 1.5).mean(), rel=1e-6)


def test_fit_finds_the_law_that_made_the_data():
    law = LAWS["M235-35A"]
    frequency, peak = (x.ravel() for x in np.meshgrid([50.0, 200.0, 1000.0, 2500.0], np.linspace(0.1, 1.8, 12)))
    found = fit_iron_loss(frequency, peak, law.specific_loss(frequency, peak), grade="made", density=7650.0, source="law")
    for name in ("hysteresis", "exponent", "eddy", "saturation", "excess"):
        assert getattr(found, name) == pytest.approx(getattr(law, name), rel=1e-3)
    assert found.largest_error < 1e-5 and found.frequencies == (50.0, 2500.0)


def test_a_sheet_without_data_needs_a_stand_in():
    for nothing in (None, ""):
        with pytest.raises(MaterialError, match="name one of M235-35A"):
            iron_loss_law(nothing)
    with pytest.raises(MaterialError, match="no loss data for '35PN270'.*stand-in"):
        iron_loss_law("35PN270")


def test_too_few_points_are_refused():
    with pytest.raises(MaterialError, match="found 3"):
        fit_iron_loss([50.0] * 3, [0.5, 1.0, 1.5], [1.0, 2.0, 3.0], grade="x", density=7650.0, source="x")
