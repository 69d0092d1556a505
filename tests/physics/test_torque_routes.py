"""Three routes to one torque: stress on the mid-gap circle, stress averaged over a ring, and virtual work."""

from __future__ import annotations

from functools import cache
from math import sqrt

import numpy as np
import pytest
from numpy.testing import assert_allclose

from geometry.half_cell import MeshDensity
from magnetostatics.model import MachineMaterials, OperatingPoint
from magnetostatics.torque import arkkio_torque, maxwell_torque
from materials.magnet import Magnet
from tests.magnetostatics.reference_machine import FINE, STEEL, TIGHT, model_of, reference_machine
from tests.physics.coenergy import ampere_turns_of, coenergy, phase_currents
from units import DEGREE

pytestmark = pytest.mark.physics

FINER = MeshDensity(gap_edges=600, gap_layers=3, across_iron=3.0)
SIX, TWENTY = 6e6 * sqrt(2), 20e6 * sqrt(2)  # A/m^2 amplitude, 6 and 20 A/mm^2 RMS
STEP = 0.02 * DEGREE  # of virtual work: W' changes by 1e-4 of itself, the field is solved to 1e-9


@cache
def fine_model(density=FINE, recoil_permeability=1.0):
    materials = MachineMaterials(STEEL, STEEL, Magnet(1.3, recoil_permeability))
    return model_of(reference_machine(), density, settings=TIGHT, materials=materials)


def virtual_work_torque(solution) -> float:
    """(W'(theta + d) - W'(theta - d)) / 2d with the currents of all phases held."""
    model, point = solution.model, solution.point
    held = ampere_turns_of(model, point)
    ends = [model.solve(phase_currents(model, point.angle + d, held), solution) for d in (STEP, -STEP)]
    return (coenergy(ends[0]) - coenergy(ends[1])) / (2 * STEP)


def three_torques(model, point):
    solution = model.solve(point)
    return [route(solution) for route in (arkkio_torque, maxwell_torque, virtual_work_torque)]


@pytest.mark.parametrize(
    ("angle", "amplitude", "gamma"),
    ((-21, SIX, 0), (-24, SIX, 15), (-20, SIX, 0), (-21, TWENTY, 0), (-19, TWENTY, 30)),
)
def test_three_routes(angle, amplitude, gamma):
    """Within 0.1 % of each other with the rotor on the nodes of the sliding circle, also in deep saturation."""
    arkkio, maxwell, work = three_torques(fine_model(), OperatingPoint(angle * DEGREE, amplitude, gamma * DEGREE))
    assert_allclose([maxwell, work], arkkio, rtol=1e-3)


def test_three_routes_with_recoil_permeability():
    """The co-energy of a magnet with mu_r > 1."""
    arkkio, maxwell, work = three_torques(fine_model(FINE, 1.05), OperatingPoint(-21 * DEGREE, SIX))
    assert_allclose([maxwell, work], arkkio, rtol=1e-3)


def test_three_routes_between_nodes():
    """Where the rotor side of the gap is sheared by half an edge, on a finer mesh."""
    arkkio, maxwell, work = three_torques(fine_model(FINER), OperatingPoint(-19.65 * DEGREE, SIX))
    assert_allclose([maxwell, work], arkkio, rtol=1e-3)


def test_three_routes_of_cogging():
    """Without current the torque is small: within 0.1 % of the torque at 6 A/mm^2 RMS."""
    torques = three_torques(fine_model(), OperatingPoint(-19 * DEGREE))
    assert np.ptp(torques) < 1e-3 * 55.5
    assert abs(torques[0]) > 0.5
