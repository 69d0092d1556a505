"""What terms gain beside a fit in its own likelihood, from where linear algebra ends with them.

Linear algebra knows Gaussian noise of known size only. Where a channel fits badly, Student's likelihood gains much less
of the same change, so that it is asked itself: at the weights that linear algebra finds, with the spread that it leaves
the background there.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np

from workbench.likelihood.fit import Fit, Problem
from workbench.likelihood.marginal import Catalogue, root_beside_one


@dataclass(frozen=True, eq=False)
class End:
    """Where linear algebra ends with some terms.

    shift, columns: what these add, whitened, and how it changes with their weights (n,), (n, k)
    pull, behind: what the background's weights feel of what is left by the shift, and of the columns (m,), (m, k)
    weights: of the columns (k,);  least: half the squares of residual and weights [nats]
    spread: half ln det of the curvature
    """

    shift: np.ndarray
    columns: np.ndarray
    pull: np.ndarray
    behind: np.ndarray
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
        felt = [self._felt(number) for number in terms]
        shift, columns = _added([by_rows for by_rows, _ in felt], len(self.residual))
        behind_shift, behind = _added([by_background for _, by_background in felt], len(self._pull))
        left, pull = self.residual - shift, self._pull - behind_shift
        root = root_beside_one((columns.T @ columns - behind.T @ behind)[None])[0]
        moved = np.linalg.solve(root, columns.T @ left - behind.T @ pull)
        least = 0.5 * (left @ left - pull @ pull - moved @ moved)
        spread = self.catalogue.half_log_det + np.log(np.diagonal(root)).sum()
        return End(shift, columns, pull, behind, np.linalg.solve(root.T, moved), float(least), float(spread))

    def of_background(self, end: End, weights: np.ndarray) -> np.ndarray:
        """Most probable weights of the background beside weights of the columns (m,)."""
        return self._turn.T @ (end.pull - end.behind @ weights)

    @cached_property
    def _turn(self) -> np.ndarray:
        """From products with the background to what weights feel that are independent of each other (m, m)."""
        return np.linalg.inv(self.catalogue.root)

    @cached_property
    def _pull(self) -> np.ndarray:
        """What these feel of the residual (m,)."""
        return self._turn @ (self.catalogue.background.T @ self.residual)

    @cached_property
    def _felt(self) -> Callable[[int], tuple[np.ndarray, np.ndarray]]:
        """What a term adds to the rows (n, 1 + k), and what the background feels of it (m, 1 + k), by its number: few
        terms are in many sets."""

        @cache
        def felt(number: int) -> tuple[np.ndarray, np.ndarray]:
            by_rows = self.catalogue.felt(number)
            return by_rows, self._turn @ (self.catalogue.background.T @ by_rows)

        return felt

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
        held = np.clip(end.weights, *self.catalogue.reach(terms))
        pulled = self.of_background(end, held)
        left = self.residual - end.shift - end.columns @ held - self.catalogue.background @ pulled
        return self._student(left) + 0.5 * float(held @ held + pulled @ pulled)

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


def _added(parts: Sequence[np.ndarray], rows: int) -> tuple[np.ndarray, np.ndarray]:
    """The sum of the first columns of all parts (rows,), and their other columns (rows, k)."""
    shift = np.sum([part[:, 0] for part in parts], axis=0) if parts else np.zeros(rows)
    return shift, np.hstack([np.empty((rows, 0)), *(part[:, 1:] for part in parts)])
