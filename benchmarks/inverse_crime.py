"""The same cases under the inverse crime: data from the workbench's own model, prior and likelihood.

Only to show how much better that looks. Conditions and declared uncertainties are those of a blind campaign.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from benchmarks.virtual_benches.case import Answer
from effects.base import Effect, InstrumentEffect
from effects.library import Library
from effects.parameter import parameters_of
from workbench.data.table import Campaign, Table
from workbench.models.bases import nominal_model
from workbench.models.model import Model


def committed(campaign: Campaign, library: Library, names: tuple[str, ...], answer: Answer) -> tuple[Campaign, Answer]:
    """The campaign with its readings replaced by the model's, effects ``names`` in it, sizes from their priors."""
    rng = np.random.default_rng([answer.seed, 7])
    model = nominal_model(campaign)
    hidden = [library[name]().at(rng.standard_normal(len(parameters_of(library[name])))) for name in names]
    base = _as_built(model, campaign, library, set(names), rng)
    truth = base
    for effect in hidden:
        truth = truth + effect
    noisy = replace(campaign, tables=tuple(_read(table, truth, rng) for table in campaign.tables))
    sizes = {effect.name(): getattr(effect, next(iter(parameters_of(effect)))) for effect in hidden}
    seen = {effect.name(): _visibility(base, effect, campaign, library) for effect in hidden}
    return noisy, replace(answer, effects=sizes, outside="", visibility=seen)


def _as_built(model: Model, campaign: Campaign, library: Library, hidden: set[str], rng) -> Model:
    for tolerance in campaign.tolerances:
        model = replace(model, design=model.base.with_tolerance(model.design, tolerance, float(rng.standard_normal())))
    for name, sigma in ((s.name, s.sigma) for s in campaign.systematics if s.name not in hidden):
        model = model + _instrument(library, name, sigma * float(rng.standard_normal()))
    return model


def _instrument(library: Library, name: str, value: float) -> InstrumentEffect:
    return library[name](**{next(iter(parameters_of(library[name]))): value})


def _read(table: Table, truth: Model, rng) -> Table:
    answers = truth.answers(table)
    read = {
        name: replace(response, values=answers[name] + response.random * rng.standard_normal(table.rows))
        for name, response in table.responses.items()
    }
    return replace(table, responses=read)


def _visibility(base: Model, effect: Effect, campaign: Campaign, library: Library) -> float:
    """chi2 of the effect in the fitted rows beyond tolerances and instruments, as in ``hiding``."""
    here = _stacked(base, campaign)
    moved = [
        replace(base, design=base.base.with_tolerance(base.design, tolerance, 1.0)) for tolerance in campaign.tolerances
    ]
    have = {e.name() for e in base.effects}
    for systematic in campaign.systematics:
        others = tuple(e for e in base.effects if e.name() != systematic.name)
        old = sum(getattr(e, next(iter(parameters_of(e)))) for e in base.effects if e.name() == systematic.name)
        if systematic.name in have:
            shifted = _instrument(library, systematic.name, old + systematic.sigma)
            moved.append(replace(base, effects=others + (shifted,)))
    slopes = np.stack([_stacked(model, campaign) - here for model in moved], axis=1)
    r = _stacked(base + effect, campaign) - here
    taken = slopes @ np.linalg.solve(np.eye(slopes.shape[1]) + slopes.T @ slopes, slopes.T @ r)
    return float(r @ (r - taken))


def _stacked(model: Model, campaign: Campaign) -> np.ndarray:
    parts = []
    for table in campaign.tables:
        answers, fitted = model.answers(table), ~table.held_out
        parts += [answers[name][fitted] / response.random[fitted] for name, response in table.responses.items()]
    return np.concatenate(parts)
