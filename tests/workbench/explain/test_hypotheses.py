"""Fits and their evidences against dense Gaussians and brute-force integration."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import logsumexp
from scipy.stats import multivariate_normal
from scipy.stats import t as student

import workbench.explain.hypotheses as hypotheses_module
import workbench.explain.neighbours as neighbours_module
import workbench.explain.search as search_module
import workbench.explain.tried as tried_module
from effects.base import DesignEffect, ResponseEffect
from effects.parameter import parameter
from effects.prior import LogNormal, Normal, Uniform
from geometry.errors import GeometryError
from tests.workbench.toy_bench import LIBRARY, RATE, Bump, Hardening, Spring, SpringModel, written
from workbench.believed import TAILS
from workbench.data.campaign import read_campaign
from workbench.errors import WorkbenchError
from workbench.explain.beside import less_one_beside, weigh
from workbench.explain.explore import beliefs_of
from workbench.explain.hypotheses import (
    Beside,
    Hypothesis,
    at_zero,
    beside_unknown,
    estimates,
    exact,
    fitted_from,
    from_elsewhere,
    null_of,
    turned,
    with_law_error,
)
from workbench.explain.neighbours import exchange, exchange_two, less_one
from workbench.explain.search import best_alone, searched
from workbench.explain.tried import Promise, Search, expand, fit_set
from workbench.likelihood.bench import SHARP, bench_of, sharpened
from workbench.likelihood.fit import fitted, linearised, misfit, refitted
from workbench.likelihood.marginal import Catalogue, Terms
from workbench.likelihood.signatures import Signatures, grid, signature, signatures_of
from workbench.likelihood.unknown import SIZES, Seen, seen, shapes_of
from workbench.likelihood.unknown_laws import LAWS
from workbench.likelihood.whitening import Course, Whitener
from workbench.models.model import Model

GAUSS = 1e9  # degrees of freedom at which the noise is known for sure


def sure_of_noise(folder, **more):
    """A bench whose noise is known for sure, so that everything linear is Gaussian."""
    campaign = read_campaign(written(folder, n=40, rho=0.3, **more))
    found = bench_of(Model(SpringModel(), SpringModel().design(campaign.device)), campaign, LIBRARY)
    sure = replace(found.fit, dof=np.full(1, GAUSS))
    return replace(found, fit=sure, null=fitted(sure, (), np.zeros(2), np.zeros(0)))


@pytest.fixture(scope="module")
def bench(tmp_path_factory):
    return sure_of_noise(tmp_path_factory.mktemp("c"), extra=lambda x: 4e4 * x**3)


def gauss(bench, change=0.0, extra=None):
    """ln density of the whitened readings, nuisances integrated out, over that of pure white noise at zero."""
    slopes = bench.null.jacobian
    covariance = np.eye(len(slopes)) + slopes @ slopes.T + (0 if extra is None else extra)
    start = bench.fit.residual(np.zeros(2))
    whole = multivariate_normal(np.zeros(len(slopes)), covariance).logpdf(start - change)
    return whole + 0.5 * len(slopes) * np.log(2 * np.pi)


@dataclass(frozen=True)
class Ripple(ResponseEffect):
    """F = k x + size^2 cos(2 pi x / 10 mm - 2 phase), as faint as an eccentricity; beyond three there is no answer."""

    title = "ripple"
    looks_like = "a force that comes and goes"
    designs = (Spring,)
    base_rate = RATE
    size: float = parameter(0.0, "N", prior=LogNormal(0.3, 0.7), low=0.0, high=10.0, source="made up")
    phase: float = parameter(0.0, "rad", prior=Uniform(-np.pi, np.pi), low=-np.pi, high=np.pi, source="any")

    def on_response(self, response, conditions, kind, design):
        if self.phase > 3.0:
            raise WorkbenchError("no answer")
        wave = np.cos(2 * np.pi * conditions["displacement"] / 0.01 - 2 * self.phase)
        return {**response, "force": response["force"] + self.size**2 * wave}


def test_a_fit_that_ended_in_a_wrong_valley_finds_the_right_one(tmp_path):
    """From a phase of 2.9 the way to -2.1, which is the same as 1.0, leads through phases without an answer."""
    bench = sure_of_noise(tmp_path, extra=lambda x: 0.25 * np.cos(2 * np.pi * x / 0.01 - 2.0))
    start = np.array([LogNormal(0.3, 0.7).standard(0.1), Uniform(-np.pi, np.pi).standard(2.9)])
    there = fitted_from(bench, (Ripple(),), np.zeros(2), start)
    found = from_elsewhere(bench, there)
    assert found.log_evidence > there.log_evidence + 100
    (ripple,) = found.effects
    assert ripple.size == pytest.approx(0.5, abs=0.05)
    assert ripple.phase % np.pi == pytest.approx(1.0, abs=0.1)
    assert from_elsewhere(bench, found).log_evidence >= found.log_evidence


class Lopsided(Ripple):
    """A ripple that is not quite the same half a turn on."""

    def on_response(self, response, conditions, kind, design):
        more = 0.1 * self.size * np.cos(np.pi * conditions["displacement"] / 0.01 - self.phase)
        return super().on_response({**response, "force": response["force"] + more}, conditions, kind, design)


def test_a_fit_that_ended_half_a_turn_off_is_turned(tmp_path):
    """Between the sizes of the grid, so that no place of it is better than the wrong side."""
    wave = lambda x: 0.16 * np.cos(2 * np.pi * x / 0.01 + 2.0) + 0.04 * np.cos(np.pi * x / 0.01 + 1.0)  # noqa: E731
    bench = sure_of_noise(tmp_path, extra=wave)
    start = np.array([LogNormal(0.3, 0.7).standard(0.4), Uniform(-np.pi, np.pi).standard(-1.0 + np.pi)])
    there = fitted_from(bench, (Lopsided(),), np.zeros(2), start)
    (ripple,) = turned(bench, there).effects
    assert there.effects[0].phase > 1.0
    assert ripple.phase == pytest.approx(-1.0, abs=0.1)


def alone(bench, cls):
    signatures = signatures_of(bench, (cls(),))
    return best_alone(bench, signatures, beliefs_of({cls.name(): cls}, signatures.names))


def test_laplace_is_exact_where_everything_is_linear_and_gaussian(bench):
    assert bench.null.log_evidence == pytest.approx(gauss(bench), abs=1e-3)


@pytest.mark.parametrize("cls", [Hardening, Bump])
def test_evidence_of_an_effect_is_the_integral_over_its_prior(bench, cls):
    base = bench.fit.residual(np.zeros(2))
    places = np.linspace(-8, 8, 321)
    changes = (base - bench.fit.residual(np.zeros(2), (cls().at([z]),)) for z in places)
    logs = np.array([gauss(bench, c) + student.logpdf(z, TAILS) for c, z in zip(changes, places)])
    whole = np.log(np.trapezoid(np.exp(logs - logs.max()), places)) + logs.max()
    assert alone(bench, cls).log_evidence == pytest.approx(whole, abs=0.1)
    catalogue = signatures_of(bench, (cls(),)).catalogue(bench.null.jacobian, bench.fit.white)
    gains = catalogue.gains((), catalogue.readings(bench.residual[:, None]))[:, 0]
    grid_sum = float(logsumexp(gains + np.array([term.log_prior for term in catalogue.terms])))
    assert bench.null.log_evidence + grid_sum == pytest.approx(whole, abs=0.3)  # the grid is coarser


def test_student_likelihood_is_the_gauss_with_its_size_integrated_out():
    dof, n = 7.0, 5

    def integrand(s, q):  # scaled inverse chi2 prior of the variance from dof repeats
        return s ** (-n / 2 - dof / 2 - 1) * np.exp(-(q + dof) / (2 * s))

    ratio = quad(integrand, 0, np.inf, args=(30.0,))[0] / quad(integrand, 0, np.inf, args=(2.0,))[0]
    values = [misfit(np.array([q]), np.array([dof]), np.array([n])) for q in (2.0, 30.0)]
    assert values[0] - values[1] == pytest.approx(np.log(ratio), rel=1e-6)


def test_a_size_lies_in_the_interval_that_is_printed_beside_it(bench, monkeypatch):
    """Where most of the belief is in fits that find another size than the one that is shown."""
    shown = alone(bench, Hardening)
    other, own = replace(shown), hypotheses_module._samples
    apart = 100 * estimates(shown)["hardening"]["cubic"].std
    monkeypatch.setattr(hypotheses_module, "_samples", lambda h, *of: own(h, *of) + apart * (h is other))
    for weights in ({shown: 1.0}, {shown: 0.02, other: 0.98}):
        found = estimates(shown, weights)["hardening"]["cubic"]
        assert found.low90 < found.value < found.high90


def test_what_slopes_promise_and_the_model_does_not_keep_is_no_evidence(bench):
    """A fit that could go no further, of a model that is not as straight as its slopes say, against Laplace's rule
    where it ended: there the fit without effects is judged too."""
    fit = fitted_from(bench, (Hardening(),), bench.null.x, np.zeros(1)).fit
    short = linearised(bench.fit, fit.x + 1.5, fit.effects, fit.z)
    assert fit.log_evidence - short.log_evidence > 1.0
    assert hypotheses_module._integrated(bench.fit, short)[2] == pytest.approx(short.log_evidence, abs=0.1)


def test_two_starts_find_the_same_maximum(bench):
    low, high = (fitted_from(bench, (Hardening(),), bench.null.x, np.array([z])) for z in (-1.5, 1.5))
    assert low.fit.z == pytest.approx(high.fit.z, abs=1e-3)
    assert low.log_evidence == pytest.approx(high.log_evidence, abs=1e-3)


# ---- beside an unknown function --------------------------------------------------------------------------------------


@pytest.mark.parametrize("start", ((0.0, 0.0), (2.0, 4.0), (-3.0, 9.0), (2.0, -2.0)))
def test_a_fit_follows_a_bent_ridge_to_its_end(tmp_path, start):
    """Of two sizes one is told twenty times better than the other: w - u^2, as Rosenbrock has it."""

    @dataclass(frozen=True)
    class Bent(Bump):
        u: float = parameter(0.0, "1", prior=Normal(1.0), low=-10.0, high=10.0, source="made up")
        w: float = parameter(0.0, "1", prior=Normal(1.0), low=-100.0, high=100.0, source="made up")

        def on_response(self, response, conditions, kind, design):
            x = conditions["displacement"]
            force = 4.0 * (self.w - self.u**2) * np.cos(600 * x) + 0.2 * self.u * np.cos(1500 * x)
            return {**response, "force": response["force"] + force}

    bench = sure_of_noise(tmp_path, extra=lambda x: 0.1 * np.cos(1500 * x))
    found = fitted_from(bench, (Bent(),), bench.null.x, np.array([0.0, *start])).fit
    best = fitted_from(bench, (Bent(),), bench.null.x, np.array([0.0, 0.5, 0.25])).fit
    assert found.objective == pytest.approx(best.objective, abs=0.02)


def test_evidence_beside_the_unknown_is_the_mean_over_all_shapes_and_sizes(bench):
    shapes = shapes_of(bench.fit.stack, bench.fit.white, bench.fit.predictor.predict(bench.null.x))
    logs = [
        gauss(bench, extra=a**2 * s.columns @ s.columns.T) + s.log_prior - np.log(len(SIZES))
        for s in shapes
        for a in SIZES
    ]
    found = beside_unknown(null_of(bench), shapes)
    assert found.log_evidence == pytest.approx(float(logsumexp(logs)), abs=1e-2)


def test_an_unknown_law_is_seen_beside_an_effect_too(tmp_path):
    """A wave and an even part: the expected function beside the even part is the wave, where noise lets it be seen."""
    wave = lambda x: 0.5 * np.sin(900 * x)  # noqa: E731
    bench = sure_of_noise(tmp_path, extra=lambda x: wave(x) + 1.0 * (x / 0.01) ** 2)
    found = beside_unknown(
        alone(bench, Bump), shapes_of(bench.fit.stack, bench.fit.white, bench.fit.predictor.predict(bench.null.x))
    )
    x = bench.fit.stack.tables[0].conditions["displacement"]
    assert found.leading[0].shape.law == "smooth"
    assert np.corrcoef(found.functions[0], wave(x))[0, 1] > 0.97


# ---- errors of laws --------------------------------------------------------------------------------------------------


MOST = 1.1e5  # N/m^3, a little more than the size that a fit finds


class Limited(Hardening):
    """There is no answer beyond a size."""

    def on_response(self, response, conditions, kind, design):
        if self.cubic > MOST:
            raise WorkbenchError("no answer")
        return super().on_response(response, conditions, kind, design)


def test_a_size_without_an_answer_is_not_believed_and_ends_no_fit(bench):
    """As motors at their limit of voltage have; the evidence is less by the share of the sizes that are left."""
    start = bench.null.x, np.array([-2.2])
    free, limited = (fitted_from(bench, (effect,), *start) for effect in (Hardening(), Limited()))
    assert limited.effects[0].cubic == pytest.approx(free.effects[0].cubic, rel=1e-3)
    after = hypotheses_module.density_of(free)
    left = np.trapezoid(np.where(after.values <= MOST, after.density, 0.0), after.values)
    assert 0.3 < left < 0.9, "the limit lies among sizes that are believed"
    assert limited.log_evidence - free.log_evidence == pytest.approx(np.log(left), abs=0.1)
    assert hypotheses_module.estimates(limited)["limited"]["cubic"].high90 <= 1.05 * MOST


class Wrong(Hardening):
    """Its law is good to a fifth."""

    model_error = 0.2


def test_the_error_of_a_law_widens_the_covariance_by_its_share(bench):
    effect = Wrong().at([1.0])
    problem, log_det = with_law_error(bench.fit, (effect,), np.zeros(2))
    x = bench.fit.stack.tables[0].conditions["displacement"]
    ranks = (np.arange(len(x)) - (len(x) - 1) / 2) / np.std(np.arange(len(x)))
    assert (np.diff(x) > 0).all()
    kernel = np.exp(-(np.subtract.outer(ranks, ranks) ** 2) / (2 * 0.8**2))
    change = 0.2 * effect.cubic * x**3
    wrong = bench.fit.white(bench.fit.white(np.outer(change, change) * kernel).T)
    assert log_det == pytest.approx(0.5 * np.linalg.slogdet(np.eye(len(x)) + wrong)[1], abs=0.05)


class Unheld(Wrong):
    """Without its partner there is no answer, as where a supply cannot hold a saturated motor."""

    def on_response(self, response, conditions, kind, design):
        if not response.get("held"):
            raise WorkbenchError("no steady state")
        return super().on_response(response, conditions, kind, design)


class Holding(Bump):
    """The partner."""

    def on_response(self, response, conditions, kind, design):
        return super().on_response(response, conditions, kind, design) | {"held": True}


def test_the_error_of_a_law_that_has_no_answer_alone_is_that_beside_its_partner(bench):
    holding = Holding().at([1.0])
    alone = with_law_error(bench.fit, (Wrong().at([1.0]),), np.zeros(2))[1]
    beside = with_law_error(bench.fit, (holding, Unheld().at([1.0])), np.zeros(2))[1]
    assert beside == pytest.approx(alone, rel=1e-9)


def test_a_fit_is_kept_where_another_start_of_it_has_no_answer(bench, monkeypatch):
    def none(*_):
        raise WorkbenchError("no answer")

    monkeypatch.setattr(tried_module, "turned", none)
    signatures = signatures_of(bench, (Hardening(),))
    best = best_alone(bench, signatures, beliefs_of({"hardening": Hardening}, signatures.names))
    assert best.names == {"hardening"}


def test_the_error_of_a_law_is_that_of_the_fitted_size_wherever_the_fit_began(tmp_path):
    """From a start far too large a fit would be free to be wrong by a large error, and its evidence not its own."""
    bench = sure_of_noise(tmp_path, extra=lambda x: 4e5 * x**3)
    near, far = (fitted_from(bench, (Wrong(),), bench.null.x, np.array([z])) for z in (0.3, 4.0))
    assert far.fit.z == pytest.approx(near.fit.z, abs=0.05)
    assert far.log_det == pytest.approx(near.log_det, abs=0.1)
    assert far.log_evidence == pytest.approx(near.log_evidence, abs=0.2)
    start = with_law_error(bench.fit, (Wrong().at([4.0]),), bench.null.x)[1]
    assert start > far.log_det + 2.0, "the start was indeed far"


class Loose(Hardening):
    """Its law is as good as none: fitted with a large error it is small and with a small one large, without end."""

    model_error = 1.0


def test_the_error_of_a_law_is_found_where_each_fit_throws_it_to_the_other_side(tmp_path):
    bench = sure_of_noise(tmp_path, extra=lambda x: 4e8 * np.abs(x) ** 3 * x)
    near, far = (fitted_from(bench, (Loose(),), bench.null.x, np.array([z])) for z in (0.5, 3.0))
    for found in (near, far):
        at_its_end = with_law_error(bench.fit, found.fit.at_maximum, found.fit.x)[1]
        assert found.log_det == pytest.approx(at_its_end, abs=0.3)
    assert far.log_evidence == pytest.approx(near.log_evidence, abs=0.3)


class Close(Hardening):
    """Its law is good to a hundredth."""

    model_error = 0.01


class Unsure(Hardening):
    """Nobody knows how good its law is: as one or the other of these."""

    with_errors = property(lambda self: (Close(self.cubic), Wrong(self.cubic)))


def test_an_unknown_error_of_a_law_is_averaged_over(tmp_path):
    bench = sure_of_noise(tmp_path, extra=lambda x: 4.0 * (x / 0.01) ** 3)
    close, wrong, unsure = (
        fitted_from(bench, (kind(),), bench.null.x, np.array([2.0])) for kind in (Close, Wrong, Unsure)
    )
    both = np.logaddexp(close.log_evidence, wrong.log_evidence) - np.log(2)
    assert unsure.log_evidence == pytest.approx(both, abs=0.02), "fits end within 0.01 nats"
    assert unsure.fit.effects == max((close, wrong), key=lambda h: h.log_evidence).fit.effects


def having(folder, effect, extra):
    """The bench of a model that has an effect already."""
    campaign = read_campaign(written(folder, n=40, rho=0.3, extra=extra))
    return bench_of(Model(SpringModel(), SpringModel().design(campaign.device)) + effect, campaign, LIBRARY)


def test_the_error_of_a_law_stays_when_its_effect_is_in_the_model(bench, tmp_path):
    """In what is left open of the readings, fitted and sealed alike."""
    effect = Wrong().at([1.0])
    had = having(tmp_path, effect, lambda x: effect.cubic * x**3)
    tried = with_law_error(bench.fit, (effect,), np.zeros(2))[0]
    assert logs_of(had.fit) == pytest.approx(logs_of(tried), rel=0.02)
    exact_one = having(tmp_path / "exact", Hardening(effect.cubic), lambda x: effect.cubic * x**3)
    assert logs_of(exact_one.fit) == pytest.approx(logs_of(bench.fit), rel=0.02)
    assert logs_of(tried) > 1.1 * logs_of(bench.fit)


def logs_of(problem):
    return sum(law.half_log_det for law in problem.white.laws)


def test_what_a_law_in_the_model_may_be_wrong_by_is_no_other_effect(tmp_path):
    """A hardening that is a tenth stiffer at one end and softer at the other, which an even part would follow."""
    extra = lambda x: 2e6 * x**3 * (1 + 0.1 * np.tanh(x / 0.005))  # noqa: E731
    exact_one, wrong = (having(tmp_path / kind.name(), kind(2e6), extra) for kind in (Hardening, Wrong))
    gains = [alone(one, Bump).log_evidence - one.null.log_evidence for one in (exact_one, wrong)]
    assert gains[0] > 8.0, "an exact law leaves no room"
    assert gains[1] < 1.0, "a law that is good to a fifth explains it"


def test_an_exact_law_has_no_error(bench):
    assert with_law_error(bench.fit, (Hardening().at([1.0]),), np.zeros(2)) == (bench.fit, 0.0)


# ---- base models that answer by an expansion -------------------------------------------------------------------------


class Expansion(SpringModel):
    """Right only at the stiffness it is expanded about: off by the square of the distance from it."""

    about = 1050.0

    def respond(self, design, kind, conditions):
        wrong = 1 + 30 * (design.stiffness / self.about - 1) ** 2
        return {"force": wrong * design.stiffness * conditions["displacement"]}

    def recentred(self, design, tables=()):
        moved = Expansion()
        moved.about = design.stiffness
        return moved

    is_expansion = True


def test_a_fit_that_begins_with_foreign_slopes_ends_where_one_with_its_own_does(bench):
    """Slopes of a spring of another stiffness, far off at the start, are replaced by its own."""
    z = np.array([1.0])
    foreign = replace(bench.null, slopes=np.roll(bench.null.slopes, 1, axis=1))
    own, found = (fitted_from(bench, (Hardening(),), bench.null.x, z, s) for s in (None, foreign.slopes))
    assert found.log_evidence == pytest.approx(own.log_evidence, abs=0.01)
    assert found.fit.slopes == pytest.approx(own.fit.slopes, rel=1e-3)


def test_a_fit_of_a_problem_that_changed_little_keeps_its_slopes(bench):
    assert refitted(bench.fit, bench.null).slopes is bench.null.slopes
    heavier = replace(bench.fit, stack=replace(bench.fit.stack, y=1.02 * bench.fit.stack.y))
    moved = refitted(heavier, bench.null)
    assert moved.slopes is not bench.null.slopes
    assert moved.objective == pytest.approx(fitted(heavier, (), np.zeros(2), np.zeros(0)).objective, abs=0.01)


def test_a_fit_ends_where_the_expansion_is_exact(bench):
    expansion = replace(bench.fit.predictor, model=replace(bench.fit.predictor.model, base=Expansion()))
    problem = replace(bench.fit, predictor=expansion)
    rough = fitted(problem, (), np.zeros(2), np.zeros(0))
    sharp = sharpened(problem, rough)[1]
    assert abs(rough.log_evidence - bench.null.log_evidence) > 3 * SHARP
    assert sharp.log_evidence == pytest.approx(bench.null.log_evidence, abs=SHARP)
    assert sharp.x == pytest.approx(bench.null.x, abs=0.15)
    effect = alone(bench, Hardening)
    assert exact(effect) is effect  # nothing to do for a model that is exact everywhere


def test_what_is_solved_for_one_fit_is_found_again_by_one_that_ends_a_rounding_away(bench, monkeypatch):
    """Not that of a fit that ends a thousandth of a tolerance further on."""
    asked = []
    monkeypatch.setattr(Expansion, "recentred", lambda self, design, tables=(): asked.append(design) or self)
    expansion = replace(bench.fit.predictor, model=replace(bench.fit.predictor.model, base=Expansion()))
    problem = replace(bench.fit, predictor=expansion)

    def first_place(away):
        asked.clear()
        sharpened(problem, replace(bench.null, x=np.round(bench.null.x, 3) + away))
        return asked[0]

    assert first_place(0.0) == first_place(1e-9) != first_place(1e-3)


class Unbuildable(Expansion):
    """It cannot be had about any other place, as a mesh that cannot be moved that far."""

    def recentred(self, design, tables=()):
        raise GeometryError("triangles would turn over")


def test_what_ends_at_a_device_that_cannot_be_is_taken_back(bench):
    """The campaign is still answered, by what is left."""
    expansion = replace(bench.fit.predictor, model=replace(bench.fit.predictor.model, base=Unbuildable()))
    problem = replace(bench.fit, predictor=expansion)
    with pytest.raises(WorkbenchError, match="no such device: triangles would turn over"):
        sharpened(problem, bench.null)
    somewhere = replace(bench, fit=problem, model=expansion.model)
    found = searched(somewhere, {"hardening": Hardening})
    assert "hardening" in found.failed and found.ranked[0] != {"hardening"}
    whole = bench_of(expansion.model, bench.campaign, LIBRARY)
    assert whole.fit.predictor.model.base.about == Expansion.about


# ---- promises --------------------------------------------------------------------------------------------------------


def with_few_repeats(bench, dof):
    """The bench with a noise that so many degrees of freedom have measured."""
    fit = replace(bench.fit, dof=np.full(1, float(dof)))
    return replace(bench, fit=fit, null=fitted(fit, (), np.zeros(2), np.zeros(0)))


def promised_and_gained(bench, cls):
    """What an effect beside nothing is promised to gain, and gains [nats]."""
    signatures, only = signatures_of(bench, (cls(),)), frozenset((cls.name(),))
    beliefs = beliefs_of({cls.name(): cls}, signatures.names)
    search = Search(bench, signatures, beliefs, (), {frozenset(): null_of(bench)})
    expand(search, search.fitted[frozenset()], [])
    gained = best_alone(bench, signatures, beliefs).log_evidence
    return search.guessed[only] - bench.null.log_evidence, gained - bench.null.log_evidence


def test_what_a_pulled_tolerance_would_give_back_is_promised(tmp_path):
    """A spring 10 % too soft, drawn to 1 %: all that the effect gains is the pull; no channel fits badly."""
    bench = with_few_repeats(sure_of_noise(tmp_path, stiffness=900.0), 30)
    assert abs(bench.null.x[0]) > 6 and np.mean(bench.null.residual**2) < 1.5
    promised, gained = promised_and_gained(bench, LIBRARY["soft_spring"])
    assert gained > 15 and promised == pytest.approx(gained, abs=0.5)


@pytest.mark.parametrize("size", (0.3, 1.0))
def test_what_a_large_misfit_would_give_back_is_promised_as_student_has_it(tmp_path, size):
    """With ten degrees of freedom the likelihood gains much less than a Gaussian one."""
    sure = sure_of_noise(tmp_path, extra=lambda x: size * np.cos(600 * x))
    promised, gained = promised_and_gained(with_few_repeats(sure, 10), WAVES["wave2"])
    assert gained < 0.5 * promised_and_gained(sure, WAVES["wave2"])[1]
    assert gained > 10 and promised == pytest.approx(gained, abs=0.5)


@dataclass(frozen=True)
class Lever(ResponseEffect):
    """The force is read through a lever: F (1 + more)."""

    title = "lever"
    looks_like = "more force"
    more: float = parameter(0.0, "1", prior=Normal(1.0), low=-0.9, high=9.0, source="made up")

    def on_response(self, response, conditions, kind, design):
        return {**response, "force": response["force"] * (1.0 + self.more)}


def test_beside_a_large_effect_others_do_what_they_do_there(bench):
    """A lever that trebles the force trebles what a spring makes of it that is too soft; one of a tenth is as good as
    none."""
    soft = LIBRARY["soft_spring"]
    signatures = signatures_of(bench, (Lever(), soft()))
    beliefs = beliefs_of({"lever": Lever, "soft_spring": soft}, signatures.names)
    search = Search(bench, signatures, beliefs, (), {frozenset(): null_of(bench)})

    def beside(more):
        return Hypothesis(linearised(bench.fit, bench.null.x, (Lever(),), [more]), bench.fit, 0.0)

    assert search.signatures_beside(beside(0.1)) is signatures
    there = search.signatures_beside(beside(2.0))
    for name, times in (("soft_spring", 3.0), ("lever", 1.0)):
        before = signatures.found[name][0].change
        assert there.found[name][0].change == pytest.approx(times * before, rel=0.01, abs=1e-9)
    assert search.signatures_beside(beside(2.1)) is there, "near enough"
    search.bench = expanded(bench)
    assert search.signatures_beside(beside(2.0)) is signatures, "an expansion is compared about its drawing"


def test_what_a_tolerance_could_do_is_done_as_the_tolerance_does_it_at_a_fit():
    """One effect does what a tolerance does, half of another is beyond tolerances: at a fit where the tolerance does
    1.5 times as much, so does that part of both."""
    tolerance, beyond = 100.0 * np.eye(40)[:, :1], 100.0 * np.eye(40)[:, 1]
    changes = {"alike": tolerance[:, 0], "half": tolerance[:, 0] + beyond}
    found = {n: (signature(Bump(), lambda effect, c=c: effect.size * c),) for n, c in changes.items()}
    signatures = Signatures(found, {}, Whitener(np.ones(40), Course.independent(40)), tolerance)
    catalogue = signatures.catalogue_at(1.5 * tolerance, np.zeros((40, 0)), signatures.white, ())
    for number in (0, len(catalogue.terms) // 2):  # the first place of either
        there, before = catalogue.felt(number), signatures.catalogue(np.zeros((40, 0)), signatures.white).felt(number)
        assert there[0] == pytest.approx(1.5 * before[0], rel=1e-3)
        assert np.array_equal(there[1:], before[1:])


# ---- grids -----------------------------------------------------------------------------------------------------------


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


def test_a_size_that_cannot_be_negative_is_not_promised_a_negative_one():
    """A friction on its logarithmic grid, held against readings that show less than none."""
    friction = signature(Bump(), lambda effect: np.full(40, np.exp(2 * effect.size)))
    white = Whitener(np.ones(40), Course.independent(40))
    catalogue = Catalogue(np.zeros((40, 0)), Terms(tuple(friction.terms(white, 0, 0.0)), 40))
    gains = catalogue.gains((), catalogue.readings(-3.0 * np.ones((40, 1))))
    assert gains.max() < 0


def test_the_prior_of_a_grid_is_that_of_its_cells():
    found = signature(Bump(), lambda effect: np.array([effect.size]))
    assert float(logsumexp(found.log_prior)) == pytest.approx(0.0, abs=1e-12)
    edge = found.z[0, 0] - found.width / 2
    inside = student.cdf(-edge, TAILS) - student.cdf(edge, TAILS)
    middle = student.cdf(found.width / 2, TAILS) - student.cdf(-found.width / 2, TAILS)
    assert np.exp(found.log_prior[4]) == pytest.approx(middle / inside)


def test_an_effect_with_too_many_parameters_is_said():
    with pytest.raises(WorkbenchError, match="one to 4 parameters, found 5"):
        grid(5)


# ---- the search ------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Cosine(Bump):
    """One of several waves, none of which the others can imitate."""

    waves = 3.0

    def on_response(self, response, conditions, kind, design):
        wave = np.cos(self.waves * 300 * conditions["displacement"])
        return {**response, "force": response["force"] + self.size * wave}


WAVES = {
    f"wave{k}": type(f"Wave{k}", (Cosine,), {"waves": float(k), "name": classmethod(lambda cls: f"wave{cls.waves:g}")})
    for k in range(2, 8)
}


@pytest.mark.parametrize("truth", [(2, 5, 7), (3, 4, 6, 7)])
def test_three_and_four_effects_at_once_are_found_by_fits(tmp_path, truth):
    hidden = lambda x: sum(0.25 * np.cos(300 * k * x) for k in truth)  # noqa: E731
    search = searched(sure_of_noise(tmp_path, extra=hidden), WAVES)
    wanted = frozenset(f"wave{k}" for k in truth)
    assert search.ranked[0] == wanted
    assert search.posterior.all_of(tuple(frozenset((n,)) for n in wanted)) > 0.9
    assert all(abs(effect.size - 0.25) < 0.1 for effect in search.fitted[wanted].effects)


def test_what_leads_is_weighed_against_itself_without_each_of_its_effects(tmp_path):
    """A search that knows nothing and a pair only, where one of the pair was hidden alone."""
    bench = sure_of_noise(tmp_path, extra=lambda x: 0.25 * np.cos(600 * x))
    signatures = signatures_of(bench, (WAVES["wave2"](), WAVES["wave5"]()))
    pair = fitted_from(bench, (WAVES["wave2"](), WAVES["wave5"]()), bench.null.x, np.array([0.8, 0.1]))
    none, both, one = frozenset(), frozenset(WAVES).intersection(signatures.names), frozenset(("wave2",))
    search = Search(bench, signatures, beliefs_of(WAVES, signatures.names), (), {none: null_of(bench), both: pair})
    assert search.ranked[0] == both
    less_one(search, lambda words: None)
    assert search.ranked[0] == one and set(search.fitted) == {none, one, frozenset(("wave5",)), both}
    straight = fitted_from(bench, (WAVES["wave2"](),), bench.null.x, np.array([0.5]))
    assert search.log_evidence(one) == pytest.approx(straight.log_evidence, abs=1e-2)


def test_no_fit_is_taken_apart_twice(tmp_path):
    bench = sure_of_noise(tmp_path, extra=lambda x: 0.25 * np.cos(600 * x) + 0.25 * np.cos(1500 * x))
    pair = fitted_from(bench, (WAVES["wave2"](), WAVES["wave5"]()), bench.null.x, np.array([0.8, 0.8]))
    search = searching(bench, {frozenset(): null_of(bench), pair.names: pair})
    asked = []
    less_one(search, asked.append)
    assert asked == ["fitting wave5", "fitting wave2"] and search.ranked[0] == pair.names
    less_one(search, asked.append)
    assert len(asked) == 2


def test_what_leads_beside_an_unknown_function_is_weighed_there_without_each_of_its_effects(tmp_path):
    """A pair was fitted where neither was hidden, but a law that none of the effects can imitate."""
    bench = sure_of_noise(tmp_path, extra=lambda x: 2.0 * np.sin(900 * x))
    pair = fitted_from(bench, (WAVES["wave2"](), WAVES["wave5"]()), bench.null.x, np.array([0.1, 0.1]))
    search = searching(bench, {frozenset(): null_of(bench), pair.names: pair})
    search.shapes = shapes_of(bench.fit.stack, bench.fit.white, bench.fit.predictor.predict(bench.null.x))
    weigh(search, pair.names)
    assert search.leader_beside == pair.names
    less_one_beside(search, lambda words: None)
    assert search.leader_beside == frozenset()
    assert set(search.beside) == {frozenset(), frozenset(("wave2",)), frozenset(("wave5",)), pair.names}


def searching(bench, fitted):
    """A search that has fitted some sets, of the named effects."""
    signatures = signatures_of(bench, [wave() for wave in WAVES.values()])
    return Search(bench, signatures, beliefs_of(WAVES, signatures.names), (), fitted)


def test_a_guess_learns_from_the_fits_of_what_it_holds(tmp_path):
    """A set was guessed too high by as much as a part of it, unless it was guessed beside a nearer fit."""
    bench = sure_of_noise(tmp_path)
    none, far, near = frozenset(), frozenset(("wave2", "wave3")), frozenset(("wave2", "wave4"))
    search = searching(bench, {none: null_of(bench)})
    search.guessed = {far: 100.0, near: 100.0}
    search.origins = {far: none, near: frozenset(("wave4",))}
    tried_module._lower(search, frozenset(("wave2",)), 30.0)
    assert search.guessed == {far: 70.0, near: 100.0}


@pytest.mark.parametrize("behind, is_near", ((50.0, False), (1.0, True)))
def test_a_fit_far_behind_does_not_raise_what_was_guessed_beside_a_nearer_one(tmp_path, monkeypatch, behind, is_near):
    """Nor is it worth to look for more beside it."""
    bench = sure_of_noise(tmp_path)
    effects = [WAVES[f"wave{k}"]() for k in (2, 3)]
    one, two = (fitted_from(bench, effects[:n], bench.null.x, np.full(n, 0.1)) for n in (1, 2))
    every, nearer = frozenset(("wave2", "wave4", "wave5")), frozenset(("wave4", "wave5"))
    search = searching(bench, {frozenset(): null_of(bench), two.names: replace(two, log_evidence=100.0)})
    search.fitted[one.names] = replace(one, log_evidence=100.0 - behind)
    search.guessed, search.origins = {every: 90.0}, {every: nearer}
    monkeypatch.setattr(tried_module.Additions, "gain", lambda self, found: 1e3)
    expand(search, search.fitted[one.names], [])
    assert search.guessed[every] == (1100.0 - behind if is_near else 90.0)
    assert search_module._leads_on(search, one.names) is is_near


def test_a_set_is_promised_less_where_a_part_of_it_was_fitted_and_promised_too_much(tmp_path, monkeypatch):
    """By hand: 1000 nats are promised beside one effect; with a second one that was fitted 200 were gained."""
    bench = sure_of_noise(tmp_path)
    effects = [WAVES[f"wave{k}"]() for k in (2, 3)]
    one, two = (fitted_from(bench, effects[:n], bench.null.x, np.full(n, 0.1)) for n in (1, 2))
    search = searching(bench, {frozenset(): null_of(bench), one.names: replace(one, log_evidence=0.0)})
    search.fitted[two.names] = replace(two, log_evidence=200.0)
    monkeypatch.setattr(tried_module.Additions, "gain", lambda self, found: 1e3)
    expand(search, search.fitted[one.names], [])
    guessed = {names: round(guess, 9) for names, guess in search.guessed.items()}
    assert guessed[one.names | {"wave4"}] == guessed[one.names | {"wave4", "wave5"}] == 1000.0
    assert guessed[two.names | {"wave4"}] == 200.0


@pytest.fixture
def two_that_explain_much(tmp_path):
    """By hand: of two effects one explains 800 nats, the other one 400. The search, both, and an unknown function
    beside both, given what it gains and the channel that it is in."""
    bench = sure_of_noise(tmp_path)
    none, first, second = frozenset(), frozenset(("wave2",)), frozenset(("wave3",))
    nats = {none: 0.0, first: 500.0, second: 100.0}
    search = searching(bench, {names: replace(null_of(bench), log_evidence=v) for names, v in nats.items()})
    pair = fitted_from(bench, [WAVES["wave2"](), WAVES["wave3"]()], bench.null.x, np.full(2, 0.8))
    search.fitted[pair.names] = replace(pair, fit=replace(pair.fit, z=np.full(2, 0.8)), log_evidence=900.0)
    shape = shapes_of(bench.fit.stack, bench.fit.white, bench.fit.stack.y)[0]

    def beside(gain, channel):
        of_channel = Seen(replace(shape, channels=(channel,)), np.zeros(len(SIZES)))
        return Beside(search.fitted[pair.names], 900.0 + gain, (of_channel,), ())

    return search, pair.names, beside


def test_an_effect_stands_out_that_explains_fifty_times_what_is_unknown_beside_it(two_that_explain_much):
    """An unknown function beside both gains 7.9, then 10, a law 17."""
    search, both, beside = two_that_explain_much

    def standing_out():
        return [name for name in sorted(both) if search.stands_out(name, both)]

    assert standing_out() == [], "nothing is known of what is unknown beside them"
    for gain, expected in ((7.9, ["wave2", "wave3"]), (10.0, ["wave2"])):
        search.beside[both] = beside(gain, "pull.force")
        assert standing_out() == expected
        more = [name for name in sorted(both) if search.stands_out(name, both | {"wave4"})]
        assert more == expected, "a set that was only guessed is taken for the most of it that was fitted"
    search.fitted[both | {next(iter(LAWS))}] = replace(search.fitted[both], log_evidence=917.0)
    assert standing_out() == []
    assert not search.stands_out("wave4", frozenset(("wave4",))), "what was not fitted explains nothing"


def test_an_effect_stands_for_no_function_in_channels_that_it_leaves_as_they_are(two_that_explain_much):
    search, both, beside = two_that_explain_much
    for channel, stands_out in (("pull.force", False), ("pull.temperature", True)):
        search.beside[both] = beside(50.0, channel)
        assert search.stands_out("wave2", both) is stands_out
    search.fitted[both] = replace(search.fitted[both], log_evidence=100.0 + 40.0)
    assert not search.stands_out("wave2", both), "what explains little may be what such a function leaves"


@pytest.mark.parametrize("behind", (None, 28.0))
def test_what_leads_is_weighed_against_its_twin(tmp_path, behind):
    """Two names for one law: the one that was found first is not sure of itself, nor where the other one was fitted
    before and ended in another valley [nats]."""
    twin = type("Twin", (WAVES["wave2"],), {"name": classmethod(lambda cls: "twin")})
    bench = sure_of_noise(tmp_path, extra=lambda x: 0.25 * np.cos(600 * x))
    signatures = signatures_of(bench, (WAVES["wave2"](), twin()))
    one = fitted_from(bench, (WAVES["wave2"](),), bench.null.x, np.array([0.8]))
    beliefs = beliefs_of({"wave2": WAVES["wave2"], "twin": twin}, signatures.names)
    found, other = {frozenset(): null_of(bench), one.names: one}, frozenset(("twin",))
    if behind is not None:
        found[other] = replace(one, log_evidence=one.log_evidence - behind)
    search = Search(bench, signatures, beliefs, (), found)
    exchange(search, one.names, lambda words: None)
    assert search.log_evidence(other) == pytest.approx(one.log_evidence, abs=1e-3)


def test_a_twin_that_has_a_say_already_is_not_fitted_again(tmp_path):
    twin = type("Twin", (WAVES["wave2"],), {"name": classmethod(lambda cls: "twin")})
    bench = sure_of_noise(tmp_path, extra=lambda x: 0.25 * np.cos(600 * x))
    signatures = signatures_of(bench, (WAVES["wave2"](), twin()))
    one = fitted_from(bench, (WAVES["wave2"](),), bench.null.x, np.array([0.8]))
    other, near = frozenset(("twin",)), replace(one, log_evidence=one.log_evidence - 3.0)
    beliefs = beliefs_of({"wave2": WAVES["wave2"], "twin": twin}, signatures.names)
    search = Search(bench, signatures, beliefs, (), {frozenset(): null_of(bench), one.names: one, other: near})
    exchange(search, one.names, lambda words: None)
    assert search.fitted[other] is near


def test_a_twin_is_one_that_tolerances_make_alike(tmp_path):
    """A law that differs from the one that was found by more than itself, in the direction of a tolerance."""

    class Slanted(WAVES["wave2"]):
        def on_response(self, response, conditions, kind, design):
            slanted = super().on_response(response, conditions, kind, design)
            return {**slanted, "force": slanted["force"] + 300.0 * self.size * conditions["displacement"]}

    bench = sure_of_noise(tmp_path, extra=lambda x: 0.25 * np.cos(600 * x))
    slanted = type("Slanted", (Slanted,), {"name": classmethod(lambda cls: "slanted")})
    signatures = signatures_of(bench, (WAVES["wave2"](), slanted()))
    one = fitted_from(bench, (WAVES["wave2"](),), bench.null.x, np.array([0.8]))
    beliefs = beliefs_of({"wave2": WAVES["wave2"], "slanted": slanted}, signatures.names)
    search = Search(bench, signatures, beliefs, (), {frozenset(): null_of(bench), one.names: one})
    exchange(search, one.names, lambda words: None)
    assert frozenset(("slanted",)) in search.fitted


def test_a_twin_is_found_of_what_a_tolerance_makes_good_but_for_its_curvature(tmp_path):
    """A stiffness, and small waves that move with it: no line between two places of the grid follows them, and with the
    stiffness of the spring free nothing else is left."""

    @dataclass(frozen=True)
    class Stiffer(Bump):
        size: float = parameter(0.0, "N", prior=LogNormal(0.3, 1.0), low=0.0, high=10.0, source="made up")

        def on_response(self, response, conditions, kind, design):
            x = conditions["displacement"]
            waves = (np.cos(300 * k * x - 9 * k * self.size) - np.cos(300 * k * x) for k in (2, 5, 7))
            return {**response, "force": response["force"] + 1e3 * self.size * x + 0.3 * sum(waves)}

    one, twin = (type(name, (Stiffer,), {"name": classmethod(lambda cls, own=name: own)}) for name in ("one", "twin"))
    hidden = one(0.5)
    bench = sure_of_noise(
        tmp_path, extra=lambda x: hidden.on_response({"force": 0.0}, {"displacement": x}, "", None)["force"]
    )
    signatures = signatures_of(bench, (one(), twin()))
    found = fitted_from(bench, (one(),), bench.null.x, np.array([0.5]))
    beliefs = beliefs_of({"one": one, "twin": twin}, signatures.names)
    search = Search(bench, signatures, beliefs, (), {frozenset(): null_of(bench), found.names: found})
    exchange(search, found.names, lambda words: None)
    assert search.log_evidence(frozenset(("twin",))) == pytest.approx(found.log_evidence, abs=1e-3)


class Rippled(SpringModel):
    """Its force has a ripple that moves by 0.4 rad with every percent of stiffness."""

    def respond(self, design, kind, conditions):
        x, more = conditions["displacement"], design.stiffness / 1e3 - 1
        return {"force": design.stiffness * x + 2.0 * np.cos(600 * x - 40 * more)}


@dataclass(frozen=True)
class Stiffness(DesignEffect):
    """k = k_drawn (1 + more)"""

    title = "stiffness"
    looks_like = "another force"
    designs = (Spring,)
    base_rate = RATE
    more: float = parameter(0.0, "1", prior=Normal(0.02), low=-0.5, high=0.5, source="made up")

    def on_design(self, design):
        return replace(design, stiffness=design.stiffness * (1 + self.more))


def test_an_effect_takes_the_place_of_the_pull_of_a_tolerance_that_no_straight_line_follows(tmp_path):
    """A spring 5 % too soft, drawn to 1 %: from where the tolerance ended the grid of the effect sees other ripples."""
    drawn = sure_of_noise(tmp_path, extra=lambda x: 2.0 * np.cos(600 * x + 2.0), stiffness=950.0)
    model = Model(Rippled(), Spring(1000.0))
    problem = replace(drawn.fit, predictor=replace(drawn.fit.predictor, model=model))
    null = fitted(problem, (), np.array([-5.0, 0.0]), np.zeros(0))
    assert null.x[0] == pytest.approx(-5.0, abs=0.2)
    bench = replace(drawn, model=model, fit=problem, null=null)
    signatures, only = signatures_of(bench, (Stiffness(),)), frozenset(("stiffness",))
    beliefs = beliefs_of({"stiffness": Stiffness}, signatures.names)
    search = Search(bench, signatures, beliefs, (), {frozenset(): null_of(bench)})
    exchange(search, frozenset(), lambda words: None)
    (found,) = search.fitted[only].effects
    assert -0.05 < found.more < -0.035, "the tolerance keeps a part"
    assert search.log_evidence(only) > null.log_evidence + 8.0


@pytest.mark.parametrize("wrong_by, is_fitted", ((0.0, True), (0.3, False)))
def test_what_leads_is_weighed_against_two_that_do_together_what_two_of_its_effects_do(tmp_path, wrong_by, is_fitted):
    """Two waves, and two effects that are their sum and their difference: neither wave takes the place of one of these.
    Where another wave is hidden as well, that only the sum has, the two waves promise too little."""

    def mixed(name, sign):
        def on_response(self, response, conditions, kind, design):
            x = conditions["displacement"]
            waves = np.cos(600 * x) + sign * np.cos(900 * x) + wrong_by * np.cos(1500 * x)
            return {**response, "force": response["force"] + self.size * waves}

        return type(name, (Bump,), {"name": classmethod(lambda cls: name), "on_response": on_response})

    library = {"sum": mixed("sum", 1), "difference": mixed("difference", -1)}
    library |= {name: WAVES[name] for name in ("wave2", "wave3")}
    hidden = [library["sum"](0.5), library["difference"](0.2)]

    def extra(x):
        found = (e.on_response({"force": 0.0}, {"displacement": x}, "", None)["force"] for e in hidden)
        return sum(found)

    bench = sure_of_noise(tmp_path, extra=extra)
    signatures = signatures_of(bench, tuple(effect() for effect in library.values()))
    effects = [library[name]() for name in ("difference", "sum")]
    one = fitted_from(bench, effects, bench.null.x, np.array([0.2, 0.5]))
    beliefs = beliefs_of(library, signatures.names)
    search = Search(bench, signatures, beliefs, (), {frozenset(): null_of(bench), one.names: one})
    others = frozenset(("wave2", "wave3"))
    exchange(search, one.names, lambda words: None)
    assert others not in search.fitted
    exchange_two(search, one.names, lambda words: None)
    assert (others in search.fitted) is is_fitted
    if is_fitted:
        assert search.log_evidence(others) == pytest.approx(one.log_evidence, abs=1.0)


def test_a_part_of_what_leads_of_which_the_model_has_no_answer_promises_nothing(tmp_path, monkeypatch):
    bench = sure_of_noise(tmp_path, extra=lambda x: 0.25 * np.cos(600 * x))
    one = fitted_from(bench, (WAVES["wave2"](),), bench.null.x, np.array([0.8]))
    search = searching(bench, {frozenset(): null_of(bench), one.names: one})

    def none(*of):
        raise WorkbenchError("no steady state")

    monkeypatch.setattr(neighbours_module, "held_at", none)
    exchange_two(search, one.names, lambda words: None)
    assert set(search.fitted) == {frozenset(), one.names}


def test_what_an_exact_model_gives_is_believed_of_sets_that_are_alike(tmp_path):
    """Alike in what moves the device: wave 4, 5 and 6 are of the instruments."""
    bench = sure_of_noise(tmp_path)
    none, pair = frozenset(), frozenset(("wave2", "wave3", "wave6"))
    search = searching(bench, {none: null_of(bench)})
    search.of_expansion = frozenset(("wave2", "wave3"))
    search.exact[pair] = 50.0
    assert search.exactness(frozenset(("wave2", "wave4"))) == 50.0 and search.exactness(pair) == 0.0
    assert search.exactness(frozenset(("wave5",))) == 0.0 and search.exactness(none) == 0.0
    assert search.exactness(frozenset(("wave6",))) == 0.0, "the same instrument beside an unmoved device"
    search.exact[frozenset(("wave6",))] = 4.0
    assert search.exactness(frozenset(("wave5",))) == 4.0, "as far from where the null is exact"
    assert search.exactness(frozenset(("wave2",))) == 50.0 and search.exactness(none) == 0.0


def test_what_an_exact_model_gave_is_added_to_a_guess_once(tmp_path):
    """Beside a fit that an exact model made better by fifty nats two waves together are believed to be as good as
    beside the same fit before; what was guessed beside it meanwhile is forgotten."""
    bench = sure_of_noise(tmp_path, extra=lambda x: 0.25 * np.cos(600 * x) + 0.1 * np.cos(900 * x))
    wave = fitted_from(bench, (WAVES["wave2"](),), bench.null.x, np.array([0.8]))
    one, both = wave.names, wave.names | {"wave3"}
    search = searching(bench, {frozenset(): null_of(bench), one: wave})
    search.of_expansion = one
    expand(search, wave, [])
    before = search.believed(both)
    search.fitted[one] = replace(wave, log_evidence=wave.log_evidence + 50.0)
    search.exact[one] = 50.0
    search.guessed[both] += 20.0
    expand(search, search.fitted[one], [])
    assert search.believed(both) == pytest.approx(before + 50.0)
    assert search.by_expansion(one) == pytest.approx(wave.log_evidence)


def test_what_leads_is_made_exact_however_many_are(tmp_path, monkeypatch):
    bench = expanded(sure_of_noise(tmp_path, extra=lambda x: 0.25 * np.cos(600 * x)))
    wave = fitted_from(bench, (WAVES["wave2"](),), bench.null.x, np.array([0.8]))
    search = searching(bench, {frozenset(): null_of(bench), wave.names: wave})
    monkeypatch.setattr(search_module, "EXACT", 0)
    search_module._exactly(search, lambda words: None)
    assert wave.names in search.exact


def test_an_expansion_is_concerned_with_what_moves_the_device(bench):
    signatures = signatures_of(bench, [cls() for cls in LIBRARY.values()])
    search = Search(bench, signatures, beliefs_of(LIBRARY, signatures.names), (), {frozenset(): null_of(bench)})
    assert search.of_expansion == {"soft_spring"} < set(signatures.found)


@pytest.mark.parametrize("exactness", [40.0, -40.0])
def test_an_unknown_function_makes_good_what_an_expansion_lacks(bench, exactness):
    search = searching(bench, {frozenset(): null_of(bench)})
    search.of_expansion = one = frozenset(("wave2",))
    search.exact[one | {"wave5"}] = exactness
    shapes = shapes_of(bench.fit.stack, bench.fit.white, bench.fit.predictor.predict(bench.null.x))
    search.beside[one] = found = beside_unknown(search.fitted[frozenset()], shapes)
    assert search.log_evidence_beside(one) == found.log_evidence + min(exactness, 0.0)


def test_a_set_beside_an_unknown_function_is_weighed_anew_where_its_fit_changed(tmp_path):
    bench = expanded(sure_of_noise(tmp_path, extra=lambda x: 0.4 * np.cos(600 * x) + 0.2 * np.sin(900 * x)))
    wave = frozenset(("wave2",))
    promise = Promise(0.0, "wave2", wave, (WAVES["wave2"](),), bench.null.x, np.ones(1), 0.0)
    search = searching(bench, {frozenset(): null_of(bench)})
    search.shapes = shapes_of(bench.fit.stack, bench.fit.white, bench.fit.predictor.predict(bench.null.x))
    fit_set(search, promise)
    weigh(search, wave)
    first, best = search.beside[wave], search.best_beside
    weigh(search, wave)
    assert search.beside[wave] is first
    assert best == first.log_evidence + search.beliefs.log_prior(wave) + search.beliefs.log_unknown
    search_module._exactly(search, lambda words: None)
    assert wave in search.exact and search.beside[wave] is not first
    fit_set(search, replace(promise, forms=1e3))
    assert not search.beside


def expanded(bench):
    """The bench with a model that answers by an expansion, which is exact where it is used."""
    model = replace(bench.model, base=Expansion())
    return replace(bench, model=model)


@pytest.mark.parametrize("model", (expanded, lambda bench: bench), ids=("expansion", "as it is"))
def test_a_long_search_ends_where_an_unknown_function_is_far_better(tmp_path, monkeypatch, model):
    """A wave that none of the others can imitate, the first of which promises much, the others a little."""
    bench = model(sure_of_noise(tmp_path, extra=lambda x: 2.0 * np.sin(900 * x)))
    search = searching(bench, {frozenset(): null_of(bench)})
    search.shapes = shapes_of(bench.fit.stack, bench.fit.white, bench.fit.predictor.predict(bench.null.x))
    monkeypatch.setattr(search_module, "PATIENCE", 2)
    little = search.log_posterior(frozenset()) + 5.0
    heap = [
        Promise(-order, f"wave{k}", frozenset((f"wave{k}",)), (WAVES[f"wave{k}"](),), bench.null.x, np.zeros(1), 0.0)
        for k, order in ((2, 9e3), *((k, little) for k in (3, 4, 5, 6)))
    ]
    search.guessed = {promise.every: -promise.order for promise in heap}
    search_module._best_first(search, heap, lambda words: None)
    assert search.is_beaten and search.best_beside > search.log_posterior(search.ranked[0]) + 10
    assert len(search.fitted) == search_module.LEAST_FITS + 1 and heap, "nothing and the first three"


@pytest.mark.parametrize("wave, are_fitted", [(900, False), (600, True)])
def test_neighbours_of_what_an_unknown_function_beats_by_far_are_not_fitted(tmp_path, monkeypatch, wave, are_fitted):
    """A wave that the one which leads cannot imitate, and one that it is."""
    bench = sure_of_noise(tmp_path, extra=lambda x: 2.0 * np.cos(wave * x + (wave == 900)))
    leader = fitted_from(bench, (WAVES["wave2"](),), bench.null.x, np.ones(1))
    search = searching(bench, {frozenset(): null_of(bench), leader.names: leader})
    search.shapes = shapes_of(bench.fit.stack, bench.fit.white, bench.fit.predictor.predict(bench.null.x))
    asked = []
    monkeypatch.setattr(search_module, "less_one", lambda *of: asked.append("less one"))
    monkeypatch.setattr(search_module, "exchange", lambda *of: asked.append("exchange"))
    first = search.ranked[0]
    search_module._effects_alone(search, [], set(), lambda words: None)
    assert first in search.beside and bool(asked) is are_fitted


@pytest.mark.parametrize(("patience", "is_weighed"), [(3, True), (4, True), (5, False)])
def test_fits_made_elsewhere_count_until_an_unknown_function_is_weighed(tmp_path, monkeypatch, patience, is_weighed):
    """Four fits, the last of them beyond three; what is promised is not worth a fifth."""
    bench = expanded(sure_of_noise(tmp_path, extra=lambda x: 2.0 * np.sin(900 * x)))
    four = [frozenset(), *(frozenset((f"wave{k}",)) for k in (3, 4, 5))]
    search = searching(bench, dict.fromkeys(four, null_of(bench)))
    search.shapes = shapes_of(bench.fit.stack, bench.fit.white, bench.fit.predictor.predict(bench.null.x))
    monkeypatch.setattr(search_module, "PATIENCE", patience)
    every = frozenset(("wave2",))
    promise = Promise(9e9, "wave2", every, (WAVES["wave2"](),), bench.null.x, np.zeros(1), 0.0)
    search.guessed[every] = -9e9
    search_module._best_first(search, [promise], lambda words: None)
    assert len(search.fitted) == 4 and bool(search.beside) is is_weighed


@pytest.mark.parametrize(
    ("ahead", "behind", "is_fitted"), [(5.0, 15.0, False), (12.0, 30.0, True), (12.0, 90.0, False), (30.0, 90.0, True)]
)
def test_what_promises_a_good_part_of_what_an_unknown_function_explains_is_fitted(tmp_path, ahead, behind, is_fitted):
    """Of three effects the first two leave more than an unknown function does; the third promises what they lack."""
    bench = sure_of_noise(tmp_path)
    others = {frozenset((f"wave{k}",)): null_of(bench) for k in (3, 4, 5)}
    search = searching(bench, {frozenset(): null_of(bench), **others})
    leading = search.log_posterior(search.ranked[0])
    above = leading + behind - search.beliefs.log_prior(frozenset()) - search.beliefs.log_unknown
    search.beside[frozenset()] = Beside(null_of(bench), above, (), ())
    every, order = frozenset(("wave2",)), leading + ahead
    promise = Promise(-order, "wave2", every, (WAVES["wave2"](),), bench.null.x, np.zeros(1), 0.0)
    search.guessed[every] = order - search.beliefs.log_prior(every)
    search_module._best_first(search, [promise], lambda words: None)
    assert search.is_beaten and (every in search.fitted) is is_fitted


def test_nothing_ends_a_search_that_finds_what_is_there(tmp_path, monkeypatch):
    monkeypatch.setattr(search_module, "PATIENCE", 1)
    hidden = lambda x: sum(0.25 * np.cos(300 * k * x) for k in (2, 5, 7))  # noqa: E731
    search = searched(expanded(sure_of_noise(tmp_path, extra=hidden)), WAVES)
    assert search.ranked[0] == {"wave2", "wave5", "wave7"} and not search.is_beaten


@pytest.mark.parametrize(
    ("ahead", "beside_what", "is_beaten", "is_over"),
    [(9, "wave2", False, False), (90, "wave2", True, False), (110, "wave2", True, True), (90, "", True, True)],
)
def test_a_search_goes_on_where_the_next_effect_may_be_worth_more_than_an_unknown_function(
    tmp_path, ahead, beside_what, is_beaten, is_over
):
    """The last effect gained 100 nats."""
    bench = sure_of_noise(tmp_path)
    leader, nothing = frozenset(("wave2",)), frozenset()
    search = searching(bench, {nothing: null_of(bench), leader: null_of(bench)})
    search.forms[leader] = 100.0 - search.beliefs.log_prior(leader)
    kept = leader if beside_what else nothing
    height = search.log_posterior(leader) + ahead - search.beliefs.log_unknown
    evidence = height - search.forms.get(kept, 0.0) - search.beliefs.log_prior(kept)
    search.beside[kept] = Beside(null_of(bench), evidence, (), ())
    assert search.last_gain == pytest.approx(100.0)
    assert (search.is_beaten, search.is_over) == (is_beaten, is_over)


def test_a_search_that_ended_goes_on_where_the_exact_model_is_not_beaten(tmp_path, monkeypatch):
    bench = sure_of_noise(tmp_path)
    search = searching(bench, {frozenset(): null_of(bench)})
    done = []
    monkeypatch.setattr(Search, "best_beside", property(lambda self: np.inf if len(done) == 1 else -np.inf))

    def treated(search, heap, settled, progress):
        done.append("effects")
        settled.add(search.ranked[0])

    monkeypatch.setattr(search_module, "_effects_alone", treated)
    monkeypatch.setattr(search_module, "_exactly", lambda *asked: done.append("exact"))
    heap = []
    expand(search, search.fitted[frozenset()], heap)
    search_module._until_exact(search, heap, lambda words: None)
    assert done == ["effects", "exact", "effects", "exact"]


def test_what_an_exact_model_brings_to_the_lead_in_the_end_is_weighed_beside_an_unknown_function(tmp_path, monkeypatch):
    """What led by an expansion falls behind; what leads now was no leader when unknown functions were weighed."""
    bench = expanded(sure_of_noise(tmp_path, extra=lambda x: 0.4 * np.cos(600 * x) + 2.0 * np.sin(900 * x)))
    exactly = []

    def fallen(search, progress):
        """An exact model gives all but one wave nothing but a loss."""
        exactly.append(search.ranked[0])
        for names in search.fitted.keys() - {frozenset(("wave2",))}:
            search.fitted[names] = replace(search.fitted[names], log_evidence=-1e6)

    monkeypatch.setattr(search_module, "_until_exact", lambda *asked: None)
    monkeypatch.setattr(search_module, "weigh_unknown", lambda *asked: None)
    monkeypatch.setattr(search_module, "_exactly", fallen)
    search = searched(bench, WAVES)
    assert search.ranked[0] == {"wave2"} and len(exactly) == 3, "of what is promised, of it, and of its parts"
    assert search.is_beaten, "by an unknown function beside it"


def test_neighbours_of_a_set_that_leads_by_an_exact_model_only_are_looked_at(tmp_path, monkeypatch):
    bench = sure_of_noise(tmp_path)
    first, then = frozenset(), frozenset(("wave2",))
    search = searching(bench, {first: null_of(bench), then: replace(null_of(bench), log_evidence=-1e3)})
    led = []

    def treated(search, heap, settled, progress):
        led.append(search.ranked[0])
        settled.add(search.ranked[0])

    def exactly(search, progress):
        search.fitted[then] = replace(null_of(bench), log_evidence=1e3)

    monkeypatch.setattr(search_module, "_effects_alone", treated)
    monkeypatch.setattr(search_module, "_exactly", exactly)
    heap = []
    expand(search, search.fitted[frozenset()], heap)
    search_module._until_exact(search, heap, lambda words: None)
    assert led == [first, then]


@pytest.mark.parametrize(
    ("gain", "behind", "is_seen", "is_next"),
    [(-9, 8.5, True, True), (9, 8.5, True, True), (-8, 20, True, False), (4, 5, True, False)]
    + [(0, 5, True, False), (0, 5, False, True), (0, 9, False, False)],
)
def test_what_an_exact_model_might_bring_to_the_lead_is_made_exact_next(tmp_path, gain, behind, is_seen, is_next):
    """What is behind by less than an exact model moved what is most like it, or may move an effect that is in no exact
    fit."""
    bench = sure_of_noise(tmp_path, extra=lambda x: 0.25 * np.cos(600 * x))
    first, other = fitted_from(bench, (WAVES["wave2"](),), bench.null.x, np.array([0.8])), frozenset(("wave3",))
    second = replace(first, log_evidence=first.log_evidence - behind - gain)
    search = searching(bench, {frozenset(): null_of(bench), first.names: first, other: second})
    search.of_expansion = first.names | {"wave3", "wave4"}
    assert search_module._next_exact(search) == (first.names if behind + gain > 0 else other)
    exact = [frozenset(), first.names] + [frozenset(("wave3", "wave4"))] * is_seen
    search.exact = dict.fromkeys(exact, float(gain))
    assert search_module._next_exact(search) == (other if is_next else None)
    search.of_expansion = frozenset()
    assert search_module._next_exact(search) is None, "both leave the field as it is: an exact one gives them the same"


@pytest.mark.parametrize(("gains", "is_next"), [((0.0, 8.0), True), ((0.0, 4.0), False), ((6.0, 8.0), True)])
def test_a_set_is_made_exact_where_it_might_gain_as_much_as_another_with_one_of_its_effects(tmp_path, gains, is_next):
    """wave3 stands with wave4 in what gained little, alone in what gained more; it is five nats behind."""
    bench = sure_of_noise(tmp_path, extra=lambda x: 0.25 * np.cos(600 * x))
    first, mine = fitted_from(bench, (WAVES["wave2"](),), bench.null.x, np.array([0.8])), frozenset(("wave3", "wave4"))
    second = replace(first, log_evidence=first.log_evidence - 5 - gains[0] + np.log(1 / RATE - 1))  # of one effect more
    search = searching(bench, {frozenset(): null_of(bench), first.names: first, mine: second})
    search.of_expansion = first.names | {"wave3", "wave4", "wave5"}
    search.exact = {frozenset(): 0.0, first.names: 0.0}
    search.exact |= {mine | {"wave5"}: gains[0], frozenset(("wave3", "wave5", "wave6")): gains[1]}
    assert search_module._next_exact(search) == (mine if is_next else None)


@pytest.mark.parametrize("moved", [frozenset(("wave2",)), frozenset()])
@pytest.mark.parametrize(("behind", "is_next"), [(12.0, True), (120.0, False)])
def test_what_leads_without_one_of_its_effects_is_made_exact_though_its_field_is_the_same(
    tmp_path, behind, is_next, moved
):
    """The leader gained fifty nats by an exact model; what is left out may have made good what the expansion lacks, of
    tolerances where no effect moves the device: the gain of a current was named with 98 % that was worth 87."""
    bench = sure_of_noise(tmp_path, extra=lambda x: 0.25 * np.cos(600 * x))
    part = fitted_from(bench, (WAVES["wave2"](),), bench.null.x, np.array([0.8]))
    whole = replace(part, log_evidence=part.log_evidence + 50 + behind)
    search = searching(bench, {frozenset(): null_of(bench), part.names: part, part.names | {"wave3"}: whole})
    search.of_expansion = moved
    search.exact[part.names | {"wave3"}] = 50.0
    assert search_module._next_exact(search) == (part.names if is_next else None)


@pytest.mark.parametrize(("behind", "reaches"), [(10.0, True), (14.0, False)])
def test_a_promise_is_worth_what_an_exact_model_would_give_it(tmp_path, behind, reaches):
    """The leader gained ten nats by an exact model, which a set with the same effect and one more gains as well."""
    bench = sure_of_noise(tmp_path, extra=lambda x: 0.25 * np.cos(600 * x))
    first, more = fitted_from(bench, (WAVES["wave2"](),), bench.null.x, np.array([0.8])), frozenset(("wave2", "wave3"))
    search = searching(bench, {frozenset(): null_of(bench), first.names: first})
    search.of_expansion = frozenset(("wave2",))
    search.guessed = {more: first.log_evidence - behind + np.log(1 / RATE - 1)}  # of one effect more
    promise = Promise(np.inf, "wave2 with wave3", more, (), bench.null.x, np.zeros(1), 0.0)
    assert not search_module._reaches(search, [promise]), "nothing is exact yet"
    search.exact[first.names] = 10.0
    assert search_module._reaches(search, [promise]) == reaches


def test_what_was_only_guessed_does_not_lead(tmp_path):
    """Whatever an exact model that became known last would give it: an eccentric machine was said to have three effects
    more that nobody had fitted."""
    bench = sure_of_noise(tmp_path, extra=lambda x: 0.25 * np.cos(600 * x))
    first, more = fitted_from(bench, (WAVES["wave2"](),), bench.null.x, np.array([0.8])), frozenset(("wave2", "wave3"))
    search = searching(bench, {frozenset(): null_of(bench), first.names: first})
    search.of_expansion = frozenset(("wave2",))
    search.guessed = {more: first.log_evidence + 40.0}
    search.exact[first.names] = 10.0
    assert search.posterior.of("wave3") == pytest.approx(0.5, abs=0.02)


def test_probabilities_of_a_search_add_up_to_one(bench):
    found = searched(bench, LIBRARY).posterior
    assert sum(found.alone.values()) + sum(found.beside.values()) == pytest.approx(1.0)
    assert found.nothing + found.none_of_these <= 1.0


def test_a_fit_begins_nearer_to_the_null_where_the_promise_has_no_answer(tmp_path):
    """As where a supply is too weak for the promised size: from half of it the fit arrives at the true 0.25."""

    class Weak(WAVES["wave2"]):
        def on_response(self, response, conditions, kind, design):
            if self.size > 0.35:
                raise WorkbenchError("no steady state")
            return super().on_response(response, conditions, kind, design)

    bench = sure_of_noise(tmp_path, extra=lambda x: 0.25 * np.cos(600 * x))
    search = searching(bench, {frozenset(): null_of(bench)})
    whole = fitted_from(bench, (WAVES["wave2"](),), bench.null.x, np.array([0.8]))
    z = np.array([1.5 * whole.fit.z[0] + 0.3])
    assert Weak().at(z).size > 0.35 > Weak().at(z / 2).size
    name = frozenset((Weak.name(),))
    promise = Promise(0.0, Weak.name(), name, (Weak(),), bench.null.x, z, 0.0)
    assert fit_set(search, promise)
    assert search.fitted[name].fit.z == pytest.approx(whole.fit.z, abs=1e-3)


def test_a_fit_that_has_no_answer_is_left_out_and_said(bench):
    class Stuck(Bump):
        def on_response(self, response, conditions, kind, design):
            if self.size not in {Stuck().at(z).size for z in grid(1)[0]} | {0.0}:
                raise WorkbenchError("no steady state")
            return super().on_response(response, conditions, kind, design)

    search = searched(bench, LIBRARY | {"stuck": Stuck})
    assert search.failed["stuck"] == "no steady state" and frozenset(("stuck",)) not in search.fitted
    assert frozenset(("stuck",)) not in search.posterior.alone


def test_the_residual_that_is_explained_is_carried_back_to_the_drawing(bench):
    """Linear in its nuisances, the residual at zero of them is what the drawing itself leaves."""
    assert np.allclose(at_zero(null_of(bench)), bench.fit.residual(np.zeros(2)), atol=1e-6)
    assert seen(
        shapes_of(bench.fit.stack, bench.fit.white, bench.fit.predictor.predict(bench.null.x)),
        bench.null.jacobian,
        at_zero(null_of(bench)),
    )
