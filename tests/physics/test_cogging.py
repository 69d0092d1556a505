"""Cogging of 12 slots and 10 poles: period 2 pi / lcm(12, 10) = 6 degrees, odd about the positions of rest."""

from __future__ import annotations

from functools import cache
from math import lcm

import numpy as np
import pytest
from numpy.testing import assert_allclose

from geometry.half_cell import MeshDensity
from magnetostatics.model import OperatingPoint
from magnetostatics.torque import arkkio_torque, maxwell_torque
from tests.magnetostatics.reference_machine import FINE, SWEEP, TIGHT, model_of, reference_machine
from units import DEGREE

pytestmark = pytest.mark.physics

RATED = 55.5  # Nm/m, at 6 A/mm^2 RMS
PERIOD = 6.0  # degrees
STEPS = 18  # in one period; none half way between two nodes, where rounding decides which way the gap is sheared
ROUTES = {"ring": arkkio_torque, "circle": maxwell_torque}
MESHES = {"sweep": SWEEP, "fine": FINE}
both_routes = pytest.mark.parametrize("route", ROUTES)
both_meshes = pytest.mark.parametrize("mesh", MESHES)


@cache
def cogging(mesh) -> dict[str, np.ndarray]:
    """Torque [Nm/m] of both routes at equal steps over one period, from a magnet on tooth 0 on."""
    model, solution, rows = model_of(reference_machine(), MESHES[mesh], settings=TIGHT), None, []
    for k in range(STEPS):
        solution = model.solve(OperatingPoint(PERIOD * k / STEPS * DEGREE), start=solution)
        rows.append([route(solution) for route in ROUTES.values()])
    return dict(zip(ROUTES, np.array(rows).T))


def torque_at(angle, mesh="sweep"):
    model = model_of(reference_machine(), MESHES[mesh], settings=TIGHT)
    return arkkio_torque(model.solve(OperatingPoint(angle * DEGREE)))


def amplitudes(torque) -> np.ndarray:
    """Of the harmonics of the period, from order 0 on [Nm/m]."""
    return np.abs(np.fft.rfft(torque)) * 2 / len(torque)


@both_meshes
@both_routes
def test_mean_is_zero(route, mesh):
    """Less than 1e-4 of the rated torque: a machine without current does no work in a turn."""
    assert abs(cogging(mesh)[route].mean()) < 1e-4 * RATED


def test_period():
    """6 degrees and no fraction of it."""
    first = torque_at(1.3)
    assert_allclose(torque_at(1.3 + PERIOD), first, rtol=1e-6)
    for part in (2, 3):
        assert abs(torque_at(1.3 + PERIOD / part) - first) > 0.5


@both_meshes
@both_routes
def test_zero_with_a_magnet_on_a_tooth_and_midway(route, mesh):
    torque = cogging(mesh)[route]
    assert np.abs(torque[[0, STEPS // 2]]).max() < 1e-6 * RATED


@both_meshes
@both_routes
def test_odd_about_the_zero(route, mesh):
    torque = cogging(mesh)[route]
    assert_allclose(torque[1:], -torque[:0:-1], atol=1e-6 * RATED)


@both_meshes
@both_routes
def test_amplitude(route, mesh):
    """1.2 Nm/m, nearly all in the first harmonic; what a coarse gap misses is 0.2 % of the rated torque at most."""
    found = amplitudes(cogging(mesh)[route])
    assert_allclose(found[1], 1.18, atol=2e-3 * RATED)
    assert found[1] > 15 * found[2:].max()


@both_routes
def test_amplitude_on_a_finer_mesh(route):
    """With 720 edges the peak, a quarter of a period from the zero, is the reference's +-1.2 Nm/m."""
    model = model_of(reference_machine(), MeshDensity(gap_edges=720, gap_layers=3, across_iron=3.0))
    assert_allclose(ROUTES[route](model.solve(OperatingPoint(PERIOD / 4 * DEGREE))), 1.2, rtol=1e-2)


@both_meshes
def test_spectrum_is_free_of_mesh_orders(mesh):
    """What the edges of the sliding circle would make stays below 0.05 % of the rated torque, as all high harmonics.

    An edge of the sliding circle is a whole fraction of the 6 degrees, so its order is a multiple of the cogging's.
    """
    edges = MESHES[mesh].edges_around(reference_machine()) // lcm(12, 10)
    found = amplitudes(cogging(mesh)["ring"])
    assert found[edges::edges].max() < 5e-4 * RATED
    assert found[4:].max() < 5e-4 * RATED


def test_two_meshes_agree_on_every_harmonic():
    """Mesh orders of 240 and 360 edges differ, physical ones do not: 0.1 % of the rated torque between the spectra."""
    assert_allclose(amplitudes(cogging("sweep")["ring"]), amplitudes(cogging("fine")["ring"]), atol=1e-3 * RATED)


def test_period_of_nine_slots():
    """2 pi / lcm(9, 10): 4 degrees, and far smaller than with 12 slots."""
    model = model_of(reference_machine(slots=9), MeshDensity(gap_edges=360), settings=TIGHT)
    torques = [arkkio_torque(model.solve(OperatingPoint(angle * DEGREE))) for angle in (1.0, 5.0, 3.0)]
    assert_allclose(torques[1], torques[0], atol=1e-5 * RATED)
    assert_allclose(torques[2], -torques[0], atol=5e-4 * RATED)
    assert 0 < abs(torques[0]) < 0.2
