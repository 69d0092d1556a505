"""Thesis table 5.1: four measured damping values. What they show, and what four values cannot show."""

from pathlib import Path

import pytest

from effects.library import package_effects
from workbench.data.campaign import read_campaign
from workbench.explain.diagnosis import diagnose
from workbench.models.bases import nominal_model
from workbench.report.sentences import conclusions, verdict_sentence

MEASURED = Path(__file__).resolve().parents[2] / "measurements" / "thesis-table-5-1"
INDEPENDENT = 0.866  # torque constant of the dynamic identification over that of table B.1 (thesis table 4.2)


def verdict_on(folder):
    campaign = read_campaign(folder)
    return diagnose(nominal_model(campaign), campaign, package_effects())


@pytest.fixture(scope="module")
def four():
    return verdict_on(MEASURED)


@pytest.fixture(scope="module")
def three(tmp_path_factory):
    """Without the short circuit, whose place in the circuit is not known."""
    folder = tmp_path_factory.mktemp("three")
    for path in MEASURED.glob("*.*"):
        lines = path.read_text(encoding="utf-8").splitlines(keepends=True)
        (folder / path.name).write_text("".join(li for li in lines if not li.startswith("0,")), encoding="utf-8")
    return verdict_on(folder)


def test_four_values_name_no_effect(four):
    assert four.verdict == "cannot_tell" and four.names == ()
    assert verdict_sentence(four).startswith("Something is missing, but these data cannot tell what.")
    assert four.p_nothing_missing < 1e-3
    assert min(r.chi2_per_n_after for r in four.ranking) > 25, "no series resistance reaches the short circuit"


def test_what_can_and_cannot_be_concluded_is_said(four):
    said = " ".join(conclusions(four))
    for words in ("does not explain these data", "No single effect", "look alike", "Nor can these data abstain",
                  "no fit has seen"):  # fmt: skip
        assert words in said


def test_three_shunted_values_ask_for_a_smaller_force_constant_and_cannot_tell_it_from_a_diode(three):
    """No name is given, as such data cannot abstain; the two that lead are those."""
    assert three.verdict == "cannot_tell" and three.names == ()
    assert [r.name for r in three.ranking[:2]] == ["weak_magnets", "diode_drop"]
    loss = next(r for r in three.ranking if r.name == "weak_magnets").parameters["loss"]
    assert loss.low90 < 1 - INDEPENDENT < loss.high90
    assert "Nor can these data abstain" in " ".join(conclusions(three))
