"""A campaign and a model brought together: rows to fit, rows held out, noise, and the model with fitted tolerances."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from effects.base import Effect
from workbench.believed import PLAIN
from workbench.data.campaign import columns_of_systematics
from workbench.data.repeats import matched_rows, places_of
from workbench.data.robust import WILD
from workbench.data.schema import BY_REGION
from workbench.data.stack import Channel, Stack, part_of, rows_in, stacked, thinned
from workbench.data.table import Campaign, Table
from workbench.errors import WorkbenchError
from workbench.likelihood.conditions import with_conditions
from workbench.likelihood.fit import Fit, Problem, fitted, linearised, refitted, with_parameters
from workbench.likelihood.noise import Noise, measured_noise, noise_on_rows, with_wild_readings
from workbench.likelihood.nuisance import nuisances_of
from workbench.likelihood.own_errors import left_open
from workbench.likelihood.predictor import DirectPredictor, answers_only
from workbench.likelihood.regions import sealed_region
from workbench.likelihood.whitening import Whitener, whitener
from workbench.models.model import Model

MOST_ROWS = 4000  # of a table in a fit; longer tables are thinned, which is said
SHARPENINGS = 3  # times a fit is repeated with a base model expanded about its result
SHARP = 0.3  # change of the objective [nats] that is none
DECIMALS = 4  # of standard normal numbers, to which the place that such a model is expanded about is rounded
WILDEST = 3  # wild readings of a channel that are named
PULLED = 6.0  # standard deviations of a tolerance from where it is declared, which chance does not explain


@dataclass(frozen=True, eq=False)
class Bench:
    """tables: as fitted and scored, thinned where long;  stack, noise, white: of all their rows

    fit: rows that may be fitted;  held_out: rows that may not, None where there are none
    null: the model as it is, tolerances and calibrations at their most probable values
    """

    model: Model
    campaign: Campaign
    stack: Stack
    noise: Noise
    white: Whitener
    fit: Problem
    held_out: Problem | None
    null: Fit
    remarks: tuple[str, ...] = field(default=())

    @property
    def complaints(self) -> tuple[str, ...]:
        """What a reader must know of the readings."""
        return self.remarks + _wildness(self.stack, self.noise)

    @cached_property
    def centre(self) -> Fit:
        """Where effects are compared by linear algebra and where their fits start."""
        return linearised(self.fit, self.fit.start) if _far(self.fit, self.null) else self.null

    @cached_property
    def residual(self) -> np.ndarray:
        """Whitened residual of the rows to fit, carried back to x = 0 by the derivatives: N(0, 1 + J J^T) when all
        is well."""
        return extrapolated(self.centre)


SAME_PLACE = 0.02  # distance over the range of the conditions, within which a sealed row repeats a fitted one


@dataclass(frozen=True, eq=False)
class SealedTables:
    """Tables with their sealed rows marked. words: where the region lies that was sealed here; empty for none"""

    tables: tuple[Table, ...]
    words: str = ""


def sealed_tables(campaign: Campaign) -> SealedTables:
    """The tables of a campaign; where it asks for a region of operating conditions to be sealed, that is done here."""
    if campaign.holdout != BY_REGION:
        return SealedTables(campaign.tables)
    region = sealed_region(campaign.tables)
    return SealedTables(
        tuple(replace(t, held_out=mask) for t, mask in zip(campaign.tables, region.masks)), region.words
    )


def sealed_words(bench: Bench) -> str:
    """What the sealed rows test, for people: prediction where conditions were never fitted, else repeatability."""
    if words := sealed_tables(bench.campaign).words:
        return f"{words}, which was never fitted: prediction beyond the conditions of the fit"
    apart = [_apart(table) for table in bench.stack.tables if table.held_out.any()]
    new = float(np.mean(np.concatenate(apart) > SAME_PLACE)) if apart else 0.0
    if new > 0.5:
        return "conditions that were never fitted: they test prediction"
    return "conditions that were fitted in other repeats: they test repeatability, not prediction"


def _apart(table: Table) -> np.ndarray:
    """Distance of every sealed row from the nearest fitted one, of the range of the conditions (sealed,)."""
    places = places_of(table)
    if table.held_out.all():
        return np.full(table.rows, np.inf)
    return cKDTree(places[~table.held_out]).query(places[table.held_out])[0]


def extrapolated(fit: Fit) -> np.ndarray:
    """Whitened residual of a fit carried back to zero of all its parameters (n,)."""
    return fit.residual + fit.jacobian @ np.concatenate([fit.x, fit.z])


def bench_of(
    model: Model, campaign: Campaign, library: Mapping[str, type[Effect]], most_rows: int = MOST_ROWS, progress=None
) -> Bench:
    """Brings a campaign and a model together and fits the tolerances.

    Raises:
        WorkbenchError: the campaign has nothing that may be fitted, or declares what the model does not know.
    """
    sealed = sealed_tables(campaign)
    tables = tuple(thinned(table, most_rows) for table in sealed.tables)
    predictor = predictor_of(model, campaign, library, stacked(tables), progress).answering()
    stack = predictor.stack
    here = predictor.predict(predictor.start)
    u = with_conditions(predictor.model_at(predictor.start), stack, here)
    stack = replace(stack, u=u, left_open=left_open(predictor.model, stack))
    chosen = _chosen(tables)
    if not any(mask.any() for mask in chosen):
        raise WorkbenchError(f"{campaign.folder}: every row is held out; leave some rows for the fit.")
    noise = _noise_at(stack, chosen, here)
    drawn = _problem(predictor, stack, noise, chosen)
    first = fitted(drawn, (), predictor.start, np.zeros(0))
    noise = _noise_at(stack, chosen, predictor.predict(first.x))
    drawn = _problem(predictor, stack, noise, chosen)
    fit, null = _where_it_can_be(drawn, refitted(drawn, first))
    held_out = _held_out(fit.predictor, stack, noise, chosen)
    remarks = campaign.complaints + _thinning(campaign.tables, tables) + _untested(campaign, tables)
    white = whitener(stack, noise)
    return Bench(fit.predictor.model, campaign, stack, noise, white, fit, held_out, null, remarks)


def reweighed(bench: Bench, predicted: np.ndarray) -> Bench:
    """The bench with its wild readings told by a model that explains the others; the same one where the rows to fit are
    not plainly likelier so.

    A model that lacks an effect larger than a wild reading takes the good one of two for it.

    predicted: all readings by that model (n,)
    """
    chosen = _chosen(bench.stack.tables)
    noise = _noise_at(bench.stack, chosen, predicted)
    fit = _problem(bench.fit.predictor, bench.stack, noise, chosen)
    residual = (bench.stack.y - predicted)[rows_in(bench.stack, chosen)]
    if _log_likelihood(fit, residual) < _log_likelihood(bench.fit, residual) + PLAIN:
        return bench
    held_out = _held_out(fit.predictor, bench.stack, noise, chosen)
    white, null = whitener(bench.stack, noise), refitted(fit, bench.null)
    return replace(bench, noise=noise, white=white, fit=fit, held_out=held_out, null=null)


def _log_likelihood(problem: Problem, residual: np.ndarray) -> float:
    """ln p of readings less prediction (n,), up to what any sizes of the noise share [nats]."""
    white = problem.white
    sizes = float(np.log(white.sigma).sum()) + sum(law.half_log_det for law in white.laws)
    return -problem.misfit(white(residual)) - sizes


def _chosen(tables: Sequence[Table]) -> list[np.ndarray]:
    """Rows of every table that may be fitted."""
    return [~table.held_out for table in tables]


def _held_out(predictor: DirectPredictor, stack: Stack, noise: Noise, chosen: Sequence[np.ndarray]) -> Problem | None:
    hidden = [~mask for mask in chosen]
    return _problem(predictor, stack, noise, hidden) if any(mask.any() for mask in hidden) else None


def _noise_at(stack: Stack, chosen: Sequence[np.ndarray], predicted: np.ndarray) -> Noise:
    """Size and correlation of the noise from what all repeats disagree by, the sealed ones too; which readings are wild
    is asked of fitted and of sealed rows apart, and of all where only one repeat is fitted. predicted: readings (n,)"""
    whole = measured_noise(stack, predicted)
    inflation = whole.inflation.copy()
    for masks in (chosen, [~mask for mask in chosen]):
        part, rows = part_of(stack, masks), rows_in(stack, masks)
        found = with_wild_readings(whole.channels, part, predicted[rows]).inflation
        repeated = np.repeat([matched_rows(part.tables[c.table]) is not None for c in part.channels], _sizes(part))
        inflation[rows] = np.where(repeated, found, inflation[rows])
    return Noise(whole.channels, inflation)


def _sizes(stack: Stack) -> list[int]:
    """Rows of every channel."""
    return [channel.size for channel in stack.channels]


def _far(fit: Problem, null: Fit) -> bool:
    """Whether something that is missing has pulled a tolerance so far that an expansion about there is of no use: with
    the effect in the model the device is near the drawing again."""
    if not fit.predictor.model.base.is_expansion:
        return False
    return bool(np.abs(null.x - fit.start).max(initial=0.0) > PULLED)


def _where_it_can_be(drawn: Problem, null: Fit) -> tuple[Problem, Fit]:
    """Sharpened, unless what is missing has pulled the tolerances to a device that is far off or cannot be."""
    try:
        fit, sharp = sharpened(drawn, null)
    except WorkbenchError:
        return drawn, null
    return drawn if _far(fit, sharp) else fit, sharp


def sharpened(problem: Problem, fit: Fit) -> tuple[Problem, Fit]:
    """The fit again with a base model that is exact where it ended, for base models that answer by an expansion. Its
    slopes are taken anew: those of an expansion far off promised 0.01 nats where 1.9 were to be had.

    Raises:
        WorkbenchError: there can be no such device.
    """
    for _ in range(SHARPENINGS):
        model = problem.predictor.model
        if not model.base.is_expansion:
            break
        there = problem.predictor.model_at(*_place_of(fit))
        rows = (table for table in problem.stack.tables if table.rows)
        tables = [replace(table, conditions=there.true_conditions(table)) for table in rows]
        with answers_only():
            base = model.base.recentred(there.design_as_built, tables)
        predictor = replace(problem.predictor, model=replace(model, base=base))
        problem, before = replace(problem, predictor=predictor), fit.objective
        fit = fitted(problem, fit.effects, fit.x, fit.z)
        if abs(before - fit.objective) < SHARP:
            break
    return problem, fit


def _place_of(fit: Fit) -> tuple[np.ndarray, tuple[Effect, ...]]:
    """Where a fit ended, nuisances and effects, rounded to what is no distance to an expansion: what was solved for one
    that ended a rounding away is found again."""
    return np.round(fit.x, DECIMALS), with_parameters(fit.effects, np.round(fit.z, DECIMALS))


def predictor_of(
    model: Model, campaign: Campaign, library: Mapping[str, type[Effect]], stack: Stack, progress=None
) -> DirectPredictor:
    """The predictor of a stack; a base model that can prepare itself for these rows does so."""
    model = replace(model, base=model.base.prepared(model.design, stack.tables, progress))
    declared = columns_of_systematics(campaign.folder)
    known = replace(campaign, tolerances=campaign.tolerances + model.base.own_tolerances(model.design))
    return DirectPredictor(model, nuisances_of(known, library, declared), stack)


def _problem(predictor: DirectPredictor, stack: Stack, noise: Noise, chosen: Sequence[np.ndarray]) -> Problem:
    part = part_of(stack, chosen)
    white = whitener(part, noise_on_rows(noise, stack, chosen))
    dof = np.array([channel.dof for channel in noise.channels])
    return Problem(predictor.on(part), part, white, dof, predictor.start)


def _thinning(tables: Sequence[Table], used: Sequence[Table]) -> tuple[str, ...]:
    return tuple(
        f"{long.file}: {short.rows} of {long.rows} rows take part in the fits; small effects are seen less well"
        for long, short in zip(tables, used)
        if short.rows < long.rows
    )


def _untested(campaign: Campaign, tables: Sequence[Table]) -> tuple[str, ...]:
    if any(table.held_out.any() for table in tables):
        return ()
    why = " (no condition but an angle has settings enough)" if campaign.holdout == BY_REGION else ""
    return (f"no row is sealed{why}: prediction beyond the conditions of the fit was not tested",)


def _wildness(stack: Stack, noise: Noise) -> tuple[str, ...]:
    """The wildest readings of every channel, where they stand, and how many more there are."""
    counts = zip(stack.channels, (found.wild for found in noise.channels))
    return tuple(words for channel, count in counts for words in _wild(stack, noise, channel, count))


def _wild(stack: Stack, noise: Noise, channel: Channel, count: int) -> list[str]:
    table, off = stack.tables[channel.table], noise.inflation[channel.rows]
    read = stack.y[channel.rows] / channel.scale
    places = table.lines if len(table.lines) else np.arange(1, table.rows + 1)
    said = [
        f"{table.file}: {channel.response} in line {places[row]}, repeat {table.repeat[row]} ({read[row]:.5g} "
        f"{channel.unit}), is off its repeats by {off[row] * WILD:.0f} standard deviations and counts less"
        for row in np.argsort(-off, kind="stable")[: min(count, WILDEST)]
    ]
    left = [f"{table.file}: {count - WILDEST} more readings of {channel.response} are wild and count less"]
    return said + left * (count > WILDEST)
