"""What people read of tolerances and uncertainty: the right one is named, sums are sums, and a shaft has no wheel."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from drivetrain.asked import Check, ControlledDamping, LostMagnets, PeakEffortAtRest
from drivetrain.constraints import OverloadForce
from drivetrain.output import Shaft, Wheel
from figures.report import capped, number_text, render_report
from report import outcome as outcome_report
from report import tolerances as report
from report import uncertainty as uncertainty_report
from tests.magnetostatics.reference_machine import reference_machine
from tests.uncertainty.a_budget import budget_of_alike
from uncertainty.budget import MagnetBudget, Uncertain
from uncertainty.deviations import MagnetArc, MagnetLength, MagnetScatter, Tolerances, ToothWidth
from uncertainty.match_spread import DrawnMatch, MatchSpread
from uncertainty.scatter import CoggingScatter
from uncertainty.stage import Uncertainty
from uncertainty.tolerance_stage import Sensitivity, ToleranceOutcome
from uncertainty.wound_slopes import QUANTITIES, Quantities

A = 5e-5  # m
ANGLES = 2 * np.pi * np.arange(30) / 30


def quantities(value=0.0, **named):
    return Quantities(**{name: named.get(name, value) for name in QUANTITIES})


def outcome(**values):
    """A thicker magnet gives 2 % of torque at its tolerance, a wider tooth 1.5 %; cogging by the tooth alone."""
    magnet, tooth, arc = MagnetLength(A), ToothWidth(A), MagnetArc(A)
    slopes = (
        Sensitivity(magnet, quantities(peak_torque=0.02 / A, copper_loss=-0.04 / A, iron_loss=0.01 / A)),
        Sensitivity(tooth, quantities(peak_torque=0.015 / A, cogging=-0.3 / A)),
        Sensitivity(arc, quantities(peak_torque=1e-4 / A)),
    )
    waves = CoggingScatter(
        reference_machine(), 36, np.sin(5 * ANGLES), np.sin(ANGLES), 50 * np.cos(ANGLES),
        np.sin(5 * ANGLES), np.sin(5 * ANGLES) + 0.1 * np.sin(ANGLES), 1e-4,
    )  # fmt: skip
    scatter = MagnetScatter(0.02, 0.01)
    allowed = Tolerances((magnet, tooth, arc), scatter, 0.2)
    return ToleranceOutcome(allowed, quantities(1.0, **values), slopes, quantities(1e-3), 300.0, 0.9, waves)


def test_sums_are_those_of_independent_and_of_all_at_once():
    found = outcome()
    assert found.standard("peak_torque") == pytest.approx(np.hypot(0.02, 0.015) / 3**0.5, rel=1e-4)
    assert found.worst("peak_torque") == pytest.approx(0.0351)
    assert found.worst("cogging") == pytest.approx(0.3), "however the derivative points"
    last = report.tolerance_table(found).iloc[-1]
    assert last.tolerance == "all" and last.peak_torque_worst_percent == pytest.approx(3.51)
    assert last.peak_torque_standard_percent == pytest.approx(100 * found.standard("peak_torque"))


def test_the_tolerance_to_buy_is_that_of_the_largest_share_and_the_table_goes_by_it():
    found = outcome()
    table = report.tolerance_table(found)
    assert table.tolerance.tolist() == ["magnet length", "tooth width", "magnet arc", "all"]
    assert table.largest_share_percent[0] == pytest.approx(100.0), "of the copper loss"
    first, second = report.remarks(found)
    assert "that of the magnet length: ±\N{NO-BREAK SPACE}0.05" in first and "most of it by the tooth width" in first
    assert "most of it by their place" in second, "50 x 0.01 against 1 x 0.02 Nm/m a magnet"


def test_without_loss_data_nothing_is_said_of_iron():
    found = outcome(iron_loss=float("nan"))
    assert not [name for name in report.tolerance_table(found) if "iron" in name]
    assert "iron loss 0" not in "".join(report.remarks(found))


def test_new_orders_are_told():
    table = report.scatter_table(outcome()).set_index("magnets and rotor")
    rotor = table.loc["rotor off centre by 0.1 mm"].iloc[-1]
    assert rotor.startswith("12: 0.1") and table.loc["as drawn"].iloc[-1] == ""
    assert table.loc["both", "cogging_mean_Nm_per_m"] > table.loc["as drawn", "cogging_mean_Nm_per_m"]


def certainty():
    one = DrawnMatch(12, 0.0425, 2.4e-3, 0.045, 55.0, 130.0, 1.9, OverloadForce(2614.0, 130.0), False, False)
    other = replace(one, active_length=0.047, stator_outer_radius=0.035, radius_bound=True)
    both = (one, other)
    budget = budget_of_alike(Uncertain(2.0, 0.0, 0.003, 0.004))
    return Uncertainty(MatchSpread(both, both, both, (*both, None, one), (other, other)), budget)


@pytest.mark.parametrize("output, words", ((Wheel(), "peak force at the wheel"), (Shaft(), "peak torque at the shaft")))
def test_the_budget_speaks_of_the_output(output, words):
    table = uncertainty_report.budget_table(certainty().budget, output)
    assert len(table) == len(certainty().budget.known) > 40 and any(text.startswith(words) for text in table.number)
    assert table.expanded_percent.tolist() == pytest.approx([1.0] * len(table))
    assert table.plus_minus.tolist() == pytest.approx((0.01 * table.value).tolist())


def test_shares_count_every_draw():
    text = uncertainty_report._binding(certainty(), Wheel())
    assert "the overload force sets the length in 75 %" in text and "25 % have no match" in text
    assert "100 % lie on an end of the investigated radii" in text
    table = uncertainty_report.spread_table(certainty(), Wheel())
    lengths = table[(table.number == "active length") & (table.choice == "chosen machine")]
    assert float(lengths["mean"].iloc[0]) == pytest.approx(45.667, abs=1e-3)


def test_files_and_sections(tmp_path):
    (tmp_path / "figures").mkdir()
    found, matched = outcome(), SimpleNamespace(chosen=certainty().spread.free[0])
    for one in (*report.files(found), *uncertainty_report.files(certainty(), matched, Shaft())):
        one.write(tmp_path / one.name)
    sections = report.section(found), uncertainty_report.section(certainty(), Shaft())
    page = render_report(sections, tmp_path, title="")
    assert "wheel" not in page and "they can only be narrower" in page
    assert {path.name for path in tmp_path.glob("*.csv")} == {"tolerances.csv", "uncertainty.csv"}


def test_what_is_reached_stands_with_its_uncertainty():
    """Of the whole for a force; of what is left of the magnets for what is beyond the knee."""
    kept, force = Uncertain(0.998, 0.0, 0.0, 0.001), Uncertain(2500.0, 0.0, 0.0, 0.01)
    lost = Check(LostMagnets(0.01, 0.002), 0.002)
    assert outcome_report._give_or_take(lost, kept, Wheel()) == "0.20"
    assert outcome_report._give_or_take(Check(PeakEffortAtRest(2000.0), 2600.0), force, Wheel()) == "52"
    assert outcome_report._give_or_take(lost, None, Wheel()) == ""
    budget = budget_of_alike(force)
    assert len(outcome_report._known(budget)) == 8
    unknown = replace(budget, magnets=MagnetBudget(), output=replace(budget.output, controlled_damping=None))
    assert set(outcome_report._known(budget)) - set(outcome_report._known(unknown)) == {LostMagnets, ControlledDamping}


def test_factors_beyond_all_doubt_are_cut_off():
    shown = [number_text(one) for one in capped([1.2, 100.0, 13678.0, np.inf, -3.0], 100.0)]
    assert shown == ["1.200", "> 100", "> 100", "∞", "−3"]
