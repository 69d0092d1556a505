"""Where effects are compared and their fits start: the null, or the drawing when an expansion has been pulled far."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.workbench.toy_bench import LIBRARY, SpringModel, written
from workbench.data.campaign import read_campaign
from workbench.explain.explore import beliefs_of
from workbench.explain.search import best_alone
from workbench.likelihood.bench import PULLED, bench_of
from workbench.likelihood.fit import linearised
from workbench.likelihood.signatures import signatures_of
from workbench.models.model import Model


class ExpandedSpring(SpringModel):
    """A spring that answers by an expansion about some design, as a machine does."""

    is_expansion = True

    def recentred(self, design, tables=()):
        return self


def bench(folder, base, stiffness):
    """The tolerance of the stiffness is 1 % of 1000 N/m."""
    campaign = read_campaign(written(folder, stiffness=stiffness, n=40))
    return bench_of(Model(base, base.design(campaign.device)), campaign, LIBRARY)


@pytest.mark.parametrize("base", (SpringModel(), ExpandedSpring()))
def test_near_the_drawing_it_is_the_null(tmp_path, base):
    found = bench(tmp_path, base, 1010.0)
    assert found.centre is found.null
    assert np.abs(found.null.x).max() < PULLED


def test_a_tolerance_pulled_far_brings_an_expansion_back_to_the_drawing(tmp_path):
    found = bench(tmp_path, ExpandedSpring(), 900.0)
    assert np.abs(found.null.x).max() > PULLED
    assert_allclose(found.centre.x, found.fit.start)
    assert_allclose(found.residual, found.fit.residual(found.fit.start))


def test_a_model_that_answers_directly_stays_at_its_null(tmp_path):
    found = bench(tmp_path, SpringModel(), 900.0)
    assert np.abs(found.null.x).max() > PULLED and found.centre is found.null


def test_linearised_where_a_fit_ended_is_that_fit(tmp_path):
    found = bench(tmp_path, SpringModel(), 1010.0)
    again = linearised(found.fit, found.null.x)
    assert_allclose(again.residual, found.null.residual)
    assert_allclose(again.jacobian, found.null.jacobian, atol=1e-6 * np.abs(found.null.jacobian).max())
    assert again.log_evidence == pytest.approx(found.null.log_evidence)


def test_a_fit_from_the_drawing_ends_where_the_one_from_the_null_does(tmp_path):
    """The spring is linear in its stiffness: the start must not matter."""
    ends = []
    for k, base in enumerate((SpringModel(), ExpandedSpring())):
        found = bench(tmp_path / str(k), base, 900.0)
        signatures = signatures_of(found, (LIBRARY["soft_spring"](),))
        ends.append(best_alone(found, signatures, beliefs_of(LIBRARY, signatures.names)).fit)
    assert ends[0].objective == pytest.approx(ends[1].objective, abs=0.05)
    assert_allclose(ends[0].z, ends[1].z, atol=0.05)
