"""Rows that no fit has seen take a name back where the effect makes them worse, and say so."""

from dataclasses import replace

import numpy as np
import pytest

from tests.workbench.toy_bench import LIBRARY, SpringModel, written
from workbench.data.campaign import read_campaign
from workbench.errors import WorkbenchError
from workbench.explain.diagnosis import diagnose
from workbench.explain.hypotheses import null_of
from workbench.explain.sealed import opened
from workbench.likelihood.bench import bench_of
from workbench.models.model import Model

REGION = '{ rule = "by region" }'
WITHIN = 0.0081  # m, below which the rows are fitted: the largest are sealed


def diagnosis_with(folder, extra):
    campaign = read_campaign(written(folder, extra, n=80, repeats=3, holdout=REGION))
    model = Model(SpringModel(), SpringModel().design(campaign.device))
    return diagnose(model, campaign, LIBRARY, 1)


def even_part(x):
    return 3.0 * (x / 0.01) ** 2


def test_an_effect_that_holds_everywhere_is_named(tmp_path):
    found = diagnosis_with(tmp_path, even_part)
    assert found.names == ("bump",) and found.sealed.holds and not found.contradictions


def test_one_that_makes_sealed_rows_worse_is_not_and_no_other_takes_its_place(tmp_path):
    found = diagnosis_with(tmp_path, lambda x: np.where(np.abs(x) < WITHIN, even_part(x), 0.0))
    assert found.verdict in ("none_of_these", "cannot_tell") and found.names == () and not found.alternatives
    assert not found.sealed.holds and found.p_nothing_missing < 1e-6
    assert len(found.contradictions) == 1 and "with even part as without it, though it would" in found.contradictions[0]
    assert not any("bump" in words for words in found.p_sets) and found.probability > 0.97


def test_sealed_rows_that_disagree_for_another_reason_leave_the_name(tmp_path):
    """An even part everywhere, and 2 N more where nothing was fitted: without the effect they are further off still."""
    found = diagnosis_with(tmp_path, lambda x: even_part(x) + np.where(np.abs(x) < WITHIN, 0.0, 2.0))
    assert found.names == ("bump",) and not found.sealed.holds and not found.contradictions
    assert found.probability == pytest.approx(1.0, abs=0.03)


def test_sealed_rows_without_an_answer_speak_against_the_model_and_end_nothing(tmp_path):
    """The model ends within what was sealed, as a motor at its limit of voltage."""

    class Ending(SpringModel):
        def respond(self, design, kind, conditions):
            if np.any(np.abs(conditions["displacement"]) > 0.0095):
                raise WorkbenchError("no steady state")
            return super().respond(design, kind, conditions)

    campaign = read_campaign(written(tmp_path, n=80, repeats=3, holdout=REGION))
    bench = bench_of(Model(SpringModel(), SpringModel().design(campaign.device)), campaign, LIBRARY)
    ending = replace(bench.fit.predictor.model, base=Ending())
    fit = replace(bench.fit, predictor=replace(bench.fit.predictor, model=ending))
    found = opened(bench, replace(null_of(bench), problem=fit))
    assert found.n == bench.held_out.stack.size and not found.holds and found.p_value == 0.0
