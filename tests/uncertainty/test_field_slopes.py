"""Derivatives of what several solutions make together, against the same mesh solved again."""

from dataclasses import replace

import numpy as np
import pytest

from geometry.half_cell import MeshDensity
from geometry.morph import Morpher
from magnetostatics.currents import PhaseCurrents
from magnetostatics.variations import Remanence, SameAmpereTurns
from materials.iron_loss import iron_loss_law
from study.inputs_field import field_case
from study.read import read_study
from uncertainty.deviations import MagnetLength, MagnetRemanence, SlotOpening, StackLength, ToothWidth
from uncertainty.field_slopes import Cogging, FieldState, LoadedIron, NoLoad, StateTask, mesh_errors, solve_slopes

COARSE = MeshDensity(gap_edges=120, longest_gap_edge=2.0, gap_layers=1, across_iron=1.0)
CASE = replace(field_case(read_study("motorcycle")), density=COARSE)
MACHINE = CASE.family.reference
LAW = iron_loss_law("M235-35A")
HALF = 5e-5  # m
STEP = {"remanence": 1e-3}  # T; the others 1e-5 m


def solved_again(deviation, state):
    """Central difference over the value in the middle."""
    model = CASE.model(MACHINE)
    morpher, step = Morpher(model.section), STEP.get(deviation.name, 1e-5)
    first, *_ = state.solutions(model)
    ends = []
    for change in (step, -step):
        changed, _ = SameAmpereTurns(deviation.variation(morpher)).at(model, first.point, change)
        ends.append(state.read(state.solutions(changed)))
    return (ends[0] - ends[1]) / (2 * step) / (0.5 * (ends[0] + ends[1]))


@pytest.mark.parametrize(
    "state, deviation",
    (
        (LoadedIron(-300.0, 800.0, LAW, 300.0), ToothWidth(HALF)),
        (NoLoad(), MagnetLength(HALF)),
        (Cogging(), SlotOpening(HALF)),
        (Cogging(), MagnetRemanence(0.03)),
    ),
)
def test_one_back_substitution_gives_what_solving_again_gives(state, deviation):
    found = solve_slopes(StateTask(CASE, MACHINE, state, (deviation,)))
    expected = solved_again(deviation, state)
    assert found.of(deviation) == pytest.approx(expected, rel=0.01, abs=0.01 * np.abs(expected).max())
    assert len(found.values) == len(state.quantities) and np.abs(expected).min() > 0


def test_what_the_field_does_not_feel_has_no_slope():
    found = solve_slopes(StateTask(CASE, MACHINE, Cogging(), (StackLength(1e-4), SlotOpening(HALF))))
    assert not found.of(StackLength(1e-4)).any() and found.of(SlotOpening(HALF)).all()


def test_a_coarse_mesh_owns_up():
    """Its bounds hold torque and flux linkages of the mesh of the sweep."""
    state = FieldState(0.0, 500.0)
    close = solve_slopes(StateTask(field_case(read_study("motorcycle")), MACHINE, state)).values
    task = StateTask(CASE, MACHINE, state)
    off = np.abs(solve_slopes(task).values / close - 1)
    assert (off < mesh_errors(task)).all() and off.max() > 1e-3


def test_ampere_turns_are_kept_where_a_wider_tooth_leaves_less_room():
    model = CASE.model(MACHINE)
    point = LoadedIron(0.0, 500.0, LAW, 300.0).solutions(model)[0].point
    variation = SameAmpereTurns(ToothWidth(HALF).variation(Morpher(model.section)))
    changed, there = variation.at(model, point, HALF)
    room = changed.section.half_slot_area / model.section.half_slot_area
    assert room < 1 and there.current_density * room == pytest.approx(point.current_density)
    with pytest.raises(TypeError, match="OperatingPoint"):
        SameAmpereTurns(Remanence()).at(model, PhaseCurrents(0.0, (0.0, 0.0, 0.0)), 0.1)
