"""Signatures of every effect on a grid over its prior, and evidences from them by linear algebra alone.

One bank serves the first ranking, the simulated empty campaigns, the power to abstain and the detection limits.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np
from scipy.special import logsumexp, ndtr
from scipy.stats import t as student

from effects.base import Effect
from effects.parameter import parameters_of
from workbench.errors import WorkbenchError
from workbench.explain.priors import TAILS
from workbench.likelihood.linear import Nuisances

# cells an axis and half-width of the grid [standard deviations] by number of parameters
_GRIDS = {1: (15, 4.5), 2: (7, 3.5), 3: (5, 3.0), 4: (3, 2.4)}
SEEN = 0.05  # length of a whitened signature below which an effect does nothing to these data


@dataclass(frozen=True, eq=False)
class Signature:
    """One effect (variant) on its grid.

    z: grid points (K, k);  s: whitened change of the readings (n, K);  tangents: ds/dz (k, n, K)
    log_prior: prior mass of each cell (K,);  width: of a cell along each axis
    """

    effect: Effect
    z: np.ndarray
    s: np.ndarray
    tangents: np.ndarray
    log_prior: np.ndarray
    width: float

    @property
    def name(self) -> str:
        return self.effect.name()

    @property
    def parameters(self) -> int:
        return self.z.shape[1]

    @cached_property
    def is_seen(self) -> bool:
        return bool(np.sqrt((self.s**2).sum(axis=0)).max(initial=0.0) > SEEN)


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


def signature(effect: Effect, change) -> Signature:
    """The signature of an effect; ``change(effect)`` is the whitened change of the readings (n,)."""
    k = len(parameters_of(effect))
    z, width, shape = grid(k)
    s, possible = _changes(effect, z, change)
    tangents = np.array([_tangent(s, possible, shape, a, width) for a in range(k)])
    masses = np.log(student.cdf(z + width / 2, TAILS) - student.cdf(z - width / 2, TAILS)).sum(axis=1)
    masses = np.where(possible, masses, -np.inf)
    return Signature(effect, z, s, tangents, masses - logsumexp(masses), width)


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


def _changes(effect: Effect, z: np.ndarray, change) -> tuple[np.ndarray, np.ndarray]:
    """Signatures (n, K), and where the model has an answer (K,); at least one place must have one."""
    found, error = [], None
    for point in z:
        try:
            found.append(change(effect.at(point)))
        except WorkbenchError as no_answer:
            found.append(None)
            error = no_answer
    possible = np.array([s is not None for s in found])
    if not possible.any():
        raise error
    nothing = np.zeros_like(next(s for s in found if s is not None))
    return np.array([nothing if s is None else s for s in found]).T, possible


@dataclass(frozen=True, eq=False)
class Prepared:
    """A signature with the nuisances taken out; what every data set needs of it."""

    signature: Signature
    nuisances: Nuisances

    @cached_property
    def s(self) -> np.ndarray:
        return self.nuisances.project(self.signature.s)

    @cached_property
    def energy(self) -> np.ndarray:
        """|W|^2, the squared length that the nuisances leave (K,)."""
        return np.sum(self.s * self.signature.s, axis=0)

    @cached_property
    def tangents(self) -> np.ndarray:
        return np.array([self.nuisances.project(t) for t in self.signature.tangents])

    @cached_property
    def curvature(self) -> np.ndarray:
        """Precision of z in each cell, prior included (K, k, k)."""
        found = np.einsum("ank,bnk->kab", self.tangents, self.signature.tangents)
        largest = np.trace(found, axis1=1, axis2=2)[:, None, None]  # rounding of it makes two alike parameters singular
        return found + (1e-9 + 1e-12 * largest) * np.eye(self.signature.parameters)

    @cached_property
    def slope(self) -> np.ndarray:
        """tangent . s (k, K)"""
        return np.einsum("ank,nk->ak", self.tangents, self.signature.s)

    def gains(self, residuals: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """For residuals (n, R): ln likelihood of each cell over the null (K, R) and best place in the cell (k, K,
        R)."""
        level = self.s.T @ residuals - 0.5 * self.energy[:, None]
        pull = np.einsum("ank,nr->kar", self.tangents, residuals) - self.slope.T[:, :, None]
        half = 0.5 * self.signature.width
        if self.signature.parameters == 1:
            return self._along_one(level, pull[:, 0], half)
        move = np.clip(np.linalg.solve(self.curvature, pull), -half, half)
        level = level + np.sum(move * pull, axis=1) - 0.5 * np.einsum("kar,kab,kbr->kr", move, self.curvature, move)
        spread = np.sqrt(2 * np.pi / np.diagonal(self.curvature, axis1=1, axis2=2)) / self.signature.width
        return level + np.log(np.minimum(spread, 1.0)).sum(axis=1)[:, None], np.moveaxis(move, 1, 0)

    def _along_one(self, level, pull, half):
        """One parameter: the mean over a cell of a likelihood that is Gaussian in z, exactly."""
        precision = self.curvature[:, 0, 0][:, None]
        root = np.sqrt(precision)
        best = pull / precision
        inside = ndtr((half - best) * root) - ndtr((-half - best) * root)
        clipped = np.clip(best, -half, half)
        at_best = level + pull * clipped - 0.5 * precision * clipped**2
        whole = level + 0.5 * pull * best + np.log(np.maximum(inside, 1e-300) * np.sqrt(2 * np.pi) / root / (2 * half))
        edge = at_best - np.log1p(np.abs(pull - precision * clipped) * 2 * half)  # exponential decay into the cell
        return np.where(inside > 1e-12, whole, edge), clipped[None]

    def log_evidence(self, residuals: np.ndarray) -> np.ndarray:
        """ln evidence over the null for each of the residuals (R,)."""
        gains, _ = self.gains(residuals)
        return logsumexp(gains + self.signature.log_prior[:, None], axis=0)

    def best(self, residual: np.ndarray, count: int = 2) -> list[np.ndarray]:
        """The best few places z (k,) on the grid that are no neighbours, best first."""
        gains, moves = self.gains(residual[:, None])
        score = gains[:, 0] + self.signature.log_prior
        places = self.signature.z + moves[:, :, 0].T
        found: list[np.ndarray] = []
        for cell in np.argsort(-score, kind="stable"):
            if not score[cell] > score.max() - 30 or len(found) == count:
                break
            if all(np.max(np.abs(places[cell] - have)) > 1.5 * self.signature.width for have in found):
                found.append(places[cell])
        return found
