"""Does a model file hold on data that it was not learned from? Nothing of the device is fitted again.

Only what the new instruments declare as their own calibration moves. The same is asked of the device as drawn.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import ndtri

from effects.base import Effect, InstrumentEffect
from workbench.data.campaign import columns_of_systematics
from workbench.data.column_units import for_people, unit_inside
from workbench.data.kinds import KINDS
from workbench.data.stack import Channel, stacked, thinned
from workbench.data.table import Campaign, Table
from workbench.errors import WorkbenchError
from workbench.explain.conventions import settle
from workbench.findings import Axis, PredictedChannel, Pull, ValidatedChannel, Validation
from workbench.ledger.applied import Known, Prediction, as_drawn, corrected, predicted, readings
from workbench.ledger.learned import Learned, LearnedRange, Source, outside
from workbench.likelihood.bench import MOST_ROWS
from workbench.likelihood.nuisance import Nuisance, nuisances_of
from workbench.models.bases import model_of_device
from workbench.models.model import Model

HALF_90 = float(ndtri(0.95))  # half width of a 90 % band in standard deviations
LEVELS = 10  # different values up to which a condition tells series apart


def validate(
    learned: Learned,
    campaign: Campaign,
    library: Mapping[str, type[Effect]],
    progress: Callable[[str], None] = lambda words: None,
    nominal: Model | None = None,
) -> Validation:
    """Predicts all rows of a campaign, held out or not, by what a model file holds.

    nominal: the device as drawn, from the ``[device]`` table of the file where it is not given

    Raises:
        WorkbenchError: the file has no fitted inputs, or the model cannot answer the tables.
    """
    source = _source(learned)
    drawn = model_of_device(learned.device, f"the model file of {source.campaign}") if nominal is None else nominal
    read_otherwise = _other_conventions(drawn, campaign, progress)
    tables = tuple(thinned(table, MOST_ROWS) for table in campaign.tables)
    progress("preparing the model for these rows")
    drawn = replace(drawn, base=drawn.base.prepared(drawn.design, tables, progress))
    errors = _calibrations(campaign, library)
    progress("predicting")
    best = predicted(_answering(corrected(learned, drawn).exact(), tables), errors, tables)
    base = predicted(as_drawn(learned, drawn), errors, tables)
    left = [_left(table, source) for table in tables]
    return Validation(
        campaign=campaign.id,
        model=learned.base,
        learned_from=source.campaign,
        effects=tuple(effect.name() for effect in learned.effects),
        corrected=_scores(best, left),
        base=_scores(base, left),
        predictions=tuple(_picture(best, base, c, left[c.table]) for c in best.stack.channels),
        calibrations=tuple(map(_pull, errors, best.calibration)),
        base_calibrations=tuple(map(_pull, errors, base.calibration)),
        range_left=tuple(words for one in left for words in one.words),
        complaints=(*read_otherwise, *_limits(learned, source, campaign, tables)),
        provenance=dict(campaign.file_hashes),
    )


def _source(learned: Learned) -> Source:
    if learned.source is None:
        raise WorkbenchError(
            "the model file holds effects but no fitted inputs, so it cannot be applied to other data: run "
            "`airgap ledger` on its campaign once more, with it as --model, and it will."
        )
    return learned.source


def _calibrations(campaign: Campaign, library: Mapping[str, type[Effect]]) -> tuple[Nuisance, ...]:
    return nuisances_of(replace(campaign, tolerances=()), library, columns_of_systematics(campaign.folder))


def _answering(known: Known, tables: Sequence[Table]) -> Known:
    """The same; the model's own sentence where it answers no row of a table, for example of a kind unknown to it."""
    model = known.model_at(np.zeros(known.size))
    for table in tables:
        if not np.isfinite(readings(model, stacked([table]))).any():
            model.answers(table)
    return known


# ---- errors ---------------------------------------------------------------------------------------------------------


def _scores(p: Prediction, left: Sequence[Left]) -> tuple[ValidatedChannel, ...]:
    return tuple(_score(p, channel, left[channel.table].rows) for channel in p.stack.channels)


def _score(p: Prediction, channel: Channel, beyond: np.ndarray) -> ValidatedChannel:
    rows = channel.rows
    error = (p.stack.y[rows] - p.reading[rows]) / channel.scale
    inside = np.abs(error) <= HALF_90 * p.sd[rows] / channel.scale  # False where there is no prediction
    squares = p.whitened[rows] ** 2
    some = bool(beyond.any())
    return ValidatedChannel(
        channel=channel.name,
        unit=channel.unit,
        n=channel.size,
        rms_error=_rms(error),
        bias=_mean(error),
        chi2_per_n=_mean(squares),
        share_in_90=float(inside.mean()),
        outside_range=float(beyond.mean()),
        no_answer=int(np.isnan(error).sum()),
        outside_rms_error=_rms(error[beyond]) if some else None,
        outside_chi2_per_n=_mean(squares[beyond]) if some else None,
        outside_share_in_90=float(inside[beyond].mean()) if some else None,
    )


def _mean(values: np.ndarray) -> float:
    """Of the rows with a prediction; NaN where there is none."""
    known = values[np.isfinite(values)]
    return float(known.mean()) if known.size else float("nan")


def _rms(values: np.ndarray) -> float:
    return float(np.sqrt(_mean(values**2)))


def _pull(error: Nuisance, z: float) -> Pull:
    systematic = error.systematic
    unit = "relative" if systematic.kind == "gain" else unit_inside(systematic.name)
    return Pull(systematic.name, float(z), systematic.sigma, unit, "instrument")


def _picture(best: Prediction, base: Prediction, channel: Channel, left: Left) -> PredictedChannel:
    rows, table = channel.rows, best.stack.tables[channel.table]
    names = _varying(table)
    axis, factor = (
        (Axis("row"), 1.0) if not names else (Axis(names[0], for_people(names[0])[0]), for_people(names[0])[1])
    )
    x = table.conditions[names[0]] if names else np.arange(table.rows, dtype=float)
    scaled = lambda values: values[rows] / channel.scale  # noqa: E731
    return PredictedChannel(
        channel.name, channel.unit, axis, factor * x, _series(table, names[1:]), scaled(best.stack.y),
        scaled(best.reading), HALF_90 * scaled(best.sd), scaled(base.reading), HALF_90 * scaled(base.sd), left.rows,
    )  # fmt: skip


def _varying(table: Table) -> list[str]:
    """Conditions that vary by more than a reading scatters, natural axes of the kind first."""
    axes = KINDS[table.kind].axes
    names = [name for name, v in table.conditions.items() if np.ptp(v) > 0]
    return sorted(names, key=lambda n: (axes.index(n) if n in axes else len(axes), names.index(n)))


def _series(table: Table, names: Sequence[str]) -> tuple[str, ...]:
    """Label of each row by the first condition that is set in levels; empty where there is none."""
    for name in names:
        values = np.round(table.conditions[name], 9)
        if len(np.unique(values)) <= LEVELS:
            unit, factor = for_people(name)
            return tuple(f"{name} {factor * v:.4g} {unit}".strip() for v in values)
    return ("",) * table.rows


# ---- where the learned range is left --------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class Left:
    """Rows of a table beyond the learned conditions (n,), and in words by which of them."""

    rows: np.ndarray
    words: tuple[str, ...]


def _left(table: Table, source: Source) -> Left:
    """A kind that was not learned from is judged by what all others were learned at; what none of them had as a
    condition is said, but says nothing of single rows."""
    kinds = {r.kind for r in source.ranges}
    ranges = [r for r in source.ranges if r.kind == table.kind] or source.ranges
    rows, words = np.zeros(table.rows, dtype=bool), []
    if table.kind not in kinds:
        words.append(f"{table.file}: no table of kind {table.kind} was learned from, only {', '.join(sorted(kinds))}.")
    for name, values in table.conditions.items():
        beyond = _beyond(name, values, ranges)
        words += [_words(table, name, beyond, ranges)] if beyond.any() else []
        if table.kind in kinds or _spans(name, ranges):
            rows |= beyond
    return Left(rows, tuple(words))


def _beyond(name: str, values: np.ndarray, ranges: Sequence[LearnedRange]) -> np.ndarray:
    """True where a condition lies in none of the ranges that have it; everywhere where none has it (n,)."""
    beyond = np.ones(len(values), dtype=bool)
    for learned in _spans(name, ranges):
        beyond &= outside(name, values, learned)
    return beyond


def _spans(name: str, ranges: Sequence[LearnedRange]) -> list[tuple[float, float]]:
    return list(dict.fromkeys(r.conditions[name] for r in ranges if name in r.conditions))


def _words(table: Table, name: str, beyond: np.ndarray, ranges: Sequence[LearnedRange]) -> str:
    unit, factor = for_people(name)
    text = lambda low, high: f"{factor * low:.4g} to {factor * high:.4g} {unit}".strip()  # noqa: E731
    values, spans = table.conditions[name], _spans(name, ranges)
    where = f"{table.file}: {name} is {text(values.min(), values.max())}"
    if not spans:
        return f"{where}; the learned campaign did not have it as a condition."
    learned = " and ".join(text(*span) for span in spans)
    return f"{where}, learned at {learned}: {int(beyond.sum())} of {table.rows} rows lie beyond."


# ---- what limits the conclusions ------------------------------------------------------------------------------------


def _other_conventions(drawn: Model, campaign: Campaign, progress: Callable[[str], None]) -> tuple[str, ...]:
    """What the columns look like instead of what is said of them: a calibration would take it up without a word."""
    settled = settle(drawn, campaign, progress)
    if settled.are_right:
        return ()
    return (*settled.sentences, f"`airgap diagnose` of {campaign.id} prints the text for its campaign.toml.")


def _limits(learned: Learned, source: Source, campaign: Campaign, used: Sequence[Table]) -> tuple[str, ...]:
    return (
        *_other_device(learned, campaign),
        *_seen_before(source, campaign),
        *campaign.complaints,
        *_other_tolerances(learned, campaign),
        *_old_instruments(learned),
        *_thinned(campaign.tables, used),
    )


def _seen_before(source: Source, campaign: Campaign) -> list[str]:
    known = set(source.data_sha256.values())
    return [
        f"{file}: the model was learned from this very file; it is no test of it"
        for file, digest in campaign.file_hashes.items()
        if digest in known
    ]


def _other_device(learned: Learned, campaign: Campaign) -> list[str]:
    """Numbers of ``[device]`` that differ; texts are for people."""
    here, there = campaign.device, learned.device
    differ = [key for key in dict.fromkeys((*there, *here)) if here.get(key) != there.get(key)]
    numbers = [key for key in differ if not isinstance(here.get(key, there.get(key)), str)]
    if not here or not numbers:
        return []
    said = ", ".join(f"{key} {here.get(key, 'not given')} instead of {there.get(key, 'not given')}" for key in numbers)
    return [f"[device] of {campaign.id} is another one ({said}); the one of the model file is used"]


def _other_tolerances(learned: Learned, campaign: Campaign) -> list[str]:
    known = {x.name for x in learned.inputs}
    new = [t.name for t in campaign.tolerances if t.name not in known]
    return [f"[tolerance] {name}: is no fitted input of the model file and stays as drawn" for name in new]


def _old_instruments(learned: Learned) -> list[str]:
    return [
        f"{effect.name()} is an error of an instrument of {learned.source.campaign}; the prediction is right only if "
        "the same instrument was used here"
        for effect in learned.effects
        if isinstance(effect, InstrumentEffect)
    ]


def _thinned(tables: Sequence[Table], used: Sequence[Table]) -> list[str]:
    return [
        f"{long.file}: {short.rows} of {long.rows} rows are predicted"
        for long, short in zip(tables, used)
        if short.rows < long.rows
    ]
