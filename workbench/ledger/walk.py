"""The walk of a user: add an effect, keep the ledger, compare and diagnose again."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from effects.base import Effect
from workbench.believed import LIKELY
from workbench.compare.comparison import comparison_of
from workbench.data.table import Campaign
from workbench.errors import WorkbenchError
from workbench.explain.diagnosis import SEED, diagnose
from workbench.explain.verdict import CONVENTION, GROUP
from workbench.findings import Comparison, Diagnosis, Ledger, LedgerStep
from workbench.ledger.final import final_parameters, learned_at
from workbench.ledger.learned import Learned, learned_from
from workbench.ledger.model_file import NAME, read_model, write_model
from workbench.ledger.skeleton import skeleton
from workbench.ledger.step import (
    ACCEPTED,
    REFUSED,
    TOGETHER,
    Trial,
    append,
    read_ledger,
    start_step,
    step_of,
    try_effect,
    try_together,
)
from workbench.likelihood.bench import bench_of
from workbench.models.model import Model

LEDGER = "ledger.csv"
MOST_STEPS = 8  # effects that a walk adds by itself


@dataclass(frozen=True, eq=False)
class Added:
    """What ``add`` did. model: after the decision"""

    model: Model
    step: LedgerStep
    ledger: Ledger
    comparison: Comparison
    diagnosis: Diagnosis


def add_effect(
    model: Model,
    campaign: Campaign,
    library: Mapping[str, type[Effect]],
    name: str,
    out: Path,
    seed: int | None = None,
    progress: Callable[[str], None] = lambda words: None,
    before: Diagnosis | None = None,
) -> Added:
    """Tries an effect, writes the ledger row and, when accepted, the model file; compares and diagnoses again.

    out: folder of ``ledger.csv`` and ``model.toml``, which are the only files written
    before: diagnosis of the model as it is, where it was made already; it holds on if the effect is refused
    """
    trial = try_effect(model, campaign, library, name, _number(model, campaign, out), progress)
    return _decided(trial, model, campaign, library, out, seed, progress, before)


def _number(model: Model, campaign: Campaign, out: Path) -> int:
    """Of the next step."""
    return len(read_ledger(out / LEDGER, campaign.id, model.base.name).steps) or 1


def _decided(
    trial: Trial,
    model: Model,
    campaign: Campaign,
    library: Mapping[str, type[Effect]],
    out: Path,
    seed: int | None,
    progress: Callable[[str], None],
    before: Diagnosis | None,
) -> Added:
    """Writes what was decided of a trial; compares and diagnoses again. model: before it"""
    path = out / LEDGER
    if not read_ledger(path, campaign.id, model.base.name).steps:
        append(path, start_step(trial.before), campaign, model)
    diagnosis = before
    if diagnosis is None or trial.step.decision == ACCEPTED:
        diagnosis = diagnose(trial.model, campaign, library, SEED if seed is None else seed, progress)
    said = ": ".join([diagnosis.verdict, *([", ".join(diagnosis.names)] if diagnosis.names else [])])
    step = replace(trial.step, verdict=said, reason=trial.step.reason + _not_told_from(before, trial.step.effect))
    append(path, step, campaign, trial.model)
    bench = trial.after if step.decision == ACCEPTED else trial.before
    learned = learned_from(bench)
    if step.decision == ACCEPTED:
        write_model(out / NAME, learned)
    comparison = comparison_of(bench, library, progress)
    whole = told(read_ledger(path, campaign.id, model.base.name), learned)
    return Added(trial.model, step, whole, comparison, diagnosis)


def _not_told_from(before: Diagnosis | None, name: str) -> str:
    """What may stand for an effect instead, as the diagnosis says before which it was added."""
    if before is None:
        return ""
    group = before.names if before.verdict == GROUP and name in before.names else before.alternatives.get(name, ())
    others = [other for other in group if other != name]
    return f"; these data cannot tell it from {' or '.join(others)}" if others else ""


def told(ledger: Ledger, learned: Learned) -> Ledger:
    """With the numbers of the final model and where it was learned."""
    ranges = learned.source.ranges if learned.source is not None else ()
    return replace(ledger, parameters=final_parameters(learned), ranges=learned_at(ranges))


def skeleton_for(path: Path, campaign: Campaign | None, library, model: Model | None) -> str:
    """The text of an effect file; with a campaign its first guess comes from the residual."""
    if campaign is None:
        return skeleton(path, {}, "response", "generic", ["condition"], 1.0)
    found = diagnose(model, campaign, library)
    if found.verdict == CONVENTION:
        raise WorkbenchError(f"{campaign.folder}: settle its conventions first, `airgap diagnose` says which.")
    signature = found.residual_signature
    bench = bench_of(model, campaign, library)
    channel = next(c for c in bench.stack.channels if c.name == signature["channel"])
    table = bench.stack.tables[channel.table]
    size = float(signature["size_in_u"] * bench.stack.u[channel.rows].mean())
    return skeleton(path, signature, channel.response, table.kind, list(table.conditions), size)


def walk(
    model: Model,
    campaign: Campaign,
    library: Mapping[str, type[Effect]],
    out: Path,
    seed: int | None = None,
    progress: Callable[[str], None] = lambda words: None,
) -> tuple[Ledger, Diagnosis]:
    """Diagnoses, adds what is named, and so on until nothing is named or all that is named is refused.

    Of several names the one with the most evidence by itself is tried first; where each alone is refused, all together;
    what was refused once more when others have been accepted.
    out: folder of ``ledger.csv`` and ``model.toml``; the latter holds the inputs fitted to these data, effects or none
    Nothing is tried or written while conventions are not settled.
    """
    diagnosis = diagnose(model, campaign, library, SEED if seed is None else seed, progress)
    if diagnosis.verdict == CONVENTION:
        return read_ledger(out / LEDGER, campaign.id, model.base.name), diagnosis
    refused: set[str] = set()
    begun = model
    for _ in range(MOST_STEPS):
        trials = _trials(model, campaign, library, diagnosis, refused, out, seed, progress)
        added = next((one for one in trials if one.step.decision == ACCEPTED), None)
        if added is None:
            break
        model, diagnosis = added.model, added.diagnosis
    path = out / LEDGER
    if model is begun:
        bench = bench_of(model, campaign, library)
        write_model(out / NAME, learned_from(bench))
        if not path.exists():
            append(path, replace(start_step(bench), verdict=diagnosis.verdict), campaign, model)
    return told(read_ledger(path, campaign.id, model.base.name), read_model(out / NAME, library)), diagnosis


def _trials(
    model: Model,
    campaign: Campaign,
    library: Mapping[str, type[Effect]],
    diagnosis: Diagnosis,
    refused: set[str],
    out: Path,
    seed: int | None,
    progress: Callable[[str], None],
) -> Iterator[Added]:
    """What is named, one after the other, then together, as one may make no sense without the others; what has no
    answer is refused in the ledger.

    refused: what was at steps before; what is now is added
    """
    attempts: dict[str, Callable[[int], Trial]] = {
        name: partial(try_effect, model, campaign, library, name, progress=progress)
        for name in by_evidence(diagnosis, refused)
    }
    if len(diagnosis.names) > 1 and diagnosis.verdict != GROUP:
        named = [ranked for ranked in diagnosis.ranking if ranked.name in diagnosis.names]
        every = TOGETHER.join(diagnosis.names)
        attempts[every] = partial(try_together, model, campaign, library, named, progress=progress)
    for name, attempt in attempts.items():
        try:
            trial = attempt(_number(model, campaign, out))
        except WorkbenchError as no_answer:
            _refuse(name, str(no_answer), model, campaign, library, out / LEDGER)
            refused.add(name)
            continue
        added = _decided(trial, model, campaign, library, out, seed, progress, diagnosis)
        if added.step.decision == REFUSED:
            refused.add(name)
        yield added


def _refuse(
    name: str, why: str, model: Model, campaign: Campaign, library: Mapping[str, type[Effect]], path: Path
) -> None:
    """Writes the row of an effect, or of some together, with which the model has no answer."""
    bench = bench_of(model, campaign, library)
    number = len(read_ledger(path, campaign.id, model.base.name).steps)
    if not number:
        append(path, start_step(bench), campaign, model)
    title = TOGETHER.join(library[one].title for one in name.split(TOGETHER))
    refused = replace(step_of(bench, number or 1, REFUSED), effect=name, title=title)
    append(path, replace(refused, reason=f"it cannot be added: {why}"), campaign, model)


def by_evidence(diagnosis: Diagnosis, refused: Collection[str] = ()) -> tuple[str, ...]:
    """The names of a verdict, the one with the most evidence first; then, of those that cannot be told apart, the most
    probable one, and what is likelier there than not: without them what is named may not stand. Of a group the most
    probable one is first: evidence is that of the best explanation with a name in it, which another may have made.

    What ends on a bound of what is possible comes after what may stand for it: its size is not to be believed.
    refused: what was named before and refused by itself; where it is likelier there than not now that others are in the
    model, it is tried again though no name is sure
    """
    alone = {ranked.name: ranked.log_evidence for ranked in diagnosis.ranking}
    probable = {ranked.name: ranked.probability for ranked in diagnosis.ranking}
    held = {ranked.name for ranked in diagnosis.ranking if ranked.at_bound}
    weight = probable if diagnosis.verdict == GROUP else alone
    named = sorted(diagnosis.names, key=lambda name: (name in held, -weight.get(name, 0.0)))
    apart = [min((first, *others), key=held.__contains__) for first, others in diagnosis.alternatives.items()]
    likely = [r.name for r in diagnosis.ranking if r.probability > LIKELY and (named or r.name in refused)]
    return tuple(dict.fromkeys((*named, *apart, *sorted(likely, key=held.__contains__))))
