"""Roads: random unevenness (ISO 8608), a lumped obstacle, or none. Heights over time at a speed."""

from __future__ import annotations

from dataclasses import dataclass
from math import exp, pi, sqrt
from pathlib import Path

import numpy as np
import scipy

from vehicle.errors import VehicleError, require_positive
from vehicle.tables import read_columns

REFERENCE_FREQUENCY = 0.1  # n_0 [cycle/m], thesis below eq. 3.21 (ISO 8608)
WAVINESS = 2  # w, thesis below eq. 3.21 (ISO 8608)
CUTOFF_WAVELENGTH = 100.0  # lambda_0 [m], thesis below eq. 3.20
# Displacement PSD G_d at n_0 [m^3/cycle], thesis Table 3.3; class E is printed 409.4, off the series of fours.
DISPLACEMENT_PSD = {"A": 1.6e-5, "B": 6.4e-5, "C": 25.6e-5, "D": 102.4e-5, "E": 409.6e-5}


def roughness_of_class(letter: str) -> float:
    """G_r = G_d n_0^w [m cycle] of a road class of ISO 8608.

    Thesis eq. 3.21 prints a division; its Table 3.3 follows from the product.
    """
    if letter not in DISPLACEMENT_PSD:
        raise VehicleError(f"road class must be one of {', '.join(DISPLACEMENT_PSD)}, found '{letter}'; choose one")
    return DISPLACEMENT_PSD[letter] * REFERENCE_FREQUENCY**WAVINESS


class Road:
    """Heights that a wheel meets; the concrete roads are below."""

    def heights(self, time: np.ndarray, speed: float) -> np.ndarray:
        """Height [m], (t,), at these times, zero before t = 0; time: [s], (t,); speed [m/s]."""
        raise NotImplementedError

    @property
    def random_seed(self) -> int | None:
        """Which of many equally likely roads this is, None for one that leaves nothing to chance."""
        return None


@dataclass(frozen=True)
class FlatRoad(Road):
    """No unevenness."""

    def heights(self, time: np.ndarray, speed: float) -> np.ndarray:
        """Zero [m], (t,); time: [s], (t,); speed: [m/s]."""
        return np.zeros(np.shape(time))


@dataclass(frozen=True)
class IsoRoad(Road):
    """Random road: white noise through a first-order low-pass filter (thesis eq. 3.20), from a flat start.

    dz/dt = -omega_0 z + 2 pi sqrt(G_r v) w,   omega_0 = 2 pi v / lambda_0

    w has a one-sided power spectral density of 1 /Hz (two-sided 0.5 /Hz), which is what Table 3.4 follows from.
    roughness: G_r [m cycle]; seed of numpy's default generator; sample_time: the noise is held so long [s];
    cutoff_wavelength: lambda_0 [m].
    Between the samples the height is straight.
    """

    roughness: float
    seed: int
    sample_time: float = 1e-3
    cutoff_wavelength: float = CUTOFF_WAVELENGTH

    def __post_init__(self) -> None:
        require_positive(
            "road",
            roughness=self.roughness,
            sample_time=self.sample_time,
            cutoff_wavelength=self.cutoff_wavelength,
        )

    @property
    def random_seed(self) -> int:
        """The seed."""
        return self.seed

    def cutoff(self, speed: float) -> float:
        """omega_0 [rad/s] at a speed [m/s]."""
        return 2 * pi * speed / self.cutoff_wavelength

    def noise_gain(self, speed: float) -> float:
        """2 pi sqrt(G_r v) [m/s^0.5], from the noise [1/s^0.5] to the velocity of the road; speed: [m/s]."""
        return 2 * pi * sqrt(self.roughness * speed)

    def noise(self, count: int) -> np.ndarray:
        """Samples of w [1/s^0.5], (count,), held for the sample time each: variance 0.5 / T_s."""
        return np.random.default_rng(self.seed).standard_normal(count) * sqrt(NOISE_INTENSITY / self.sample_time)

    def heights(self, time: np.ndarray, speed: float) -> np.ndarray:
        """Height [m], (t,); time: [s], (t,); speed: [m/s]."""
        require_positive("random road", speed=speed)
        count = int(np.ceil(np.max(time) / self.sample_time)) + 1
        decay = exp(-self.cutoff(speed) * self.sample_time)
        gain = self.noise_gain(speed) * (1 - decay) / self.cutoff(speed)
        samples = scipy.signal.lfilter([0.0, gain], [1.0, -decay], self.noise(count + 1))
        return np.interp(time, np.arange(count + 1) * self.sample_time, samples, left=0.0)

    @property
    def stationary_rms(self) -> float:
        """Root mean square of the height far from the start: sqrt(pi G_r lambda_0 / 2) [m], at any speed."""
        return sqrt(NOISE_INTENSITY * pi * self.roughness * self.cutoff_wavelength)


NOISE_INTENSITY = 0.5  # two-sided density of w [1/Hz]


@dataclass(frozen=True)
class ObstacleShape:
    """Normalised profile of a lumped obstacle over distance (thesis Fig. 3.8), straight between the points.

    distance [m], rising from 0; height, from 0 to 0 with 1 at the top.
    """

    distance: tuple[float, ...]
    height: tuple[float, ...]
    source: str

    def __post_init__(self) -> None:
        x, h = np.array(self.distance, dtype=float), np.array(self.height, dtype=float)
        sound = x.shape == h.shape and x.size >= 3 and np.isfinite(x).all() and np.isfinite(h).all()
        if not (sound and x[0] == 0 and (np.diff(x) > 0).all() and h[0] == h[-1] == 0 and np.abs(h).max() == 1):
            raise VehicleError(
                f"obstacle shape ({self.source}): expected distances that rise from 0 and heights that begin and end "
                "at 0 with the largest magnitude 1; correct the table"
            )

    @property
    def length(self) -> float:
        """From the first to the last point [m]."""
        return self.distance[-1]


def read_obstacle_shape(path: Path) -> ObstacleShape:
    """Shape from a CSV file with the columns distance_m and height."""
    distance, height = read_columns(path, "distance_m", "height")
    return ObstacleShape(distance, height, source=Path(path).name)


@dataclass(frozen=True)
class Obstacle(Road):
    """A bump (positive amplitude [m]) or a pothole (negative) that the first wheel meets at t = 0."""

    shape: ObstacleShape
    amplitude: float

    def __post_init__(self) -> None:
        if not (np.isfinite(self.amplitude) and self.amplitude != 0):
            raise VehicleError(
                f"obstacle: needs an amplitude other than zero, found {self.amplitude:g}; give metres above "
                "(bump) or below (pothole) the road, or use a flat road"
            )

    def heights(self, time: np.ndarray, speed: float) -> np.ndarray:
        """Height [m], (t,); time: [s], (t,); speed: [m/s]."""
        require_positive("obstacle", speed=speed)
        shape = self.shape
        return self.amplitude * np.interp(np.asarray(time) * speed, shape.distance, shape.height, left=0.0, right=0.0)
