"""Energy: flux linkage as the derivative of co-energy, reciprocity, and the balance of work over a turn."""

from __future__ import annotations

from functools import cache
from math import sqrt

import numpy as np
import pytest
from numpy.testing import assert_allclose

from magnetostatics.flux_linkage import phase_flux_linkage
from magnetostatics.model import OperatingPoint
from magnetostatics.torque import arkkio_torque, maxwell_torque
from tests.magnetostatics.reference_machine import FINE, SWEEP, TIGHT, model_of, reference_machine
from tests.physics.coenergy import ampere_turns_of, coenergy, phase_currents
from units import DEGREE

pytestmark = pytest.mark.physics

SATURATED = OperatingPoint(-19.3 * DEGREE, 20e6 * sqrt(2), 20 * DEGREE)  # teeth at 1.9 T
both_layers = pytest.mark.parametrize("layers", (2, 1))


@cache
def sharp_model(layers=2, density=SWEEP):
    return model_of(reference_machine(), density, layers=layers, settings=TIGHT)


@cache
def saturated_field(layers):
    return sharp_model(layers).solve(SATURATED)


def with_more_current(layers, phase, extra):
    """The saturated field with some more ampere-turns [A] in one phase."""
    model = sharp_model(layers)
    ampere_turns = ampere_turns_of(model, SATURATED) + extra * np.eye(3)[phase]
    return model.solve(phase_currents(model, SATURATED.angle, ampere_turns), saturated_field(layers))


@both_layers
def test_flux_linkage_is_the_derivative_of_coenergy(layers):
    """psi_i = dW'/di_i for every phase, a double and a single layer, saturated, the rotor between two nodes."""
    step = 2.0  # A of some 850
    ends = [[coenergy(with_more_current(layers, phase, sign * step)) for sign in (1, -1)] for phase in range(3)]
    derivative = -np.diff(ends, axis=1)[:, 0] / (2 * step)
    assert_allclose(derivative, phase_flux_linkage(saturated_field(layers)), rtol=1e-5, atol=1e-8)


@both_layers
def test_incremental_inductances_are_reciprocal(layers):
    """dpsi_a/di_b = dpsi_b/di_a, all nine by central differences; the matrix is positive definite."""
    step = 2.0
    more, less = (
        np.array([phase_flux_linkage(with_more_current(layers, phase, change)) for phase in range(3)])
        for change in (step, -step)
    )
    inductance = (more - less) / (2 * step)
    largest = np.abs(inductance).max()
    assert_allclose(inductance, inductance.T, atol=1e-5 * largest)
    assert np.linalg.eigvalsh(inductance).min() > 0
    assert np.ptp(np.diag(inductance)) > 0.02 * largest  # saturation makes the phases unequal


def test_work_at_held_currents():
    """W'(theta_2) - W'(theta_1) = integral of T dtheta at constant currents, over four edges of the sliding circle.

    Both ends on nodes: between nodes the sheared gap changes the co-energy by 1e-4 of itself.
    """
    model = sharp_model(density=FINE)
    held = ampere_turns_of(model, OperatingPoint(-21 * DEGREE, 6e6 * sqrt(2)))
    nodes, weights = np.polynomial.legendre.leggauss(6)
    ends = [coenergy(model.solve(phase_currents(model, angle * DEGREE, held))) for angle in (-19, -23)]
    fields = [model.solve(phase_currents(model, (-21 + 2 * node) * DEGREE, held)) for node in nodes]
    for route in (arkkio_torque, maxwell_torque):
        work = 2 * DEGREE * sum(weight * route(field) for weight, field in zip(weights, fields))
        assert_allclose(work, ends[0] - ends[1], rtol=1e-3)


def period_fields(amplitude, gamma, steps=16):
    """Fields at equal steps over 60 electrical degrees, after which a balanced machine repeats itself."""
    model, solution = sharp_model(), None
    for k in range(steps):
        solution = model.solve(OperatingPoint((-24 + 12 * k / steps) * DEGREE, amplitude, gamma), start=solution)
        yield solution


@pytest.mark.parametrize(("amplitude", "gamma"), ((6e6 * sqrt(2), 0.0), (20e6 * sqrt(2), 30 * DEGREE)))
def test_energy_balance_over_a_period(amplitude, gamma):
    """dW' = T dtheta + sum psi di, and W' is the same again after 60 electrical degrees:
    integral T dtheta = -integral sum_i psi_i (di_i/dtheta) dtheta.
    """
    mechanical, electrical = [], []
    for field in period_fields(amplitude, gamma):
        lead = OperatingPoint(field.point.angle, amplitude, gamma + 90 * DEGREE)  # d cos(p theta + ..)/d(p theta)
        slope = 5 * ampere_turns_of(field.model, lead)
        mechanical.append(arkkio_torque(field))
        electrical.append(-phase_flux_linkage(field) @ slope)
    assert_allclose(np.mean(mechanical), np.mean(electrical), rtol=5e-4)


def test_coenergy_repeats_after_a_period():
    """The premise of the balance, and of the sector's sign: 60 electrical degrees on, the co-energy is the same."""
    model = sharp_model()
    first, later = (coenergy(model.solve(OperatingPoint(angle * DEGREE, 8e6, 0.2))) for angle in (-20.2, -8.2))
    assert_allclose(later, first, rtol=1e-9)
