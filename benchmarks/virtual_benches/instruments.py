"""Readings as a real bench gives them: correlated noise with heavy tails, wild readings, converter steps, drift."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

DEGREES = 4.0  # of the t distribution of the noise
WILD_SHARE = 0.005  # of the readings
WILD_SIZE = (6.0, 15.0)  # of a wild reading, in standard deviations


@dataclass(frozen=True)
class Noise:
    """How noisy one bench is.

    scale: true over declared size of the noise;  correlation: of a reading with the one before it
    step: of the converter, of the declared size;  drift: of the one scan that drifts, over its length, of the same
    """

    scale: float
    correlation: float
    step: float
    drift: float

    @classmethod
    def drawn(cls, rng: np.random.Generator) -> Noise:
        scale = float(np.exp(rng.uniform(np.log(0.6), np.log(1.6))))
        return cls(scale, float(rng.uniform(0.0, 0.5)), float(rng.uniform(0.05, 0.4)), float(rng.uniform(0.3, 1.0)))

    @classmethod
    def ideal(cls) -> Noise:
        """Exactly what a likelihood assumes: white, of the declared size."""
        return cls(1.0, 0.0, 0.0, 0.0)

    @property
    def is_ideal(self) -> bool:
        return self == Noise.ideal()


def readings(
    truth: np.ndarray, declared: np.ndarray, repeat: np.ndarray, noise: Noise, drifts: bool, rng: np.random.Generator
) -> np.ndarray:
    """One response column as read, rows in order of acquisition, repeats one after the other.

    truth: with the instrument's own gain and offset;  declared: its random uncertainty (n,)
    drifts: whether the first scan of this column drifts
    """
    if noise.is_ideal:
        return truth + declared * rng.standard_normal(len(truth))
    error = np.concatenate([_correlated(int(n), noise, rng) for n in np.bincount(repeat)])
    if drifts:
        first = repeat == 0
        error[first] += noise.drift * np.linspace(-0.5, 0.5, int(first.sum()))
    wild = rng.random(len(truth)) < WILD_SHARE
    error[wild] += rng.choice([-1.0, 1.0], wild.sum()) * rng.uniform(*WILD_SIZE, wild.sum())
    step = noise.step * np.median(declared)
    return np.round((truth + noise.scale * declared * error) / step) * step


def _correlated(n: int, noise: Noise, rng: np.random.Generator) -> np.ndarray:
    """AR(1) with t-distributed innovations, of unit size (n,)."""
    fresh = rng.standard_t(DEGREES, n) / np.sqrt(DEGREES / (DEGREES - 2.0))
    rho, error = noise.correlation, np.empty(n)
    before = fresh[0]
    for k in range(n):
        before = fresh[k] if k == 0 else rho * before + np.sqrt(1 - rho**2) * fresh[k]
        error[k] = before
    return error
