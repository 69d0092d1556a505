"""Derivatives of what several solutions make together, against the same mesh solved again."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from geometry.half_cell import MeshDensity
from geometry.morph import Morpher
from magnetostatics.currents import PhaseCurrents
from magnetostatics.demagnetisation import MagnetFlux
from magnetostatics.newton import NewtonSettings
from magnetostatics.variations import Remanence, SameAmpereTurns
from materials.iron_loss import iron_loss_law
from study.inputs_field import field_case
from study.read import read_study
from uncertainty.deviations import MagnetLength, MagnetRemanence, SlotOpening, StackLength, ToothWidth
from uncertainty.field_slopes import (
    AtTheKnee,
    Cogging,
    FieldState,
    LoadedInductances,
    LoadedIron,
    NoLoad,
    OpposingField,
    StateTask,
    mesh_errors,
    solve_slopes,
)
from units import MU_0

COARSE = MeshDensity(gap_edges=120, longest_gap_edge=2.0, gap_layers=1, across_iron=1.0)
CASE = replace(field_case(read_study("motorcycle")), density=COARSE)
MACHINE = CASE.family.reference
LAW = iron_loss_law("M235-35A")
HALF = 5e-5  # m
STEP = {"remanence": 1e-3}  # T; the others 1e-5 m


def solved_again(deviation, state):
    """Central difference over the value in the middle."""
    model = CASE.model(MACHINE, NewtonSettings(tolerance=1e-9))
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
        (LoadedInductances(-300.0, 1200.0), MagnetLength(HALF)),
        (Cogging(), SlotOpening(HALF)),
        (Cogging(), MagnetRemanence(0.03)),
        (OpposingField(-1500.0, 100.0, 0.01), SlotOpening(HALF)),
        (AtTheKnee(-3000.0, 0.0, 0.01, 9e5), MagnetLength(HALF)),
        (AtTheKnee(-3000.0, 0.0, 0.01, 9e5), MagnetRemanence(0.03)),
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


def test_the_inductances_under_load_are_those_of_the_data_sheet():
    """A machine of constant parameters: psi_d = psi_m + L_d i_d, psi_q = L_q i_q, whatever the order of its angles."""
    flux, l_d, l_q, direct, quadrature = 0.3, 2e-5, 3e-5, -300.0, 1200.0
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(
            "uncertainty.field_slopes.flux_and_torque", lambda i: {"psi_d": flux + l_d * i, "psi_q": l_q * 1200}
        )
        found = LoadedInductances(direct, quadrature).read([0.0, 0.0, direct, direct])
    assert found == pytest.approx([flux, l_d, l_q])


def test_the_current_that_meets_the_knee_is_found_between_two():
    """B falls by 0.1 mT an ampere-turn from 0.5 T without current: at 3000 A to 0.2 T, wherever that is sought."""
    magnet = SimpleNamespace(remanence=1.2, recoil_permeability=1.05)
    model, knee = SimpleNamespace(materials=SimpleNamespace(magnet=magnet)), (1.2 - 0.2) / (MU_0 * 1.05)

    def seen(one):
        return MagnetFlux(np.array([[[0.5 + 1e-4 * one.current + one.lift, 0.9]]]), np.array([[0.02, 0.98]]))

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("uncertainty.field_slopes.magnet_flux", seen)
        for direct in (-2900.0, -3200.0):
            currents = [direct * 0.98] * 2 + [direct * 1.02] * 2
            lifts = (0.0, 0.2, 0.2, 0.0)  # at one angle of two it is less
            solutions = [SimpleNamespace(model=model, current=i, lift=b) for i, b in zip(currents, lifts)]
            assert AtTheKnee(direct, 0.0, 0.01, knee).read(solutions) == pytest.approx([3000.0])
            assert OpposingField(direct, 0.0, 0.03).read(solutions) < knee / 3, "what lies in less of the volume"


def test_the_ripple_is_from_peak_to_peak():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("uncertainty.field_slopes.flux_and_torque", lambda t: {"psi_d": 1.0, "psi_q": 2.0, "torque": t})
        assert FieldState(0.0, 1.0).read([50.0, 53.0, 49.0, 52.0]) == pytest.approx([51.0, 1.0, 2.0, 4.0])


def test_ampere_turns_are_kept_where_a_wider_tooth_leaves_less_room():
    model = CASE.model(MACHINE)
    point = LoadedIron(0.0, 500.0, LAW, 300.0).solutions(model)[0].point
    variation = SameAmpereTurns(ToothWidth(HALF).variation(Morpher(model.section)))
    changed, there = variation.at(model, point, HALF)
    room = changed.section.half_slot_area / model.section.half_slot_area
    assert room < 1 and there.current_density * room == pytest.approx(point.current_density)
    with pytest.raises(TypeError, match="OperatingPoint"):
        SameAmpereTurns(Remanence()).at(model, PhaseCurrents(0.0, (0.0, 0.0, 0.0)), 0.1)
