"""Readings as a real bench gives them: correlated noise with heavy tails, wild readings, converter steps, drift, the
scatter of mounting the device anew for every scan, and here and there a reading that is missing."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from scipy.linalg import solve_triangular

DEGREES = 4.0  # of the t distribution of the noise
WILD_SHARE = 0.005  # of the readings
WILD_SIZE = (6.0, 15.0)  # of a wild reading, in standard deviations
MISDECLARED = 0.25  # share of benches whose declared uncertainty is off by up to a factor of two
REMOUNTED = 0.75  # share of benches whose scans have an offset and a slope of their own
FLOORED = 0.5  # share of benches whose readings have a part that wanders over many of them, and one that does not
WANDERS = (0.5, 0.95)  # correlation of what wanders in them
FLOOR = (0.2, 0.8)  # share of the variance that does not
LOGGED = 0.5  # share of benches that log a temperature and miss readings
MISSING = 3  # readings at most that are missing in a bench that misses some


@dataclass(frozen=True)
class Noise:
    """How noisy one bench is.

    scale: true over declared size of the noise;  correlation: of what wanders in a reading with that of the one before
    floor: share of the variance that does not wander
    step: of the converter, of the declared size;  drift: of the one scan that drifts, over its length, of the same
    remount: standard deviation of offset and of slope over its length of every scan, of the same
    logs: whether it logs the temperature of the room, with scatter, and misses single readings
    """

    scale: float
    correlation: float
    step: float
    drift: float
    remount: float = 0.0
    logs: bool = False
    floor: float = 0.0

    @classmethod
    def drawn(cls, rng: np.random.Generator) -> Noise:
        most = 2.0 if rng.random() < MISDECLARED else 1.15
        scale = float(np.exp(rng.uniform(-np.log(most), np.log(most))))
        shape = float(rng.uniform(0.0, 0.5)), float(rng.uniform(0.05, 0.4)), float(rng.uniform(0.3, 1.0))
        remount = float(np.exp(rng.uniform(np.log(0.3), np.log(2.0)))) if rng.random() < REMOUNTED else 0.0
        bench = cls(scale, *shape, remount, bool(rng.random() < LOGGED))
        (own,) = rng.spawn(1)  # what is drawn after this stays what it is for benches without a floor
        return bench._floored(own) if own.random() < FLOORED else bench

    def _floored(self, rng: np.random.Generator) -> Noise:
        return replace(self, correlation=float(rng.uniform(*WANDERS)), floor=float(rng.uniform(*FLOOR)))

    @classmethod
    def ideal(cls) -> Noise:
        """Exactly what a likelihood assumes: white, of the declared size."""
        return cls(1.0, 0.0, 0.0, 0.0)

    @classmethod
    def still(cls) -> Noise:
        """None at all."""
        return cls(0.0, 0.0, 0.0, 0.0)

    @property
    def told(self) -> dict[str, float]:
        """What the answer of a campaign says of its noise."""
        return {"declared": self.scale, "remount": self.remount, "correlation": self.correlation, "floor": self.floor}

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
    if noise.is_ideal or not noise.scale:
        return truth + noise.scale * declared * rng.standard_normal(len(truth))
    error = np.concatenate([_correlated(int(n), noise, rng) for n in np.bincount(repeat)])
    if drifts:
        first = repeat == 0
        error[first] += noise.drift * np.linspace(-0.5, 0.5, int(first.sum()))
    wild = rng.random(len(truth)) < WILD_SHARE
    error[wild] += rng.choice([-1.0, 1.0], wild.sum()) * rng.uniform(*WILD_SIZE, wild.sum())
    step = noise.step * np.median(declared)
    mounted = remounting(declared, repeat, noise, rng) if noise.remount else 0.0
    return np.round((truth + mounted + noise.scale * declared * error) / step) * step


def remounting(declared: np.ndarray, repeat: np.ndarray, noise: Noise, rng: np.random.Generator) -> np.ndarray:
    """Offset and slope of every scan (n,), in the unit of the column."""
    offset = np.empty_like(declared)
    for scan in np.unique(repeat):
        rows = repeat == scan
        shapes = scan_shapes(declared[rows])
        offset[rows] = noise.remount * shapes @ rng.standard_normal(2)
    return offset


def scan_shapes(declared: np.ndarray) -> np.ndarray:
    """An offset and a slope over a scan (n, 2), so large that each is one declared uncertainty in the root mean
    square over the rows."""
    n = len(declared)
    shapes = np.stack([np.ones(n), np.linspace(-1.0, 1.0, n) if n > 1 else np.zeros(n)], axis=1)
    size = np.sqrt(np.mean((shapes / declared[:, None]) ** 2, axis=0))
    return shapes / np.where(size > 0, size, 1.0)


def room_temperature(rows: int, rng: np.random.Generator) -> np.ndarray:
    """As a thermometer on the wall logs it, row by row [degC] (n,)."""
    return np.round(22.0 + 0.5 * np.linspace(-1, 1, rows) * rng.standard_normal() + 0.3 * rng.standard_normal(rows), 2)


def with_gaps(columns: dict[str, np.ndarray], rng: np.random.Generator) -> dict[str, np.ndarray]:
    """Some readings gone."""
    gone = {name: values.copy() for name, values in columns.items()}
    for _ in range(int(rng.integers(1, MISSING + 1))):
        name = str(rng.choice(list(gone)))
        gone[name][int(rng.integers(len(gone[name])))] = np.nan
    return gone


def _correlated(n: int, noise: Noise, rng: np.random.Generator) -> np.ndarray:
    """AR(1) with t-distributed innovations over a floor of the same distribution, of unit size together (n,)."""
    fresh = _heavy(n, rng)
    rho, error = noise.correlation, np.empty(n)
    before = fresh[0]
    for k in range(n):
        before = fresh[k] if k == 0 else rho * before + np.sqrt(1 - rho**2) * fresh[k]
        error[k] = before
    return np.sqrt(1 - noise.floor) * error + np.sqrt(noise.floor) * _heavy(n, rng) if noise.floor else error


def _heavy(n: int, rng: np.random.Generator) -> np.ndarray:
    """Independent, t-distributed, of unit size (n,)."""
    return rng.standard_t(DEGREES, n) / np.sqrt(DEGREES / (DEGREES - 2.0))


def white(scan: np.ndarray, noise: Noise) -> np.ndarray:
    """One scan as independent rows of the same noise (n,)."""
    return solve_triangular(_root(len(scan), noise.correlation, noise.floor), scan, lower=True)


@lru_cache(maxsize=16)
def _root(n: int, correlation: float, floor: float) -> np.ndarray:
    """Of the covariance of a scan (n, n)."""
    lag = np.abs(np.subtract.outer(np.arange(n), np.arange(n)))
    return np.linalg.cholesky((1 - floor) * correlation**lag + floor * np.eye(n))
