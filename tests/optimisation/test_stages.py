"""Sweep, optima, limits and fits as functions, on grids as small as they can be; fits without any field."""

from dataclasses import replace
from math import nan

import numpy as np
import pytest
import xarray as xr

import optimisation.sweep as sweep_module
from geometry.family import Combination
from optimisation.constrained_optimum import NoOptimumError
from optimisation.fits import QUANTITIES, fits_stage
from optimisation.freedom import AS_SWEPT
from optimisation.limits import limits_stage
from optimisation.optima import Optima, Optimum, edges_at, optima_stage
from optimisation.polynomial_fits import FitRefused
from optimisation.states import AlignedTooth
from optimisation.sweep import VARIABLES, DesignMaps, SaturationLimit, SweepGrid, sweep_stage
from report.fits import remarks
from report.sweep import limits_files
from study.inputs_field import field_case, saturation_limit, sweep_grid
from study.read import read_study
from tasks import InThisProcess
from tests.optimisation.machines import machine_of

TWELVE = Combination(12, 10)
STUDY = read_study("motorcycle")
CASE = field_case(STUDY)
LIMIT = SaturationLimit(AlignedTooth(), 1.2, (1.2, 3.0))
GRID = SweepGrid((TWELVE,), (42.5e-3,), (0.065, 0.115), 4, (0.30, 0.38), 3)


@pytest.fixture(scope="module")
def maps():
    return sweep_stage(CASE, GRID, LIMIT, InThisProcess())


@pytest.fixture(scope="module")
def optima(maps):
    return optima_stage(CASE, maps, AS_SWEPT, InThisProcess())


# ---- sweep ----------------------------------------------------------------------------------------------------------


def test_the_study_in_si():
    grid, limit = sweep_grid(STUDY), saturation_limit(STUDY)
    assert grid.stator_outer_radii[3] == pytest.approx(42.5e-3) and len(grid.sections) == 20
    assert (limit.reading, limit.limit, limit.compared[-1]) == (AlignedTooth(), 1.2, 1.8)
    assert CASE.nominal_density == pytest.approx(6e6 * 2**0.5)
    assert CASE.family.reference.back_iron_width == pytest.approx(3.3e-3)


def test_the_map_holds_every_design_in_its_place(maps):
    one = maps.one(TWELVE).sel(stator_outer_radius=42.5e-3)
    assert set(VARIABLES) < set(maps.data) and maps.designs == 12
    machine = machine_of(CASE.family, 12, 42.5e-3, float(one.back_iron_width[1]), float(one.rotor_outer_radius[2]))
    assert machine.back_iron_width / 42.5e-3 == pytest.approx(GRID.back_iron[1])
    assert machine.rotor_outer_radius / 42.5e-3 == pytest.approx(GRID.rotor[2])
    assert float(one.torque[1, 2]) > float(one.torque[1, 0]), "a larger rotor gives more torque"
    assert np.isfinite(one.torque_null.values).sum() == maps.designs - maps.unbuildable


def test_what_cannot_be_built_is_not_a_number(maps):
    one = maps.data.isel(combination=0, stator_outer_radius=0)
    assert maps.unbuildable == 3
    assert np.isnan(one.torque[3, 0]) and np.isfinite(one.torque[3, 2])


def test_every_slot_count_is_swept_with_every_pole_count(monkeypatch):
    """Each block stands where its combination says, here by a torque of its slots times its poles."""
    study = read_study("motorcycle", ["sweep.poles=[10, 14]", "sweep.stator_diameters_mm=[85, 95]"])
    grid = sweep_grid(study)
    assert [(one.slots, one.poles) for one in grid.combinations] == [(9, 10), (9, 14), (12, 10), (12, 14)]
    monkeypatch.setattr(sweep_module, "solve_block", _slots_times_poles)
    found = sweep_stage(CASE, grid, LIMIT, InThisProcess())
    for one in grid.combinations:
        assert (found.map(one, 47.5e-3).torque == one.slots * one.poles).all()
    assert found.data.poles.values.tolist() == [10, 14, 10, 14]


def _slots_times_poles(block):
    shape = len(block.rotor_outer_radii), len(block.back_iron_widths), len(VARIABLES)
    return np.full(shape, float(block.combination.slots * block.combination.poles))


# ---- optima ---------------------------------------------------------------------------------------------------------


def test_the_optimum_is_that_of_the_mean_torque(optima):
    (optimum,) = optima.found
    assert (optimum.back_iron_width, optimum.rotor_outer_radius) == pytest.approx((2.94e-3, 14.56e-3), rel=0.01)
    assert optimum.torque_nominal == pytest.approx(55.83, rel=2e-3)
    assert optimum.torque_null == pytest.approx(55.32, rel=2e-3)
    assert optimum.torque_overload == pytest.approx(132.9, rel=5e-3)
    assert optimum.torque_overload_linear == pytest.approx(optimum.torque_nominal * 20 / 6)
    assert optimum.limit_binds and optimum.limited == pytest.approx(1.2, rel=3e-4)
    assert 0 < optimum.torque_nominal_error < 0.3 and 0 < optimum.torque_overload_error < 1.0


def test_an_optimum_beyond_the_grid_says_which_key_to_move(maps, optima):
    (optimum,) = optima.found
    assert optima.edges == ()
    beyond = edges_at(optimum, replace(GRID, back_iron_fractions=(0.075, 0.115), rotor_radius_fractions=(0.28, 0.34)))
    assert [edge.key for edge in beyond] == ["sweep.back_iron_fraction_min", "sweep.rotor_radius_fraction_max"]
    assert "lower sweep.back_iron_fraction_min" in beyond[0].sentence and "85 mm" in beyond[0].sentence
    assert beyond[1].found == pytest.approx(0.3427, rel=0.01)


def test_no_design_below_the_limit_is_a_sentence(maps):
    impossible = DesignMaps(GRID, replace(LIMIT, limit=0.4), maps.data)
    refused = "no design of the sweep holds the limit of 0.4 T.*raise saturation.limit_T"
    with pytest.raises(NoOptimumError, match=refused):
        optima_stage(CASE, impossible, AS_SWEPT, InThisProcess())


def test_one_section_without_an_optimum_leaves_the_others(maps):
    """Two stators, the second of which holds no design below the limit."""
    grid = replace(GRID, stator_outer_radii=(42.5e-3, 45e-3))
    second = maps.data.assign_coords(stator_outer_radius=[45e-3])
    hot = second.assign(limited=second.limited + 2.0)
    both = DesignMaps(grid, LIMIT, xr.concat([maps.data, hot], "stator_outer_radius", data_vars="minimal"))
    found = optima_stage(CASE, both, AS_SWEPT, InThisProcess())
    assert [one.stator_outer_radius for one in found.found] == [42.5e-3]
    assert "12 slots, 10 poles, 90 mm: no design of the sweep holds 1.2 T" in found.without[0].reason


# ---- limits ---------------------------------------------------------------------------------------------------------


def test_no_limits_need_be_compared():
    found = limits_stage(CASE, GRID, replace(LIMIT, compared=()), InThisProcess())
    assert found.points == () and list(limits_files(found)) == []


def test_limits_differ_in_the_limit_alone():
    found = limits_stage(CASE, GRID, LIMIT, InThisProcess())
    best = {(point.reading, point.limit): point for point in found.points}
    assert len(best) == 6
    names = ("aligned_tooth", "every_tooth", "every_tooth_and_back_iron_over_period")
    free = [best[name, 3.0].torque for name in names]
    assert free == pytest.approx([free[0]] * 3, rel=1e-6), "where no limit binds, all readings see one torque"
    assert best["aligned_tooth", 1.2].torque == pytest.approx(55.8, rel=0.01)
    assert np.isnan(best["every_tooth_and_back_iron_over_period", 1.2].torque)


# ---- fits, from optima alone ----------------------------------------------------------------------------------------


def optima_at(radii, combination=TWELVE):
    """Optima that follow parabolas of the stator radius."""
    return Optima(LIMIT, tuple(_optimum(combination, radius) for radius in radii), (), ())


def _optimum(combination, radius):
    return Optimum(
        combination=combination,
        stator_outer_radius=radius,
        back_iron_width=0.07 * radius,
        rotor_outer_radius=0.3 * radius + 0.8 * radius**2,
        tooth_width=0.1 * radius,
        half_slot_area=0.07 * radius**2,
        torque_nominal=3e4 * radius**2,
        torque_nominal_error=0.1,
        torque_nominal_ring=3e4 * radius**2,
        torque_overload=7e4 * radius**2,
        torque_overload_error=0.1,
        torque_overload_linear=1e5 * radius**2,
        torque_null=nan,
        limited=1.2,
        limit_binds=True,
        tooth_worst=1.5,
        back_iron_worst=1.4,
        field_solutions=20,
        newton_iterations=3,
    )


RADII = (0.035, 0.040, 0.045, 0.050, 0.055)


def test_fits_give_the_section_at_any_radius():
    fits = fits_stage(optima_at(RADII))
    section = fits.at(TWELVE, 0.0425)
    assert section.torque_nominal == pytest.approx(3e4 * 0.0425**2)
    assert section.rotor_outer_radius == pytest.approx(0.3 * 0.0425 + 0.8 * 0.0425**2)
    assert fits.range(TWELVE) == (0.035, 0.055)
    assert fits.usable == (TWELVE,) and len(fits.of(TWELVE).fits) == len(QUANTITIES)
    assert fits.of(TWELVE).of("torque_nominal").r_squared == pytest.approx(1.0)


def test_fits_do_not_care_about_the_order_of_the_optima():
    shuffled = optima_at((0.05, 0.035, 0.055, 0.04, 0.045))
    assert fits_stage(shuffled).at(TWELVE, 0.0425) == fits_stage(optima_at(RADII)).at(TWELVE, 0.0425)


def test_three_diameters_are_refused_with_the_reason():
    fits = fits_stage(optima_at(RADII[:3]))
    assert fits.usable == ()
    said = list(remarks(fits))
    assert len(said) == len(QUANTITIES) and all("3 points cannot test" in one for one in said)
    with pytest.raises(FitRefused, match="add to sweep.stator_diameters_mm"):
        fits.at(TWELVE, 0.04)


def test_fits_refuse_what_they_do_not_know():
    fits = fits_stage(optima_at(RADII))
    with pytest.raises(
        FitRefused, match="no optima of 9 slots, 10 poles are fitted, but of 12 slots, 10 poles: add 9 to sweep.slots"
    ):
        fits.at(Combination(9, 10), 0.04)
    with pytest.raises(FitRefused, match="holds from 35 to 55 mm"):
        fits.at(TWELVE, 0.06)


def test_an_outlier_is_kept_with_its_reason():
    good = optima_at(RADII).found
    bad = Optima(LIMIT, (*good[:2], replace(good[2], torque_nominal=80.0), *good[3:]), (), ())
    fit = fits_stage(bad).of(TWELVE).of("torque_nominal")
    assert "45 mm" in fit.refused and np.isfinite(fit.largest_residual)
