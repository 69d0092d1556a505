"""Skewed magnets or slots: the mean over slices of the machine, each turned a little further than the one before.

Every slice is a 2-D field of its own with the current of the whole machine; flux does not pass from slice to slice.
Torque, flux linkage and pull of the skewed machine are the means over the slices. On a waveform over the rotor angle
without current, or with one held, that mean multiplies each harmonic by a factor:

    n steps:      k = sin(nu gamma/2) / (n sin(nu gamma/(2 n)))
    continuous:   k = sin(nu gamma/2) / (nu gamma/2)

nu: mechanical order, gamma: skew from end to end of the stack (from the first to the last step: gamma (n - 1)/n).
Source: Pyrhonen, Jokinen, Hrabovcova, Design of Rotating Electrical Machines, 2nd ed. (2014), the skewing factor in the
chapter on windings; multi-slice fields: Piriou, Razek, IEEE Trans. Magn. 26 (1990) 1096.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from magnetostatics.currents import CoilCurrents, PhaseCurrents
from magnetostatics.model import FieldModel, FieldSolution, OperatingPoint
from units import Values

FOR_CONTINUOUS = 5  # Gauss points over a continuous skew; 1e-7 for harmonics that turn by pi in it, 3e-5 for 2 pi


def stepped_skew(skew: float, steps: int) -> tuple[np.ndarray, np.ndarray]:
    """Angles [rad] and weights (sum 1), each (steps,), of equal slices of a skew [rad] from end to end."""
    return skew * ((np.arange(steps) + 0.5) / steps - 0.5), np.full(steps, 1 / steps)


def continuous_skew(skew: float, points: int = FOR_CONTINUOUS) -> tuple[np.ndarray, np.ndarray]:
    """Angles [rad] and weights (sum 1), each (points,), of Gauss slices for a continuous skew [rad] from end to end."""
    nodes, weights = np.polynomial.legendre.leggauss(points)
    return skew / 2 * nodes, weights / 2


def skewed(
    model: FieldModel,
    point: OperatingPoint | PhaseCurrents | CoilCurrents,
    slices: tuple[np.ndarray, np.ndarray],
    read: Callable[[FieldSolution], Values],
) -> Values:
    """Mean of ``read(solution)`` over the slices, all of them with the currents that ``point`` has in the middle.

    read: value [any unit], that of the result; skewed: [the same], of its shape
    slices: angles [rad] and weights, (slices,) each, of ``stepped_skew`` or ``continuous_skew``
    """
    total: Values = 0.0
    held, solution = with_held_currents(point, model), None
    for offset, weight in zip(*slices):
        solution = model.solve(replace(held, angle=held.angle + float(offset)), start=solution)
        total = total + weight * np.asarray(read(solution))
    return total


def with_held_currents(
    point: OperatingPoint | PhaseCurrents | CoilCurrents, model: FieldModel
) -> PhaseCurrents | CoilCurrents:
    """The same state with currents that do not follow the rotor when its angle is replaced."""
    if isinstance(point, OperatingPoint):
        a, b, c = point.ampere_turns(model.section).tolist()
        return PhaseCurrents(point.angle, (a, b, c))
    return point


def skewed_waveform(values: np.ndarray, period: float, slices: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
    """A waveform over the rotor angle after skewing, by its harmonics, in its unit and shape.

    skewed_waveform, values: [any unit], (..., n), at equal steps over one whole period, currents zero or held
    period: [rad mechanical]; slices: angles [rad] and weights, (slices,) each
    """
    count = values.shape[-1]
    orders = 2 * np.pi / period * np.arange(count // 2 + 1)
    angles, weights = slices
    factor = np.exp(1j * np.outer(orders, angles)) @ weights
    return np.fft.irfft(np.fft.rfft(values) * factor, count)


def skew_factor(order: float, skew: float, steps: int | None = None) -> float:
    """k of a harmonic of a mechanical order; steps: None for a continuous skew [rad]."""
    half = order * skew / 2
    if steps is None:
        return float(np.sinc(half / np.pi))
    return float(np.sinc(half / np.pi) / np.sinc(half / steps / np.pi))
