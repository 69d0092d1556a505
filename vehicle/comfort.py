"""How strongly a person feels a vertical vibration: weighting W_k of ISO 2631-1, as a filter of third order."""

from __future__ import annotations

import numpy as np
import scipy
from numpy.typing import ArrayLike

# Numerator and denominator in descending powers of s, thesis eq. 3.23 (fit by Zuo and Nayfeh).
WEIGHTING = ((80.03, 989.0, 0.02108), (1.0, 78.92, 2412.0, 5614.0))


def weighting_gain(frequency: ArrayLike) -> np.ndarray:
    """|H_2631|, dimensionless, at these frequencies [Hz], of their shape.

    Within 15 % of the standard's W_k between 0.5 and 2 Hz.
    """
    s = 2j * np.pi * np.asarray(frequency, dtype=float)
    numerator, denominator = WEIGHTING
    return np.abs(np.polyval(numerator, s) / np.polyval(denominator, s))


def weighted_acceleration(acceleration: np.ndarray, step: float) -> np.ndarray:
    """Acceleration as it is felt [m/s^2], (..., t), from rest; step between samples [s].

    acceleration: [m/s^2], samples along the last axis, (..., t)
    """
    return scipy.signal.lfilter(*scipy.signal.bilinear(*WEIGHTING, fs=1 / step), acceleration, axis=-1)
