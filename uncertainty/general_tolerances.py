"""Tolerances of standards: ISO 286-1 grades for diameters, ISO 2768-1 class f for what the drawing leaves open."""

from __future__ import annotations

from math import inf, sqrt

from units import MILLIMETRE

_MICROMETRE = 1e-3 * MILLIMETRE
# Ends of the steps of nominal sizes [mm], ISO 286-1 Table 1.
_STEPS = (0.0, 3.0, 6.0, 10.0, 18.0, 30.0, 50.0, 80.0, 120.0, 180.0, 250.0, 315.0, 400.0, 500.0, 630.0, 800.0, 1000.0,
          1250.0, 1600.0, 2000.0, 2500.0, 3150.0)  # fmt: skip
_FACTORS = {6: 10.0, 7: 16.0, 8: 25.0, 9: 40.0, 10: 64.0}  # of the tolerance factor i, ISO 286-1
_CLASS_F = ((6.0, 0.05), (30.0, 0.1), (120.0, 0.15), (400.0, 0.2), (1000.0, 0.3), (inf, 0.5))  # up to [mm], +- [mm]


def international_tolerance(diameter: float, grade: int) -> float:
    """Width of the tolerance of a diameter [m] in the grade IT6 to IT10 [m]; half of it lies on either side.

    i = 0.45 D^(1/3) + 0.001 D up to 500 mm, 0.004 D + 2.1 above, in micrometres with D in mm, the geometric mean of the
    step that the diameter lies in; IT7 = 16 i, IT8 = 25 i. The table of the standard rounds to whole micrometres.
    grade: dimensionless. Source: ISO 286-1:2010, the formulas of its Annex.
    """
    size = diameter / MILLIMETRE
    step = next((k for k, end in enumerate(_STEPS[1:], 1) if size <= end), len(_STEPS) - 1)
    mean = sqrt(max(_STEPS[step - 1], 1.0) * _STEPS[step])
    factor = 0.45 * mean ** (1 / 3) + 1e-3 * mean if mean <= 500.0 else 4e-3 * mean + 2.1
    return _FACTORS[grade] * factor * _MICROMETRE


def fine_tolerance(length: float) -> float:
    """Half width +-a of a length without a tolerance of its own [m], class f; length: [m].

    Source: ISO 2768-1:1989, Table 1; below 0.5 mm, where it has none, that of its first step.
    """
    return next(half for end, half in _CLASS_F if length / MILLIMETRE <= end) * MILLIMETRE
