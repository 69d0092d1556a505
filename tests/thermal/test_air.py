"""Films of air against tables, a worked example of a textbook and limits that are known exactly."""

from math import pi

import pytest

from thermal.air import (
    STEFAN_BOLTZMANN,
    Air,
    GivenFilm,
    StillAir,
    air_gap_film,
    cylinder_surface,
    end_space_film,
    radiation_film,
    still_air_film,
)
from thermal.errors import ThermalError

# Incropera, Fundamentals of Heat and Mass Transfer, Table A.4: K, nu [m^2/s], k [W/(m K)], Pr, rho [kg/m^3]
TABLE = ((250, 11.44e-6, 22.3e-3, 0.720, 1.3947), (300, 15.89e-6, 26.3e-3, 0.707, 1.1614),
         (350, 20.92e-6, 30.0e-3, 0.700, 0.9950), (400, 26.41e-6, 33.8e-3, 0.690, 0.8711))  # fmt: skip


@pytest.mark.reference
@pytest.mark.parametrize("row", TABLE, ids=lambda row: f"{row[0]} K")
def test_air_is_that_of_the_table(row):
    kelvin, viscosity, conductivity, prandtl, density = row
    air = Air(kelvin - 273.15)
    assert air.kinematic_viscosity == pytest.approx(viscosity, rel=0.025)
    assert air.conductivity == pytest.approx(conductivity, rel=0.01)
    assert air.prandtl == pytest.approx(prandtl, rel=0.015)
    assert air.density == pytest.approx(density, rel=0.015)


@pytest.mark.reference
def test_a_steam_pipe_is_that_of_the_textbook():
    """Incropera, section 9.6: 0.1 m across, 165 degC in 23 degC, emissivity 0.85; Nu = 23.3, h = 7.29 W/(m^2 K),
    325 W/m by convection and 441 W/m by radiation."""
    assert still_air_film(0.1, 165.0, 23.0) == pytest.approx(7.29, rel=0.01)
    assert still_air_film(0.1, 165.0, 23.0) * pi * 0.1 * 142 == pytest.approx(325.0, rel=0.01)
    assert radiation_film(0.85, 165.0, 23.0) * pi * 0.1 * 142 == pytest.approx(441.0, rel=0.01)


def test_a_casing_adds_convection_and_radiation():
    both = still_air_film(0.11, 90.0, 40.0) + radiation_film(0.9, 90.0, 40.0)
    assert StillAir(0.9).at(0.11, 90.0, 40.0) == pytest.approx(both)
    assert GivenFilm(30.0).at(0.11, 90.0, 40.0) == 30.0


def test_radiation_at_one_temperature_is_its_derivative():
    assert radiation_film(0.5, 27.0, 27.0) == pytest.approx(0.5 * 4 * STEFAN_BOLTZMANN * 300.15**3)


def test_an_air_gap_at_rest_only_conducts():
    assert air_gap_film(0.5e-3, 16e-3, 0.0, 80.0) == pytest.approx(Air(80.0).conductivity / 0.5e-3)


def test_a_turning_gap_is_stirred_beyond_its_taylor_number():
    """1 mm at 50 mm and 20 degC, nu = 15.1e-6 m^2/s: Ta = 1700 at 88 rad/s; at 150 rad/s 4940, Nu = 0.128 Ta^0.367."""
    still = Air(20.0).conductivity / 1e-3
    assert air_gap_film(1e-3, 50e-3, 80.0, 20.0) == pytest.approx(still)
    taylor = 150.0**2 * 50e-3 * 1e-9 / 15.1e-6**2
    assert taylor == pytest.approx(4940, rel=0.01)
    assert air_gap_film(1e-3, 50e-3, 150.0, 20.0) == pytest.approx(still * 0.128 * taylor**0.367 / 2, rel=0.01)
    assert air_gap_film(1e-3, 50e-3, 500.0, 20.0) > air_gap_film(1e-3, 50e-3, 220.0, 20.0)
    with pytest.raises(ThermalError, match="Taylor"):
        air_gap_film(5e-3, 50e-3, 5000.0, 20.0)


def test_the_end_space_is_stirred_by_the_rotor():
    assert end_space_film(0.0) == 15.0
    assert end_space_film(10.0) == pytest.approx(15 * (1 + 0.4 * 7.943), rel=1e-3)


def test_the_surface_of_a_casing_has_both_ends():
    assert cylinder_surface(0.1, 0.2) == pytest.approx(0.0628319 + 0.0157080, rel=1e-5)
