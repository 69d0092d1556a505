"""The vehicle driven again with the actuator that was designed for it (thesis Fig. 3.28)."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from actuator.drive import MappedMotor, TorqueLimit
from actuator.model import Actuator
from actuator.parts import MechanicalLoss
from drivetrain.actuator_limits import ActuatorLimits
from vehicle.damping import DamperCurve
from vehicle.demands import RideCase, RideRequirements
from vehicle.most_demanding import SetBy
from vehicle.ride import simulate
from vehicle.ride_means import RideMeans, ride_means
from vehicle.scenarios import summaries
from vehicle.traces import Trace, Traces, traces

IDEAL_NAME, DESIGNED_NAME = "ideal", "designed"
_HELD_BACK = 1e-3  # of the force that is asked for; less is missing only by rounding


@dataclass(frozen=True)
class WorstCase:
    """The run that sets the peak force, with one actuator; magnitudes.

    force_peak: of the machine [N]; velocity_peak [m/s]; stroke_peak [m]; tyre_load_min, tyre_load_max: of the actuated
    axle [N]; time_saturated: for which the force limit holds back the machine [s]
    """

    force_peak: float
    velocity_peak: float
    stroke_peak: float
    tyre_load_min: float
    tyre_load_max: float
    time_saturated: float


@dataclass(frozen=True, eq=False)
class RideAgain:
    """The vehicle with the designed actuator beside the ideal one.

    set_by: the worst case, which sets the peak force; ideal, designed: its numbers; worst_traces: its histories, named
    "ideal" and "designed"
    road_ideal, road_designed: means over the seeds of the random road, one a damping
    """

    set_by: SetBy
    ideal: WorstCase
    designed: WorstCase
    worst_traces: Traces
    road_ideal: tuple[RideMeans, ...]
    road_designed: tuple[RideMeans, ...]


def ride_again_stage(case: RideCase, found: RideRequirements, actuator: ActuatorLimits) -> RideAgain:
    """The worst case and the random road driven with the designed actuator; the ideal one has been driven before.

    Raises VehicleError where the motion, a curve or the energy balance does not allow it.
    """
    set_by, own = found.demands.force_peak.set_by, driven_actuator(actuator)
    run = case.run(set_by)
    (designed,) = simulate([replace(run, actuator=own)])
    command = next(curve for curve in case.damping if curve.name == set_by.damping)
    pair = traces((IDEAL_NAME, DESIGNED_NAME), (found.worst_traces.by_name[set_by.damping], designed))
    cases = {name: worst_case(trace, command) for name, trace in pair.by_name.items()}
    road = ride_means(summaries([replace(one, actuator=own) for one in case.road_runs]))
    return RideAgain(set_by, cases[IDEAL_NAME], cases[DESIGNED_NAME], pair, found.ride, road)


def driven_actuator(limits: ActuatorLimits) -> Actuator:
    """The actuator as the vehicle feels it: a motor at the wheel, without the ratio, the lag and the mount."""
    speed, force = (tuple(values.tolist()) for values in (limits.speed, limits.force))
    return Actuator(
        MappedMotor(TorqueLimit(speed, force, force)),
        equivalent_mass=limits.equivalent_mass,
        loss=MechanicalLoss(limits.viscous_friction, limits.coulomb_friction),
    )


def worst_case(trace: Trace, command: DamperCurve) -> WorstCase:
    """Numbers of one run; command: the curve that the actuator is asked for."""
    load = trace.tyre_loads[-1]
    return WorstCase(
        force_peak=_largest(trace.actuator_force),
        velocity_peak=_largest(trace.velocity),
        stroke_peak=_largest(trace.stroke),
        tyre_load_min=float(load.min()),
        tyre_load_max=float(load.max()),
        time_saturated=_saturated(trace, command),
    )


def _largest(values: np.ndarray) -> float:
    return float(np.abs(values).max())


def _saturated(trace: Trace, command: DamperCurve) -> float:
    """Time for which less force acts than is asked for [s]."""
    wanted = np.abs(command.at(trace.velocity))
    held = np.abs(trace.actuator_force) < wanted * (1 - _HELD_BACK)
    return float(held.sum() * (trace.time[1] - trace.time[0]))
