"""Magnetic pull on the rotor: zero by symmetry, along the eccentricity, and the derivative of co-energy."""

from __future__ import annotations

from functools import cache
from math import atan2, hypot, pi

import numpy as np
import pytest
from numpy.testing import assert_allclose

from geometry.defects import (
    DynamicEccentricity,
    MagnetArc,
    MagnetPosition,
    SlotOpening,
    StaticEccentricity,
    ToothWidth,
)
from geometry.errors import GeometryError
from geometry.half_cell import MeshDensity
from magnetostatics.currents import PhaseCurrents
from magnetostatics.newton import NewtonSettings
from magnetostatics.torque import arkkio_torque, magnetic_pull, maxwell_torque
from tests.magnetostatics.other_machines import NAMED, currents, model_of
from tests.magnetostatics.reference_machine import FINE, SWEEP
from tests.magnetostatics.whole_machine import COARSE, NINE_SLOTS, TWELVE_EIGHT, whole_model, with_defects
from tests.physics.coenergy import coenergy

pytestmark = pytest.mark.physics

IDLE = PhaseCurrents(-0.353, (0.0, 0.0, 0.0))
LOADED = PhaseCurrents(-0.353, (250.0, -100.0, -150.0))
AMOUNT, DIRECTION = 0.1e-3, 0.7
TYPICAL = 1600.0  # N/m, of 0.1 mm


def turned(vector, angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s], [s, c]]) @ vector


@cache
def field(kind=None, x=0.0, y=0.0, point=IDLE, density=SWEEP, **changes):
    """Solution of a machine with a shift (x, y) [m] of its stator or rotor."""
    base = whole_model(density, **changes)
    model = with_defects(base, kind(hypot(x, y), atan2(y, x))) if kind else base
    return model.solve(point)


@pytest.mark.parametrize("changes", ({}, TWELVE_EIGHT), ids=("12/10", "12/8"))
@pytest.mark.parametrize("point", (IDLE, LOADED))
def test_no_pull_in_a_concentric_machine_with_even_slots(changes, point):
    assert_allclose(magnetic_pull(whole_model(COARSE, **changes).solve(point)), 0.0, atol=1e-6 * TYPICAL)


def nine_slots(angle, currents=(0.0, 0.0, 0.0)):
    return magnetic_pull(whole_model(COARSE, **NINE_SLOTS).solve(PhaseCurrents(angle, currents)))


def test_nine_slots_and_eight_poles_pull_when_concentric():
    """Fields of 4 and, by the slots, 9 - 4 = 5 pairs beat once round the gap, with or without current."""
    assert np.hypot(*nine_slots(0.1)) > 0.2 * TYPICAL
    assert np.hypot(*(nine_slots(0.1, (300.0, -150.0, -150.0)) - nine_slots(0.1))) > 0.2 * TYPICAL


def test_pull_of_nine_slots_has_the_symmetry_of_stator_and_rotor():
    """A pole pitch on, it is the same; a slot pitch on, it has turned by a slot pitch."""
    first = nine_slots(0.1)
    assert_allclose(nine_slots(0.1 + pi / 4), first, atol=1e-6 * TYPICAL)
    assert_allclose(nine_slots(0.1 + 2 * pi / 9), turned(first, 2 * pi / 9), atol=1e-6 * TYPICAL)


@pytest.mark.parametrize("point", (IDLE, LOADED))
def test_pull_of_an_eccentric_stator_is_towards_the_narrow_gap(point):
    shift = AMOUNT * np.array([np.cos(DIRECTION), np.sin(DIRECTION)])
    pull = magnetic_pull(field(StaticEccentricity, *shift, point))
    assert abs(np.hypot(*pull)) == pytest.approx(TYPICAL, rel=0.1)
    assert abs(np.angle(complex(*pull) / complex(*-shift))) < 0.1


def test_pull_of_an_eccentric_rotor_turns_with_it():
    base, pulls = with_defects(whole_model(COARSE), DynamicEccentricity(AMOUNT, DIRECTION)), []
    for angle in np.array([0.0, 1.0, 2.0, 3.0]):
        pulls.append(turned(magnetic_pull(base.solve(PhaseCurrents(angle, (0.0, 0.0, 0.0)))), -angle - DIRECTION))
    assert_allclose(np.array(pulls)[:, 0], TYPICAL, rtol=0.1)
    assert_allclose(np.array(pulls)[:, 1], 0.0, atol=0.1 * TYPICAL)


def coenergy_force(kind, point, density=SWEEP):
    """-dW/dx at held currents is +dW'/dx: central differences of co-energy over the shift (2,) [N/m]."""
    at, step = AMOUNT * np.array([np.cos(DIRECTION), np.sin(DIRECTION)]), 2e-6
    ends = [
        [coenergy(field(kind, *(at + sign * step * axis), point, density)) for sign in (1, -1)] for axis in np.eye(2)
    ]
    return -np.diff(ends, axis=1)[:, 0] / (2 * step)


@pytest.mark.parametrize("point", (IDLE, LOADED))
def test_virtual_work_of_an_eccentric_stator(point):
    """The stator shifted by dx gains co-energy F dx; the rotor feels -F. Within 0.2 %."""
    shift = AMOUNT * np.array([np.cos(DIRECTION), np.sin(DIRECTION)])
    pull, force = magnetic_pull(field(StaticEccentricity, *shift, point)), coenergy_force(StaticEccentricity, point)
    assert_allclose(pull, -force, atol=2e-3 * TYPICAL)


@pytest.mark.parametrize("point", (IDLE, LOADED))
def test_virtual_work_of_an_eccentric_rotor(point):
    """Here the force is read on one side of the sliding circle and the work done on the other: 0.6 % on a fine mesh."""
    shift = AMOUNT * np.array([np.cos(DIRECTION), np.sin(DIRECTION)])
    pull = magnetic_pull(field(DynamicEccentricity, *shift, point, FINE))
    assert_allclose(turned(pull, -point.angle), coenergy_force(DynamicEccentricity, point, FINE), atol=0.006 * TYPICAL)


OF_OTHERS = MeshDensity(gap_edges=360, longest_gap_edge=1.0, gap_layers=2, across_iron=1.5)
TIGHT = NewtonSettings(tolerance=1e-10)
OTHER_KINDS = {"outrunner": 40.0, "reluctance": 600.0, "inset": 300.0}  # ampere-turns of a coil


@pytest.mark.parametrize("name", OTHER_KINDS)
def test_virtual_work_of_machines_of_other_kinds(name):
    """As above, the shift a fifth of the gap."""
    drawn = NAMED[name]
    base, size = model_of(drawn, OF_OTHERS, whole=True, settings=TIGHT), 0.2 * drawn.airgap
    point = currents(base, 0.07, OTHER_KINDS[name], 0.5 if name != "reluctance" else -0.8, 1.0)
    at, step = size * np.array([np.cos(DIRECTION), np.sin(DIRECTION)]), 0.02 * size

    def solved(x, y):
        return with_defects(base, StaticEccentricity(hypot(x, y), atan2(y, x))).solve(point)

    pull, work = magnetic_pull(solved(*at)), []
    for axis in np.eye(2):
        ends = [coenergy(solved(*(at + sign * step * axis))) for sign in (1, -1)]
        work.append((ends[0] - ends[1]) / (2 * step))
    assert_allclose(pull, -np.array(work), atol=0.01 * np.hypot(*pull))
    assert np.hypot(*pull) > 10.0


OF_ONE_KIND = MagnetPosition(1, 0.01), MagnetArc(1, 0.01), SlotOpening(1, 1e-5), ToothWidth(1, 1e-5)


@pytest.mark.parametrize("defect", OF_ONE_KIND, ids=lambda one: type(one).__name__)
def test_defects_that_another_kind_has_not_are_refused(defect):
    with pytest.raises(GeometryError, match="magnets on the surface of an inner rotor, found OutwardTeeth with Outer"):
        with_defects(model_of(NAMED["outrunner"], OF_OTHERS, whole=True), defect)


def test_pull_is_linear_in_a_small_eccentricity():
    pulls = [magnetic_pull(field(StaticEccentricity, share * AMOUNT, 0.0))[0] for share in (0.5, 1.0)]
    assert pulls[1] == pytest.approx(2 * pulls[0], rel=0.02)


@pytest.mark.parametrize("kind", (StaticEccentricity, DynamicEccentricity))
@pytest.mark.parametrize("amount", (0.1e-3, 0.2e-3))
def test_torque_routes_agree_with_eccentricity(kind, amount):
    """On either side of the sliding circle, one of them no ring any more: 0.2 % at 40 % of the gap."""
    solution = field(kind, amount, 0.0, LOADED)
    assert arkkio_torque(solution) == pytest.approx(maxwell_torque(solution), rel=2e-3)


def test_shifting_both_is_no_eccentricity():
    """Stator and rotor shifted together are concentric about an axis beside that of rotation.

    Of the two pulls of 1600 N/m that cancel the coarse gap leaves 1.3 % (0.3 % with 720 edges and three layers).
    """
    model = with_defects(
        whole_model(SWEEP), StaticEccentricity(AMOUNT, 0.0), DynamicEccentricity(AMOUNT, -LOADED.angle)
    )
    solution = model.solve(LOADED)
    assert_allclose(magnetic_pull(solution), 0.0, atol=0.02 * TYPICAL)
    assert arkkio_torque(solution) == pytest.approx(arkkio_torque(field(None, 0.0, 0.0, LOADED)), rel=2e-3)
