"""The power by which one quantity goes with another, from its values a little to either side."""

from __future__ import annotations

from math import atanh

import numpy as np

LITTLE = 0.01  # relative, of what is moved: the difference is then right to its square
LOG_STEP = atanh(LITTLE)  # ln x moves by twice that between x (1 - LITTLE) and x (1 + LITTLE)


def power(more: float, less: float) -> float:
    """p = d ln y / d ln x, dimensionless.

    more, less: y where ln x is ``LOG_STEP`` larger and smaller, of one sign [any unit]
    """
    return float(np.log(more / less)) / (2 * LOG_STEP)
