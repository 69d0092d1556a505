"""The walk of a user on machine benches: compare finds the failing channel, diagnose names the effect, add ends at the
noise.

The truth is the field of the very machine, solved at every angle and current that is read, on another mesh and with
another reading of the steel's curve than the model has. Tolerances, instruments and correlated noise are drawn.
"""

from __future__ import annotations

from dataclasses import dataclass

import pytest

from benchmarks.virtual_benches.machine_bench import Grid, measured_in_full_field
from benchmarks.virtual_benches.machine_bench import MachineBench as Truth
from effects.library import library
from geometry.half_cell import MeshDensity
from workbench.compare.comparison import compare
from workbench.data.campaign import read_campaign
from workbench.data.table import Campaign
from workbench.explain.diagnosis import diagnose
from workbench.findings import Comparison, Diagnosis
from workbench.ledger.step import ACCEPTED, Trial, try_effect
from workbench.models.machine.build import MeshPlan
from workbench.models.machine.model import MachineBench
from workbench.models.model import Model

GRID = Grid(6.0, 4.5, (6.0, 30.0, 54.0), (60.0,), 69.0, (-60.0, 60.0))
# What is added to the fine bases comes from coarse meshes; the leading effects are solved again at their size.
PLAN = MeshPlan(
    idle=MeshDensity(gap_edges=180, longest_gap_edge=2.5, gap_layers=1, across_iron=1.0),
    loaded=MeshDensity(gap_edges=120, longest_gap_edge=2.5, gap_layers=1, across_iron=1.0),
)
NAMES = (
    "magnet_temperature", "end_leakage", "weak_magnet", "lost_turns", "phase_imbalance", "steel_saturation",
    "voltage_gain", "torque_gain", "torque_offset", "current_gain", "encoder_zero",
)  # fmt: skip
LIBRARY = {name: cls for name, cls in library().items() if name in NAMES}
NAMED = ("effect", "group")
# Effect: size in SI, and the tables one of which must fail
HIDDEN = {
    "magnet_temperature": (50.0, {"back_emf", "cogging"}),  # its voltage may be taken over by the remanence
    "weak_magnet": (0.15, {"cogging", "back_emf"}),
}


@dataclass(frozen=True, eq=False)
class Walk:
    effect: str
    comparison: Comparison
    diagnosis: Diagnosis
    trial: Trial


@pytest.fixture(scope="module")
def base(tmp_path_factory) -> MachineBench:
    """The model; its field solutions are made by the first campaign, in this process, and kept for the others."""
    return MachineBench(PLAN, tmp_path_factory.mktemp("fields"), workers=1)


def opened(base: MachineBench, hidden: dict[str, float], seed: int, folder) -> tuple[Model, Campaign]:
    campaign = read_campaign(measured_in_full_field(Truth(grid=GRID), hidden, seed).write(folder / "campaign"))
    return Model(base, base.design(campaign.device)), campaign


@pytest.fixture(scope="module", params=enumerate(HIDDEN, 2), ids=HIDDEN)
def walked(request, base, tmp_path_factory) -> Walk:
    seed, effect = request.param
    folder = tmp_path_factory.mktemp(effect)
    model, campaign = opened(base, {effect: HIDDEN[effect][0]}, seed, folder)
    comparison, found = compare(model, campaign, LIBRARY), diagnose(model, campaign, LIBRARY)
    return Walk(effect, comparison, found, try_effect(model, campaign, LIBRARY, effect))


def test_compare_finds_the_failing_channel(walked):
    failing = walked.comparison.failing
    errors = {s.channel: s.chi2_per_n_nominal for s in walked.comparison.scoreboard}
    assert failing.split(".")[0] in HIDDEN[walked.effect][1]
    assert errors[failing] > 10.0


def test_diagnose_names_the_effect_or_its_group(walked):
    assert walked.diagnosis.verdict in NAMED, walked.diagnosis.verdict
    assert walked.effect in walked.diagnosis.names


def test_add_brings_the_error_to_the_noise(walked):
    step = walked.trial.step
    assert step.decision == ACCEPTED, step.reason
    assert step.chi2_per_n <= 1.2 and step.held_out_chi2_per_n <= 1.5


def test_the_size_that_was_hidden_is_found(walked):
    """Within five standard deviations of its posterior."""
    hidden, found = HIDDEN[walked.effect][0], next(iter(walked.trial.step.parameters.values()))
    assert abs(found.value - hidden) < 5 * found.std


def test_nothing_is_missing_where_nothing_is_hidden(base, tmp_path):
    assert diagnose(*opened(base, {}, 1, tmp_path), LIBRARY).verdict == "nothing_missing"
