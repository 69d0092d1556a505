"""What a search found, as the plain values of ``workbench.findings``."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np

from effects.base import Effect
from effects.parameter import parameters_of
from workbench.compare.views import channel_fit, channel_views, describe
from workbench.errors import WorkbenchError
from workbench.explain.agreement import NOTHING_LEFT, agreement, left_over
from workbench.explain.calibration import FALSE_ALARM_RATE, Screen, detection_limit, plain_shares
from workbench.explain.hypotheses import (
    Hypothesis,
    Rival,
    density_of,
    estimates,
    fitted_rows,
    held_out,
    held_residual,
    rival,
)
from workbench.explain.recommend import next_measurements
from workbench.explain.verdict import (
    EFFECT,
    GROUP,
    LIKELY,
    NOTHING_MISSING,
    PAIR,
    PARTIAL,
    SAME_SHAPE,
    Posterior,
    Signs,
    Verdict,
    leaders,
    posterior,
    separation,
    twins_of,
    verdict,
)
from workbench.findings import ChannelFit, DetectionLimit, Diagnosis, Ranked, Separation, SizePosterior
from workbench.likelihood.bench import Bench
from workbench.likelihood.fit import Problem
from workbench.likelihood.linear import cosine

QUIET = 0.30  # probability of "nothing is missing" from which there is no alarm
CLEARLY = 0.20  # probability of "nothing is missing" that is an alarm by itself: two effects may hide one another
# What is left of less than this share of an effect's own change is put down to its law: laws of friction, iron loss and
# saturation are good to a few percent.
LAW_GOOD_TO = 0.05
VISIBLE = 9.0  # chi2 of an effect that is seen at all: three standard deviations
EXPLAINS = 5.0  # nats over nothing from which the leader explains a part: the odds of one effect of 25 are even at 3.6
NEAREST = 5  # signatures that are named beside an unknown residual


def diagnosis_of(
    search, threshold: float, power: Mapping[float, float], seed: int, wall: Callable[[], float]
) -> Diagnosis:
    """The diagnosis of a search.

    threshold: ln odds of "something" that is an alarm;  power: size of an unknown discrepancy -> share noticed
    """
    bench: Bench = search.bench
    probabilities = posterior(search.evidences)
    separations = separations_of(search)
    twins = {name: twins_of(name, separations) for name in search.singles}
    loud = float(search.screen.alarm(bench.residual[:, None])[0])
    alarm = (loud > threshold and probabilities.nothing < QUIET) or probabilities.nothing < CLEARLY
    signs = Signs(alarm, power[max(power)], *_signs(search, probabilities))
    said = verdict(probabilities, twins, signs)
    if said.kind == NOTHING_MISSING:
        said = replace(said, probability=_nothing_plain(search, probabilities))
    return Diagnosis(
        campaign=bench.campaign.id,
        model=bench.model.base.name,
        verdict=said.kind,
        names=said.names,
        probability=said.probability,
        ranking=ranking(search, probabilities),
        p_nothing_missing=probabilities.nothing,
        p_none_of_these=probabilities.unknown,
        p_partial=dict(probabilities.rest),
        alternatives=alternatives(probabilities, said, twins),
        p_pairs={" + ".join(names): p for names, p in probabilities.pairs.items()},
        abstention_power=power,
        detection_limits=limits(search.screen, threshold),
        next_measurements=next_measurements(search, probabilities),
        residual_signature=residual_signature(search, said),
        seed=seed,
        wall_s=wall(),
        before=_failing_fit(search, None),
        after=_failing_fit(search, leading(search, said)),
        posteriors=_posteriors(search, said),
        separations=tuple(Separation(a, b, nats) for (a, b), nats in separations.items()),
        false_alarm_rate=FALSE_ALARM_RATE,
        complaints=bench.complaints + _not_tried(search.failed),
        provenance={name: digest for name, digest in bench.campaign.file_hashes.items()},
    )


def _nothing_plain(search, p: Posterior) -> float:
    """Probability that nothing is missing that these data would show plainly: the verdict cannot speak of smaller
    things."""
    effects, unknown = plain_shares(search.screen, search.bench.residual)
    singles = sum(share * effects[name] for name, share in p.singles.items())
    return 1.0 - singles - unknown * p.unknown - sum(p.pairs.values()) - sum(p.rest.values())


def _not_tried(failed: Mapping[str, str]) -> tuple[str, ...]:
    """One sentence for each reason why effects were not tried."""
    reasons: dict[str, list[str]] = {}
    for name, why in failed.items():
        reasons.setdefault(why, []).append(name)
    return tuple(f"not tried: {', '.join(names)}; {why}" for why, names in reasons.items())


def chi2_per_n(problem: Problem, x: np.ndarray, effects=()) -> float:
    """Mean square of the whitened residuals of some rows."""
    return float(np.mean(problem.residual(x, effects) ** 2))


def ranking(search, p: Posterior) -> tuple[Ranked, ...]:
    """Every effect that was tried, most probable first."""
    bench = search.bench
    before = chi2_per_n(bench.fit, bench.null.x)
    held_before = chi2_per_n(bench.held_out, bench.null.x) if bench.held_out else None
    ranked = sorted(p.singles, key=lambda n: (-p.log((n,)), n))
    titles = {prepared.signature.name: prepared.signature.effect.title for prepared in search.screen.prepared}
    return tuple(_ranked(search, name, titles[name], p.singles[name], before, held_before) for name in ranked)


def _ranked(search, name: str, title: str, probability: float, before: float, held_before) -> Ranked:
    bench, hypothesis = search.bench, search.singles.get(name)
    evidence = search.evidences.singles[name] - search.evidences.nothing
    if hypothesis is None:
        return Ranked(name, title, probability, evidence, {}, before, before, held_before, held_before)
    x, effects = hypothesis.fit.x, hypothesis.effects
    after = chi2_per_n(fitted_rows(bench, hypothesis), x, effects)
    held = chi2_per_n(held_out(bench, hypothesis), x, effects) if bench.held_out else None
    found = estimates(hypothesis)[name]
    return Ranked(name, title, probability, evidence, found, before, after, held_before, held)


def alternatives(p: Posterior, said: Verdict, twins: Mapping[str, tuple[str, ...]]) -> dict[str, tuple[str, ...]]:
    """Of a pair: what may stand for each of the two, by other likely pairs with the same partner or as its twin."""
    if said.kind != PAIR:
        return {}
    first, second = said.names
    best = p.pairs[said.names]
    out = {}
    for name, partner in ((first, second), (second, first)):
        swapped = [n for pair, share in p.pairs.items() if partner in pair and share > LIKELY * best for n in pair]
        out[name] = tuple(sorted({*swapped, *twins.get(name, ())} - {first, second}))
    return out


def _signs(search, p: Posterior) -> tuple[bool, bool, bool, str, bool]:
    """What ``Signs`` holds beside alarm and power, in its order."""
    bench = search.bench
    hypothesis = search.named(leaders(p))
    if bench.held_out is None or hypothesis is None:
        return False, _is_left(search, None, search.unknown), False, "", False
    beside = search.rest.get(hypothesis.names[0]) if len(hypothesis.names) == 1 else None
    beside = beside or rival(hypothesis.problem, hypothesis.fit, search.screen.unknown)
    odds = hypothesis.log_evidence - bench.null.log_evidence
    return (
        _is_left(search, hypothesis, beside),
        _is_left(search, None, search.unknown),
        _is_bendable(search, hypothesis),
        _mended(search, hypothesis),
        odds < EXPLAINS,
    )


def _is_left(search, hypothesis: Hypothesis | None, beside: Rival) -> bool:
    """Whether fitted and held-out rows agree that a hypothesis (None: the model as it is) misses something, more than
    what the laws of its effects may be wrong by."""
    bench: Bench = search.bench
    if bench.held_out is None:
        return False
    held = held_residual(bench, hypothesis)
    left = left_over(bench, beside.explained, held)
    if hypothesis is None:
        return left > 0 or agreement(bench, bench.null.residual, held) > NOTHING_LEFT
    change = _change(bench, hypothesis.effects)
    own = 0.0 if change is None else float(np.linalg.norm(bench.nuisances.root(change)))
    return left > LAW_GOOD_TO * own or agreement(bench, hypothesis.fit.residual, held) > NOTHING_LEFT


def _is_bendable(search, hypothesis: Hypothesis) -> bool:
    """Whether the effects of a pair have nearly the same shape beside the tolerances."""
    if len(hypothesis.names) < 2:
        return False
    bench = search.bench
    changes = [_change(bench, (effect,)) for effect in hypothesis.effects]
    if any(change is None for change in changes):
        return False
    return abs(cosine(*(bench.nuisances.root(change) for change in changes))) > SAME_SHAPE


def _mended(search, hypothesis: Hypothesis) -> str:
    """The effect of a pair whose law may be wrong by as much as the other one adds in every channel; empty for none.

    The other counts where its chi2 beyond the declared error is VISIBLE or more.
    """
    if len(hypothesis.names) < 2:
        return ""
    bench = search.bench
    changes = [_change(bench, (effect,)) for effect in hypothesis.effects]
    if any(change is None for change in changes):
        return ""
    squares = [bench.fit.squares(bench.nuisances.root(change)) for change in changes]
    for own, other, effect in zip(squares, squares[::-1], hypothesis.effects):
        law = effect.model_error**2
        if law and np.sum(np.maximum(other - law * own, 0.0)) < VISIBLE:
            return effect.name()
    return ""


def _change(bench: Bench, effects: Sequence[Effect]) -> np.ndarray | None:
    """Whitened change of the rows to fit by effects beside the null (n,); None where the model has no answer there."""
    predictor, x = bench.fit.predictor, bench.null.x
    try:
        return bench.fit.white(predictor.predict(x, effects) - predictor.predict(x))
    except WorkbenchError:
        return None


def separations_of(search) -> dict[tuple[str, str], float]:
    """Expected log-Bayes factors between the effects that were fitted, both ways."""
    bench = search.bench
    m = len(bench.null.x)
    changes = {name: _change(bench, h.effects) for name, h in search.singles.items()}
    changes = {name: change for name, change in changes.items() if change is not None}
    return {
        (a, b): separation(search.singles[a], search.singles[b], m, changes)
        for first in combinations(changes, 2)
        for a, b in (first, first[::-1])
    }


def limits(screen: Screen, threshold: float) -> tuple[DetectionLimit, ...]:
    """Smallest size of every effect that would have been seen, and the effects that never would."""
    found = {}
    for prepared in screen.prepared:
        signature = prepared.signature
        value = detection_limit(screen, prepared, threshold)
        have = found.get(signature.name)
        if value is not None and (have is None or abs(value) < abs(have.value)):
            name, parameter = next(iter(parameters_of(signature.effect).items()))
            found[signature.name] = DetectionLimit(signature.name, signature.effect.title, name, value, parameter.unit)
    return tuple(found.values())


def residual_signature(search, said: Verdict) -> dict[str, object]:
    """Where the largest part of the residual sits and what it looks like; nearest known signatures with their
    cosine."""
    bench = search.bench
    leading = search.rest[said.names[0]] if said.kind == PARTIAL and said.names[0] in search.rest else search.unknown
    return {**describe(bench, leading.raw), "nearest": nearest(search.screen, bench.residual)}


def nearest(screen: Screen, residual: np.ndarray) -> dict[str, float]:
    """Effect -> largest cosine of its signature with the residual, both freed of what tolerances explain."""
    seen = screen.nuisances.root(residual)
    found: dict[str, float] = {}
    for prepared in screen.prepared:
        if prepared.signature.is_seen:
            gains, _ = prepared.gains(residual[:, None])
            best = prepared.signature.s[:, int(np.argmax(gains[:, 0]))]
            value = cosine(screen.nuisances.root(best), seen)
            found[prepared.signature.name] = max(found.get(prepared.signature.name, -1.0), value)
    return dict(sorted(found.items(), key=lambda item: -item[1])[:NEAREST])


def leading(search, said: Verdict) -> Hypothesis | None:
    """The fit that the verdict speaks of, or the most probable single effect; None where nothing is missing."""
    if said.kind == NOTHING_MISSING:
        return None
    best = max(search.singles, key=lambda n: search.singles[n].log_evidence, default=None)
    return search.named(said.names if said.kind != GROUP else said.names[:1]) or search.singles.get(best)


def _failing_fit(search, hypothesis: Hypothesis | None) -> ChannelFit | None:
    """The channel that fails most, at the null or with a hypothesis."""
    bench = search.bench
    squares = [np.mean(bench.null.residual[c.rows] ** 2 - 1) * c.size for c in bench.fit.stack.channels]
    x, effects = (bench.null.x, ()) if hypothesis is None else (hypothesis.fit.x, hypothesis.effects)
    return channel_fit(channel_views(bench, x, effects)[int(np.argmax(squares))])


def _posteriors(search, said: Verdict) -> tuple[SizePosterior, ...]:
    if said.kind not in (EFFECT, GROUP, PARTIAL):
        return ()
    return tuple(
        density_of(search.singles[name]) for name in said.names if name in search.singles and _has_one(search, name)
    )


def _has_one(search, name: str) -> bool:
    return len(search.singles[name].fit.z) == 1
