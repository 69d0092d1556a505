"""A user's walk on campaigns with a hidden effect: compare finds the channel, diagnose names it, add lowers the error.

The campaigns come from virtual benches that follow other laws and methods than the models, see
``benchmarks/virtual_benches``. Sizes are drawn by the bench; the seeds are the first whose effect stands out by a chi2
of 100 to 10 000 (beyond that the approximate law of an effect is seen as something missing, rightly).
"""

from __future__ import annotations

import pytest

from benchmarks.virtual_benches.damper_bench import CATALOGUE as DAMPER
from benchmarks.virtual_benches.dq_bench import CATALOGUE as DQ
from benchmarks.virtual_benches.hiding import hide
from effects.library import library
from workbench.compare.comparison import compare
from workbench.data.campaign import read_campaign
from workbench.explain.diagnosis import diagnose
from workbench.ledger.step import ACCEPTED, start_step, try_effect
from workbench.models.bases import nominal_model

BENCHES = {"damper": DAMPER, "dq": DQ}
CLEAR = (100.0, 1e4)
NAMED = ("effect", "group")
# Effects with the first seed from 50000 on in which they are clear, and the tables in which they show
HIDDEN = {
    ("damper", "coulomb_friction", 50001): {"force_velocity", "impedance"},
    ("damper", "inertance", 50002): {"impedance"},
    ("damper", "excess_viscous", 50018): {"force_velocity", "impedance"},
    ("dq", "quadrature_inductance", 50001): {"operation"},
    ("dq", "friction_torque", 50000): {"operation", "drag", "short_circuit"},
    ("dq", "torque_gain", 50000): {"operation", "drag", "short_circuit"},
}
EMPTY = [("damper", 50000), ("dq", 50001)]


def clear_case(bench: str, effect: str, seed: int):
    """A campaign of a bench in which the effect is clear."""
    truth, answer = hide(BENCHES[bench], "single", seed, (effect,))
    assert CLEAR[0] < answer.visibility[effect] < CLEAR[1]
    return truth


def opened(truth, folder):
    campaign = read_campaign(truth.write(folder / truth.id))
    return nominal_model(campaign), campaign


@pytest.fixture(scope="module", params=HIDDEN, ids=lambda case: "-".join(case[:2]))
def walked(request, tmp_path_factory):
    """Comparison, diagnosis and what adding the hidden effect would do."""
    model, campaign = opened(clear_case(*request.param), tmp_path_factory.mktemp("walk"))
    trial = try_effect(model, campaign, library(), request.param[1])
    return request.param, compare(model, campaign, library()), diagnose(model, campaign, library()), trial


def test_compare_finds_the_failing_channel(walked):
    """Or, where the tolerances could take the effect over, a pull of three sigma and more."""
    case, comparison, _, _ = walked
    if comparison.failing:
        assert comparison.failing.split(".")[0] in HIDDEN[case]
    else:
        assert max(abs(pull.pull) for pull in comparison.pulls) > 3


def test_diagnose_names_the_effect_or_its_group(walked):
    (_, effect, _), _, diagnosis, _ = walked
    assert diagnosis.verdict in NAMED, diagnosis.verdict
    assert effect in diagnosis.names


def test_add_brings_the_error_to_the_noise(walked):
    """Of the fitted rows and, but for what the inputs leave open, of conditions that are left out of the fit."""
    _, _, _, trial = walked
    start, step = start_step(trial.before), trial.step
    assert step.decision == ACCEPTED, step.reason
    assert step.chi2_per_n <= 1.25
    assert step.held_out_chi2_per_n < max(start.held_out_chi2_per_n, 1.2)
    assert step.held_out_chi2_per_n <= 1.5


@pytest.mark.parametrize("bench, seed", EMPTY)
def test_nothing_is_missing_where_nothing_is_hidden(bench, seed, tmp_path):
    model, campaign = opened(hide(BENCHES[bench], "null", seed)[0], tmp_path)
    assert diagnose(model, campaign, library()).verdict == "nothing_missing"
