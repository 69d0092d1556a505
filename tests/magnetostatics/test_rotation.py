"""Turning the rotor without a new mesh: whole edges by matching nodes, the rest by shearing the rotor-side gap."""

from __future__ import annotations

from functools import cache
from math import pi, sqrt

import numpy as np
import pytest
from numpy.testing import assert_allclose

from magnetostatics.flux_linkage import park, phase_flux_linkage
from magnetostatics.model import OperatingPoint
from magnetostatics.torque import arkkio_torque, maxwell_torque
from tests.magnetostatics.reference_machine import FINE, SWEEP, TIGHT, model_of, reference_machine
from units import DEGREE

RATED = 55.5  # Nm/m, at 6 A/mm^2 RMS
AMPLITUDE = 6e6 * sqrt(2)
ROUTES = {"ring": arkkio_torque, "circle": maxwell_torque}
MESHES = {"sweep": SWEEP, "fine": FINE}
STEPS = 40  # in 12 degrees, 0.3 degrees each: mostly between the nodes of either mesh


@cache
def model(mesh="fine"):
    return model_of(reference_machine(), MESHES[mesh], settings=TIGHT)


@cache
def solved(angle, mesh="fine", gamma=0.0):
    return model(mesh).solve(OperatingPoint(angle, AMPLITUDE, gamma))


@cache
def scan(mesh="fine") -> dict[str, np.ndarray]:
    """Torque [Nm/m] of both routes and psi_d, psi_q [Wb/m] over the 12 degrees on which everything repeats."""
    solution, rows = None, []
    for k in range(STEPS):
        point = OperatingPoint((-24 + 12 * k / STEPS) * DEGREE, AMPLITUDE)
        solution = model(mesh).solve(point, start=solution)
        psi = park(phase_flux_linkage(solution), 5 * point.angle, model(mesh).section.layout.phase_axis)
        rows.append([route(solution) for route in ROUTES.values()] + list(psi))
    return dict(zip([*ROUTES, "psi_d", "psi_q"], np.array(rows).T))


def noise(values, harmonics=8) -> float:
    """Largest distance from the smooth curve of the first few harmonics."""
    spectrum = np.fft.rfft(values)
    spectrum[: harmonics + 1] = 0
    return np.abs(np.fft.irfft(spectrum, len(values))).max()


@pytest.mark.parametrize("turn", (2 * pi, -2 * pi, 6 * pi))
def test_whole_turns(turn):
    """After whole turns the field is the same, node by node."""
    there = solved(-20.3 * DEGREE + turn, "sweep")
    assert_allclose(there.a, solved(-20.3 * DEGREE, "sweep").a, atol=1e-9 * np.abs(there.a).max())


@pytest.mark.parametrize("turn", (pi, pi / 5, 12 * DEGREE))
def test_turns_on_which_the_machine_repeats(turn):
    """Half a turn, a pole pitch and 60 electrical degrees: the same torque and dq flux linkage at q-axis current."""
    first, later = solved(-20.3 * DEGREE, "sweep"), solved(-20.3 * DEGREE + turn, "sweep")
    for route in ROUTES.values():
        assert_allclose(route(later), route(first), rtol=1e-6)
    axis = model("sweep").section.layout.phase_axis
    dq = [park(phase_flux_linkage(field), 5 * field.point.angle, axis) for field in (first, later)]
    assert_allclose(dq[1], dq[0], rtol=1e-6)


@pytest.mark.parametrize(
    ("route", "mesh", "jump"),
    (
        ("ring", "sweep", 5e-4),
        ("ring", "fine", 2e-4),
        ("circle", "sweep", 2e-3),
        ("circle", "fine", 1e-3),
    ),
)
@pytest.mark.parametrize("edge", (0, 1, 2))
def test_no_jump_where_the_shear_changes_sides(edge, route, mesh, jump):
    """Half way between two nodes the shear goes from + half an edge to - half an edge, with one more edge turned."""
    unknowns = model(mesh).unknowns
    turned = np.ceil((-21 * DEGREE + unknowns.offset) / unknowns.edge_angle) + edge
    switch = (turned + 0.5) * unknowns.edge_angle - unknowns.offset
    before, after = (solved(switch + sign * 1e-7, mesh) for sign in (-1, 1))
    assert unknowns.turn(after.point.angle).edges == unknowns.turn(before.point.angle).edges + 1
    assert abs(ROUTES[route](after) - ROUTES[route](before)) < jump * RATED


def test_ring_torque_is_free_of_noise():
    """0.01 % of the rated torque around the curve of eight harmonics, where 0.05 % are asked for."""
    assert noise(scan()["ring"]) < 1e-4 * RATED


def test_circle_torque_is_nearly_free_of_noise():
    assert noise(scan()["circle"]) < 5e-4 * RATED


def test_flux_linkage_is_free_of_noise():
    """2e-5 of the magnets' flux linkage, true harmonics above the eighth included: what flux maps are made of."""
    assert noise(scan()["psi_d"]) < 2e-5 * 0.0295
    assert noise(scan()["psi_q"]) < 2e-5 * 0.0295


@pytest.mark.parametrize(("mesh", "tolerance"), (("fine", 1e-3), ("sweep", 5e-3)))
def test_routes_agree_at_every_angle(mesh, tolerance):
    """0.5 % on the mesh of the sweep, 0.1 % on the finer one."""
    assert np.abs(scan(mesh)["ring"] - scan(mesh)["circle"]).max() < tolerance * RATED


def test_ring_torque_of_the_sweep_is_free_of_noise():
    """The coarse mesh of the sweep keeps to 0.05 % as well."""
    assert noise(scan("sweep")["ring"]) < 5e-4 * RATED


def test_two_meshes_follow_one_curve():
    """Torque over the angle on both meshes within 0.2 % of the rated torque, at every angle."""
    assert_allclose(scan("sweep")["ring"], scan("fine")["ring"], atol=2e-3 * RATED)
