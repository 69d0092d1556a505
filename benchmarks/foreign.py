"""Whether a truth is outside the library that is installed: what the best of its effects leaves of it.

A truth that no effect described when it was written may be described by a later one. So each is held against every
effect of the library as it is, of any size and with other values of its further parameters, beside tolerances,
instruments and the scatter of mounting.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from benchmarks.virtual_benches.hiding import FREE
from benchmarks.virtual_benches.instruments import scan_shapes
from effects.base import Effect
from effects.library import Library
from effects.parameter import parameters_of
from workbench.data.table import Campaign
from workbench.errors import WorkbenchError
from workbench.models.bases import nominal_model
from workbench.models.model import Model

ASIDE = (-1.0, 1.0)  # standard deviations of its prior at which a further parameter is tried besides its middle


@dataclass(frozen=True)
class Left:
    """chi2 that the best effect of the library leaves of a truth, and which effect that is."""

    chi2: float
    best: str


def left_by_library(without: Campaign, changed: Campaign, library: Library, about: Mapping[str, float]) -> Left:
    """How much of the change from one campaign to the other the library cannot describe.

    without, changed: the same rows free of random error, one repeat;  about: "declared", "remount" and "fitted", the
    number of fitted repeats
    """
    weight = np.sqrt(about["fitted"]) / about["declared"]
    r = weight * (_readings(changed) - _readings(without))
    model = nominal_model(without)
    fixed = np.hstack([weight * _declared(model, without, library), _mounting(without, about)])
    kept = {
        name: _chi2(r, np.hstack([fixed, _free(model, signatures, without)]))
        for name, signatures in _tried(model, library)
    }
    best = min(kept, key=kept.get)
    return Left(kept[best], best)


def _readings(campaign: Campaign) -> np.ndarray:
    """All readings over their declared uncertainty."""
    return np.concatenate([r.values / r.random for table in campaign.tables for r in table.responses.values()])


def _answers(model: Model, campaign: Campaign) -> np.ndarray:
    parts = []
    for table in campaign.tables:
        answers = model.answers(table)
        parts += [answers[name] / response.random for name, response in table.responses.items()]
    return np.concatenate(parts)


def _declared(model: Model, campaign: Campaign, library: Library) -> np.ndarray:
    """One standard deviation of every tolerance and of every instrument (n, columns)."""
    here = _answers(model, campaign)
    tolerances = (*campaign.tolerances, *model.base.own_tolerances(model.design))
    moved = [replace(model, design=model.base.with_tolerance(model.design, t, 1.0)) for t in tolerances]
    for systematic in campaign.systematics:
        size = next(iter(parameters_of(library[systematic.name])))
        moved.append(model + library[systematic.name](**{size: systematic.sigma}))
    return np.stack([_answers(one, campaign) - here for one in moved], axis=1)


def _mounting(campaign: Campaign, about: Mapping[str, float]) -> np.ndarray:
    """Offset and slope of the mean scan of every channel (n, columns)."""
    sizes = [r.random for table in campaign.tables for r in table.responses.values()]
    n, row, columns = sum(map(len, sizes)), 0, []
    for u in sizes if about["remount"] else ():
        for shape in (scan_shapes(u) / u[:, None] * about["remount"] / about["declared"]).T:
            columns.append(np.concatenate([np.zeros(row), shape, np.zeros(n - row - len(u))]))
        row += len(u)
    return np.stack(columns, axis=1) if columns else np.zeros((n, 0))


def _tried(model: Model, library: Library) -> Iterator[tuple[str, list[Effect]]]:
    """Every effect that can act on the device, with its further parameters at several values."""
    for name, effect in library.items():
        if effect.can_act_on(model.design):
            for variant in effect.variants(model.design):
                yield name, _forms(variant)


def _forms(effect: Effect) -> list[Effect]:
    count = len(parameters_of(effect))
    middle = np.zeros(count)
    middle[0] = 1.0
    forms = [effect.at(middle)]
    for k in range(1, count):
        for z in ASIDE:
            forms.append(effect.at(np.where(np.arange(count) == k, z, middle)))
    return forms


def _free(model: Model, forms: list[Effect], campaign: Campaign) -> np.ndarray:
    """What an effect does, of any size (n, forms); nothing where it cannot be answered for."""
    here, columns = _answers(model, campaign), []
    for effect in forms:
        try:
            column = _answers(model + effect, campaign) - here
        except WorkbenchError:
            continue
        columns.append(FREE * column / max(np.linalg.norm(column), 1e-9))
    return np.stack(columns, axis=1) if columns else np.zeros((len(here), 0))


def _chi2(r: np.ndarray, columns: np.ndarray) -> float:
    taken = np.linalg.solve(np.eye(columns.shape[1]) + columns.T @ columns, columns.T @ r)
    return float(r @ (r - columns @ taken))
