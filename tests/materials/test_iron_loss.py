"""The iron-loss law: what it was fitted to, how well, and that it asks for a grade."""

import numpy as np
import pytest

from materials.errors import MaterialError
from materials.iron_loss import (
    EXCESS_OF_SINE,
    FITTED,
    GUARANTEED,
    LAWS,
    LOOPED,
    classical_eddy,
    fit_iron_loss,
    guaranteed_loss,
    iron_loss_law,
    loop_loss,
)

POUND = 0.45359237  # kg
# (grade, frequency [Hz], peak [T], the law there [W/kg], its relative error against the measured value of the cited
# table): the three largest errors of each grade from 0.2 T up, and three at the flux densities of a loaded tooth.
POINTS = [
    ("M235-35A", 400, 0.4, 2.882, -0.091),
    ("M235-35A", 50, 1.0, 1.002, +0.090),
    ("M235-35A", 100, 0.3, 0.2731, -0.090),
    ("M235-35A", 50, 1.5, 2.159, -0.040),
    ("M235-35A", 400, 1.5, 40.84, -0.009),
    ("M235-35A", 1000, 1.0, 71.79, +0.004),
    ("M19", 50, 0.3, 0.1569, -0.144),
    ("M19", 150, 0.3, 0.5854, -0.118),
    ("M19", 200, 0.3, 0.8456, -0.104),
    ("M19", 60, 1.5, 3.254, -0.021),
    ("M19", 400, 1.0, 18.67, +0.002),
    ("M19", 1000, 1.0, 77.57, +0.035),
    ("M400-50A", 100, 0.3, 0.4832, -0.105),
    ("M400-50A", 100, 0.4, 0.7875, -0.105),
    ("M400-50A", 50, 0.2, 0.09899, +0.100),
    ("M400-50A", 50, 1.5, 3.580, +0.003),
    ("M400-50A", 400, 1.0, 34.84, -0.030),
    ("M400-50A", 2500, 1.0, 883.4, -0.017),
    ("M800-50A", 50, 1.9, 8.512, +0.048),
    ("M800-50A", 50, 1.6, 6.082, -0.045),
    ("M800-50A", 50, 1.7, 6.830, -0.035),
    ("M800-50A", 50, 1.5, 5.389, -0.024),
    ("M800-50A", 100, 1.5, 13.51, -0.004),
    ("M800-50A", 200, 1.5, 37.54, -0.001),
    ("M530-65A", 50, 0.2, 0.1171, +0.064),
    ("M530-65A", 50, 1.8, 6.43, +0.054),
    ("M530-65A", 50, 1.1, 2.221, +0.048),
    ("M530-65A", 50, 1.5, 4.228, -0.008),
    ("NO20-150Y320", 50, 0.5001, 0.2329, -0.138),
    ("NO20-150Y320", 60, 0.5001, 0.2908, -0.119),
    ("NO20-150Y320", 50, 1.6065, 2.654, -0.091),
    ("NO20-150Y320", 400, 0.7001, 6.447, -0.002),
    ("NO20-150Y320", 2000, 1.0002, 136.4, +0.012),
]
# Guaranteed limits at 1.5 T: EN 10106 at 50 Hz; 0.36 mm M19 at 60 Hz 1.74 W/lb (AISI). Typical sheet is below them.
LIMITS = {"M235-35A": (50, 2.35), "M19": (60, 1.74 / POUND), "M400-50A": (50, 4.00), "M800-50A": (50, 8.00),
          "M530-65A": (50, 5.30)}  # fmt: skip
THIN_LIMIT = 400, 1.0, 15.0  # Hz, T, W/kg: that of the name of a thin sheet


@pytest.mark.reference
@pytest.mark.parametrize("grade, frequency, peak, loss, error", POINTS)
def test_law_keeps_its_documented_errors(grade, frequency, peak, loss, error):
    assert LAWS[grade].specific_loss(frequency, peak) == pytest.approx(loss, rel=5e-4)
    assert abs(error) < LAWS[grade].largest_error + 1e-3


@pytest.mark.reference
@pytest.mark.parametrize("grade", FITTED)
def test_largest_error_is_stated(grade):
    largest = max(abs(error) for name, *_, error in POINTS if name == grade)
    assert LAWS[grade].largest_error == pytest.approx(largest, abs=1e-3) and LAWS[grade].rms_error < 0.051


@pytest.mark.reference
@pytest.mark.parametrize("grade", FITTED)
def test_typical_sheet_keeps_its_guarantee(grade):
    frequency, peak, limit = (LIMITS[grade][0], 1.5, LIMITS[grade][1]) if grade in LIMITS else THIN_LIMIT
    assert 0.65 * limit < LAWS[grade].specific_loss(frequency, peak) < limit


@pytest.mark.parametrize("grade", ["M235-35A", "M400-50A"])
def test_eddy_term_is_near_the_classical_one(grade):
    """At 1 T within a factor 0.7 to 1.3 of the sheet without skin effect (resistivity 0.52 and 0.42 uOhm m assumed)."""
    thickness, resistivity = {"M235-35A": (0.35e-3, 0.52e-6), "M400-50A": (0.5e-3, 0.42e-6)}[grade]
    law = LAWS[grade]
    assert 0.7 < law.eddy * (1 + law.saturation) / classical_eddy(thickness, resistivity, law.density) < 1.3


# (thickness [m], resistivity [Ohm m]) of the grades that have tables
TABLED = {"M235-35A": (0.35e-3, 0.52e-6), "M19": (0.36e-3, 0.50e-6), "M400-50A": (0.5e-3, 0.42e-6)}


@pytest.mark.parametrize("frequency, peak", ((50, 1.0), (50, 1.5), (400, 1.0), (400, 1.5), (1000, 1.0)))
@pytest.mark.parametrize("grade", TABLED)
def test_a_law_from_the_guarantee_alone_is_near_that_of_the_table(grade, frequency, peak):
    (thickness, resistivity), (guaranteed_at, limit) = TABLED[grade], LIMITS[grade]
    sheet = {"thickness": thickness, "resistivity": resistivity, "density": 7650.0}
    law = guaranteed_loss(grade, limit, **sheet, source="", frequency=guaranteed_at)
    assert 0.9 < law.specific_loss(frequency, peak) / LAWS[grade].specific_loss(frequency, peak) < 1.23


# M400-50A, measured as those of ``LOOPED`` are: 395.3 J/m^3 of loop with its tips at 1.492 T.
LOOP = {"thickness": 0.5e-3, "conductivity": 3.22e6, "density": 7700.0}


@pytest.mark.parametrize("frequency, peak", ((50, 1.0), (50, 1.5), (400, 1.0), (400, 1.5), (1000, 1.0), (1000, 1.5)))
def test_a_law_from_loop_and_conductivity_is_near_that_of_the_table(frequency, peak):
    law = loop_loss("M400-50A", 395.3, 1.492, **LOOP, source="")
    assert 1.05 < law.specific_loss(frequency, peak) / LAWS["M400-50A"].specific_loss(frequency, peak) < 1.22


def test_the_loop_is_the_loss_of_slow_cycles():
    law = loop_loss("M400-50A", 395.3, 1.492, **LOOP, source="")
    assert law.specific_loss(1e-3, 1.492) / 1e-3 == pytest.approx(395.3 / 7700.0, rel=1e-4)


@pytest.mark.parametrize("grade", LOOPED)
def test_measured_loops_stay_below_the_guarantee_of_the_name(grade):
    limit = float(grade[1:4]) / 100
    assert 0.75 * limit < iron_loss_law(grade).specific_loss(50.0, 1.5) < limit


@pytest.mark.parametrize("grade", GUARANTEED)
def test_the_guaranteed_loss_is_that_of_the_name(grade):
    law = iron_loss_law(grade)
    assert law.specific_loss(50.0, 1.5) == pytest.approx(float(grade[1:4]) / 100, rel=1e-12)
    assert law.hysteresis > 0 and 0.1 < law.eddy * (50 * 1.5) ** 2 / law.specific_loss(50.0, 1.5) < 0.3


def test_another_makers_sheet_of_the_grade_has_the_same_shape():
    """M800-50A, typical: 6.60 W/kg at 1.5 T and 3.05 at 1.0 T (two values of pyleecan's material files)."""
    law = iron_loss_law("M800-50A")
    assert law.specific_loss(50.0, 1.0) / law.specific_loss(50.0, 1.5) == pytest.approx(3.05 / 6.60, rel=0.07)
    assert 0.8 * 6.60 < law.specific_loss(50.0, 1.5) < 6.60


def test_classical_eddy_is_the_textbook_one():
    """sigma d^2/24 times the squared peak of dB/dt, per volume."""
    thickness, resistivity, density, frequency, peak = 0.35e-3, 0.5e-6, 7650.0, 333.0, 1.2
    per_volume = thickness**2 / resistivity / 24 * (2 * np.pi * frequency * peak) ** 2
    coefficient = classical_eddy(thickness, resistivity, density)
    assert coefficient * density * (frequency * peak) ** 2 == pytest.approx(per_volume)


def test_excess_constant_is_the_mean_of_a_cosine():
    phase = np.linspace(0, 2 * np.pi, 200_000, endpoint=False)
    assert EXCESS_OF_SINE == pytest.approx((np.abs(2 * np.pi * np.cos(phase)) ** 1.5).mean(), rel=1e-6)


def test_fit_finds_the_law_that_made_the_data():
    law = LAWS["M235-35A"]
    frequency, peak = (x.ravel() for x in np.meshgrid([50.0, 200.0, 1000.0, 2500.0], np.linspace(0.1, 1.8, 12)))
    losses = law.specific_loss(frequency, peak)
    found = fit_iron_loss(frequency, peak, losses, grade="made", density=7650.0, source="law")
    for name in ("hysteresis", "exponent", "eddy", "saturation", "excess"):
        assert getattr(found, name) == pytest.approx(getattr(law, name), rel=1e-3)
    assert found.largest_error < 1e-5 and found.frequencies == (50.0, 2500.0)


def test_rounded_points_count_less():
    """Losses rounded to 0.2 W/kg leave the smallest ones without meaning; weighted, they do not bend the law."""
    law = LAWS["M235-35A"]
    frequency, peak = (x.ravel() for x in np.meshgrid([50.0, 100.0, 400.0, 1000.0], np.linspace(0.2, 1.8, 12)))
    exact = law.specific_loss(frequency, peak)
    rounded = np.maximum(np.round(exact / 0.2), 1) * 0.2
    facts = {"grade": "made", "density": 7650.0, "source": "law"}
    plain, weighted = (fit_iron_loss(frequency, peak, rounded, **facts, resolution=step) for step in (0.0, 0.2))
    large = peak > 0.7
    errors = [np.abs(found.specific_loss(frequency, peak) / exact - 1)[large].max() for found in (plain, weighted)]
    assert errors[1] < 0.75 * errors[0]


def test_a_sheet_without_data_needs_a_stand_in():
    for nothing in (None, ""):
        with pytest.raises(MaterialError, match="name one of M235-35A"):
            iron_loss_law(nothing)
    with pytest.raises(MaterialError, match="no loss data for '35PN270'.*stand-in"):
        iron_loss_law("35PN270")


def test_too_few_points_are_refused():
    with pytest.raises(MaterialError, match="found 3"):
        fit_iron_loss([50.0] * 3, [0.5, 1.0, 1.5], [1.0, 2.0, 3.0], grade="x", density=7650.0, source="x")
