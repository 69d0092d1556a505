"""How well does a model predict conditions that it was not fitted to? One region of the operating conditions of one
table is left out after the other, and predicted from all the rest, by linear algebra at the fit of all rows."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import gammaincinv

from workbench.likelihood.fit import Fit, Problem
from workbench.likelihood.regions import blocks_of

SUCH = 0.95  # share of models without a fault that err no more than is allowed for


@dataclass(frozen=True)
class Prediction:
    """Of rows left out region by region.

    blocks: regions, 0 where the conditions allow none;  n: rows predicted
    chi2_per_n: mean square of their errors over the noise;  log_score: ln p of them, given all others [nats]
    without_fault: chi2_per_n that a model without a fault stays below with probability ``SUCH``: noise, and what the
        other rows leave uncertain of its parameters
    """

    blocks: int
    n: int
    chi2_per_n: float
    log_score: float
    without_fault: float


def predicted(problem: Problem, fit: Fit) -> Prediction:
    """The prediction of a fit. Parameters are as uncertain as their priors and the other rows leave them; those of
    effects that the model has, too, though they stand where all rows have put them."""
    zero = fit.residual + fit.jacobian @ np.concatenate([fit.x - problem.predictor.centre, fit.z])
    found = [_LeftOut.of(fit.jacobian, zero, rows) for rows in regions(problem)]
    if not found:
        return Prediction(0, 0, float("nan"), 0.0, float("nan"))
    n = sum(one.rows for one in found)
    chi2_per_n, score = sum(one.square for one in found) / n, sum(one.score for one in found)
    return Prediction(len(found), n, chi2_per_n, score, _without_fault(fit.jacobian, found) / n)


def regions(problem: Problem) -> Iterator[np.ndarray]:
    """Places of the rows of every region that is left out (n_b,)."""
    for number, table in enumerate(problem.stack.tables):
        blocks = blocks_of(table)
        channels = [c for c in problem.stack.channels if c.table == number]
        for block in np.unique(blocks) if blocks.max(initial=0) else ():
            inside = np.flatnonzero(blocks == block)
            yield np.concatenate([c.rows.start + inside for c in channels])


@dataclass(frozen=True, eq=False)
class _LeftOut:
    """One region, predicted by parameters w that were fitted to all other rows.

    rows: their number;  square: of the errors;  score: ln p of them [nats]
    uncertain: covariance of what the errors owe to w, along w (m, m);  lever: J^T J of what its rows do to their own
        errors, J_b (1 + cov(w) J_b^T J_b) (m, m)
    """

    rows: int
    square: float
    score: float
    uncertain: np.ndarray
    lever: np.ndarray

    @classmethod
    def of(cls, jacobian: np.ndarray, zero: np.ndarray, rows: np.ndarray) -> _LeftOut:
        out = np.zeros(len(zero), dtype=bool)
        out[rows] = True
        own, rest = jacobian[out], jacobian[~out]
        precision = np.eye(jacobian.shape[1]) + rest.T @ rest
        error = zero[out] - own @ np.linalg.solve(precision, rest.T @ zero[~out])
        spread = np.linalg.solve(np.linalg.cholesky(precision), own.T)
        uncertain = spread @ spread.T
        inner = np.eye(len(precision)) + uncertain
        taken = np.linalg.solve(np.linalg.cholesky(inner), spread @ error)
        square = float(error @ error)
        score = -0.5 * (square - float(taken @ taken)) - 0.5 * float(np.linalg.slogdet(inner)[1])
        does = own + own @ np.linalg.solve(precision, own.T @ own)
        return cls(len(rows), square, score, uncertain, does.T @ does)


def _without_fault(jacobian: np.ndarray, found: Sequence[_LeftOut]) -> float:
    """Sum of squares of all errors that a model without a fault stays below with probability ``SUCH``.

    Errors e_b = (1 + U_b) z_b have the covariance 1 + U_b, those of two regions -D_b (1 + J^T J)^-1 D_c^T with the
    levers D^T D. Of such a sum of squares the quantile of the gamma distribution with its mean and variance
    (Satterthwaite, Biometrics Bulletin 2 (1946), 110).
    """
    mean = sum(one.rows + np.trace(one.uncertain) for one in found)
    own = sum(one.rows + 2 * np.trace(one.uncertain) + np.sum(one.uncertain**2) for one in found)
    inverse = np.linalg.inv(np.eye(jacobian.shape[1]) + jacobian.T @ jacobian)
    levers = [inverse @ one.lever for one in found]
    every = sum(levers)
    across = np.sum(every * every.T) - sum(np.sum(one * one.T) for one in levers)
    variance = 2 * (own + across)
    return float(gammaincinv(mean**2 / variance, SUCH) * variance / mean)
