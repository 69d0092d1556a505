"""The ledger: which effect was tried, what it did to the errors of fitting and of prediction, and what was decided.

A step is accepted when the data speak for the effect more than its base rate speaks against it, and when the error of
conditions that are left out of the fit, region by region, does not rise above what it was or above the noise. Sealed
rows decide nothing. Refused steps stay in the ledger.
"""

from __future__ import annotations

import csv
import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from difflib import get_close_matches
from math import exp, log, log1p
from pathlib import Path

import numpy as np

from effects.base import Effect
from workbench.data.stack import Channel
from workbench.data.table import Campaign
from workbench.errors import WorkbenchError
from workbench.explain.contradictions import contradiction
from workbench.explain.diagnosis import on_bounds
from workbench.explain.explore import beliefs_of
from workbench.explain.hypotheses import Hypothesis, estimates
from workbench.explain.search import best_alone
from workbench.findings import Estimate, Ledger, LedgerStep, Ranked
from workbench.ledger.model_file import model_hash
from workbench.likelihood.bench import Bench, bench_of
from workbench.likelihood.prediction import predicted
from workbench.likelihood.signatures import signatures_of
from workbench.models.model import Model

START, ACCEPTED, REFUSED = "start", "accepted", "refused"
TOGETHER = " + "  # between effects of one step
OF_CHANNELS = ("rms_error", "noise_floor", "units", "rms_error_percent")
COLUMNS = (
    "step", "effect", "title", "decision", "parameters", "log_evidence_gain", "chi2_per_n", "held_out_chi2_per_n",
    "rms_error", "noise_floor", "units", "rms_error_percent", "verdict", "reason", "data_sha256",
    "model_sha256",
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class Trial:
    """An effect that was tried on a model. model: with the effect if it was accepted, unchanged otherwise"""

    before: Bench
    after: Bench
    model: Model
    step: LedgerStep


def try_effect(
    model: Model,
    campaign: Campaign,
    library: Mapping[str, type[Effect]],
    name: str,
    number: int = 1,
    progress: Callable[[str], None] = lambda words: None,
) -> Trial:
    """Adds an effect at its most probable size, fits everything again and decides.

    Raises:
        WorkbenchError: no such effect, or it cannot act on this device or these data.
    """
    cls = _known(name, model, library)
    before = bench_of(model, campaign, library)
    progress(f"fitting {name}")
    hypothesis = best_fit(before, cls)
    effect = hypothesis.effects[0]
    trial = model + effect
    after = bench_of(trial, campaign, library)
    sizes = estimates(hypothesis)[name]
    row = replace(
        step_of(after, number, START),
        effect=name,
        title=cls.title,
        parameters=sizes,
        log_evidence_gain=float(hypothesis.log_evidence - before.null.log_evidence),
        reason="; ".join(filter(None, (_on_bound(effect), contradiction(cls, sizes, campaign.tolerances)))),
    )
    return _decided(before, after, (model, trial), row, (cls,))


def _on_bound(effect: Effect) -> str:
    """A sentence where a parameter ends on a bound; else empty."""
    names = on_bounds(effect)
    return f"on a bound of what is possible: {', '.join(names)}" if names else ""


def try_together(
    model: Model,
    campaign: Campaign,
    library: Mapping[str, type[Effect]],
    named: Sequence[Ranked],
    number: int = 1,
    progress: Callable[[str], None] = lambda words: None,
) -> Trial:
    """As ``try_effect`` with several effects at once, from the sizes that a diagnosis found.

    Raises:
        WorkbenchError: the model has no answer with them, or one of them has several forms.
    """
    before, trial = bench_of(model, campaign, library), model
    progress(f"fitting {TOGETHER.join(one.name for one in named)}")
    for one in named:
        trial = trial + _sized(library[one.name], one, model)
    after = bench_of(trial, campaign, library)
    row = replace(
        step_of(after, number, START),
        effect=TOGETHER.join(one.name for one in named),
        title=TOGETHER.join(one.title for one in named),
        parameters={f"{one.name}.{name}": size for one in named for name, size in one.parameters.items()},
        log_evidence_gain=min(one.log_evidence for one in named),
    )
    return _decided(before, after, (model, trial), row, [library[one.name] for one in named])


def _decided(
    before: Bench, after: Bench, models: tuple[Model, Model], row: LedgerStep, effects: Sequence[type[Effect]]
) -> Trial:
    """What was tried, with the decision; models: without and with it; row: undecided, its reason what speaks against"""
    model, trial = models
    rates = [effect.base_rate for effect in effects]
    decision, reason = decide(before, after, row.log_evidence_gain + sum(log(rate) - log1p(-rate) for rate in rates))
    if decision == ACCEPTED:
        fitted_again = after.fit.predictor.model_at(after.null.x).effects[: len(trial.effects)]
        model = replace(model, effects=fitted_again)
    said = "; ".join(filter(None, (reason, row.reason)))
    return Trial(before, after, model, replace(row, decision=decision, reason=said))


def _sized(cls: type[Effect], row: Ranked, model: Model) -> Effect:
    forms = cls.variants(model.design)
    if len(forms) > 1:
        raise WorkbenchError(f"{row.name} has {len(forms)} forms and cannot be added beside others at once")
    return replace(forms[0], **{name: size.value for name, size in row.parameters.items()})


def best_fit(bench: Bench, cls: type[Effect]) -> Hypothesis:
    """The most probable fit of an effect over its forms, starts as linear algebra promises.

    Raises:
        WorkbenchError: the effect changes nothing in these data, or the model has no answer with it.
    """
    signatures = signatures_of(bench, cls.variants(bench.model.design))
    if cls.name() not in signatures.found:
        raise WorkbenchError(f"{cls.name()}: {signatures.failed[cls.name()]}; it can be neither shown nor added.")
    return best_alone(bench, signatures, beliefs_of({cls.name(): cls}, signatures.names))


def decide(before: Bench, after: Bench, odds: float) -> tuple[str, str]:
    """Accepted or refused, and why. odds: ln of those for what is added, after the data"""
    old, new = (predicted(bench.fit, bench.null) for bench in (before, after))
    words = f"the data speak {'for' if odds > 0 else 'against'} the effect, {_to_one(abs(odds))} to 1"
    if old.blocks:
        words += (
            f"; chi2/n of conditions left out of the fit, region by region, goes from {old.chi2_per_n:.4g} to "
            f"{new.chi2_per_n:.4g}"
        )
    else:
        words += "; these conditions have no regions, so that prediction beyond them was not tested"
    if odds <= 0:
        return REFUSED, words
    if old.blocks and new.chi2_per_n > max(old.chi2_per_n, new.without_fault):
        return REFUSED, f"{words}: it rises"
    return ACCEPTED, words


def _to_one(log_odds: float) -> str:
    return f"{exp(log_odds):.2g}" if log_odds < log(100) else f"10^{log_odds / log(10):.1f}"


def start_step(bench: Bench) -> LedgerStep:
    """Row 0: the model before any effect."""
    return step_of(bench, 0, START)


def step_of(bench: Bench, number: int, decision: str) -> LedgerStep:
    """A row with the errors of a bench, effect and gain still empty."""
    stack, predictor = bench.stack, bench.fit.predictor.on(bench.stack)
    error = stack.y - predictor.wherever_known(bench.null.x)
    size = {c.name: _rms(stack.y, c) for c in stack.channels}
    return LedgerStep(
        step=number,
        effect="",
        title="",
        decision=decision,
        parameters={},
        log_evidence_gain=0.0,
        chi2_per_n=float(np.mean(bench.null.residual**2)),
        held_out_chi2_per_n=_left_out(bench),
        rms_error={c.name: _rms(error, c) for c in stack.channels},
        noise_floor={c.name: _rms(bench.white.sigma / bench.noise.inflation, c) for c in stack.channels},
        units={c.name: c.unit for c in stack.channels},
        rms_error_percent={c.name: 100 * _rms(error, c) / size[c.name] for c in stack.channels if size[c.name] > 0},
    )


def _rms(values: np.ndarray, channel: Channel) -> float:
    """Of the rows of a channel that have a value, in its own unit."""
    return float(np.sqrt(np.nanmean((values[channel.rows] / channel.scale) ** 2)))


def _left_out(bench: Bench) -> float | None:
    """chi2/n of conditions left out of the fit, region by region; None where there are no regions."""
    found = predicted(bench.fit, bench.null)
    return found.chi2_per_n if found.blocks else None


def append(path: Path, step: LedgerStep, campaign: Campaign, model: Model) -> None:
    """Adds a row to the file; rows that are there are never touched."""
    new = not path.exists()
    with path.open("a", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream)
        if new:
            writer.writerow(COLUMNS)
        writer.writerow(_row(step, campaign, model))


def _row(step: LedgerStep, campaign: Campaign, model: Model) -> list[str]:
    parameters = {n: vars(e) for n, e in step.parameters.items()}
    values = {
        **{name: getattr(step, name) for name in COLUMNS[:-2]},
        "parameters": json.dumps(parameters),
        **{name: json.dumps(getattr(step, name)) for name in OF_CHANNELS},
        "held_out_chi2_per_n": "" if step.held_out_chi2_per_n is None else repr(step.held_out_chi2_per_n),
        "data_sha256": json.dumps(dict(campaign.file_hashes)),
        "model_sha256": model_hash(model),
    }
    return [values[name] if isinstance(values[name], str) else repr(values[name]) for name in COLUMNS]


def read_ledger(path: Path, campaign: str, model: str) -> Ledger:
    """The ledger of a file; empty where there is none.

    Raises:
        WorkbenchError: the file is no ledger.
    """
    if not path.exists():
        return Ledger(campaign, model, ())
    with path.open(newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    try:
        return Ledger(campaign, model, tuple(_step(row) for row in rows))
    except (KeyError, ValueError, TypeError) as error:
        raise WorkbenchError(
            f"{path}: is no ledger of the workbench ({error}); move it away to begin a new one."
        ) from None


def _step(row: Mapping[str, str]) -> LedgerStep:
    return LedgerStep(
        step=int(row["step"]),
        effect=row["effect"],
        title=row["title"],
        decision=row["decision"],
        parameters={n: Estimate(**e) for n, e in json.loads(row["parameters"]).items()},
        log_evidence_gain=float(row["log_evidence_gain"]),
        chi2_per_n=float(row["chi2_per_n"]),
        held_out_chi2_per_n=float(row["held_out_chi2_per_n"]) if row["held_out_chi2_per_n"] else None,
        **{name: json.loads(row[name]) for name in OF_CHANNELS},
        verdict=row["verdict"],
        reason=row["reason"],
    )


def _known(name: str, model: Model, library: Mapping[str, type[Effect]]) -> type[Effect]:
    if name not in library:
        close = [n for n in library if name.split("_")[0] in n] or get_close_matches(name, library, n=3)
        hint = f"; did you mean {', '.join(close[:6])}?" if close else ";"
        raise WorkbenchError(f"there is no effect {name!r}{hint} `airgap effects` lists all.")
    if not library[name].can_act_on(model.design):
        raise WorkbenchError(f"{name} cannot act on a {type(model.design).__name__}.")
    return library[name]
