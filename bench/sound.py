"""A-weighted sound pressure levels of a record (IEC 61672-1).

    H_A(s) = K s^4 / ((s + w_1)^2 (s + w_2) (s + w_3) (s + w_4)^2),   0 dB at 1 kHz

with w = 2 pi (20.6, 107.7, 737.9, 12194) Hz = (129.4, 676.4, 4636, 7.66e4) rad/s. (Thesis eq. 5.2 prints 12.4 for
129.4, which reads 3 dB too much at 31.5 Hz.) The weighting acts on the spectrum of the whole record, so that it is
that of the analogue filter up to half the sampling frequency. The level is

    L = 20 log10(p_A,rms / 20 uPa)                                                                    (5.3)
"""

from __future__ import annotations

from dataclasses import dataclass
from math import log10, pi

import numpy as np
import scipy

from bench.errors import RecordError
from bench.record import Record

REFERENCE_PRESSURE = 20e-6  # Pa
CORNERS = (20.598997, 107.65265, 737.86223, 12194.217)  # Hz, f_1 to f_4 of IEC 61672-1:2013, annex E
FAST = 0.125  # s, time constant of the weighting F of IEC 61672-1
_SHORTEST = 8 * FAST  # s, of a record whose level the fast weighting follows


@dataclass(frozen=True, eq=False)
class SoundLevels:
    """Levels of one record.

    record: its name; equivalent: A-weighted over the whole record [dB]; unweighted: the same without weighting [dB]
    loudest: largest of the fast level once it has settled [dB]; time [s], (n,); fast: A-weighted level with the
    time weighting F [dB], (n,)
    """

    record: str
    equivalent: float
    unweighted: float
    loudest: float
    time: np.ndarray
    fast: np.ndarray


def a_weighting(frequency: np.ndarray) -> np.ndarray:
    """H_A, complex, dimensionless, 1 in size at 1 kHz; frequency: [Hz], any shape, which the answer has."""
    low, second, third, high = (2 * pi * f for f in CORNERS)
    poles = [-low, -low, -second, -third, -high, -high]

    def answer(at: np.ndarray) -> np.ndarray:
        """Response before it is made 1 at 1 kHz, complex, (n,); at: [Hz], (n,)."""
        return scipy.signal.freqs_zpk([0.0] * 4, poles, 1.0, 2 * pi * np.atleast_1d(at))[1]

    return (answer(np.asarray(frequency).ravel()) / np.abs(answer(np.array([1000.0])))).reshape(np.shape(frequency))


def sound_levels(record: Record) -> SoundLevels:
    """From the channel pressure. Raises RecordError for a record of less than a second."""
    if record.duration < _SHORTEST:
        raise RecordError(
            f"{record.name}: expected {_SHORTEST:g} s of sound or more, found {record.duration:.3g} s; record longer."
        )
    pressure = record.channel("pressure") - record.channel("pressure").mean()
    spectrum = np.fft.rfft(pressure) * a_weighting(np.fft.rfftfreq(record.samples, record.step))
    weighted = np.fft.irfft(spectrum, record.samples)
    keep = np.exp(-record.step / FAST)
    mean_square = scipy.signal.lfilter([1 - keep], [1, -keep], np.square(weighted))
    fast = 10 * np.log10(np.maximum(mean_square, 1e-30) / REFERENCE_PRESSURE**2)
    settled = record.time >= 5 * FAST
    return SoundLevels(record.name, _level(weighted), _level(pressure), float(fast[settled].max()), record.time, fast)


def _level(pressure: np.ndarray) -> float:
    return 20 * log10(float(np.sqrt(np.mean(np.square(pressure)))) / REFERENCE_PRESSURE)
