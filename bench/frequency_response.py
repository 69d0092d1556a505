"""Frequency responses of records by averaged spectra, with coherence and confidence bands.

    H_1 = S_xy / S_xx  (noise on the output),  H_2 = S_yy / S_yx  (noise on the input),
    gamma^2 = |S_xy|^2 / (S_xx S_yy)

over overlapping segments. The band about H_1 is that of Bendat and Piersol, Random Data, section 9.2 (eq. 9.83 ff.):

    |H - H_1|^2 <= 2 / (n - 2) F(2, n - 2; 0.95) (1 - gamma^2) S_yy / S_xx,   n = 2 n_d

with n_d segments that share nothing; overlapping ones count for less. Seen from a given input it is the band of a
complex
regression of the segments, so that it holds for a sweep as well, as long as the noise is stationary. It says nothing
about leakage: a segment must be longer than the answer rings.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy

from bench.errors import RecordError
from bench.record import Record

OVERLAP = 0.5
_FEWEST_SEGMENTS = 4
_CONFIDENCE = 0.95


@dataclass(frozen=True, eq=False)
class FrequencyResponse:
    """Output over input at each frequency, arrays (m,).

    frequency [Hz], (m,); h1, h2: complex [unit of output over input], (m,); coherence: gamma^2, dimensionless (m,)
    averages: number n_d of segments that share nothing; radius: of the 95 % band about H_1 [unit of H_1], (m,)
    """

    frequency: np.ndarray
    h1: np.ndarray
    h2: np.ndarray
    coherence: np.ndarray
    averages: float
    radius: np.ndarray

    @property
    def is_sure(self) -> np.ndarray:
        """Whether the band is narrower than the response is large (m,)."""
        return self.radius < np.abs(self.h1)

    def between(self, lowest: float, highest: float) -> FrequencyResponse:
        """The part from lowest to highest frequency [Hz]; raises RecordError where nothing lies there."""
        inside = (self.frequency >= lowest) & (self.frequency <= highest)
        if not inside.any():
            raise RecordError(
                f"frequency response: expected frequencies between {lowest:g} and {highest:g} Hz, found none in steps "
                f"of {self.frequency[1]:.3g} Hz; use longer segments."
            )
        h1, h2, coherence, radius = (one[inside] for one in (self.h1, self.h2, self.coherence, self.radius))
        return FrequencyResponse(self.frequency[inside], h1, h2, coherence, self.averages, radius)


def frequency_response(record: Record, cause: np.ndarray, answer: np.ndarray, segment: float) -> FrequencyResponse:
    """Response of answer [SI], (n,), to cause [SI], (n,), channels of a record, their means taken off.

    segment: duration of a segment [s]; its inverse is the distance of the frequencies
    Raises RecordError where the record holds too few segments.
    """
    length = int(round(segment / record.step))
    hop = max(int(length * (1 - OVERLAP)), 1)
    count = (record.samples - length) // hop + 1
    if count < _FEWEST_SEGMENTS:
        raise RecordError(
            f"{record.name}: expected {_FEWEST_SEGMENTS} segments of {segment:g} s or more for an averaged spectrum, "
            f"found {max(count, 0)} in {record.duration:.3g} s; record longer or state a shorter segment."
        )
    window = scipy.signal.windows.hann(length, sym=False)
    transform = scipy.signal.ShortTimeFFT(window, hop, 1 / record.step, scale_to="psd")
    whole = slice(transform.lower_border_end[1], transform.upper_border_begin(record.samples)[1])
    x, y = (transform.stft(one - one.mean())[:, whole] for one in (cause, answer))
    return _of_segments(transform.f[1:], x[1:], y[1:], x.shape[1] / _shared(transform))


def _shared(transform: scipy.signal.ShortTimeFFT) -> float:
    """How many overlapping segments say as much as one that shares nothing: 1 + 2 rho^2 (Welch 1967), half overlap."""
    window = transform.win
    rho = float(window[transform.hop :] @ window[: -transform.hop] / (window @ window))
    return 1 + 2 * rho**2


def _of_segments(frequency: np.ndarray, x: np.ndarray, y: np.ndarray, averages: float) -> FrequencyResponse:
    """x, y: spectra of the segments (m, segments)."""
    s_xx, s_yy = np.sum(np.abs(x) ** 2, axis=1), np.sum(np.abs(y) ** 2, axis=1)
    s_xy = np.sum(np.conj(x) * y, axis=1)
    coherence = np.abs(s_xy) ** 2 / (s_xx * s_yy)
    n = 2 * averages
    share = 2 / (n - 2) * scipy.stats.f.ppf(_CONFIDENCE, 2, n - 2)
    radius = np.sqrt(share * (1 - coherence) * s_yy / s_xx)
    return FrequencyResponse(frequency, s_xy / s_xx, s_yy / np.conj(s_xy), coherence, averages, radius)
