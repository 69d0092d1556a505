"""How deep a surface is ground that was fitted by hand."""

from __future__ import annotations

from effects.parameter import parameter
from effects.prior import LogNormal
from units import MILLIMETRE


def ground_depth(source: str) -> float:
    """The parameter of an effect, radial [m]; source: of its prior."""
    low, high = 0.0, 0.3 * MILLIMETRE
    return parameter(0.0, "m", prior=LogNormal(0.05 * MILLIMETRE, 0.6), low=low, high=high, source=source)
