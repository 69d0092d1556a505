"""All stages at once, as the pipeline asks for it: a machine solved by the field, and what the questions compare."""

import pandas as pd
import pytest

from drivetrain.whole_design import OBJECTIVES, Values, WholeDesign
from pipeline.optimise import Outcome, idle_share, questions, solve_idle, solve_section
from study.read import read_study

MOTORCYCLE = read_study("motorcycle")
REFERENCE = {
    "study": str(MOTORCYCLE.path.resolve()), "slots": 12, "stator_outer_radius": 42.5e-3, "back_iron_width": 3.3e-3,
    "rotor_outer_radius": 15.7e-3,
}  # fmt: skip


def test_the_field_solves_the_reference_machine():
    """Torques as in the reference table; the iron loss at 50 Hz is that of some 3.5 kg a metre at 1 to 2 W/kg."""
    nominal, overload, area, hysteresis, eddy, excess = solve_section(REFERENCE)
    assert nominal == pytest.approx(55.6, abs=0.3) and 2 < overload / nominal < 20 / 6
    assert area == pytest.approx(100.45e-6, rel=1e-3)
    iron = hysteresis * 50 + eddy * 50**2 + excess * 50**1.5
    assert 10 < iron < 100
    assert solve_idle(REFERENCE) == pytest.approx([hysteresis, eddy, excess], rel=1e-12)


BEFORE = (2.0, 5.0, 1.2, 3.0)


def test_each_objective_is_asked_for_with_the_others_kept():
    asked = questions(BEFORE)
    assert [k for _, k, _ in asked[:4]] == [0, 1, 2, 3] and all(allowed == BEFORE for *_, allowed in asked[:4])
    assert all(name.split("_")[0] in question for name, (question, *_) in zip(OBJECTIVES, asked[:4], strict=True))
    assert all(allowed[2] == 1 for *_, allowed in asked[4:])  # then a damping reserve of 1 is enough


def test_the_gain_is_the_change_of_what_was_asked_for():
    design = WholeDesign(12, 37e-3, 40e-3, 1.4e-3, 0.161)
    bettered = [("mass, the other three no worse", 0, design, Values((1.8, 5.0, 1.2, 3.0), (0.0,)))]
    found = Outcome((design, Values(BEFORE, (0.0,))), bettered, [])
    (row,) = found.gains
    assert row["change_percent"] == pytest.approx(-10) and row["stator_diameter_mm"] == pytest.approx(74)
    assert [name for name, *_ in Outcome(found.staged, bettered, [bettered[0][2:]]).shown] == [
        "stage by stage", "mass, the other three no worse", "front 1"
    ]  # fmt: skip


def test_the_idle_share_is_what_the_damping_does_not_explain():
    """300 N over 40 kNs/m with a reserve of 1 take 2.25 W in the copper, a reserve of 2 half of it."""
    front = pd.DataFrame({"damping_reserve": [1.0, 2.0], "road_loss_W": [2.5, 2.25]})
    assert "10 to 50 %" in idle_share(MOTORCYCLE, front)
