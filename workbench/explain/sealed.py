"""What rows that no fit has seen say of the model that the verdict speaks of. They choose nothing; they take back."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from scipy.special import chdtrc

from workbench.believed import DISAGREE
from workbench.errors import WorkbenchError
from workbench.explain.hypotheses import Hypothesis, sealed_rows
from workbench.explain.tried import Search
from workbench.explain.verdict import NONE_OF_THESE, NOTHING_MISSING, Verdict
from workbench.findings import Sealed
from workbench.likelihood.bench import Bench, sealed_words
from workbench.likelihood.fit import linearised

WORSE = 4.0  # times the squared error that sealed rows have without an effect, from which they refute it: twice as far


def opened(bench: Bench, final: Hypothesis) -> Sealed | None:
    """The sealed rows under the final model, its inputs as uncertain as the fit leaves them; None where none are."""
    part = sealed_rows(bench, final)
    if part is None:
        return None
    try:
        there = linearised(part, final.fit.x, final.fit.effects, final.fit.z)
    except WorkbenchError:  # what was read where the model cannot be speaks against it as loudly as can be
        return Sealed(part.stack.size, float("inf"), 0.0, sealed_words(bench), False)
    residual, slopes = there.residual, there.jacobian
    covariance = np.eye(len(residual)) + slopes @ final.fit.covariance @ slopes.T
    square = float(residual @ np.linalg.solve(covariance, residual))
    dof = float(np.mean([channel.dof for channel in bench.noise.channels]))
    p_value = float(chdtrc(len(residual), square / _heavier(len(residual), dof)))
    return Sealed(len(residual), float(np.mean(residual**2)), p_value, sealed_words(bench), p_value > DISAGREE)


def _heavier(rows: int, dof: float) -> float:
    """Factor on chi2 that the unknown size of the noise is worth: two standard deviations of it."""
    return 1.0 + 2.0 * float(np.sqrt(2.0 / dof)) if rows else 1.0


def refuted(search: Search, said: Verdict, best: Hypothesis, sealed: Sealed | None) -> dict[str, float]:
    """Effects that the verdict names, of which sealed rows that disagree are at least twice as far from what the fit
    predicts as they are without the effect, and how many times as far; less than the noise counts as the noise."""
    if sealed is None or sealed.holds:
        return {}
    parts = {name: search.fitted.get(best.names - {name}) for name in said.groups if name in best.names}
    squares = {name: opened(search.bench, part).chi2_per_n for name, part in parts.items() if part is not None}
    worse = {name: sealed.chi2_per_n / max(square, 1.0) for name, square in squares.items()}
    return {name: float(np.sqrt(times)) for name, times in worse.items() if times >= WORSE}


def refutations(search: Search, worse: Mapping[str, float]) -> tuple[str, ...]:
    """A sentence for each effect that is refuted. worse: how many times as far the sealed rows are with it, by name"""
    titles = {name: search.signatures.found[name][0].effect.title for name in worse}
    return tuple(
        f"Rows that no fit has seen lie {times:.1f} times as far from what the model says with {titles[name]} as "
        "without it, though it would explain the fitted rows: it is not named, and not counted below."
        for name, times in worse.items()
    )


def with_sealed(said: Verdict, sealed: Sealed | None) -> Verdict:
    """Nothing cannot be said to be missing while rows that no fit has seen disagree."""
    if said.kind == NOTHING_MISSING and sealed is not None and not sealed.holds:
        return replace(said, kind=NONE_OF_THESE, probability=1.0 - sealed.p_value)
    return said
