"""Where a declared tolerance speaks against what was found: against an effect that moves the same input, or against the
fit itself."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from effects.base import Effect
from units import percent
from workbench.data.column_units import split_unit
from workbench.data.table import Tolerance
from workbench.explain.hypotheses import Hypothesis
from workbench.findings import Estimate
from workbench.likelihood.bench import PULLED
from workbench.likelihood.nuisance import TolerancedInput

EXCEEDED = 4.0  # declared standard deviations, beyond which a tolerance contradicts an effect


def contradiction(effect: type[Effect], sizes: Mapping[str, Estimate], tolerances: Iterable[Tolerance]) -> str:
    """A sentence where the first parameter of an effect lies beyond what a campaign declares of its input; else empty.

    sizes: of the parameters, the first one first [SI]
    """
    declared = {split_unit(t.name)[0]: t for t in tolerances if not t.relative}
    tolerance = declared.get(effect.exceeds)
    if tolerance is None or not sizes:
        return ""
    size = abs(next(iter(sizes.values())).value) / tolerance.sigma
    if size <= EXCEEDED:
        return ""
    return (
        f"[tolerance] {tolerance.name} says otherwise: {effect.title}, by {size:.0f} of its standard deviations. One "
        "of the two is wrong, or something else looks like it."
    )


def exceeded(hypothesis: Hypothesis) -> tuple[str, ...]:
    """A sentence for each input of the device that a fit needs further off its tolerance than chance brings it."""
    moved = zip(hypothesis.problem.predictor.nuisances, hypothesis.fit.x)
    inputs = ((n.tolerance, float(z)) for n, z in moved if isinstance(n, TolerancedInput) and abs(z) > PULLED)
    return tuple(
        f"[tolerance] {tolerance.name} says otherwise: without anything unknown the best fit needs it {abs(z):.0f} of "
        f"its standard deviations {'higher' if z > 0 else 'lower'} than [device] states{_share(tolerance, z)}. Look "
        "whether [device] is what was measured: a unit, a value between lines for one of a phase, another specimen."
        for tolerance, z in inputs
    )


def _share(tolerance: Tolerance, z: float) -> str:
    return f", by {percent(abs(tolerance.sigma * z))}" if tolerance.relative else ""
