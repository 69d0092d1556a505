"""Evidences against closed forms and brute-force integration."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.stats import multivariate_normal
from scipy.stats import t as student

from tests.workbench.toy_bench import LIBRARY, Bump, Hardening, SpringModel, written
from workbench.data.campaign import read_campaign
from workbench.errors import WorkbenchError
from workbench.explain.bank import Prepared, signature
from workbench.explain.hypotheses import exact, hypothesis_from, single, with_unknown
from workbench.explain.priors import TAILS
from workbench.explain.rivals import Choice, unknown_function
from workbench.likelihood.bench import SHARP, bench_of, sharpened
from workbench.likelihood.fit import fitted
from workbench.likelihood.linear import Nuisances
from workbench.models.model import Model

GAUSS = 1e9  # degrees of freedom at which the noise is known for sure


@pytest.fixture(scope="module")
def bench(tmp_path_factory):
    campaign = read_campaign(written(tmp_path_factory.mktemp("c"), extra=lambda x: 4e4 * x**3, n=40, rho=0.3))
    found = bench_of(Model(SpringModel(), SpringModel().design(campaign.device)), campaign, LIBRARY)
    sure = replace(found.fit, dof=np.full(1, GAUSS))
    return replace(found, fit=sure, null=fitted(sure, (), np.zeros(2), np.zeros(0)))


def gauss(bench, change=0.0, extra=None):
    """ln density of the whitened readings, nuisances integrated out, over that of pure white noise at zero."""
    slopes = bench.null.jacobian
    covariance = np.eye(len(slopes)) + slopes @ slopes.T + (0 if extra is None else extra)
    start = bench.fit.residual(np.zeros(2))
    return multivariate_normal(np.zeros(len(slopes)), covariance).logpdf(start - change) + 0.5 * len(slopes) * np.log(
        2 * np.pi
    )


def test_laplace_is_exact_where_everything_is_linear_and_gaussian(bench):
    assert bench.null.log_evidence == pytest.approx(gauss(bench), abs=1e-3)


def prepared(bench, effect):
    base = bench.fit.predictor.predict(bench.null.x)
    change = lambda e: bench.fit.white(bench.fit.predictor.predict(bench.null.x, (e,)) - base)  # noqa: E731
    return Prepared(signature(effect, change), bench.nuisances)


@pytest.mark.parametrize("effect", [Hardening(), Bump()])
def test_evidence_of_an_effect_is_the_integral_over_its_prior(bench, effect):
    base = bench.fit.residual(np.zeros(2))

    def change(z):
        return base - bench.fit.residual(np.zeros(2), (effect.at([z]),))

    places = np.linspace(-8, 8, 801)
    logs = np.array([gauss(bench, change(z)) + student.logpdf(z, TAILS) for z in places])
    exact = np.log(np.trapezoid(np.exp(logs - logs.max()), places)) + logs.max()
    assert single(bench, prepared(bench, effect))[0].log_evidence == pytest.approx(exact, abs=0.05)
    linear = bench.null.log_evidence + float(prepared(bench, effect).log_evidence(bench.residual[:, None])[0])
    assert linear == pytest.approx(exact, abs=0.3)  # the grid of the screen is coarser


def test_evidence_of_the_unknown_function_is_that_of_its_gaussian_process(bench):
    unknown = unknown_function(bench.fit.stack, bench.fit.white)
    gains = unknown.log_evidences(bench.nuisances, bench.residual[:, None])[:, 0]
    for number in (0, 7, 13):
        choice = unknown.choices[number]
        shapes = unknown.shapes[0][choice.parts[0][1]]
        process = choice.amplitude**2 * shapes.values @ shapes.values.T
        exact = gauss(bench, extra=process) - gauss(bench) + choice.log_prior
        assert gains[number] == pytest.approx(exact, abs=1e-6)


def test_the_shapes_make_the_kernel_they_stand_for(bench):
    unknown = unknown_function(bench.fit.stack, bench.fit.white)
    x = bench.fit.stack.tables[0].conditions["displacement"]
    ranks = (np.argsort(np.argsort(x)) - (len(x) - 1) / 2) / np.std(np.arange(len(x)))
    raw = unknown.shapes[0][2].raw
    kernel = np.exp(-(np.subtract.outer(ranks, ranks) ** 2) / (2 * 1.4**2))
    assert np.allclose(raw @ raw.T, kernel, atol=2e-3)


def test_projection_is_the_inverse_covariance():
    random = np.random.default_rng(0)
    slopes, v = random.standard_normal((9, 3)), random.standard_normal(9)
    nuisances, inverse = Nuisances(slopes), np.linalg.inv(np.eye(9) + slopes @ slopes.T)
    assert np.allclose(nuisances.project(v), inverse @ v)
    assert np.dot(nuisances.root(v), nuisances.root(v)) == pytest.approx(v @ inverse @ v)
    assert nuisances.half_log_det == pytest.approx(-0.5 * np.linalg.slogdet(inverse)[1])


def test_the_mean_of_the_unknown_function_is_kriging(bench):
    unknown = unknown_function(bench.fit.stack, bench.fit.white)
    choice = Choice(((0, 1),), 3.0, 0.0)
    shapes = unknown.shapes[0][1]
    process = 9.0 * shapes.values @ shapes.values.T
    slopes = bench.null.jacobian
    whole = np.eye(len(slopes)) + slopes @ slopes.T + process
    exact = process @ np.linalg.solve(whole, bench.residual)
    assert np.allclose(unknown.mean(bench.nuisances, bench.residual, choice)[0], exact, atol=1e-8)


def test_student_likelihood_is_the_gauss_with_its_size_integrated_out():
    from workbench.likelihood.fit import misfit

    dof, n = 7.0, 5

    def integrand(s, q):  # scaled inverse chi2 prior of the variance from dof repeats
        return s ** (-n / 2 - dof / 2 - 1) * np.exp(-(q + dof) / (2 * s))

    ratio = quad(integrand, 0, np.inf, args=(30.0,))[0] / quad(integrand, 0, np.inf, args=(2.0,))[0]
    found = misfit(np.array([2.0]), np.array([dof]), np.array([n])) - misfit(
        np.array([30.0]), np.array([dof]), np.array([n])
    )
    assert found == pytest.approx(np.log(ratio), rel=1e-6)


def test_two_starts_find_the_same_maximum(bench):
    low, high = (hypothesis_from(bench.fit, 0.0, (Hardening(),), bench.null.x, np.array([z])) for z in (-1.5, 1.5))
    assert low.fit.z == pytest.approx(high.fit.z, abs=1e-3)


def test_a_fit_beside_the_unknown_function_has_the_evidence_of_both(bench):
    unknown = unknown_function(bench.fit.stack, bench.fit.white)
    choice = Choice(((0, 2),), 4.2, 0.0)
    problem, half_log_det = with_unknown(bench.fit, unknown, choice)
    shapes = unknown.shapes[0][2]
    found = fitted(problem, (), np.zeros(2), np.zeros(0)).log_evidence - half_log_det
    assert found == pytest.approx(gauss(bench, extra=4.2**2 * shapes.values @ shapes.values.T), abs=1e-3)


class Expansion(SpringModel):
    """Right only at the stiffness it is expanded about: off by the square of the distance from it."""

    about = 1050.0

    def respond(self, design, kind, conditions):
        wrong = 1 + 30 * (design.stiffness / self.about - 1) ** 2
        return {"force": wrong * design.stiffness * conditions["displacement"]}

    def recentred(self, design):
        moved = Expansion()
        moved.about = design.stiffness
        return moved


def test_a_fit_ends_where_the_expansion_is_exact(bench):
    expansion = replace(bench.fit.predictor, model=replace(bench.fit.predictor.model, base=Expansion()))
    problem = replace(bench.fit, predictor=expansion)
    rough = fitted(problem, (), np.zeros(2), np.zeros(0))
    sharp = sharpened(problem, rough)[1]
    assert abs(rough.log_evidence - bench.null.log_evidence) > 3 * SHARP
    assert sharp.log_evidence == pytest.approx(bench.null.log_evidence, abs=SHARP)
    assert sharp.x == pytest.approx(bench.null.x, abs=0.15)
    effect = single(bench, prepared(bench, Hardening()))[0]
    assert exact(effect) is effect  # nothing to do for a model that is exact everywhere


def test_an_effect_beside_the_unknown_function_counts_the_error_of_its_law_once(bench):
    """With an amplitude of almost nothing the unknown function changes nothing, also where a law is wrong."""

    class Wrong(Hardening):
        model_error = 3.0

    found = single(bench, prepared(bench, Wrong()))[0]
    unknown = unknown_function(bench.fit.stack, bench.fit.white)
    problem, half_log_det = with_unknown(found.problem, unknown, Choice(((0, 2),), 1e-6, 0.0))
    laws = sum(law.half_log_det for law in found.problem.white.laws)
    assert laws > 0.5 and half_log_det == pytest.approx(laws, abs=1e-6)
    again = fitted(problem, found.fit.effects, found.fit.x, found.fit.z).log_evidence - half_log_det
    assert again == pytest.approx(found.fit.log_evidence - laws, abs=1e-3)


def test_tangents_do_not_reach_over_places_without_an_answer():
    """A change z^2 along one axis, unknown above z = 1.5: the slope at the last place is that to its neighbour."""

    def change(effect):
        z = effect.parameters_z
        if z > 1.5:
            raise WorkbenchError("no steady state")
        return np.array([z**2])

    class Half(Bump):
        def at(self, z):
            found = super().at(z)
            object.__setattr__(found, "parameters_z", float(z[0]))
            return found

    found = signature(Half(), change)
    last = int(np.max(np.flatnonzero(np.isfinite(found.log_prior))))
    z = found.z[:, 0]
    assert found.tangents[0, 0, last] == pytest.approx(z[last] + z[last - 1])
    assert np.allclose(found.tangents[0, 0, 1:last], 2 * z[1:last]) and not found.tangents[0, 0, last + 2 :].any()


def test_a_start_without_an_answer_is_passed_over(bench, monkeypatch):
    from workbench.explain import hypotheses

    known = prepared(bench, Hardening())
    starts = [np.array([99.0]), *known.best(bench.residual)]
    monkeypatch.setattr(Prepared, "best", lambda self, residual: starts)
    real = hypotheses._from_start

    def start(bench, effect, z):
        if z[0] == 99.0:
            raise WorkbenchError("no steady state")
        return real(bench, effect, z)

    monkeypatch.setattr(hypotheses, "_from_start", start)
    assert single(bench, known)[0].fit.z[0] != 99.0
    starts[1:] = []
    with pytest.raises(WorkbenchError, match="no steady state"):
        single(bench, known)
