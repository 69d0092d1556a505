"""What terms gain beside a fit in its own likelihood, from where linear algebra ends with them.

Linear algebra knows Gaussian noise of known size only. Where a channel fits badly, Student's likelihood gains much less
of the same change, so that it is asked itself: at the weights that linear algebra finds, with the spread that it leaves
the background there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np

from workbench.likelihood.fit import Fit, Problem
from workbench.likelihood.marginal import Catalogue


@dataclass(frozen=True, eq=False)
class End:
    """Where linear algebra ends with some terms.

    shift, columns: what these add, whitened, and how it changes with their weights (n,), (n, k)
    weights: of the background, then of the columns (m + k,);  least: half the squares of residual and weights [nats]
    spread: half ln det of the curvature
    """

    shift: np.ndarray
    columns: np.ndarray
    weights: np.ndarray
    least: float
    spread: float


@dataclass(frozen=True, eq=False)
class Gains:
    """Of the terms of a catalogue beside a fit. residual: whitened, its nuisances carried back to zero (n,)"""

    problem: Problem
    fit: Fit
    residual: np.ndarray
    catalogue: Catalogue

    def of(self, terms: Sequence[int], gaussian: float, log_prior: float) -> float:
        """ln p that some terms gain [nats].

        Linear algebra takes as cost of a set, too, what weights beyond their reach would have gained: more than the set
        can cost by itself it does not.

        gaussian: the same by linear algebra, forms and places averaged;  log_prior: of the terms
        """
        after = self.end(terms)
        itself = after.spread - self._bare.spread - log_prior
        cost = min(self._bare.least - after.least - gaussian, itself)
        return self._begins - self._ends(after, terms) - cost

    def end(self, terms: Sequence[int]) -> End:
        """Where linear algebra ends with some terms beside the background, by their columns alone: products with all
        that a catalogue holds, as a search among them needs, would take five times as long."""
        parts = [self._felt(number) for number in terms]
        shift = np.sum([part[:, 0] for part in parts], axis=0) if parts else np.zeros_like(self.residual)
        columns = np.hstack([np.empty((len(shift), 0)), *(part[:, 1:] for part in parts)])
        every, left = np.hstack([self.catalogue.background, columns]), self.residual - shift
        root = np.linalg.cholesky(np.eye(every.shape[1]) + every.T @ every)
        pull = np.linalg.solve(root, every.T @ left)
        least, spread = 0.5 * (left @ left - pull @ pull), np.log(np.diagonal(root)).sum()
        return End(shift, columns, np.linalg.solve(root.T, pull), float(least), float(spread))

    @cached_property
    def _felt(self):
        """What a term adds (n, 1 + k), by its number: few terms are in many sets."""
        return cache(self.catalogue.felt)

    @cached_property
    def _bare(self) -> End:
        return self.end(())

    @cached_property
    def _begins(self) -> float:
        """Minus ln p where the fit ended, or linear algebra without terms if that is better [nats]."""
        x = self.fit.x
        return min(self._ends(self._bare, ()), self._student(self.fit.residual) + 0.5 * float(x @ x))

    def _ends(self, end: End, terms: Sequence[int]) -> float:
        """The same where linear algebra ends with some terms, these within their reach [nats]."""
        background = self.catalogue.background
        held = np.clip(end.weights[background.shape[1] :], *self.catalogue.reach(terms))
        left = self.residual - end.shift - end.columns @ held
        pulled = self._pulls @ left
        return self._student(left - background @ pulled) + 0.5 * float(held @ held + pulled @ pulled)

    @cached_property
    def _pulls(self) -> np.ndarray:
        """From a residual to the most probable weights of the background (m, n)."""
        background = self.catalogue.background
        return np.linalg.solve(np.eye(background.shape[1]) + background.T @ background, background.T)

    def _student(self, residual: np.ndarray) -> float:
        """Minus ln p of a residual, with the spread that it leaves the background [nats]."""
        weights = self.problem.channel_weights(residual)
        curvature = np.eye(self.catalogue.background.shape[1]) + np.tensordot(weights, self._of_channels, 1)
        return self.problem.misfit(residual) + 0.5 * float(np.linalg.slogdet(curvature)[1])

    @cached_property
    def _of_channels(self) -> np.ndarray:
        """Products of the background's columns with one another in every channel (channels, m, m)."""
        parts = [self.catalogue.background[channel.rows] for channel in self.problem.stack.channels]
        return np.array([part.T @ part for part in parts])
