"""Means of readings that follow each other: how much less they say than as many independent ones."""

from __future__ import annotations

import numpy as np


def memory_of(readings: np.ndarray) -> float:
    """g = 1 + 2 sum rho_k over the first run of positive autocorrelations, dimensionless, 1 at least.

    readings: [SI], (n,)
    The variance of a mean of n readings is g sigma^2 / n. Standard textbook formula; the first negative autocorrelation
    ends the sum, since those beyond are noise (Geyer's initial positive sequence in its simplest form).
    """
    spectrum = np.abs(np.fft.rfft(readings - np.mean(readings), 2 * len(readings))) ** 2
    correlation = np.fft.irfft(spectrum)[: len(readings)]
    if correlation[0] <= 0:
        return 1.0
    rho = correlation[1:] / correlation[0]
    run = int(np.argmax(rho <= 0)) if (rho <= 0).any() else len(rho)
    return 1.0 + 2.0 * float(rho[:run].sum())


def mean_and_error(readings: np.ndarray) -> tuple[float, float]:
    """mean_and_error: mean of the readings [SI], (n,), and its standard error [SI]."""
    spread = float(np.std(readings, ddof=1))
    return float(np.mean(readings)), spread * float(np.sqrt(memory_of(readings) / len(readings)))
