"""Functions over a revolution, as Fourier coefficients by mechanical order."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

ORDERS = 240  # that are kept
_TABLE = 4096  # angles of a revolution that are interpolated between by cubics; 68 to a period of order 60
_FEW = 64  # angles, up to which all orders are summed at each of them in less time than the table takes


def coefficients(samples: np.ndarray, most: int = ORDERS) -> np.ndarray:
    """Coefficients (columns, orders) of samples over a revolution (n, columns): f = Re sum c_m exp(i m angle)."""
    found = np.fft.rfft(samples, axis=0).T * 2 / len(samples)
    found[:, 0] /= 2
    return found[:, : min(most, (len(samples) - 1) // 2) + 1]


def evaluated(spectrum: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Values (rows, n) at angles [rad] (n,) of functions over the revolution."""
    return _summed(spectrum, angle) if len(angle) <= _FEW else _interpolated(spectrum, angle)


def _summed(spectrum: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """By the orders themselves."""
    return (spectrum @ _turning(np.asarray(angle, dtype=float).tobytes(), spectrum.shape[1])).real


@lru_cache(maxsize=32)
def _turning(angle: bytes, orders: int) -> np.ndarray:
    """exp(i m angle) (orders, n), every order turned by one angle more than the one before; of angles given as the
    bytes of their array: every fit asks for the same few tables."""
    turning = np.tile(np.exp(1j * np.frombuffer(angle)), (orders, 1))
    turning[0] = 1.0
    return np.cumprod(turning, axis=0)


def _interpolated(spectrum: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """By cubics between _TABLE angles."""
    full = spectrum * (_TABLE / 2)
    full[:, 0] *= 2
    table = np.fft.irfft(full, _TABLE, axis=1)
    places, weights = _between(np.asarray(angle, dtype=float).tobytes())
    return np.einsum("kn,rkn->rn", weights, table.take(places, axis=1))


@lru_cache(maxsize=32)
def _between(angle: bytes) -> tuple[np.ndarray, np.ndarray]:
    """Places in the table and weights of the values there (4, n) each, of angles given as the bytes of their array."""
    place = np.mod(np.frombuffer(angle), 2 * np.pi) * _TABLE / (2 * np.pi)
    first = np.floor(place).astype(int)
    t = place - first
    weights = (-t * (t - 1) * (t - 2) / 6, (t * t - 1) * (t - 2) / 2, -t * (t + 1) * (t - 2) / 2, t * (t * t - 1) / 6)
    return (first + np.arange(-1, 3)[:, None]) % _TABLE, np.array(weights)


def half_rate(angle: np.ndarray) -> float:
    """Order whose half period is the usual distance of neighbouring angles [rad]; infinite where nothing is known."""
    apart = np.abs(np.mod(np.diff(angle) + np.pi, 2 * np.pi) - np.pi)
    return np.pi / float(np.median(apart)) if np.any(apart) else np.inf


def slope(spectrum: np.ndarray) -> np.ndarray:
    """Coefficients of the derivative by angle."""
    return spectrum * (1j * np.arange(spectrum.shape[1]))


def averaged(spectrum: np.ndarray, width: float) -> np.ndarray:
    """Coefficients of the mean over a window of angles, as a skew by ``width`` [rad] takes it: sinc(m width / 2)."""
    return spectrum * np.sinc(np.arange(spectrum.shape[1]) * width / (2 * np.pi))
