"""What the runs of a vehicle ask of the gears over their life."""

from __future__ import annotations

from gearbox.stage import GearLoads, RecordedLoads
from vehicle.demands import RideRequirements


def road_loads(found: RideRequirements) -> GearLoads:
    """The random road with the damping that sets the RMS force."""
    return RecordedLoads(found.nominal)
