"""Which effect is missing? Every effect is tried, rivals that no effect explains too; one verdict comes out."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from time import perf_counter

import numpy as np
from scipy.special import logsumexp

from effects.base import Effect
from workbench.data.table import Campaign
from workbench.errors import WorkbenchError
from workbench.explain.agreement import repeats_itself
from workbench.explain.bank import Prepared, signature
from workbench.explain.calibration import Screen, abstention_power, alarm_threshold
from workbench.explain.conventions import diagnosis_of as of_conventions
from workbench.explain.conventions import settle
from workbench.explain.hypotheses import (
    Hypothesis,
    Rival,
    exact,
    fitted_rows,
    held_out,
    held_residual,
    pair,
    rival,
    single,
)
from workbench.explain.priors import NOTHING, ONE_EFFECT, TWO_EFFECTS
from workbench.explain.rivals import unknown_function
from workbench.explain.verdict import Evidences
from workbench.findings import Diagnosis
from workbench.likelihood.bench import Bench, bench_of, extrapolated
from workbench.likelihood.fit import Problem, misfit
from workbench.likelihood.linear import Nuisances
from workbench.models.model import Model

REFINED = 8  # effects that are fitted non-linearly
AT_LEAST = 4  # effects that are fitted, however far behind
CLOSE = 25.0  # nats behind the best, within which an effect is worth a non-linear fit
PAIR_GAIN = 2.0  # nats that an effect must promise before it is looked at more closely
PAIRS = 16  # pairs that are fitted
OUT_OF_REACH = 8.0  # nats that a promise may lie behind the most probable hypothesis, one in 3000
SHARE = (
    0.25  # of what an effect takes off chi2 of the fitted rows, the least it must take off that of the held-out rows
)
ROUNDING = 3.0  # nats that a promise may be too modest by
SCATTER = 4.0  # of a fall of chi2 of held-out rows
EXACT = 2  # leading effects that are fitted again where the base model is only an expansion
RIVALS = 3  # leading effects that are tried beside the unknown function
SEED = 20261

Progress = Callable[[str], None]


@dataclass(frozen=True, eq=False)
class Search:
    """All that was tried. singles, pairs: non-linear fits;  screened: ln evidence over the null by linear algebra"""

    bench: Bench
    screen: Screen
    screened: Mapping[str, float]
    singles: Mapping[str, Hypothesis]
    pairs: Mapping[tuple[str, str], Hypothesis]
    unknown: Rival
    rest: Mapping[str, Rival]
    evidences: Evidences
    failed: Mapping[str, str]

    def named(self, names: tuple[str, ...]) -> Hypothesis | None:
        """The fit of one effect or of two, None where they were not fitted."""
        return self.singles.get(names[0]) if len(names) == 1 else self.pairs.get(tuple(sorted(names)))


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
        WorkbenchError: the campaign cannot be used, see ``workbench.likelihood.bench``.
    """
    from workbench.explain.results import diagnosis_of

    start = perf_counter()
    conventions = settle(model, campaign, library, progress)
    if not conventions.are_right:
        return of_conventions(conventions, model, seed, perf_counter() - start)
    progress("fitting tolerances and calibrations")
    bench = bench_of(model, campaign, library)
    random = np.random.default_rng(seed)
    search = searched(bench, library, progress)
    progress("simulating campaigns that hide nothing")
    threshold = alarm_threshold(search.screen, bench, random)
    power = abstention_power(search.screen, bench, threshold, random)
    return diagnosis_of(search, threshold, power, seed, lambda: perf_counter() - start)


def candidates(bench: Bench, library: Mapping[str, type[Effect]]) -> tuple[Effect, ...]:
    """Effects (all variants) that can act on the device and are not in the model yet."""
    model = bench.model
    have = {effect.name() for effect in model.effects}
    within = {name for effect in model.effects for name in effect.contains}
    return tuple(
        variant
        for name, cls in library.items()
        if name not in have and name not in within and cls.can_act_on(model.design)
        for variant in cls.variants(model.design)
    )


def screen_of(bench: Bench, effects: tuple[Effect, ...], progress: Progress) -> tuple[Screen, dict[str, str]]:
    """Signatures of all effects, and why some could not be had."""
    problem = bench.fit
    base = problem.predictor.predict(bench.centre.x)
    change = lambda effect: problem.white(problem.predictor.predict(bench.centre.x, (effect,)) - base)  # noqa: E731
    prepared, failed = [], {}
    for effect in effects:
        progress(f"signature of {effect.name()}")
        try:
            prepared.append(Prepared(signature(effect, change), bench.nuisances))
        except (WorkbenchError, ArithmeticError, ValueError) as error:
            failed[effect.name()] = str(error)
    prepared = [p for p in prepared if p.signature.name not in failed]
    seen = {p.signature.name for p in prepared if p.signature.is_seen}
    failed |= {p.signature.name: "it changes nothing in these data" for p in prepared if p.signature.name not in seen}
    prepared = [p for p in prepared if p.signature.name in seen]
    return Screen(bench.nuisances, tuple(prepared), unknown_function(problem.stack, problem.white)), failed


def searched(bench: Bench, library: Mapping[str, type[Effect]], progress: Progress = lambda words: None) -> Search:
    """Tries every effect, the promising pairs, and the unknown function."""
    screen, failed = screen_of(bench, candidates(bench, library), progress)
    screened = {n: float(v[0]) for n, v in screen.log_evidences(bench.residual[:, None]).items()}
    singles = _refined(bench, screen, screened, failed, progress)
    null = bench.null.log_evidence
    evidences = {n: _checked(bench, h) for n, h in singles.items()} | _behind(screened, singles, null)
    leaders = sorted(singles, key=lambda n: -singles[n].log_evidence)
    pairs = _pairs(bench, screen, singles, progress)
    progress("unknown functions")
    unknown = rival(bench.fit, bench.null, screen.unknown)
    rest = {n: rival(singles[n].problem, singles[n].fit, screen.unknown) for n in leaders[:RIVALS]}
    found = Evidences(
        null,
        evidences,
        {names: h.log_evidence for names, h in pairs.items()},
        unknown.log_evidence if _is_in_held_out_rows(bench, unknown, None) else -np.inf,
        {n: r.log_evidence for n, r in rest.items() if _is_in_held_out_rows(bench, r, singles[n])},
    )
    return Search(bench, screen, screened, singles, pairs, unknown, rest, found, failed)


def _refined(bench, screen, screened, failed, progress) -> dict[str, Hypothesis]:
    """Non-linear fits of the effects that lead the linear ranking and are seen at all."""
    ranked = sorted(screened, key=lambda n: (-screened[n], n))
    found = {}
    for name in ranked[:REFINED]:
        if len(found) >= AT_LEAST and screened[name] < screened[ranked[0]] - _margin(screened[ranked[0]]):
            break
        progress(f"fitting {name}")
        try:
            found[name] = _best_variant(bench, [p for p in screen.prepared if p.signature.name == name])
        except (WorkbenchError, ArithmeticError, np.linalg.LinAlgError) as error:
            failed[name] = str(error)
    far = bench.centre is not bench.null  # the null is exact, the fits are those of an expansion far from it
    worth = [n for n in found if far or found[n].log_evidence > bench.null.log_evidence + PAIR_GAIN]
    for name in sorted(worth, key=lambda n: -found[n].log_evidence)[:EXACT]:
        found[name] = exact(found[name])
    return found


def _margin(best: float) -> float:
    """How far behind the best [nats] an effect may lie in the linear ranking; signatures are less exact when large."""
    return CLOSE + 0.5 * max(best, 0.0)


def _best_variant(bench: Bench, variants: list[Prepared]) -> Hypothesis:
    """The fit of the most probable variant; its evidence is the mean over all variants."""
    linear = np.array([float(p.log_evidence(bench.residual[:, None])[0]) for p in variants])
    order = np.argsort(-linear, kind="stable")[:3]
    fits = [single(bench, variants[k])[0] for k in order]
    best = max(fits, key=lambda h: h.log_evidence)
    mean = logsumexp([h.log_evidence for h in fits]) - np.log(len(variants))
    return replace(best, log_evidence=float(mean))


def _behind(screened, singles, null) -> dict[str, float]:
    """Effects that were not fitted: behind the last that was by as much as in the linear ranking."""
    if not singles:
        return {n: null + v for n, v in screened.items()}
    last = min(singles, key=lambda n: screened[n])
    worst = min(h.log_evidence for h in singles.values())
    return {n: worst + min(v - screened[last], 0.0) for n, v in screened.items() if n not in singles}


def _is_in_held_out_rows(bench: Bench, found: Rival, beside: Hypothesis | None) -> bool:
    """Whether an unknown function repeats itself; what only one scan shows is a drift, not a property of the device.

    beside: the effect that it stands beside
    """
    return bench.held_out is None or repeats_itself(bench, found.explained, held_residual(bench, beside))


def _pairs(bench, screen, singles: Mapping[str, Hypothesis], progress) -> dict[tuple[str, str], Hypothesis]:
    """Fits of the pairs that promise most, each effect that was fitted with every other."""
    promises = _promises(bench, screen, singles)
    promised = sorted(promises.values(), key=lambda o: (-o[0], o[3]))
    tried: set[tuple[str, str]] = set()
    found: dict[tuple[str, str], Hypothesis] = {}
    least = _least_promise(bench, screen, singles)
    for promise, leader, prepared, names, z in promised:
        key = tuple(sorted(names))
        if key in tried or len(tried) == PAIRS or promise < least:
            continue
        tried.add(key)
        progress(f"fitting {key[0]} with {key[1]}")
        try:
            fit = pair(bench, leader, prepared.signature.effect, z, singles.get(names[1]))
        except (WorkbenchError, ArithmeticError, np.linalg.LinAlgError):
            continue
        if _second_helps(bench, leader, fit):
            found[key] = fit
            least = max(least, fit.log_evidence - OUT_OF_REACH)
    return found


def _least_promise(bench: Bench, screen: Screen, singles: Mapping[str, Hypothesis]) -> float:
    """ln evidence of a pair below which it is out of the question beside nothing and single effects."""
    effects = max(len(screen.names), 1)
    best = max((h.log_evidence for h in singles.values()), default=-np.inf) + np.log(ONE_EFFECT / effects)
    share = np.log(TWO_EFFECTS / max(effects * (effects - 1) // 2, 1))
    return max(best, bench.null.log_evidence + np.log(NOTHING)) - share - OUT_OF_REACH


def _checked(bench: Bench, found: Hypothesis) -> float:
    """ln evidence of an effect; no more than that of nothing where the held-out rows do not show what the fitted
    ones do."""
    if bench.held_out is None:
        return found.log_evidence
    fitted_fall = _square(bench.fit, bench.null.x) - _square(fitted_rows(bench, found), found.fit.x, found.effects)
    held_fall = _square(bench.held_out, bench.null.x) - _square(held_out(bench, found), found.fit.x, found.effects)
    gain = found.log_evidence - bench.null.log_evidence
    return found.log_evidence if _shown(bench, gain, fitted_fall, held_fall) else bench.null.log_evidence


def _second_helps(bench: Bench, first: Hypothesis, both: Hypothesis) -> bool:
    """Whether the second effect takes off the error of held-out rows a fair share of what it takes off the fitted
    ones."""
    if bench.held_out is None:
        return True
    fitted_fall, held_fall = (
        _square(rows(bench, first), first.fit.x, first.effects) - _square(rows(bench, both), both.fit.x, both.effects)
        for rows in (fitted_rows, held_out)
    )
    return _shown(bench, both.log_evidence - first.log_evidence, fitted_fall, held_fall)


def _square(part: Problem, x: np.ndarray, effects=()) -> float:
    return float(np.sum(part.residual(x, effects) ** 2))


def _shown(bench: Bench, gain: float, fitted_fall: float, held_fall: float) -> bool:
    """Whether chi2 of the held-out rows falls by a fair share of what chi2 of the fitted rows falls.

    gain: of ln evidence; where most of it comes from smaller pulls of tolerances the residuals have nothing to show
    """
    if fitted_fall < gain:
        return True
    return held_fall > SHARE * bench.held_out.stack.size / bench.fit.stack.size * fitted_fall - SCATTER


def _promises(bench: Bench, screen: Screen, singles: Mapping[str, Hypothesis]) -> dict[tuple[str, str], tuple]:
    """What each pair promises; where both effects were fitted alone, the larger of both promises: beside the wrong one
    of two effects the right one looks odd."""
    found: dict[tuple[str, str], tuple] = {}
    for leader in singles.values():
        for option in _seconds(bench, leader, screen):
            key = tuple(sorted(option[3]))
            if key not in found or option[0] > found[key][0]:
                found[key] = option
    return found


def _seconds(bench: Bench, leader: Hypothesis, screen: Screen) -> list[tuple]:
    """(promised ln evidence, leader, signature, names, z) of every effect that would help beside the leader."""
    nuisances, residual = Nuisances(leader.fit.jacobian), extrapolated(leader.fit)
    out = []
    first = type(leader.fit.effects[0])
    for p in screen.prepared:
        second = type(p.signature.effect)
        if second is first or second.name() in first.contains or first.name() in second.contains:
            continue
        beside = Prepared(p.signature, nuisances)
        gain = _student_gain(leader, float(beside.log_evidence(residual[:, None])[0]))
        if gain > PAIR_GAIN:
            z = beside.best(residual, 1)[0]
            out.append((leader.log_evidence + gain, leader, p, (first.name(), second.name()), z))
    return out


def _student_gain(leader: Hypothesis, gain: float) -> float:
    """A Gaussian gain of ln evidence in the likelihood of the fits, taken from the channels that fit worst."""
    problem = leader.problem
    squares, sizes = problem.squares(leader.fit.residual), problem.sizes
    excess = np.maximum(squares - sizes, 0.0)
    if gain <= 0 or excess.sum() == 0:
        return gain
    fall = np.minimum(2 * gain * excess / excess.sum(), excess)
    return min(gain, misfit(squares, problem.dof, sizes) - misfit(squares - fall, problem.dof, sizes) + ROUNDING)
