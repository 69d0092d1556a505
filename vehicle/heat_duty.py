"""What the runs of a vehicle ask of the machine as long as it drives, for its temperatures."""

from __future__ import annotations

import numpy as np

from thermal.stage import Duty
from vehicle.demands import RideRequirements


def road_duty(found: RideRequirements) -> Duty:
    """The random road with the damping that sets the RMS force, one seed after the other."""
    road = found.nominal
    effort, speed = (road[name].transpose("seed", "time").values.ravel() for name in ("force", "velocity"))
    return Duty(effort, speed, float(np.diff(road.time.values[:2])[0]))
