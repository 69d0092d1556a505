"""Where a declared tolerance speaks against an effect that moves the same input."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from effects.base import Effect
from workbench.data.column_units import split_unit
from workbench.data.table import Tolerance
from workbench.findings import Estimate

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
