"""Rational transfer functions in s, their frequency response, margins and bandwidth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from control.errors import ControlError

FREQUENCIES = np.geomspace(1e-2, 1e4, 6001)  # Hz, over which margins and bandwidths are sought
_HALF_POWER = 1 / np.sqrt(2)


@dataclass(frozen=True)
class TransferFunction:
    """numerator(s) / denominator(s), coefficients in descending powers of s [of the unit of the ratio], (n,), (m,)."""

    numerator: tuple[float, ...]
    denominator: tuple[float, ...]

    def at(self, frequency: np.ndarray | float) -> np.ndarray:
        """Response [of the unit of the ratio], of that shape; frequency: [Hz], any shape."""
        s = 2j * np.pi * np.asarray(frequency, dtype=float)
        return np.asarray(np.polyval(self.numerator, s) / np.polyval(self.denominator, s))

    def times(self, other: TransferFunction) -> TransferFunction:
        """Both behind each other."""
        return TransferFunction(
            tuple(np.polymul(self.numerator, other.numerator)), tuple(np.polymul(self.denominator, other.denominator))
        )

    @property
    def closed(self) -> TransferFunction:
        """L / (1 + L): what the loop makes of its reference."""
        return TransferFunction(self.numerator, tuple(np.polyadd(self.denominator, self.numerator)))

    @property
    def poles(self) -> np.ndarray:
        """Zeros of the denominator [rad/s], (m - 1,)."""
        return np.asarray(np.roots(self.denominator))

    @property
    def is_stable(self) -> bool:
        """Whether every pole lies in the left half plane."""
        return bool((self.poles.real < 0).all())


@dataclass(frozen=True)
class Margins:
    """How far a loop is from swinging by itself.

    crossover: where the loop's gain last falls through 1 [Hz]; phase: margin there [rad]; gain: the factor that the
    gain may grow by, dimensionless, inf where the phase never reaches -180 degrees beyond the crossover
    """

    crossover: float
    phase: float
    gain: float


def margins(loop: TransferFunction) -> Margins:
    """Of an open loop L. Raises ControlError where its gain never falls through 1."""
    response = loop.at(FREQUENCIES)
    size, phase = np.abs(response), np.unwrap(np.angle(response))
    falls = np.flatnonzero((size[:-1] >= 1) & (size[1:] < 1))
    if not falls.size:
        raise ControlError(
            f"the loop's gain never falls through 1 between {FREQUENCIES[0]:g} and {FREQUENCIES[-1]:g} Hz, it lies "
            f"between {size.min():.3g} and {size.max():.3g}; change its gains"
        )
    k = falls[-1]
    share = np.log(size[k]) / np.log(size[k] / size[k + 1])
    crossover = float(FREQUENCIES[k] * (FREQUENCIES[k + 1] / FREQUENCIES[k]) ** share)
    at_crossover = phase[k] + share * (phase[k + 1] - phase[k])
    beyond = np.flatnonzero((phase[k:-1] > -np.pi) & (phase[k + 1 :] <= -np.pi))
    gain = float(1 / size[k + beyond[0]]) if beyond.size else float("inf")
    return Margins(crossover, float(np.pi + at_crossover), gain)


def bandwidth(closed: TransferFunction) -> float:
    """Frequency where a closed loop first falls 3 dB below its gain at rest [Hz]; inf where it never does."""
    size = np.abs(closed.at(FREQUENCIES))
    below = np.flatnonzero(size < _HALF_POWER * size[0])
    if not below.size:
        return float("inf")
    k = max(int(below[0]), 1)
    share = np.log(size[k - 1] / (_HALF_POWER * size[0])) / np.log(size[k - 1] / size[k])
    return float(FREQUENCIES[k - 1] * (FREQUENCIES[k] / FREQUENCIES[k - 1]) ** share)
