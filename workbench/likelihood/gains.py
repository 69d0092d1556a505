"""What terms gain beside a fit in its own likelihood, from where linear algebra ends with them.

Linear algebra knows Gaussian noise of known size only. Where a channel fits badly, Student's likelihood gains much less
of the same change, so that it is asked itself: at the weights that linear algebra finds, with the spread that it leaves
the background there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from workbench.likelihood.fit import Fit, Problem
from workbench.likelihood.marginal import Catalogue, Given, Readings


@dataclass(frozen=True, eq=False)
class Gains:
    """Of the terms of a catalogue beside a fit.

    residual: whitened, its nuisances carried back to zero (n,);  readings: the same as the catalogue has it
    """

    problem: Problem
    fit: Fit
    residual: np.ndarray
    catalogue: Catalogue
    readings: Readings

    def of(self, terms: Sequence[int], gaussian: float, log_prior: float) -> float:
        """ln p that some terms gain [nats].

        Linear algebra takes as cost of a set, too, what weights beyond their reach would have gained: more than the set
        can cost by itself it does not.

        gaussian: the same by linear algebra, forms and places averaged;  log_prior: of the terms
        """
        after = self.catalogue.given(terms, self.readings)
        itself = after.spread - self._bare.spread - log_prior
        cost = min(self._bare.least - after.least - gaussian, itself)
        return self._begins - self._ends(after, terms) - cost

    @cached_property
    def _bare(self) -> Given:
        return self.catalogue.given((), self.readings)

    @cached_property
    def _begins(self) -> float:
        """Minus ln p where the fit ended, or linear algebra without terms if that is better [nats]."""
        x = self.fit.x
        return min(self._ends(self._bare, ()), self._student(self.fit.residual) + 0.5 * float(x @ x))

    def _ends(self, given: Given, terms: Sequence[int]) -> float:
        """The same where linear algebra ends with some terms, these within their reach [nats]."""
        background = self.catalogue.background
        held = np.clip(given.weights[background.shape[1] :], *self.catalogue.reach(terms))
        left = self.residual - self.catalogue.added(terms, held)
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
