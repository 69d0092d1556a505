"""What every effect would do to the readings, on a grid over the sizes that are believed possible.

One set of signatures, about the centre of a bench, serves the search, the simulated campaigns, the detection limits and
the short list of shapes; beside fits of large effects the search takes its own.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property
from itertools import product
from math import log

import numpy as np
from scipy.special import stdtr

from effects.base import Effect
from effects.parameter import parameters_of
from workbench.believed import TAILS
from workbench.errors import WorkbenchError
from workbench.likelihood.bench import Bench
from workbench.likelihood.marginal import Carried, Catalogue, Term, Terms
from workbench.likelihood.predictor import Predictor
from workbench.likelihood.unknown_laws import LAWS
from workbench.likelihood.whitening import Whitener

# cells an axis and half-width of the grid [standard deviations] by number of parameters
_GRIDS = {1: (9, 4.5), 2: (5, 3.5), 3: (4, 3.0), 4: (3, 2.4)}
_BELL = 1 / np.sqrt(2 * np.pi)  # standard deviation over width of a bell as high as the box it stands for
MOST_WEIGHT = 1e3  # of a column that does nothing
UNSEEN = 0.05  # length of a whitened signature below which an effect does nothing to these data

Progress = Callable[[str], None]


@dataclass(frozen=True, eq=False)
class Signature:
    """One effect (variant) on its grid.

    z: grid points (K, k);  change: of the readings, SI (n, K)
    log_prior: ln of the prior mass of each cell (K,);  width: of a cell along each axis
    """

    effect: Effect
    z: np.ndarray
    change: np.ndarray
    log_prior: np.ndarray
    width: float

    @property
    def tangents(self) -> np.ndarray:
        """d change / dz (k, n, K), worked out when asked for: kept, they would be larger than the changes."""
        possible, shape = np.isfinite(self.log_prior), self._shape
        return np.array([_tangent(self.change, possible, shape, a, self.width) for a in range(len(shape))])

    @property
    def _shape(self) -> tuple[int, ...]:
        """Of the grid."""
        return grid(self.z.shape[1])[2]

    @property
    def term_columns(self) -> int:
        """Of all its terms, shifts included."""
        return int(np.isfinite(self.log_prior).sum()) * (1 + self.z.shape[1])

    @property
    def name(self) -> str:
        return self.effect.name()

    def terms(self, white: Whitener, variant: int, share: float) -> Iterable[Term]:
        """A term for every place of the grid that has an answer. share: ln of the prior of this variant"""
        s = white(self.change)
        tangents = np.stack([white(t) for t in self.tangents]) * (_BELL * self.width)
        reach = np.stack([self._reach(s, tangents[a], a) for a in range(len(tangents))])
        for k in np.flatnonzero(np.isfinite(self.log_prior)):
            prior = float(self.log_prior[k]) + share
            yield Term(self.name, s[:, k], tangents[:, :, k].T, prior, reach[:, :, k], variant, int(k))

    def _reach(self, s: np.ndarray, column: np.ndarray, axis: int) -> np.ndarray:
        """Weights of a column at which a place becomes its neighbour below and above, at an end of the grid nothing at
        all (2, K). s: whitened changes;  column: of this axis, whitened (n, K)"""
        shape = self._shape
        on_grid = np.moveaxis(s.reshape((len(s),) + shape), 1 + axis, -1)
        known = np.moveaxis(np.isfinite(self.log_prior).reshape(shape), axis, -1)
        steps = np.linalg.norm(np.diff(on_grid, axis=-1), axis=0)
        both = known[..., 1:] & known[..., :-1]
        apart = np.repeat(np.linalg.norm(on_grid, axis=0)[None], 2, axis=0)
        apart[0, ..., 1:] = np.where(both, steps, apart[0, ..., 1:])
        apart[1, ..., :-1] = np.where(both, steps, apart[1, ..., :-1])
        lengths = np.linalg.norm(column, axis=0)
        weights = np.moveaxis(apart, -1, 1 + axis).reshape(2, -1) / np.maximum(lengths, 1e-200)
        return np.minimum(weights, MOST_WEIGHT) * np.array([[-1.0], [1.0]])

    def nearest(self, target: np.ndarray, shifts: np.ndarray, white: Whitener) -> tuple[np.ndarray, Effect, np.ndarray]:
        """What is left of a change of the readings by the most like one that the effect makes, whitened (n,); the
        effect, and its z there.

        target: the change, whitened (n,);  shifts: those of the effect, whitened (n, K);  white: that did it
        """
        away = np.linalg.norm(target[:, None] - shifts, axis=0)
        place = int(np.argmin(np.where(np.isfinite(self.log_prior), away, np.inf)))
        left, slopes = target - shifts[:, place], self._slopes(place, white)
        step = np.clip(np.linalg.lstsq(slopes, left, rcond=None)[0], -self.width / 2, self.width / 2)
        return left - slopes @ step, self.effect, self.z[place] + step

    def straight(self, target: np.ndarray, white: Whitener) -> tuple[np.ndarray, np.ndarray]:
        """What is left of a change of the readings, whitened (n,), by the effect as a straight line about the middle of
        its grid, however long; its z at the end of the line."""
        away = np.where(np.isfinite(self.log_prior), np.linalg.norm(self.z, axis=1), np.inf)
        place = int(np.argmin(away))
        slopes = self._slopes(place, white)
        step = np.linalg.lstsq(slopes, target, rcond=None)[0]
        return target - slopes @ step, self.z[place] + step

    def _slopes(self, place: int, white: Whitener) -> np.ndarray:
        """d change / dz at a place, whitened (n, k)."""
        return white(self.tangents[:, :, place].T)

    def at(self, place: int, weights: np.ndarray) -> np.ndarray:
        """z (k,) of a place of the grid moved by the weights of its columns."""
        return self.z[place] + _BELL * self.width * weights


def grid(k: int) -> tuple[np.ndarray, float, tuple[int, ...]]:
    """Grid points (K, k), width of a cell and shape of the grid for k parameters.

    Raises:
        WorkbenchError: more parameters than a grid can hold.
    """
    if k not in _GRIDS:
        raise WorkbenchError(
            f"an effect must have one to {max(_GRIDS)} parameters, found {k}: fix some or split it in two"
        )
    cells, half = _GRIDS[k]
    width = 2 * half / cells
    axis = -half + width * (np.arange(cells) + 0.5)
    return np.array(list(product(axis, repeat=k))), width, (cells,) * k


def signature(effect: Effect, change: Callable[[Effect], np.ndarray]) -> Signature:
    """The signature of an effect; ``change(effect)`` is the change of the readings, SI (n,)."""
    k = len(parameters_of(effect))
    z, width, _ = grid(k)
    changes, possible = _changes(effect, z, change)
    below, above = (stdtr(TAILS, z + side * width / 2) for side in (-1, 1))
    masses = np.log(above - below).sum(axis=1)
    masses = np.where(possible, masses, -np.inf)
    return Signature(effect, z, changes, masses - np.logaddexp.reduce(masses), width)


def _tangent(s: np.ndarray, possible: np.ndarray, shape: tuple[int, ...], axis: int, width: float) -> np.ndarray:
    """ds/dz along one axis (n, K): the mean slope to the neighbours, of those only that have an answer."""
    on_grid = np.moveaxis(s.reshape((len(s),) + shape), 1 + axis, -1)
    known = np.moveaxis(possible.reshape(shape), axis, -1)
    both = known[..., 1:] & known[..., :-1]
    slopes, total = np.where(both, np.diff(on_grid, axis=-1) / width, 0.0), np.zeros_like(on_grid)
    count = np.zeros(known.shape)
    for side in (slice(None, -1), slice(1, None)):
        total[..., side] += slopes
        count[..., side] += both
    return np.moveaxis(total / np.maximum(count, 1.0), -1, 1 + axis).reshape(s.shape)


def _changes(effect: Effect, z: np.ndarray, change: Callable[[Effect], np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Changes (n, K), and where the model has an answer (K,); at least one place must have one."""
    found: list[np.ndarray | None] = []
    error: WorkbenchError | None = None
    for point in z:
        try:
            found.append(change(effect.at(point)))
        except WorkbenchError as no_answer:
            found.append(None)
            error = no_answer
    possible = np.array([s is not None for s in found])
    if error is not None and not possible.any():
        raise error
    nothing = np.zeros_like(next(s for s in found if s is not None))
    return np.array([nothing if s is None else s for s in found]).T, possible


@dataclass(frozen=True, eq=False)
class Signatures:
    """Of all effects that do something to the readings.

    failed: why others could not be had, by name;  white: without the errors of the effects' own laws
    slopes: d readings / d x where they were made, SI (n, m)
    """

    found: Mapping[str, tuple[Signature, ...]]
    failed: Mapping[str, str]
    white: Whitener
    slopes: np.ndarray

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(self.found)

    @property
    def effects(self) -> dict[str, tuple[Signature, ...]]:
        """Those of the library, without the unknown laws."""
        return {name: variants for name, variants in self.found.items() if name not in LAWS}

    @cached_property
    def terms(self) -> Terms:
        """Of all effects in all their forms."""
        every = [(s, k, len(variants)) for variants in self.found.values() for k, s in enumerate(variants)]
        terms = (term for s, k, count in every for term in s.terms(self.white, k, -log(count)))
        return Terms.in_one(terms, len(self.white.sigma), sum(s.term_columns for s, _, _ in every))

    @cached_property
    def _shares(self) -> np.ndarray:
        """Of tolerances in the columns of all terms (m, Q): what they would be pulled by to do the same."""
        could = self.white(self.slopes)
        return np.linalg.solve(np.eye(could.shape[1]) + could.T @ could, could.T @ self.terms.columns)

    def beside(self, predictor: Predictor, x: np.ndarray, effects: Sequence[Effect], slopes: np.ndarray) -> Signatures:
        """The same at nuisances x (m,), with d readings / d x (n, m), and beside effects that are there, of these each
        beside the others."""
        without = cache(lambda others: predictor.predict(x, others))

        def again(before: Signature) -> Signature:
            others = tuple(effect for effect in effects if effect.name() != before.name)
            try:
                return signature(before.effect, lambda e: predictor.predict(x, (*others, e)) - without(others))
            except (WorkbenchError, ArithmeticError, ValueError):  # the model has no answer there: as it was
                return before

        return replace(self, found={n: tuple(map(again, forms)) for n, forms in self.found.items()}, slopes=slopes)

    def catalogue(self, background: np.ndarray, white: Whitener) -> Catalogue:
        """The catalogue where they were made, beside a background that was whitened so (n, m)."""
        return Catalogue(background, self.terms, white.beyond(self.white))

    def catalogue_at(
        self, slopes: np.ndarray, background: np.ndarray, white: Whitener, without: Iterable[str]
    ) -> Catalogue:
        """The same of all effects but some, where d readings / d x, SI (n, m), is another."""
        change = self.white(slopes - self.slopes)
        moved = change.any(axis=0)  # shapes of the meshes' error stay
        carried = Carried(change[:, moved], self._shares[moved])
        return Catalogue(background, self.terms, white.beyond(self.white), frozenset(without), carried)


def signatures_of(bench: Bench, effects: Iterable[Effect], progress: Progress = lambda words: None) -> Signatures:
    """Signatures of effects (all their variants) about the centre of a bench."""
    predictor, x = bench.fit.predictor, bench.centre.x
    base = predictor.predict(x)
    change = lambda effect: predictor.predict(x, (effect,)) - base  # noqa: E731
    found: dict[str, list[Signature]] = {}
    failed: dict[str, str] = {}
    for effect in effects:
        progress(f"signature of {effect.name()}")
        try:
            found.setdefault(effect.name(), []).append(signature(effect, change))
        except (WorkbenchError, ArithmeticError, ValueError) as error:
            failed[effect.name()] = str(error)
    seen = {n: tuple(v) for n, v in found.items() if any(_is_seen(bench, s) for s in v)}
    failed = {n: why for n, why in failed.items() if n not in found}  # another form of it has an answer
    failed |= {n: "it changes nothing in these data" for n in found if n not in seen}
    return Signatures(seen, failed, bench.fit.white, bench.centre.slopes)


def _is_seen(bench: Bench, signature: Signature) -> bool:
    return bool(np.sqrt(np.sum(bench.fit.white(signature.change) ** 2, axis=0)).max(initial=0.0) > UNSEEN)


def candidates(bench: Bench, library: Mapping[str, type[Effect]]) -> tuple[Effect, ...]:
    """Effects (all variants) that can act on the device and are not in the model yet."""
    model = bench.model
    have = set(model.names)
    within = {name for effect in model.effects for name in effect.contains}
    return tuple(
        variant
        for name, cls in library.items()
        if name not in have and name not in within and cls.can_act_on(model.design)
        for variant in cls.variants(model.design)
    )


def nearest(bench: Bench, signatures: Signatures, count: int = 5) -> dict[str, float]:
    """Effect -> largest cosine of what it does with the residual of the null, both freed of what tolerances explain."""
    jacobian, white = bench.centre.jacobian, bench.fit.white
    u, size, _ = np.linalg.svd(jacobian, full_matrices=False)
    shrink = (1 - 1 / np.sqrt(1 + size**2))[:, None]
    free = lambda v: v - u @ (shrink * (u.T @ v))  # noqa: E731
    target = free(bench.residual[:, None])[:, 0]
    found: dict[str, float] = {}
    for name, variants in signatures.effects.items():
        shapes = free(np.hstack([white(s.change) for s in variants]))
        lengths = np.linalg.norm(shapes, axis=0) * np.linalg.norm(target)
        found[name] = float(np.max((target @ shapes) / np.where(lengths > 0, lengths, np.inf)))
    return dict(sorted(found.items(), key=lambda item: -item[1])[:count])
