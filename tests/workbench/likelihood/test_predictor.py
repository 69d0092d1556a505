"""What a predictor says of devices that cannot be: a fit must turn back there, not end."""

import numpy as np
import pytest

from geometry.errors import GeometryError
from materials.errors import MaterialError
from tests.workbench.toy_bench import LIBRARY, Hardening, SpringModel, written
from workbench.data.campaign import read_campaign
from workbench.errors import WorkbenchError
from workbench.likelihood.bench import bench_of
from workbench.likelihood.fit import fitted
from workbench.likelihood.predictor import one_sided
from workbench.models.model import Model

SOFTEST = 800.0  # N/m


class Wound(SpringModel):
    """Springs softer than the softest cannot be wound."""

    def __init__(self, error):
        self.error = error

    def with_tolerance(self, design, tolerance, z):
        moved = super().with_tolerance(design, tolerance, z)
        if moved.stiffness < SOFTEST:
            raise self.error(f"a spring of {moved.stiffness:g} N/m cannot be wound")
        return moved


@pytest.fixture(params=[GeometryError, MaterialError])
def problem(request, tmp_path):
    """One tolerance of one per cent; the readings are of a spring a little softer than can be wound."""
    campaign, model = read_campaign(written(tmp_path, stiffness=SOFTEST - 10)), Wound(request.param)
    return bench_of(Model(model, model.design(campaign.device)), campaign, LIBRARY).fit


def test_there_can_be_no_such_device(problem):
    far = np.zeros(len(problem.start))
    far[0] = -30.0
    with pytest.raises(WorkbenchError, match="no such device: a spring of 700 N/m cannot be wound"):
        problem.predictor.predict(far)


def test_a_step_to_such_a_device_is_shortened(problem):
    found = fitted(problem, (), np.zeros(len(problem.start)), np.zeros(0))
    assert -20.0 <= found.x[0] < -19.0


def known(effect, folder):
    """The predictor of a bench whose model has an effect."""
    campaign, model = read_campaign(written(folder, extra=lambda x: 4e5 * x**3)), SpringModel()
    return bench_of(Model(model, model.design(campaign.device), (effect,)), campaign, LIBRARY).fit.predictor


def test_the_centre_is_where_nothing_was_learned(tmp_path):
    predictor = known(Hardening(4e5), tmp_path)
    assert predictor.model_at(np.zeros(3)).effects[0].cubic == 4e5
    assert predictor.model_at(predictor.centre).effects[0].cubic == pytest.approx(3e5), "the median of its prior"
    assert np.count_nonzero(predictor.centre) == 1


class Undefined(Hardening):
    """Its equation is no number at some places."""

    def on_response(self, response, conditions, kind, design):
        return {**response, "force": response["force"] + np.where(conditions["displacement"] > 0.009, np.nan, 0.0)}


class Endless(Hardening):
    """Its equation divides by nothing."""

    def on_response(self, response, conditions, kind, design):
        return {**response, "force": response["force"] + 1.0 / float(self.is_null)}


NO_NUMBERS = [(Undefined(1.0), "no number in 3 readings"), (Endless(1.0), "division by zero")]


@pytest.mark.parametrize("effect, words", NO_NUMBERS)
def test_what_is_no_number_is_no_answer(effect, words, tmp_path):
    campaign, model = read_campaign(written(tmp_path)), SpringModel()
    fit = bench_of(Model(model, model.design(campaign.device)), campaign, LIBRARY).fit
    with pytest.raises(WorkbenchError, match=words):
        fit.predictor.predict(np.zeros(len(fit.start)), (effect,))


def test_slopes_are_taken_to_the_side_where_something_moves():
    """At a bound nothing moves outwards; beyond the limit of a supply nothing turns."""
    bound = lambda p: np.minimum(p, 1.0) * np.ones(3)  # noqa: E731

    def limit(p):
        if p[0] > 1.0:
            raise WorkbenchError("no steady state")
        return 2 * p * np.ones(3)

    for answer, slope in ((bound, 1.0), (limit, 2.0)):
        here = np.array([1.0])
        assert np.allclose(one_sided(answer, here, 0, 0.02, answer(here)), slope)
