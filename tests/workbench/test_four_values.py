"""Thesis table 5.1: four measured damping values. What they show, and what four values cannot show."""

from pathlib import Path

import pytest

from effects.library import package_effects
from workbench.data.campaign import read_campaign
from workbench.explain.diagnosis import diagnose
from workbench.models.bases import nominal_model

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
    """Something is missing, and nothing of the library reaches the short circuit without something unknown."""
    assert four.verdict in ("none_of_these", "cannot_tell") and four.names == ()
    assert four.p_nothing_missing < 1e-3 and four.probability > 0.99
    assert all("unknown" in words for words in four.p_sets), "no series resistance reaches the short circuit"


def test_that_prediction_cannot_be_tested_is_said(four):
    assert four.sealed is None and any("no row is sealed" in words for words in four.complaints)


def test_three_shunted_values_ask_for_a_smaller_force_constant(three):
    """Nothing else is named, and the size agrees with the torque constant that was identified independently."""
    assert three.names in ((), ("weak_magnets",)) and three.verdict in ("effect", "none_of_these", "cannot_tell")
    assert three.ranking[0].name == "weak_magnets"
    assert "weak_magnets" in three.p_sets
    loss = three.ranking[0].parameters["loss"]
    assert loss.low90 < 1 - INDEPENDENT < loss.high90
