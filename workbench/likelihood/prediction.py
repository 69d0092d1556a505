"""How well does a model predict conditions that it was not fitted to? One region of the operating conditions of one
table is left out after the other, and predicted from all the rest, by linear algebra at the fit of all rows."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from workbench.likelihood.fit import Fit, Problem
from workbench.likelihood.regions import blocks_of


@dataclass(frozen=True)
class Prediction:
    """Of rows left out region by region.

    blocks: regions, 0 where the conditions allow none;  n: rows predicted
    chi2_per_n: mean square of their errors over the noise;  log_score: ln p of them, given all others [nats]
    """

    blocks: int
    n: int
    chi2_per_n: float
    log_score: float


def predicted(problem: Problem, fit: Fit) -> Prediction:
    """The prediction of a fit. Parameters are as uncertain as their priors and the other rows leave them; those of
    effects that the model has, too, though they stand where all rows have put them."""
    zero = fit.residual + fit.jacobian @ np.concatenate([fit.x - problem.predictor.centre, fit.z])
    found = [_left_out(fit.jacobian, zero, rows) for rows in regions(problem)]
    if not found:
        return Prediction(0, 0, float("nan"), 0.0)
    n = sum(rows for rows, _, _ in found)
    return Prediction(len(found), n, sum(square for _, square, _ in found) / n, sum(score for _, _, score in found))


def regions(problem: Problem) -> Iterator[np.ndarray]:
    """Places of the rows of every region that is left out (n_b,)."""
    for number, table in enumerate(problem.stack.tables):
        blocks = blocks_of(table)
        channels = [c for c in problem.stack.channels if c.table == number]
        for block in np.unique(blocks) if blocks.max(initial=0) else ():
            inside = np.flatnonzero(blocks == block)
            yield np.concatenate([c.rows.start + inside for c in channels])


def _left_out(jacobian: np.ndarray, zero: np.ndarray, rows: np.ndarray) -> tuple[int, float, float]:
    """Rows, sum of squares of the errors, and ln p of one region, from parameters fitted to all other rows."""
    out = np.zeros(len(zero), dtype=bool)
    out[rows] = True
    rest = jacobian[~out]
    precision = np.eye(jacobian.shape[1]) + rest.T @ rest
    error = zero[out] - jacobian[out] @ np.linalg.solve(precision, rest.T @ zero[~out])
    spread = np.linalg.solve(np.linalg.cholesky(precision), jacobian[out].T)
    inner = np.eye(len(precision)) + spread @ spread.T
    taken = np.linalg.solve(np.linalg.cholesky(inner), spread @ error)
    square = float(error @ error)
    return len(rows), square, -0.5 * (square - float(taken @ taken)) - 0.5 * float(np.linalg.slogdet(inner)[1])
