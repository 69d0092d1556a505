"""Functions over a revolution, as Fourier coefficients by mechanical order."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

ORDERS = 240  # that are kept
_DIGITS = 12  # of an angle [rad] that count
_TABLE = 4096  # angles of a revolution that are interpolated between by cubics; 68 to a period of order 60
_FEW = 360  # different angles, up to which all orders are summed at each in less time than the table takes


def coefficients(samples: np.ndarray, most: int = ORDERS) -> np.ndarray:
    """Coefficients (columns, orders) of samples over a revolution (n, columns): f = Re sum c_m exp(i m angle)."""
    found = np.fft.rfft(samples, axis=0).T * 2 / len(samples)
    found[:, 0] /= 2
    return found[:, : min(most, (len(samples) - 1) // 2) + 1]


def evaluated(spectrum: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Values (rows, n) at angles [rad] (n,) of functions over the revolution.

    What the angles past the first one ask for is kept by the bytes of their array: every fit asks for the same few
    tables, and its zero of the encoder turns the functions instead.
    """
    if not len(angle):
        return np.zeros((len(spectrum), 0))
    turned = spectrum * np.exp(1j * np.arange(spectrum.shape[1]) * angle[0])
    past = (np.round(angle - angle[0], _DIGITS) + 0.0).tobytes()  # no minus zero, which has other bytes
    distinct, places = _distinct(past)
    return _summed(turned, past).take(places, axis=1) if len(distinct) <= _FEW else _interpolated(turned, past)


@lru_cache(maxsize=32)
def _distinct(angle: bytes) -> tuple[np.ndarray, np.ndarray]:
    """Angles that differ (k,) and the place of each among them (n,): repeats are read at the same angles."""
    return np.unique(np.frombuffer(angle), return_inverse=True)


def _summed(spectrum: np.ndarray, angle: bytes) -> np.ndarray:
    """By the orders themselves, at angles that differ (rows, k)."""
    return np.ascontiguousarray(spectrum).view(float) @ _turning(angle, spectrum.shape[1])


@lru_cache(maxsize=32)
def _turning(angle: bytes, orders: int) -> np.ndarray:
    """What the real and the imaginary part of every order are worth at angles that differ, cos(m angle) and
    -sin(m angle) in turn (2 orders, k), every order turned by one angle more than the one before."""
    turning = np.tile(np.exp(1j * _distinct(angle)[0]), (orders, 1))
    turning[0] = 1.0
    turning = np.cumprod(turning, axis=0)
    return np.stack([turning.real, -turning.imag], axis=1).reshape(2 * orders, -1)


def _interpolated(spectrum: np.ndarray, angle: bytes) -> np.ndarray:
    """By cubics between _TABLE angles."""
    full = spectrum * (_TABLE / 2)
    full[:, 0] *= 2
    table = np.fft.irfft(full, _TABLE, axis=1)
    places, weights = _between(angle)
    return np.einsum("kn,rkn->rn", weights, table.take(places, axis=1))


@lru_cache(maxsize=32)
def _between(angle: bytes) -> tuple[np.ndarray, np.ndarray]:
    """Places in the table and weights of the values there (4, n) each."""
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
