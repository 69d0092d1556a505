"""Mechanical impedance Z = F / v from records of a driven output (thesis eq. B.1): of a sine, or of a sweep.

A sine with its harmonics is fitted to stroke and force by least squares, the frequency free (as the four-parameter fit
of IEEE 1057); the impedance is the ratio of the fundamentals. What is left is noise, which says how sure that is.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import log, pi, sqrt

import numpy as np
from scipy.optimize import minimize_scalar

from bench.errors import RecordError
from bench.frequency_response import FrequencyResponse, frequency_response
from bench.memory import memory_of
from bench.record import Record

_HARMONICS = 9  # fitted, so that the distortion of a play or a rectifier does not count as noise
_OF_RADIUS = sqrt(-2 * log(0.05))  # radius that 95 % of a complex normal number lie in, over its deviation in a part
_FEWEST_PERIODS = 3
_FEWEST_PER_PERIOD = 4 * _HARMONICS  # samples


@dataclass(frozen=True)
class ImpedancePoint:
    """Impedance at one frequency.

    record: its name; frequency [Hz]; amplitude: of the stroke [m]; shunt [ohm], infinite for an open circuit
    impedance: fundamental of force over velocity [Ns/m], complex; error: standard deviation of either part [Ns/m]
    distortion: rms of the force's harmonics over that of its fundamental, dimensionless
    """

    record: str
    frequency: float
    amplitude: float
    shunt: float
    impedance: complex
    error: float
    distortion: float


def sine_impedance(record: Record) -> ImpedancePoint:
    """From the channels stroke, force and shunt of a record of one sine.

    Raises RecordError for a record of too few periods or samples a period.
    """
    stroke, force = record.channel("stroke"), record.channel("force")
    frequency = _frequency(record, stroke)
    moved, rest_of_stroke = _harmonics(stroke, frequency, record.step)
    pushed, rest_of_force = _harmonics(force, frequency, record.step)
    velocity = 2j * pi * frequency * moved[0]
    impedance = complex(pushed[0] / velocity)
    force_error, stroke_error = (_error(rest) for rest in (rest_of_force, rest_of_stroke))
    error = sqrt(force_error**2 + abs(impedance * 2 * pi * frequency * stroke_error) ** 2) / abs(velocity)
    distortion = float(np.linalg.norm(pushed[1:]) / abs(pushed[0]))
    shunt = record.constant("shunt")
    return ImpedancePoint(record.name, frequency, float(abs(moved[0])), shunt, impedance, error, distortion)


def sweep_impedance(record: Record, segment: float) -> FrequencyResponse:
    """Force over velocity of a sweep or of noise, channels stroke (or velocity) and force, by averaged spectra.

    segment: duration of a segment [s]. The fundamental of a device that is not linear needs a sine.
    """
    return frequency_response(record, record.velocity(), record.channel("force"), segment)


def sweep_points(record: Record, found: FrequencyResponse) -> list[ImpedancePoint]:
    """The frequencies of a sweep whose band is narrower than the impedance, as if each were a sine of a record.

    found: ``sweep_impedance`` of the record, which also needs the channels stroke and shunt. The amplitude is that of a
    sine with the rms of the stroke: right for a sweep of constant stroke, and without meaning for a linear device.
    """
    amplitude, shunt = sqrt(2) * float(np.std(record.channel("stroke"))), record.constant("shunt")
    rows = zip(found.frequency[found.is_sure], found.h1[found.is_sure], found.radius[found.is_sure])
    return [
        ImpedancePoint(record.name, float(f), amplitude, shunt, complex(z), float(radius) / _OF_RADIUS, 0.0)
        for f, z, radius in rows
    ]


def _frequency(record: Record, stroke: np.ndarray) -> float:
    """Of the largest line of the spectrum, then where a sine fits the stroke best."""
    spectrum = np.abs(np.fft.rfft((stroke - stroke.mean()) * np.hanning(len(stroke))))
    line = 1 / record.duration
    start = line * float(np.argmax(spectrum))
    _require_resolved(record, start)

    def left(frequency: float) -> float:
        """Squares of the stroke that a sine of this frequency [Hz] leaves [m^2]."""
        return float(np.sum(np.square(_harmonics(stroke, frequency, record.step)[1])))

    return float(
        minimize_scalar(left, bounds=(start - line, start + line), method="bounded", options={"xatol": 1e-6 * line}).x
    )


def _require_resolved(record: Record, frequency: float) -> None:
    periods, per_period = frequency * record.duration, 1 / (frequency * record.step) if frequency else 0.0
    if periods < _FEWEST_PERIODS or per_period < _FEWEST_PER_PERIOD:
        raise RecordError(
            f"{record.name}: expected a sine of {_FEWEST_PERIODS} periods or more with {_FEWEST_PER_PERIOD} samples "
            f"each, found {periods:.3g} periods with {per_period:.3g}; record longer or sample faster."
        )


def _harmonics(signal: np.ndarray, frequency: float, step: float) -> tuple[np.ndarray, np.ndarray]:
    """Complex amplitudes of the harmonics from the fundamental on, and what is left beside them, mean and drift."""
    time = step * np.arange(len(signal))
    turning = np.exp(2j * pi * frequency * np.outer(time, np.arange(1, _HARMONICS + 1)))
    basis = np.column_stack([np.ones_like(time), time / time[-1], turning.real, -turning.imag])
    found = np.linalg.solve(basis.T @ basis, basis.T @ signal)
    real, imaginary = np.split(found[2:], 2)
    return real + 1j * imaginary, signal - basis @ found


def _error(rest: np.ndarray) -> float:
    """Standard deviation of either part of an amplitude: sigma sqrt(2 g / n)."""
    return float(np.std(rest)) * sqrt(2 * memory_of(rest) / len(rest))
