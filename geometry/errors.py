"""What is said of a machine that cannot be drawn."""

from __future__ import annotations

from units import MILLIMETRE


class GeometryError(ValueError):
    """A machine that cannot be drawn; the message says what is wrong and which parameter to move."""


def in_mm(length: float) -> str:
    """A length [m] in words."""
    return f"{length / MILLIMETRE:.3f} mm"
