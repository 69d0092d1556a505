"""The law of ``materials.reluctivity.SplineReluctivity`` at many points in one pass, compiled.

It is the innermost loop of every field solution.
"""

from __future__ import annotations

import numpy as np

from compiling import compiled
from units import MU_0


@compiled
def nu_and_derivative(
    b2: np.ndarray,
    ends: np.ndarray,
    coefficients: np.ndarray,
    bins_per_tesla: float,
    interval_of_bin: np.ndarray,
    last_flux: float,
    saturation: float,
    knee: float,
) -> tuple[np.ndarray, np.ndarray]:
    """nu [m/H] and dnu/d(b2) [m/(H T^2)] at b2 [T^2], (m,) each.

    ends [T], (n,), coefficients, rows B_k and a0 to a3 [T, A/m and over T], (5, n), bins_per_tesla [1/T]
    interval_of_bin: indices (bins,); all of ``PiecewiseCubic``
    last_flux, saturation: B_l and J_s of ``ApproachToSaturation`` [T]; knee: its c H_l [T A/m]
    """
    nu, derivative = np.empty_like(b2), np.empty_like(b2)
    starts, a0, a1, a2, a3 = coefficients
    for i in range(len(b2)):
        b = np.sqrt(b2[i])
        if b > last_flux:
            u = b - saturation
            H = (u + np.sqrt(u * u + 4 * MU_0 * knee)) / (2 * MU_0)
            slope = 1.0 / (MU_0 + knee / (H * H))
        else:
            k = interval_of_bin[max(0, min(int(b * bins_per_tesla), len(interval_of_bin) - 1))]  # 0 for NaN
            while b >= ends[k]:
                k += 1
            t = b - starts[k]
            H = a0[k] + t * (a1[k] + t * (a2[k] + t * a3[k]))
            slope = a1[k] + t * (2 * a2[k] + 3 * t * a3[k])
        if b < ends[0]:  # an even function of B, finite at zero
            nu[i], derivative[i] = a1[0] + a3[0] * b2[i], a3[0]
        else:
            nu[i] = H / b
            derivative[i] = (slope - nu[i]) / (2 * b2[i])
    return nu, derivative
