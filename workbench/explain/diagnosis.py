"""Which effect is missing? Conventions are settled first; then effects, alone and together, and unknown functions are
weighed by one likelihood; simulated campaigns of the same bench say from which probability on a name is printed."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from time import perf_counter

import numpy as np
from scipy.special import stdtr

from effects.base import Effect
from effects.parameter import Parameter, parameters_of
from workbench.believed import LIKELY, TAILS
from workbench.compare.views import channel_fit, channel_views, describe
from workbench.data.checks import checks_of
from workbench.data.table import Campaign
from workbench.explain.calibrate import Simulator, detection_limits, plainly_nothing, thresholds_of
from workbench.explain.contradictions import contradiction, exceeded
from workbench.explain.conventions import diagnosis_of as of_conventions
from workbench.explain.conventions import settle
from workbench.explain.explore import Posterior, beside_the_unknown
from workbench.explain.hypotheses import Hypothesis, density_of, estimates, null_of
from workbench.explain.misread import misread
from workbench.explain.recommend import next_measurements
from workbench.explain.sealed import opened, refutations, refuted, with_sealed
from workbench.explain.search import searched
from workbench.explain.tried import Search
from workbench.explain.verdict import NOTHING_MISSING, Thresholds, Verdict, verdict
from workbench.findings import ChannelFit, Diagnosis, Estimate, Ranked, SizePosterior
from workbench.likelihood.bench import Bench, bench_of
from workbench.likelihood.prediction import predicted
from workbench.likelihood.signatures import nearest
from workbench.likelihood.unknown_laws import LAWS
from workbench.models.model import Model

SEED = 20261
LISTED = 12  # explanations that are printed with their probability
ON_BOUND = 1e-6  # of the range of a parameter, within which it ends on its bound
AS_BELIEVED = 0.75  # of what was believed of a parameter before, from which in its 90 % interval nothing was learned

Progress = Callable[[str], None]


def diagnose(
    model: Model,
    campaign: Campaign,
    library: Mapping[str, type[Effect]],
    seed: int = SEED,
    progress: Progress = lambda words: None,
) -> Diagnosis:
    """The diagnosis of a campaign.

    library: effects by name, see ``effects.library``;  seed: of the simulated campaigns
    Raises:
        WorkbenchError: the campaign cannot be used, see ``likelihood.bench``.
    """
    start = perf_counter()
    conventions = settle(model, campaign, progress)
    if not conventions.are_right:
        return of_conventions(conventions, model, seed, perf_counter() - start)
    progress("fitting tolerances and calibrations")
    search = searched(bench_of(model, campaign, library, progress=progress), library, progress)
    if (beside := misread(search, library, progress)) is not None:
        return of_conventions(beside, model, seed, perf_counter() - start)
    progress("simulating campaigns of this bench")
    simulator = Simulator(search.bench, search.signatures, search.beliefs, search.shapes, np.random.default_rng(seed))
    thresholds, power = thresholds_of(simulator)
    progress("what to measure next")
    found = diagnosis_of(search, simulator, thresholds, power)
    return replace(found, seed=seed, wall_s=perf_counter() - start)


def diagnosis_of(
    search: Search, simulator: Simulator, thresholds: Thresholds, power: Mapping[float, float]
) -> Diagnosis:
    """The diagnosis of a search. power: size of an unknown discrepancy -> share noticed"""
    bench, judged = search.bench, _judged(search, simulator, thresholds)
    best = leading(search, judged.said)
    sealed = opened(bench, best)
    worse = refuted(search, judged.said, best, sealed)
    if worse:
        judged = _taken_back(search, simulator, thresholds, judged.said, worse)
        best = leading(search, judged.said, judged.struck)
    p, shown = judged.p, judged.shown
    said = with_sealed(judged.said, opened(bench, best) if worse else sealed)
    ranked = ranking(search, shown)
    return Diagnosis(
        campaign=bench.campaign.id,
        model=bench.model.base.name,
        effects=bench.model.names,
        verdict=said.kind,
        names=said.names,
        probability=said.probability,
        ranking=ranked,
        p_nothing_missing=p.nothing,
        p_none_of_these=shown.none_of_these,
        p_something_remains=p.remains,
        p_sets=leading_sets(shown),
        alternatives=said.alternatives,
        sure=thresholds.sure,
        abstention_power=power,
        detection_limits=detection_limits(simulator, thresholds),
        next_measurements=next_measurements(search, p),
        residual_signature=residual_signature(search),
        sealed=sealed,
        before=_failing_fit(bench, null_of(bench)),
        after=_failing_fit(bench, best),
        posteriors=_posteriors(search, said),
        complaints=bench.complaints,
        checks=checks_of(bench.campaign) + bench.model.base.doubts(bench.model.design),
        not_tried=_not_tried(search.failed),
        contradictions=_contradictions(search, ranked, said.names) + refutations(search, worse),
        provenance=dict(bench.campaign.file_hashes),
    )


@dataclass(frozen=True)
class _Judged:
    """struck: effects that are not to be believed;  p: probabilities without them;  shown: the same beside something
    unknown, where that is likely"""

    struck: frozenset[str]
    p: Posterior
    shown: Posterior
    said: Verdict


def _judged(
    search: Search, simulator: Simulator, thresholds: Thresholds, struck: frozenset[str] = frozenset()
) -> _Judged:
    p = search.posterior_without(struck)
    shown = beside_the_unknown(p, search.beliefs, search.stands_out) if p.remains >= LIKELY else p
    return _Judged(struck, p, shown, verdict(shown, thresholds, plainly_nothing(simulator, p, search.bench.residual)))


def _taken_back(
    search: Search, simulator: Simulator, thresholds: Thresholds, said: Verdict, worse: Collection[str]
) -> _Judged:
    """Without the effects that sealed rows refute, and what may stand for them. No name is chosen by rows that test:
    where others would be said than before, none is."""
    struck = frozenset(name for first in worse for name in said.groups[first])
    again = _judged(search, simulator, thresholds, struck)
    if again.said.all_names <= said.all_names:
        return again
    return _judged(search, simulator, replace(thresholds, sure=np.inf), struck)


def _contradictions(search: Search, ranked: Sequence[Ranked], names: Collection[str]) -> tuple[str, ...]:
    named = {row.name: row.parameters for row in ranked if row.name in names}
    classes = {name: type(search.signatures.found[name][0].effect) for name in named}
    found = (contradiction(classes[name], sizes, search.bench.campaign.tolerances) for name, sizes in named.items())
    return tuple(filter(None, found)) + exceeded(_best_known(search))


def _best_known(search: Search) -> Hypothesis:
    """The most probable fit without an unknown law, which could stand for a wrong constant of the device."""
    return search.fitted[next(names for names in search.ranked if LAWS.keys().isdisjoint(names))]


def leading(search: Search, said: Verdict, struck: frozenset[str] = frozenset()) -> Hypothesis:
    """The fit that the verdict speaks of: of its names and of the first of every group of them, alone where that was
    fitted, else in the most probable set that holds them; where none does the most probable one.

    struck: effects that are not to be believed
    """
    if said.kind == NOTHING_MISSING:
        return search.fitted[frozenset()]
    stated = frozenset(said.groups)
    if stated and stated in search.fitted:
        return search.fitted[stated]
    ranked = [names for names in search.ranked if not names & struck]
    return search.fitted[next((names for names in ranked if names >= stated), ranked[0])]


def leading_sets(p: Posterior) -> dict[str, float]:
    """The most probable explanations in words, with their probabilities."""
    named = {" + ".join(sorted(names)) or "nothing": share for names, share in p.alone.items()}
    more = {" + ".join([*sorted(names), "something unknown"]): share for names, share in p.beside.items()}
    every = sorted({**named, **more}.items(), key=lambda item: -item[1])
    return {words: share for words, share in every[:LISTED] if share > 1e-4}


def _not_tried(failed: Mapping[str, str]) -> tuple[str, ...]:
    """One sentence for each reason why effects were not tried."""
    reasons: dict[str, list[str]] = {}
    for name, why in failed.items():
        reasons.setdefault(why, []).append(name)
    return tuple(f"not tried: {', '.join(names)}; {why}" for why, names in reasons.items())


def ranking(search: Search, p: Posterior) -> tuple[Ranked, ...]:
    """Every effect that was tried, most probable first."""
    null = search.fitted[frozenset()]
    before = _errors(null)
    gains = _gains(search)
    names = sorted(search.signatures.effects, key=lambda n: (-p.of(n), -gains[n], n))
    return tuple(_ranked(search, name, p.of(name), gains[name], before) for name in names)


def _gains(search: Search) -> dict[str, float]:
    """ln p that the best fit with each effect gains over nothing; without any, what the effect alone promised."""
    evidences, null = search.evidences, search.log_evidence(frozenset())
    fits = {name: [evidences[names] for names in search.fitted if name in names] for name in search.signatures.effects}
    alone = {name: evidences.get(frozenset((name,)), -np.inf) for name in fits}
    return {name: max(found, default=alone[name]) - null for name, found in fits.items()}


def _ranked(search: Search, name: str, probability: float, gain: float, before: tuple[float, float | None]) -> Ranked:
    known = search.signatures.found[name][0].effect
    best = next((names for names in search.ranked if name in names), None)
    if best is None:
        nothing = Ranked(name, known.title, probability, gain, {}, before[0], before[0], before[1], before[1])
        return replace(nothing, shown_by=known.remedy)
    hypothesis = search.fitted[best]
    after = _errors(hypothesis)
    (effect,) = (one for one in hypothesis.effects if one.name() == name)
    sizes = estimates(hypothesis, search.weights(name))[name]
    said = on_bounds(effect), as_believed(effect, sizes), known.remedy
    return Ranked(name, known.title, probability, gain, sizes, before[0], after[0], before[1], after[1], *said)


def _errors(hypothesis: Hypothesis) -> tuple[float, float | None]:
    """chi2/n of the fitted rows, and of conditions left out region by region."""
    left_out = predicted(hypothesis.problem, hypothesis.fit)
    return float(np.mean(hypothesis.fit.residual**2)), left_out.chi2_per_n if left_out.blocks else None


def on_bounds(effect: Effect) -> tuple[str, ...]:
    """Parameters of an effect that stand on a bound of what is possible, other than that of doing nothing."""
    found = []
    for name, p in parameters_of(effect).items():
        value, reach = getattr(effect, name), ON_BOUND * (p.high - p.low)
        if min(abs(value - p.low), abs(value - p.high)) <= reach and abs(value - p.null) > reach:
            found.append(name)
    return tuple(found)


def as_believed(effect: Effect, sizes: Mapping[str, Estimate]) -> tuple[str, ...]:
    """Parameters of an effect of which the readings tell next to nothing. sizes: the estimate of each"""
    return tuple(name for name, p in parameters_of(effect).items() if _believed(p, sizes[name]) >= AS_BELIEVED)


def _believed(parameter: Parameter, estimate: Estimate) -> float:
    """How probable it was before that a parameter lies in its 90 % interval."""
    low = estimate.low90 if estimate.low90 > parameter.low else -np.inf  # what lies beyond a bound is believed at it
    high = estimate.high90 if estimate.high90 < parameter.high else np.inf
    ends = [end if np.isinf(end) else parameter.prior.standard(end) for end in (low, high)]
    return float(np.diff(stdtr(TAILS, ends))[0])


def residual_signature(search: Search) -> dict[str, object]:
    """Where the largest part of the residual sits and what it looks like; nearest known signatures with their
    cosine."""
    bench, law = search.bench, search.unknown_in_words
    words = {"law": law} if law else {}
    return {**describe(bench, search.unknown), **words, "nearest": nearest(bench, search.signatures)}


def _failing_fit(bench: Bench, hypothesis: Hypothesis) -> ChannelFit:
    """The channel that fails most without effects, with a hypothesis."""
    squares = [np.mean(bench.null.residual[c.rows] ** 2 - 1) * c.size for c in bench.fit.stack.channels]
    views = channel_views(bench, hypothesis.fit.x, hypothesis.effects)
    return channel_fit(views[int(np.argmax(squares))])


def _posteriors(search: Search, said: Verdict) -> tuple[SizePosterior, ...]:
    singles = [search.fitted.get(frozenset((name,))) for name in said.names]
    return tuple(density_of(h) for h in singles if h is not None and len(h.fit.z) == 1)
