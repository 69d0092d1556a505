"""What a ride on the random road comes to with each damping, over all seeds (thesis Table 3.4)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from vehicle.indices import RideSummary


@dataclass(frozen=True)
class RideMeans:
    """Means over the seeds of one damping; magnitudes, since the sign of a peak differs from seed to seed.

    comfort_rms [m/s^2]; road_holding_rms: dimensionless; stroke_peak [m]; force_rms [N], velocity_rms [m/s];
    power_rms, power_mean [W]
    """

    damping: str
    comfort_rms: float
    road_holding_rms: float
    stroke_peak: float
    force_rms: float
    velocity_rms: float
    power_rms: float
    power_mean: float


def ride_means(road: Sequence[RideSummary]) -> tuple[RideMeans, ...]:
    """One for each damping, in the order in which the runs on the random road name them."""
    dampings = dict.fromkeys(run.damping for run in road)
    return tuple(_means(damping, [run for run in road if run.damping == damping]) for damping in dampings)


def _means(damping: str, runs: Sequence[RideSummary]) -> RideMeans:
    numbers = [f.name for f in fields(RideMeans) if f.name != "damping"]
    values = {name: float(np.mean(np.abs([getattr(run, name) for run in runs]))) for name in numbers}
    return RideMeans(damping, **values)
