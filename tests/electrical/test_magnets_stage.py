"""What the currents of a wound machine do to its magnets: a strong grade holds, a weak one fails, and by how much."""

from dataclasses import replace
from math import inf

import numpy as np
import pytest

from drivetrain.asked import LostMagnets
from drivetrain.gear_views import braking_demand
from drivetrain.output import Wheel
from electrical.braking_stage import CopperHeat, braking_stage
from electrical.magnets_stage import (
    FAULT,
    NO_LOAD,
    OVERLOAD,
    STEADY,
    SUDDEN,
    MagnetInputs,
    demagnetising_current,
    magnets_stage,
    steady_current,
    with_grade,
)
from electrical.winding_stage import winding_stage
from geometry.half_cell import MeshDensity
from magnetostatics.case import FieldCase
from materials.magnet import Magnet
from materials.magnet_grade import load_grade
from report.magnets import remarks
from tasks import InThisProcess
from tests.electrical.analytic_map import DEMAND, GOOD, INPUTS, MATCHED, REQUIRED, TRANSMISSION, flux_map
from tests.magnetostatics.reference_machine import MATERIALS
from units import MU_0

COARSE = MeshDensity(gap_edges=60, gap_layers=1, across_iron=1.0)
CASE = FieldCase(MATERIALS, 2, None, 0.3, COARSE, COARSE, 6e6, 20e6)
STRONG, WEAK, FERRITE = "N42UH", "N42SH", "Y30H-1"
MAP = flux_map()


@pytest.fixture(scope="module")
def winding():
    return winding_stage(MAP, MATCHED, DEMAND, INPUTS, GOOD)


@pytest.fixture(scope="module")
def braking(winding):
    heat = CopperHeat(20.0, 120.0, 1.0, 1.393)
    return braking_stage(MAP, winding, INPUTS, braking_demand(REQUIRED, TRANSMISSION), heat)


@pytest.fixture(scope="module")
def magnets(winding, braking):
    """Of each grade."""

    def of(name):
        return magnets_stage(
            CASE, MAP, winding, braking, MagnetInputs(load_grade(name), -15.0, 120.0, 0.01, 2), InThisProcess()
        )

    return {name: of(name) for name in (STRONG, WEAK, FERRITE)}


def states(found):
    return {state.name: state for state in found.states}


def test_a_strong_grade_holds_and_a_weak_one_fails(magnets):
    assert magnets[STRONG].lost < 0.01 < magnets[WEAK].lost < magnets[FERRITE].lost
    assert magnets[STRONG].margin(magnets[STRONG].worst) > 0 > magnets[WEAK].margin(magnets[WEAK].worst)
    assert states(magnets[FERRITE])[OVERLOAD].lost > 0.5, "ferrite at 20 A/mm2"
    assert next(remarks(magnets[FERRITE])).startswith("THE MAGNETS FAIL")


def test_the_field_against_the_magnets_is_that_of_the_straight_line(magnets):
    """B = B_r - mu_0 mu_r H: a knee that is off with the field by so much lies where the worst flux density did."""
    found = magnets[STRONG]
    magnet = found.inputs.grade.magnet_at(120.0)
    line = magnet.remanence - MU_0 * magnet.recoil_permeability * found.opposing_field
    assert line == pytest.approx(found.worst.exceeded) and found.opposing_field < found.field_at_knee
    assert found.knee_off_by(found.field_at_knee / found.opposing_field - 1) - found.knee == pytest.approx(
        found.margin(found.worst)
    )
    assert magnets[WEAK].opposing_field > magnets[WEAK].field_at_knee


def test_the_requirement_says_so(magnets):
    for name, holds in ((STRONG, True), (WEAK, False), (FERRITE, False)):
        check = LostMagnets(0.01, magnets[name].lost).check(None)
        assert check.holds is holds and (check.margin > 0) is holds
        assert check.requirement.unit(Wheel()) == "percent"


def test_each_grade_is_judged_where_it_is_weaker(magnets):
    assert (magnets[STRONG].temperature, magnets[FERRITE].temperature) == (120.0, -15.0)
    assert magnets[FERRITE].knee == pytest.approx(load_grade(FERRITE).knee_at(-15.0))


def test_the_states_are_those_of_the_machine(magnets, winding, braking):
    found, largest = states(magnets[WEAK]), winding.limits.current_peak
    assert [found[name].i_d for name in (NO_LOAD, OVERLOAD, FAULT)] == [0.0, 0.0, pytest.approx(-largest)]
    assert found[STEADY].i_d == pytest.approx(np.nanmin(braking.cold.i_d))
    plain = winding.constant
    assert -(plain.psi_m + np.hypot(*plain.flux_linkage(0.0, largest))) / plain.inductance_d < found[SUDDEN].i_d
    assert found[SUDDEN].i_d < 2 * found[STEADY].i_d
    least = [found[name].least for name in (NO_LOAD, STEADY, FAULT, SUDDEN)]
    assert least == sorted(least, reverse=True), "the more current against the magnets, the less is left"


def test_a_turn_loses_more_than_one_angle(magnets):
    for found in magnets.values():
        assert all(state.lost_at_once <= state.lost for state in found.states)
    assert states(magnets[WEAK])[SUDDEN].lost_at_once < 0.5 * states(magnets[WEAK])[SUDDEN].lost


def test_the_demagnetising_current_is_where_the_allowed_share_is_lost(magnets, winding, braking):
    """Solved there again, as a fault of that current."""
    found = magnets[WEAK]
    limits = replace(winding.limits, current_peak=found.demagnetising_current)
    again = magnets_stage(CASE, MAP, replace(winding, limits=limits), braking, found.inputs, InThisProcess())
    assert states(again)[FAULT].exceeded == pytest.approx(found.knee, abs=0.01)
    assert 0 < magnets[FERRITE].demagnetising_current < found.demagnetising_current
    assert found.demagnetising_current < magnets[STRONG].demagnetising_current


def test_demagnetising_currents_by_hand():
    against = [0.0, 10.0, 20.0]
    assert demagnetising_current(against, [0.5, 0.3, 0.2], 0.4) == pytest.approx(5.0)
    assert demagnetising_current(against, [0.5, 0.3, 0.2], 0.25) == pytest.approx(15.0)
    assert demagnetising_current(against, [0.5, 0.3, 0.2], 0.1) == inf
    assert demagnetising_current(against, [0.5, 0.3, 0.2], 0.6) == 0.0


def test_where_the_map_ends_the_current_without_flux_stands_for_the_shorted_one(winding, braking):
    machine = winding.wound.on_map(MAP.data)
    gone = replace(braking.cold, i_d=np.append(braking.cold.i_d[:-1], np.nan))
    i_d, i_q = steady_current(machine, gone)
    assert np.hypot(*machine.flux_linkage(i_d, i_q)) < 1e-9
    worst = steady_current(machine, braking.cold)[0]
    assert i_d < worst == braking.cold.i_d.min(), "more than any of the speeds"


def test_the_field_is_that_of_the_hot_grade():
    """With the error of the axis that the case has, on the grade's own recoil line."""
    crooked = replace(CASE, materials=replace(MATERIALS, magnet=Magnet(1.3, 1.0, axis_error=0.02)))
    magnet = with_grade(crooked, load_grade(WEAK), 120.0).materials.magnet
    assert (magnet.remanence, magnet.recoil_permeability, magnet.axis_error) == (pytest.approx(1.157), 1.05, 0.02)


def test_the_picture_is_of_the_worst_state(magnets):
    found = magnets[WEAK]
    assert found.worst.name == SUDDEN
    assert found.turn.flux.min() == pytest.approx(found.worst.least, abs=0.15), "corners against points inside"
    assert found.at_once.corners.shape[2] == 5 * found.turn.corners.shape[2], "five magnets in the sector"
    x, y = found.turn.corners.mean(axis=(1, 2))
    assert abs(x) < 1e-5 < y, "upright"
