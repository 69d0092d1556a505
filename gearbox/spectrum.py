"""Load spectra: torque classes from a history, load cycles of the gears, and rainflow counting.

The torque at the slow shaft is sorted into classes of even width and each class keeps its share of the time and its
mean speed, as the thesis does (text to eqs 3.121-3.123); the cycles then follow from the revolutions.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import ArrayLike

from gearbox.batch import Batch
from gearbox.errors import GearError
from units import DEGREE


@dataclass(frozen=True)
class LoadSpectrum:
    """Torque classes at the slow shaft (carrier of stage 1).

    torque: magnitude [Nm], (classes,), representative of each class; share: of the operating time, sum 1, (classes,)
    speed: mean magnitude in the class [rad/s], (classes,); duration: operating time of the life [s]
    swing: angle between the ends of the shaft's motion [rad], inf for continuous rotation
    """

    torque: np.ndarray
    share: np.ndarray
    speed: np.ndarray
    duration: float
    swing: float = np.inf

    def __post_init__(self) -> None:
        sizes = {np.shape(part) for part in (self.torque, self.share, self.speed)}
        if len(sizes) != 1 or np.ndim(self.torque) != 1 or not np.size(self.torque):
            raise GearError(f"a load spectrum needs as many torques as shares and speeds; found shapes {sorted(sizes)}")
        wrong = np.any(np.asarray(self.torque) <= 0) or np.any(np.asarray(self.share) < 0) or np.any(self.speed < 0)
        if wrong or abs(np.sum(self.share) - 1) > 1e-6 or not (self.duration > 0 and self.swing > 0):
            raise GearError(
                "a load spectrum needs torques above 0, shares and speeds not below 0, shares that sum to 1, and a "
                f"positive duration and swing; found a sum of {np.sum(self.share):.6g} over {self.duration:g} s"
            )

    @property
    def revolutions(self) -> np.ndarray:
        """Number of revolutions of the slow shaft in each class over the life, back and forth added up, (classes,)."""
        return self.share * self.duration * self.speed / (2 * pi)

    @property
    def rms_torque(self) -> float:
        """Root mean square over the time [Nm]."""
        return float(np.sqrt(np.sum(self.share * self.torque**2)))

    def scaled(self, torque_factor: float, speed_factor: float) -> LoadSpectrum:
        """The same classes behind a transmission: torque and speed times these factors, the swing times the second."""
        return LoadSpectrum(
            self.torque * torque_factor, self.share, self.speed * speed_factor, self.duration, self.swing * speed_factor
        )


def spectrum_from_history(
    torque: np.ndarray, speed: np.ndarray, *, class_width: float, duration: float, swing: float
) -> LoadSpectrum:
    """Spectrum of an evenly sampled history at the slow shaft (method of the thesis).

    torque [Nm], speed [rad/s]: (samples,), any sign; class_width [Nm]; duration: life [s]; swing: [rad], see
    ``largest_swing``. Each class counts with its upper end, so that no torque is rated below what it was; the
    revolutions of the history are kept exactly. Raises GearError.
    """
    torque, speed = np.abs(np.asarray(torque, dtype=float)), np.abs(np.asarray(speed, dtype=float))
    if torque.shape != speed.shape or torque.ndim != 1 or not torque.size or not class_width > 0:
        raise GearError(
            f"a torque history needs as many torques as speeds and a positive class width; found {torque.shape} "
            f"torques, {speed.shape} speeds and {class_width:g} Nm"
        )
    number = np.maximum(np.ceil(torque / class_width).astype(int) - 1, 0)
    count = np.bincount(number)
    used = np.flatnonzero(count)
    mean_speed = np.bincount(number, weights=speed)[used] / count[used]
    return LoadSpectrum((used + 1) * class_width, count[used] / torque.size, mean_speed, duration, swing)


def gaussian_spectrum(
    torque_rms: float, speed_rms: float, *, class_width: float, duration: float, swing: float, crest: float = 4.0
) -> LoadSpectrum:
    """Stand-in without a history: normal torque, speed in proportion to it (a linear damper), up to ``crest`` RMS.

    torque_rms [Nm], speed_rms [rad/s], crest: relative to the RMS, the others as in ``spectrum_from_history``.
    """
    samples = 4000
    quantile = (np.arange(samples) + 0.5) / samples
    normal = np.interp(quantile, *_normal_quantiles(crest))
    scale = 1 / np.sqrt(np.mean(normal**2))
    return spectrum_from_history(
        torque_rms * scale * normal, speed_rms * scale * normal, class_width=class_width, duration=duration, swing=swing
    )


def _normal_quantiles(crest: float) -> tuple[np.ndarray, np.ndarray]:
    """Distribution function of |x| of a normal x up to a multiple of its RMS, and x."""
    x = np.linspace(0, crest, 2001)
    density = np.exp(-(x**2) / 2)
    total = np.concatenate([[0], np.cumsum((density[1:] + density[:-1]) / 2)])
    return total / total[-1], x


def largest_swing(angle: ArrayLike) -> float:
    """Largest angle between two successive reversals of a history of the shaft's angle [rad]."""
    turning = reversals(angle)
    return float(np.max(np.abs(np.diff(turning)), initial=0.0))


def cycles_per_revolution(contacts: float, alternation: float, swing: float, speed_ratio: float) -> Batch:
    """N_j = a_1 a_2 max(1, 2 pi / (swing ratio)): number of load cycles of a gear per revolution of that gear (3.123).

    contacts a_1: number of them per continuous revolution (3 for sun and ring, 1 for a planet)
    alternation a_2: dimensionless, 0.5 where a full alternation takes two revolutions, there and back (sun, ring), 1
        for a planet
    swing [rad] of the input shaft of the stage
    speed_ratio: number of turns of the gear, against the carrier, per turn of that shaft
    """
    return contacts * alternation * np.maximum(1.0, 360 * DEGREE / (swing * speed_ratio))


def reversals(history: ArrayLike) -> np.ndarray:
    """Turning points (k,) of a history (n,) [any unit, that of the result], its first and last value included."""
    values = np.asarray(history, dtype=float)
    values = values[np.concatenate([[True], np.diff(values) != 0])]
    if values.size < 3:
        return values
    inner = np.diff(values)[:-1] * np.diff(values)[1:] < 0
    return values[np.concatenate([[True], inner, [True]])]


def rainflow(history: ArrayLike) -> np.ndarray:
    """Cycles of a history, (cycles, 3), by the rainflow rule of ASTM E1049-85, 5.4.4.

    history: [any unit], (n,); rainflow: range and mean [unit of the history], count (1 or 0.5)
    """
    stack, found = [], []
    for point in reversals(history):
        stack.append(point)
        while len(stack) >= 3 and abs(stack[-1] - stack[-2]) >= abs(stack[-2] - stack[-3]):
            first, second = stack[-3], stack[-2]
            if len(stack) == 3:  # the range holds the start of the history: half a cycle
                found.append((abs(second - first), (first + second) / 2, 0.5))
                stack.pop(0)
            else:
                found.append((abs(second - first), (first + second) / 2, 1.0))
                del stack[-3:-1]
    found += [(abs(b - a), (a + b) / 2, 0.5) for a, b in zip(stack[:-1], stack[1:], strict=True)]
    return np.array(found).reshape(-1, 3)
