"""Another machine on moved triangles against the same machine meshed anew: torque, cogging and flux linkage."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from math import sqrt

import numpy as np
import pytest

from geometry.errors import GeometryError
from geometry.morph import Morpher
from magnetostatics.flux_linkage import phase_flux_linkage
from magnetostatics.model import OperatingPoint
from magnetostatics.probes import probe_reader
from magnetostatics.torque import arkkio_torque, maxwell_torque
from magnetostatics.variations import Dimension
from tests.magnetostatics.reference_machine import SWEEP, TIGHT, model_of, reference_machine, section_of
from units import DEGREE

RATED, NO_LOAD_FLUX = 55.5, 0.0295
POINTS = [OperatingPoint(angle * DEGREE, j) for angle in (-19.7, -16.6) for j in (6e6 * sqrt(2), 0.0)]
# Dimension [m], and how far moved and new mesh may be apart as a share of the rated torque, by ring and by circle.
# 1e-3 is what the default mesh itself is off by: each of the two has an error of its own.
CHANGES = {
    "airgap -0.1": ({"airgap": 0.4e-3}, (1e-3, 1e-3)),
    "airgap +0.1": ({"airgap": 0.6e-3}, (1e-3, 1e-3)),
    "rotor radius -0.3": ({"rotor_outer_radius": 15.4e-3}, (1e-3, 1e-3)),
    "rotor radius +0.3": ({"rotor_outer_radius": 16.0e-3}, (1e-3, 1e-3)),
    "magnet length +0.3": ({"magnet_length": 2.8e-3}, (1e-3, 1e-3)),
    "tooth width +0.5": ({"tooth_width": 6.0e-3}, (1e-3, 1e-3)),
    "slot opening +0.5": ({"slot_opening": 2.5e-3}, (4e-3, 1e-3)),  # sheared under the shoe by as much as half the gap
}


@cache
def morpher():
    return Morpher(section_of(reference_machine()))


def results(model):
    solutions = [model.solve(point) for point in POINTS]
    torques = np.array([[arkkio_torque(s), maxwell_torque(s)] for s in solutions])
    return torques / RATED, np.array([phase_flux_linkage(s) for s in solutions]) / NO_LOAD_FLUX


@pytest.mark.parametrize("name", CHANGES)
def test_moved_and_new_mesh_agree(name):
    dimensions, tolerance = CHANGES[name]
    machine = replace(reference_machine(), **dimensions)
    moved = model_of(reference_machine(), settings=TIGHT).like(morpher().to(machine))
    found, expected = results(moved), results(model_of(machine, SWEEP, settings=TIGHT))
    assert (np.abs(found[0] - expected[0]).max(axis=0) < tolerance).all()
    assert np.abs(found[1] - expected[1]).max() < 5e-4


def test_a_gap_that_closes_is_refused():
    with pytest.raises(GeometryError):
        morpher().to(replace(reference_machine(), airgap=0.0))


def test_probes_of_a_moved_mesh_are_found_among_those_of_the_first():
    first = model_of(reference_machine())
    moved = first.like(morpher().to(replace(reference_machine(), back_iron_width=3.6e-3)))
    known, anew = probe_reader(moved, probe_reader(first)), probe_reader(moved)
    assert (known.elements == anew.elements).all() and (known.shares == anew.shares).all()


def test_a_dimension_moves_the_mesh_once_for_all_states():
    """Linear and quadratic elements of one model get their share of one moved model."""
    model = model_of(reference_machine())
    varied = Dimension(morpher(), lambda d: replace(reference_machine(), airgap=0.5e-3 + d))
    fine, coarse = (varied.at(one, POINTS[0], 1e-6)[0] for one in (model, model.coarse_model))
    assert fine.coarse_model is coarse and varied.at(model, POINTS[1], 1e-6)[0] is fine
    assert varied.at(model, POINTS[0], -1e-6)[0] is not fine
