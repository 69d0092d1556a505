"""The ledger: which effect was tried, what it did to the error of fitted and held-out rows, and what was decided.

A step is accepted when the error of rows that no fit has seen falls. Where an effect takes over what tolerances had
hidden, that error stays, or stays within the noise (chi2/n up to 1); then the pulls of the declared uncertainties
must fall instead. Refused steps stay in the ledger.
"""

from __future__ import annotations

import csv
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from effects.base import Effect
from workbench.data.stack import Channel
from workbench.data.table import Campaign
from workbench.errors import WorkbenchError
from workbench.explain.bank import Prepared, signature
from workbench.explain.hypotheses import Hypothesis, estimates, single
from workbench.explain.results import chi2_per_n
from workbench.findings import Estimate, Ledger, LedgerStep
from workbench.ledger.model_file import model_hash
from workbench.likelihood.bench import Bench, bench_of
from workbench.likelihood.fit import Problem
from workbench.models.model import Model

START, ACCEPTED, REFUSED = "start", "accepted", "refused"
SAME = 0.01  # relative change of the held-out error that is none
LEAST_FALL = 1.0  # fall of chi2 of the held-out rows that is none: a parameter that means nothing changes it by as much
RELIEF = 9.0  # fall of the sum of squared pulls that speaks for an effect: one pull of three
OF_CHANNELS = ("rms_error", "noise_floor", "units", "rms_error_percent", "held_out_rms_error")
COLUMNS = (
    "step", "effect", "title", "decision", "parameters", "log_evidence_gain", "chi2_per_n", "held_out_chi2_per_n",
    "rms_error", "noise_floor", "units", "rms_error_percent", "held_out_rms_error", "verdict", "reason", "data_sha256",
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
    trial = model + hypothesis.effects[0]
    after = bench_of(trial, campaign, library)
    fitted_again = after.fit.predictor.model_at(after.null.x).effects[: len(trial.effects)]
    gain = hypothesis.log_evidence - before.null.log_evidence
    decision, reason = decide(before, after)
    step = replace(
        step_of(after, number, decision),
        effect=name,
        title=cls.title,
        parameters=estimates(hypothesis)[name],
        log_evidence_gain=float(gain),
        reason=reason,
    )
    return Trial(before, after, replace(model, effects=fitted_again) if decision == ACCEPTED else model, step)


def best_fit(bench: Bench, cls: type[Effect]) -> Hypothesis:
    """The most probable fit of an effect over its variants and starts."""
    problem, x = bench.fit, bench.null.x
    base = problem.predictor.predict(x)
    change = lambda effect: problem.white(problem.predictor.predict(x, (effect,)) - base)  # noqa: E731
    prepared = [Prepared(signature(v, change), bench.nuisances) for v in cls.variants(bench.model.design)]
    seen = [p for p in prepared if p.signature.is_seen]
    if not seen:
        raise WorkbenchError(
            f"{cls.name()} changes nothing in these data; it can be neither shown nor added with them."
        )
    ranked = sorted(seen, key=lambda p: -float(p.log_evidence(bench.residual[:, None])[0]))[:3]
    return max((h for p in ranked for h in single(bench, p)), key=lambda h: h.log_evidence)


def decide(before: Bench, after: Bench) -> tuple[str, str]:
    """Accepted or refused, and why."""
    which = "fitted rows (none are held out)" if before.held_out is None else "held-out rows"
    old, new = (_unseen(b).squares(_residual(b)).sum() for b in (before, after))
    rows = len(_residual(before))
    m = len(before.fit.predictor.nuisances)
    relief = float(np.sum(before.null.x[:m] ** 2) - np.sum(after.null.x[:m] ** 2))
    words = f"chi2/n of the {which} goes from {old / rows:.3g} to {new / rows:.3g}"
    if old - new > max(SAME * old, LEAST_FALL):
        return ACCEPTED, words
    if new <= max(old * (1 + SAME), rows) and relief > RELIEF:
        return (
            ACCEPTED,
            f"{words}, no more than noise; the squared pulls of declared uncertainties fall by {relief:.3g}",
        )
    return REFUSED, f"{words}: it does not fall" if new >= old else f"{words}: it falls no more than by chance"


def _unseen(bench: Bench) -> Problem:
    """The rows that decide: those held out, or all where none are."""
    return bench.held_out or bench.fit


def _residual(bench: Bench) -> np.ndarray:
    return _unseen(bench).residual(bench.null.x)


def start_step(bench: Bench) -> LedgerStep:
    """Row 0: the model before any effect."""
    return step_of(bench, 0, START)


def step_of(bench: Bench, number: int, decision: str) -> LedgerStep:
    """A row with the errors of a bench, effect and gain still empty."""
    stack, predictor = bench.stack, bench.fit.predictor.on(bench.stack)
    error = stack.y - predictor.predict(bench.null.x)
    size = {c.name: _rms(stack.y, c) for c in stack.channels}
    return LedgerStep(
        step=number,
        effect="",
        title="",
        decision=decision,
        parameters={},
        log_evidence_gain=0.0,
        chi2_per_n=chi2_per_n(bench.fit, bench.null.x),
        held_out_chi2_per_n=chi2_per_n(bench.held_out, bench.null.x) if bench.held_out else None,
        rms_error={c.name: _rms(error, c) for c in stack.channels},
        noise_floor={c.name: _rms(bench.white.sigma / bench.noise.inflation, c) for c in stack.channels},
        units={c.name: c.unit for c in stack.channels},
        rms_error_percent={c.name: 100 * _rms(error, c) / size[c.name] for c in stack.channels if size[c.name] > 0},
        held_out_rms_error=_held_out_rms(bench),
    )


def _rms(values: np.ndarray, channel: Channel) -> float:
    """Of the rows of a channel, in its own unit."""
    return float(np.sqrt(np.mean((values[channel.rows] / channel.scale) ** 2)))


def _held_out_rms(bench: Bench) -> dict[str, float]:
    if bench.held_out is None:
        return {}
    part = bench.held_out
    error = part.stack.y - part.predictor.predict(bench.null.x)
    return {c.name: _rms(error, c) for c in part.stack.channels if c.size}


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
        close = [n for n in library if name.split("_")[0] in n] or list(library)
        raise WorkbenchError(
            f"there is no effect {name!r}; did you mean {', '.join(close[:6])}? `airgap effects` lists all."
        )
    if not library[name].can_act_on(model.design):
        raise WorkbenchError(f"{name} cannot act on a {type(model.design).__name__}.")
    return library[name]
