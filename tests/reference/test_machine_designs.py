"""Headline results of the shipped machines that are looked for, so that a change of any of them is seen.

What ``make pipeline STUDY=<machine>`` found on 2026-11-23: how far each variable moves, torque and motor constant at
the current angle that goes with it, flux densities in teeth and back iron; and of the machine as it is drawn the
linkage of a phase without current. Another code's values of the 9/12 outrunner and of the V: ``test_other_machines``.
"""

from dataclasses import dataclass

import pytest

from electrical.kind_search import KindTask, solve_place
from magnetostatics.turn import Supply, turned
from study.inputs_stated_machine import kind_search, stated_design
from study.machine_file import read_machine
from units import MILLIMETRE

STEEPEST = 80.0  # degrees of the current angle at either end of the search


@dataclass(frozen=True)
class Found:
    """amounts: of the variables [mm]; current_angle [deg]; torque [Nm]; motor_constant [Nm/sqrt(W)]; tooth, back_iron
    [T]"""

    amounts: tuple[float, ...]
    current_angle: float
    torque: float
    motor_constant: float
    tooth: float
    back_iron: float


FOUND = {
    "outrunner_9_12": Found((-0.716839, -0.4, 0.4), 7.830967, 0.0295091, 0.01088458, 1.59992, 1.57176),
    "outrunner_12_14": Found((0.031925, -0.826120, 0.830010), 20.00662, 1.118281, 0.133967, 1.59959, 1.59847),
    "outrunner_24_28": Found((-0.341522, -1.556330, 0.96), 23.78653, 5.806396, 0.426597, 1.59988, 1.59029),
    "synrm_48_4": Found((0.252668, -0.895240, 0.013744), -15.137299, 25.024660, 0.593595, 1.79968, 1.79999),
    "v_48_8": Found((-0.193413, 3.0, 0.8), 53.422338, 365.835199, 4.871921, 1.99999, 1.99890),
}


def place_of(search, found):
    """Shares of the bounds, the current angle last."""
    shares = [(a * MILLIMETRE - m.low) / (m.high - m.low) for m, a in zip(search.moves, found.amounts, strict=True)]
    return (*shares, (found.current_angle / STEEPEST + 1) / 2)


@pytest.mark.slow
@pytest.mark.parametrize("name", FOUND)
def test_the_best_design_is_as_it_was(name):
    """Within the limit of its file, and better than the machine as drawn at the same current angle."""
    read, found = read_machine(name), FOUND[name]
    stated, search = stated_design(read), kind_search(read)
    one = solve_place(KindTask(stated, search, place_of(search, found)))
    assert one.torque == pytest.approx(found.torque, rel=1e-3)
    assert one.motor_constant == pytest.approx(found.motor_constant, rel=1e-3)
    assert (one.tooth, one.back_iron) == pytest.approx((found.tooth, found.back_iron), rel=2e-3)
    assert one.flux_density <= 1.001 * search.limit
    drawn = [-move.low / (move.high - move.low) for move in search.moves]
    before = solve_place(KindTask(stated, search, (*drawn, (found.current_angle / STEEPEST + 1) / 2)))
    assert before.motor_constant < one.motor_constant


LINKAGES = {
    "outrunner_9_12": 0.277270e-3, "outrunner_12_14": 5.501160e-3, "outrunner_24_28": 9.915373e-3, "v_48_8": 0.2059672,
    "v2_48_8": 0.1860255,
}  # of a phase as drawn, peak [Wb]  # fmt: skip


@pytest.mark.parametrize("name", LINKAGES)
def test_the_linkage_as_drawn_is_as_it_was(name):
    """Of the d axis without current; p times it is the constant of a phase's EMF."""
    read = read_machine(name)
    model = stated_design(read).case.model(read.machine)
    angle = model.section.layout.phase_axis / read.machine.pole_pairs
    found = turned(model, Supply(0.0, 0.0, read.equivalent_turns), read.active_length, [angle])
    assert found.dq_linkage[0, 0] == pytest.approx(LINKAGES[name], rel=1e-4)
