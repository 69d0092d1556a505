"""Newton's method on the machine: how it ends, where it starts from, and what happens at the edges of its range."""

from __future__ import annotations

from functools import cache
from math import log, sqrt

import numpy as np
import pytest
from numpy.testing import assert_allclose

from geometry.half_cell import MeshDensity
from geometry.magnetisation import RadialMagnetisation
from magnetostatics.elements import LINEAR, QUADRATIC
from magnetostatics.flux_linkage import phase_flux_linkage
from magnetostatics.model import FieldModel, MachineMaterials, OperatingPoint
from magnetostatics.newton import FieldSolutionError, NewtonSettings
from magnetostatics.torque import arkkio_torque, maxwell_torque
from materials.library import known_steels, load_steel
from materials.magnet import Magnet
from materials.reluctivity import LinearReluctivity
from tests.magnetostatics.other_machines import NAMED, currents
from tests.magnetostatics.other_machines import model_of as other_model_of
from tests.magnetostatics.reference_machine import MATERIALS, STEEL, model_of, reference_machine, section_of
from units import DEGREE

SHARP = NewtonSettings(tolerance=1e-12)
POINT = OperatingPoint(-20.7 * DEGREE, 6e6 * sqrt(2))
CURRENTS = (0.0, 6e6 * sqrt(2), 20e6 * sqrt(2), 1e9)  # A/m^2; the last is far beyond any copper
both_orders = pytest.mark.parametrize("order", (LINEAR, QUADRATIC), ids=("linear", "quadratic"))


@cache
def sharp_model(order=QUADRATIC) -> FieldModel:
    return model_of(reference_machine(), settings=SHARP, order=order)


@cache
def cold(current, order=QUADRATIC):
    return sharp_model(order).solve(OperatingPoint(POINT.angle, current))


@both_orders
@pytest.mark.parametrize("current", CURRENTS)
def test_ends_quadratically(current, order):
    """Digits nearly double from step to step at the end: the tangent is the derivative of the residual."""
    residuals = [r for r in cold(current, order).newton.residuals if r > 1e-12]
    digits = [-log(r) for r in residuals[-3:]]
    assert digits[-1] > 1.35 * digits[-2]
    assert residuals[-1] < 100 * residuals[-2] ** 1.5


@both_orders
@pytest.mark.parametrize("current", CURRENTS[:3])
def test_needs_few_whole_steps(current, order):
    """From the linear elements' solution five to seven steps to 1e-12, from zero nine, none of them shortened."""
    record = cold(current, order).newton
    assert record.iterations <= (7 if order is QUADRATIC else 9)
    assert set(record.steps) == {1.0}


@pytest.mark.parametrize("name", ("V shape", "two layers"))
def test_saturated_bridges_need_few_steps(name):
    """From zero field, where the first step sends more than 10 T through them."""
    model = other_model_of(NAMED[name], MeshDensity(120, 2.5, 2, 1.0), order=LINEAR)
    record = model.solve(currents(model, 0.07, 337.5, 0.5, 1.0)).newton
    assert record.iterations <= 9


def test_warm_and_cold_start_reach_one_field():
    """From a distant rotor position and another current, and from zero current."""
    wanted = cold(POINT.current_density)
    for start in (sharp_model().solve(OperatingPoint(10 * DEGREE, 20e6 * sqrt(2))), cold(0.0)):
        found = sharp_model().solve(OperatingPoint(POINT.angle, POINT.current_density), start=start)
        assert_allclose(found.a, wanted.a, atol=1e-8 * np.abs(wanted.a).max())


def test_a_solution_is_where_newton_stops():
    """Started from itself, one step of nothing."""
    solution = cold(POINT.current_density)
    again = sharp_model().solve(solution.point, start=solution)
    assert again.newton.iterations == 1
    assert_allclose(again.a, solution.a, atol=1e-10 * np.abs(solution.a).max())


def test_default_tolerance_is_enough():
    """Torque and flux linkage at the default tolerance against 1e-12: 5e-5 of the torque."""
    quick = model_of(reference_machine()).solve(POINT)
    sharp = cold(POINT.current_density)
    for route in (arkkio_torque, maxwell_torque):
        assert_allclose(route(quick), route(sharp), rtol=5e-5)
    assert_allclose(phase_flux_linkage(quick), phase_flux_linkage(sharp), rtol=1e-4)


def without_magnets(steel=STEEL):
    """Materials with no remanence."""
    return MachineMaterials(steel, steel, Magnet(remanence=0.0, recoil_permeability=1.0))


def test_no_sources_no_field():
    solution = model_of(reference_machine(), materials=without_magnets()).solve(OperatingPoint(0.1))
    assert not solution.a.any()
    assert solution.newton.iterations == 0
    assert arkkio_torque(solution) == maxwell_torque(solution) == 0.0


def test_no_magnets_no_torque():
    """Surface magnets of mu_r = 1 have no saliency: currents alone make no torque (103 Nm/m with magnets)."""
    model = model_of(reference_machine(), materials=without_magnets(), settings=SHARP)
    solution = model.solve(OperatingPoint(0.1, 20e6))
    assert abs(arkkio_torque(solution)) < 1e-4 * 103
    assert abs(maxwell_torque(solution)) < 2e-4 * 103


def test_gives_up_with_its_record():
    model = model_of(reference_machine(), settings=NewtonSettings(tolerance=1e-12, most_iterations=2))
    with pytest.raises(FieldSolutionError, match="2 Newton iterations"):
        model.solve(POINT)


@pytest.mark.parametrize("name", known_steels())
def test_every_steel_converges(name):
    steel = load_steel(name)
    solution = model_of(reference_machine(), materials=MachineMaterials(steel, steel, MATERIALS.magnet)).solve(POINT)
    assert_allclose(arkkio_torque(solution), maxwell_torque(solution), rtol=5e-3)


@pytest.mark.parametrize(
    "name", ("airgap", "rotor_outer_radius", "back_iron_width", "stator_outer_radius", "slot_opening", "magnet_length")
)
def test_torque_is_smooth_in_the_dimensions(name):
    """A millionth and a ten-thousandth of a change: torque follows in proportion, no jump of the mesh."""

    def torque(factor):
        value = getattr(reference_machine(), name) * factor
        return arkkio_torque(model_of(reference_machine(**{name: value}), settings=SHARP).solve(POINT))

    base = torque(1.0)
    small, large = (torque(1 + change) - base for change in (1e-6, 1e-4))
    assert_allclose(100 * small, large, rtol=5e-2, atol=1e-5 * base)
    assert abs(large) < 1e-3 * base


def test_radial_magnetisation_makes_less_torque_with_ten_poles():
    """37.14 against 39.49 Nm/m: at full arc the parallel pattern has the larger first harmonic."""
    radial = model_of(reference_machine(magnetisation=RadialMagnetisation())).solve(POINT)
    assert 0.9 < arkkio_torque(radial) / arkkio_torque(cold(POINT.current_density)) < 0.97


def test_torque_falls_with_the_magnet_arc():
    """Both routes, from full arc down to a half; a slit between the magnets is no different from none."""
    machines = [reference_machine(magnet_arc_fraction=arc) for arc in (1.0, 0.9999, 0.95, 0.8, 0.5)]
    fields = [model_of(machine).solve(POINT) for machine in machines]
    torques = np.array([(arkkio_torque(field), maxwell_torque(field)) for field in fields])
    assert_allclose(torques[1], torques[0], rtol=2e-3)
    assert_allclose(torques[:, 0], torques[:, 1], rtol=5e-3)
    assert (np.diff(torques[1:], axis=0) < 0).all()


@cache
def linear_limit(layers):
    """(no-load flux linkage, mean torque) of a weakly magnetised machine with linear steel, in one amplitude of J."""
    weak = MachineMaterials(LinearReluctivity(1e5), LinearReluctivity(1e5), Magnet(1e-3, 1.0))
    model = model_of(reference_machine(), layers=layers, materials=weak, settings=SHARP)
    axis = model.section.layout.phase_axis
    first = (axis - np.pi / 2) / 5
    angles = first + 12 * DEGREE * np.arange(4) / 4
    torque = [
        arkkio_torque(model.solve(OperatingPoint(angle, 1e6))) - arkkio_torque(model.solve(OperatingPoint(angle)))
        for angle in angles
    ]
    steps = 8  # over 120 electrical degrees; B and C supply the rest of the period of A
    psi = np.array([phase_flux_linkage(model.solve(OperatingPoint(24 * DEGREE * k / steps))) for k in range(steps)])
    period = np.concatenate([psi[:, 0], psi[:, 2], psi[:, 1]])
    return np.abs(np.fft.rfft(period))[1] * 2 / len(period), np.mean(torque)


def test_single_layer_of_twelve_slots():
    """12/10 with one layer: k_w 0.966 against 0.933, and half as many coils of twice the copper.

    So at equal current density torque goes as k_w, flux linkage per turn as k_w/2.
    """
    layouts = [section_of(reference_machine(), layers=layers).layout for layers in (1, 2)]
    ratio = layouts[0].winding_factor() / layouts[1].winding_factor()
    assert_allclose(ratio, 0.9659258 / 0.9330127, rtol=1e-6)
    (psi_1, torque_1), (psi_2, torque_2) = linear_limit(1), linear_limit(2)
    assert_allclose(2 * psi_1 / psi_2, ratio, rtol=5e-4)
    assert_allclose(torque_1 / torque_2, ratio, rtol=5e-4)


def test_single_layer_saturates_earlier():
    """At 6 A/mm^2 RMS less of the 3.5 % is left: the coils crowd on every second tooth."""
    torques = []
    for layers in (1, 2):
        model = model_of(reference_machine(), layers=layers)
        first = (model.section.layout.phase_axis - np.pi / 2) / 5
        fields = [model.solve(OperatingPoint(first + 3 * DEGREE * k, POINT.current_density)) for k in range(4)]
        torques.append(np.mean([arkkio_torque(field) for field in fields]))
    assert 1.0 < torques[0] / torques[1] < 1.035
