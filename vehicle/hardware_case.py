"""An actuator on a bench in the loop of thesis Fig. 5.15, ready to run: vehicle, road, damping, force control."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from actuator.linear import tangent_plant
from actuator.model import Actuator
from actuator.observer import ForceObserver
from control.design import loop_for
from control.sampled_loop import SampledLoop
from vehicle.comfort import weighted_acceleration
from vehicle.errors import require_positive
from vehicle.hardware_loop import (
    Device,
    HydraulicAxis,
    LoadCellLoop,
    LoopRun,
    LowLevel,
    NoLoop,
    ObserverLoop,
    Platform,
    run_loop,
)
from vehicle.indices import rms
from vehicle.models import Vehicle
from vehicle.real_time import Pace
from vehicle.ride import Scenario

NO_LOOP, LOAD_CELL, OBSERVER = "no force loop", "load cell", "observer"
AXIS = 100.0  # Hz, stand-in: see ``HydraulicAxis``
ENCODER = 2**14  # counts of a turn, a usual resolution
_FASTER = 2.0  # bandwidth of the observer over that of the loop
_AT_REST = 20  # samples that are run before, so that everything is compiled


@dataclass(frozen=True)
class WantedLoop:
    """What the force loop on the bench is made for.

    bandwidth [Hz], margin: of the phase [rad], force: about which it is designed [N]; sample_time [s]
    """

    bandwidth: float = 100.0
    margin: float = np.radians(50.0)
    force: float = 300.0
    sample_time: float = 5e-4

    def __post_init__(self) -> None:
        require_positive("force loop on the bench", bandwidth=self.bandwidth, margin=self.margin, force=self.force)
        require_positive("force loop on the bench", sample_time=self.sample_time)


def low_levels(actuator: Actuator, wanted: WantedLoop) -> Mapping[str, Callable[[], LowLevel]]:
    """The three ways to make the actuator give a force, by name, each made anew on a call.

    Raises ControlError, on the call, where no loop has what is wanted, ActuatorError for a rigid mount.
    """

    def loop() -> SampledLoop:
        """For the actuator about the wanted force."""
        continuous = loop_for(tangent_plant(actuator, wanted.force), wanted.bandwidth, wanted.margin)
        limit = float(actuator.drive.limit.braking_at(0.0)) / actuator.ratio.nominal
        return SampledLoop(continuous, wanted.sample_time, limit)

    def observed() -> LowLevel:
        """Around the observer."""
        return ObserverLoop(loop(), ForceObserver(actuator, wanted.sample_time, _FASTER * wanted.bandwidth))

    return {NO_LOOP: NoLoop, LOAD_CELL: lambda: LoadCellLoop(loop()), OBSERVER: observed}


@dataclass(frozen=True)
class LoopTest:
    """A test in the loop.

    vehicle: with the actuator at its last axle; scenario: what it is driven over; damping: that the high-level control
    asks for [Ns/m]; sample_time: of the loop [s]
    """

    vehicle: Vehicle
    scenario: Scenario
    damping: float
    sample_time: float

    @property
    def road(self) -> np.ndarray:
        """Heights under the wheels at the samples [m], (t, n)."""
        scenario = self.scenario
        time = np.arange(0.0, scenario.duration + self.sample_time, self.sample_time)
        delays = self.vehicle.delays(scenario.speed)
        return np.array([scenario.road.heights(time - late, scenario.speed) for late in delays]).T

    def run(self, device: Device, low_level: LowLevel, paced: bool) -> LoopRun:
        """Drive the vehicle over the road; paced: by the clock of this machine, or as fast as it goes."""
        platform = Platform(
            self.vehicle,
            lambda told: self.damping * (told.body_velocity - told.wheel_velocity),
            low_level,
            self.sample_time,
        )
        pace = Pace(self.sample_time) if paced else None
        return run_loop(platform, device, HydraulicAxis(AXIS), self.road, pace)

    def warm_up(self, device: Device, low_level: LowLevel) -> None:
        """Some samples at rest, so that everything is compiled before a paced run."""
        still = 0 * self.road[:_AT_REST]
        platform = Platform(self.vehicle, lambda told: 0.0, low_level, self.sample_time)
        run_loop(platform, device, HydraulicAxis(AXIS), still)


def loop_numbers(test: LoopTest, run: LoopRun) -> dict[str, float]:
    """What a test comes to by name: loop_numbers [of the unit in the name]."""
    return {
        "damping_Ns_per_m": test.damping,
        "wanted_rms_N": rms(run.wanted),
        "force_rms_N": rms(run.force),
        "force_error_rms_N": run.force_error,
        "force_peak_N": float(np.abs(run.force).max()),
        "comfort_rms_m_per_s2": rms(weighted_acceleration(run.acceleration, test.sample_time)),
    }
